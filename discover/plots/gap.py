"""Pictures of a gap search: records before and after, loops, the effect's shape, the contest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import Any

import numpy as np

from discover.figure_data import EffectShape, GapFigureData
from discover.plots.style import (
    ACCENT,
    BEFORE,
    INK,
    MODEL,
    MUTED,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
    scaled,
)
from discover.plots.svg import to_svg
from discover.words import raised, short_name

_ROW = 17.0
_NARROW = 15  # letters of a line of a round's name
_LEVEL = 5  # names that have room side by side


def gap_by_record(records: Sequence[Mapping[str, Any]]) -> str | None:
    """Draw each record's gap before and after beside its noise floor, one row a record.

    Parameters
    ----------
    records : sequence of mapping
        As in ``gap.json``; None is returned for none.
    """
    if not records:
        return None
    values = [
        v
        for r in records
        for v in (r["gap_before_percent"], r["gap_after_percent"], r["noise_percent"])
        if v
    ]
    with house_style():
        figure = new_figure(620, 100 + _ROW * max(len(records), 3))
        axes = figure.add_subplot()
        axes.set_xscale("log")
        axes.set_xlim(min(values) / 1.15, max(values) * 1.15)
        for row, record in enumerate(records):
            ends = [record["gap_before_percent"], record["gap_after_percent"]]
            axes.plot(ends, [row, row], color="#c5cdd6", linewidth=1.6, zorder=1)
        rows = range(len(records))
        axes.plot(
            [r["noise_percent"] or np.nan for r in records],
            rows,
            linestyle="none",
            marker="|",
            markersize=11,
            markeredgewidth=2.2,
            color=MUTED,
            label="noise floor",
        )
        for key, colour, label in (
            ("gap_before_percent", BEFORE, "before"),
            ("gap_after_percent", MODEL, "after"),
        ):
            for held_out in sorted({bool(r["held_out"]) for r in records}):
                group = [(r[key], i) for i, r in enumerate(records) if r["held_out"] == held_out]
                axes.plot(
                    *zip(*group, strict=True),
                    "o",
                    markersize=7.0,
                    markerfacecolor="white" if held_out else colour,
                    markeredgecolor=colour,
                    markeredgewidth=1.5,
                    label=f"{label}, held out" if held_out else label,
                    zorder=3,
                )
        axes.set_ylim(max(len(records), 3) - 0.4, -0.6)
        axes.set_yticks(rows, [str(r["file"]) for r in records])
        axes.tick_params(axis="y", length=0, labelcolor=INK)
        axes.grid(visible=False, axis="y")
        axes.spines["left"].set_visible(False)
        plain_log_axis(axes, which="x")
        axes.set_xlabel("Gap, ‖force − model‖ / ‖force‖ (%)")
        legend_above(figure, ncols=3, columnspacing=1.2, handletextpad=0.4)
        return to_svg(figure, name="gap-records", title="Gap of each record before and after")


def gap_by_round(document: Mapping[str, Any]) -> str | None:
    """Draw the pooled gap from round to round, fitted and held out; None without rounds."""
    rounds = document["rounds"]
    if not rounds:
        return None
    # Rounds start from the baseline's own coefficients refitted, not from what was given.
    names = ["baseline" if document["baseline"].get("fixed") else "baseline,\nrefitted"]
    for r in rounds:
        instead = " instead" if r.get("dropped") else ""
        names.append("\n".join(wrap(f"+ {short_name(r['effect'])}{instead}", _NARROW)))
    with house_style():
        figure = new_figure(620, 290 if len(names) <= _LEVEL else 350)
        axes = figure.add_subplot()
        axes.set_yscale("log")
        for key, colour, label in (("gap", ACCENT, "fitted"), ("held_out", MODEL, "held out")):
            values = [rounds[0][f"{key}_before_percent"]]
            values += [r[f"{key}_after_percent"] for r in rounds]
            if all(v is not None for v in values):
                axes.plot(range(len(values)), values, "o-", color=colour, label=label)
        if document.get("noise_percent"):
            axes.axhline(
                document["noise_percent"],
                color=MUTED,
                linewidth=1.6,
                linestyle=(0, (4, 2)),
                label="noise floor",
            )
        if len(names) > _LEVEL:  # names would run into each other
            slanted = [name.replace("\n", " ") for name in names]
            axes.set_xticks(
                range(len(names)), slanted, rotation=28, ha="right", rotation_mode="anchor"
            )
        else:
            axes.set_xticks(range(len(names)), names)
        axes.tick_params(axis="x", labelcolor=INK, length=0)
        axes.set_xlim(-0.3, len(names) - 0.7)
        low, high = axes.get_ylim()
        axes.set_ylim(low / 1.15, high * 1.15)
        axes.set_ylabel("Gap (%)")
        plain_log_axis(axes, which="y")
        axes.grid(visible=False, axis="x")
        legend_above(figure, ncols=3)
        return to_svg(figure, name="gap-rounds", title="The gap from round to round")


def effect_shape(shape: EffectShape, *, name: str) -> str:
    """Draw the force that an effect adds over what it follows, with its band."""
    with house_style():
        figure = new_figure(620, 300)
        axes = figure.add_subplot()
        x_scale, x_unit = scaled(float(np.max(np.abs(shape.x))), shape.unit)
        peak = max(float(np.max(np.abs(c))) for c in (shape.lower, shape.upper, shape.force))
        scale, unit = scaled(peak, "N")
        if shape.measured.size:
            axes.plot(
                x_scale * shape.measured_x,
                scale * shape.measured,
                ".",
                markersize=3.5,
                color="#aab4c0",
                label="measured less the rest",
            )
        x, lower, upper = x_scale * shape.x, scale * shape.lower, scale * shape.upper
        band: dict[str, Any] = {"color": MODEL, "alpha": 0.2, "label": "95 % band"}
        if shape.joined:
            axes.fill_between(x, lower, upper, linewidth=0.0, **band)
        else:
            axes.vlines(x, lower, upper, linewidth=1.6, **band)
        look = "-" if shape.joined else "."
        axes.plot(x, scale * shape.force, look, markersize=4.0, color=MODEL, label="the effect")
        along = f"{shape.abscissa.capitalize()} ({raised(x_unit)})"
        axes.set(xlabel=along, ylabel=f"Force ({unit})")
        legend_above(figure, ncols=3)
        return to_svg(figure, name=name, title=f"Shape of {short_name(shape.effect)}")


def contest(entry: Mapping[str, Any], *, name: str) -> str:
    """Draw the candidates of one round with their probabilities, the named one first."""
    parts = [(str(entry["effect"]), float(entry["probability"]))]
    parts += [
        (str(a["effect"]), float(a["probability"]))
        for a in entry.get("alternatives", ())
        if a["effect"] != entry["effect"]
    ]
    with house_style():
        figure = new_figure(620, 84 + 26 * len(parts))
        axes = figure.add_subplot()
        for row, (_, probability) in enumerate(parts):
            axes.barh(row, 100.0 * probability, height=0.62, color=MODEL if row == 0 else BEFORE)
            text = "> 99" if probability > 0.995 else f"{100.0 * probability:.0f}"
            axes.text(100.0 * probability + 1.0, row, f"{text} %", va="center", fontsize=10.5)
        axes.set_xlim(0.0, 112.0)
        axes.set_xticks([0, 25, 50, 75, 100])
        axes.set_ylim(len(parts) - 0.5, -0.5)
        axes.set_yticks(range(len(parts)), [short_name(label) for label, _ in parts])
        axes.tick_params(axis="y", length=0, labelcolor=INK)
        axes.grid(visible=False, axis="y")
        axes.spines["left"].set_visible(False)
        axes.set_xlabel("Probability of the effect (%)")
        return to_svg(figure, name=name, title=f"Candidates beside {short_name(entry['effect'])}")


def misfit_surface(data: GapFigureData) -> str | None:
    """Draw the baseline's misfit over displacement and velocity; None where it is not given."""
    if not data.surface:
        return None
    columns = sorted({c.displacement for c in data.surface})
    rows = sorted({c.velocity for c in data.surface})
    values = np.full((len(rows), len(columns)), np.nan)
    for cell in data.surface:
        values[rows.index(cell.velocity), columns.index(cell.displacement)] = cell.share
    limit = float(np.nanmax(np.abs(values))) or 1.0
    with house_style():
        figure = new_figure(620, 400)
        axes = figure.add_subplot()
        mesh = axes.pcolormesh(
            columns,
            rows,
            values,
            cmap="PuOr_r",
            vmin=-limit,
            vmax=limit,
            shading="nearest",
            edgecolors="face",
            linewidth=0.4,
        )
        bar = figure.colorbar(mesh, ax=axes)
        bar.set_label("Misfit (of the records' rms misfit)")
        axes.set(xlabel="Displacement (of its amplitude)", ylabel="Velocity (of its amplitude)")
        axes.grid(visible=False)
        return to_svg(figure, name="gap-surface", title="Where in the cycle the baseline misses")
