"""Dynamic stiffness over frequency, measured beside the model, at each amplitude."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from discover.figure_data import ShownRecord
from discover.plots.style import (
    MODEL_OVER_MANY,
    graded_colours,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
    scaled,
)
from discover.plots.svg import series, to_svg
from discover.residual_data import Response
from models.checks import Array

_ALIKE = 1.08  # amplitudes that differ by less are one
_MOST = 8
# A test alone at its amplitude has no line through it.
_MODEL_OF_SINES: dict[str, Any] = {**MODEL_OVER_MANY, "marker": "x", "markersize": 3.5}


def stiffness(records: Sequence[ShownRecord], *, name: str) -> str | None:
    """Draw magnitude and phase of force over displacement as one ``<svg>``; None without any.

    Sine tests of one amplitude are a curve; every other record is one, with its coherence.

    Parameters
    ----------
    records : sequence of ShownRecord
        With the response of their first model.
    name : str
        Prefix of the picture's ids.
    """
    curves = [c for c in (*_by_amplitude(records), *_by_record(records)) if c[1].size]
    if not curves:
        return None
    wide = any(c[4].size for c in curves)
    with house_style():
        figure = new_figure(620, 520 if wide else 420)
        panels = figure.subplots(3 if wide else 2, 1, sharex=True)
        upper, lower = panels[0], panels[1]
        factor, unit = scaled(max(float(np.max(np.abs(c[2]))) for c in curves), "N/m")
        for (label, frequency, measured, model, coherence), colour in zip(
            curves, graded_colours(len(curves)), strict=True
        ):
            sine = not coherence.size
            look = _points(colour) if sine else {"color": colour, "linewidth": 2.2}
            of_model = _MODEL_OF_SINES if sine else MODEL_OVER_MANY
            for axes, part in ((upper, lambda k: factor * np.abs(k)), (lower, _degrees)):
                lines = axes.plot(frequency, part(measured), label=label, **look)
                lines += axes.plot(frequency, part(model), label="_model", **of_model)
                series(lines, label)
            if coherence.size:
                series(panels[-1].plot(frequency, coherence, **look), label)
        upper.set_xscale("log")
        upper.set_yscale("log")
        upper.set_ylabel(f"|K| ({unit})")
        lower.set_ylabel("Phase of K (°)")
        lower.locator_params(axis="y", nbins=6)
        if wide:
            panels[-1].set(ylabel="Coherence", ylim=(0.0, 1.05))
        panels[-1].set_xlabel("Frequency (Hz)")
        _legend(upper, curves)
        plain_log_axis(upper, which="y")
        plain_log_axis(panels[-1], which="x")
        return to_svg(figure, name=name, title="Dynamic stiffness, measured and model")


_Curve = tuple[str, Array, Any, Any, Array]


def _first(record: ShownRecord) -> Response | None:
    return record.responses[0] if record.responses else None


def _by_amplitude(records: Sequence[ShownRecord]) -> list[_Curve]:
    found: list[tuple[float, Response]] = []
    for record in records:
        response = _first(record)
        if record.frequency is not None and record.amplitude and response is not None:
            found.append((record.amplitude, response))
    groups: list[list[tuple[float, Response]]] = []
    for amplitude, response in sorted(found, key=lambda f: f[0]):
        if not groups or amplitude > _ALIKE * groups[-1][0][0]:
            groups.append([])
        groups[-1].append((amplitude, response))
    curves = []
    for group in groups:
        ordered = sorted((r for _, r in group), key=lambda r: float(r.stiffness_frequency[0]))
        middle = float(np.median([a for a, _ in group]))
        curves.append((
            f"{1e3 * middle:.3g} mm",
            np.concatenate([r.stiffness_frequency for r in ordered]),
            np.concatenate([r.stiffness for r in ordered]),
            np.concatenate([r.model_stiffness for r in ordered]),
            np.zeros(0),
        ))  # fmt: skip
    return curves


def _by_record(records: Sequence[ShownRecord]) -> list[_Curve]:
    found = [
        (r.file, x.stiffness_frequency, x.stiffness, x.model_stiffness, x.coherence)
        for r in records
        if r.frequency is None and (x := _first(r)) is not None
    ]
    return found[:_MOST]


def _degrees(values: Any) -> Array:
    """Return phases without jumps, in degrees, the first from -180 to 180."""
    return np.asarray(np.degrees(np.unwrap(np.angle(values))))


def _points(colour: Any) -> dict[str, Any]:
    """Return rings, so that their colour shows beside the model's crosses inside them."""
    return {
        "color": colour, "linestyle": "none", "marker": "o", "markersize": 7.5,
        "markerfacecolor": "none", "markeredgewidth": 1.8,
    }  # fmt: skip


def _legend(axes: Axes, curves: Sequence[_Curve]) -> None:
    """Name the curves; of very many only the ends, between which colours run."""
    handles, labels = axes.get_legend_handles_labels()
    if len(handles) > _MOST:
        handles, labels = [handles[0], handles[-1]], [labels[0], f"to {labels[-1]}"]
    sines = any(not c[4].size for c in curves)
    (model,) = axes.plot([], [], **(_MODEL_OF_SINES if sines else MODEL_OVER_MANY))
    figure = axes.get_figure(root=True)
    if figure is not None:
        legend_above(
            figure, [*handles, model], [*labels, "model"], ncols=4,
            columnspacing=1.2, handletextpad=0.5,
        )  # fmt: skip
