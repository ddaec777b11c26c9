"""What models leave of a record: spectrum beside noise, over the cycle, correlation; all tests."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.figure_data import ShownRecord
from discover.plots.style import (
    ACCENT,
    INK,
    MODEL,
    MUTED,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
    prediction_look,
    scaled,
)
from discover.plots.svg import series, to_svg

_DECADES = 1e6  # between the greatest force and what is still drawn


def residual(record: ShownRecord, *, name: str) -> str | None:
    """Draw what is left of a record as one ``<svg>``: spectrum, over the cycle, whiteness.

    Parameters
    ----------
    record : ShownRecord
        With a response of each of its models; None is returned for none.
    name : str
        Prefix of the picture's ids.
    """
    if not record.responses or not record.responses[0].frequency.size:
        return None
    first = record.responses[0]
    with house_style():
        figure = new_figure(620, 430)
        grid = figure.add_gridspec(2, 2)
        spectrum = figure.add_subplot(grid[0, :])
        cycle, white = figure.add_subplot(grid[1, 0]), figure.add_subplot(grid[1, 1])
        (line,) = spectrum.plot(first.frequency, first.force, color=INK, linewidth=1.1)
        line.set_label("measured")
        series(line, "measured")
        if first.noise.size:
            (line,) = spectrum.plot(first.frequency, first.noise, color=ACCENT, linewidth=1.6)
            line.set_label("noise")
            series(line, "noise")
        force, unit = scaled(_peak([r.over_phase for r in record.responses]), "N")
        for number, ((label, _), found) in enumerate(
            zip(record.predictions, record.responses, strict=True)
        ):
            look = prediction_look(label, number)
            if number == 0:  # the model that matters, whole
                look = {"color": look["color"], "linewidth": 1.3}
            left = f"left {label}" if label in ("before", "after") else f"left by {label}"
            lines = spectrum.plot(found.frequency, found.left, label=left, **look)
            lines += cycle.plot(360.0 * found.phase, force * found.over_phase, **look)
            lines += white.plot(1e3 * found.lag, found.correlation, **look)
            series(lines, left)
        spectrum.set_xscale("log")
        spectrum.set_yscale("log")
        low, high = spectrum.get_ylim()
        spectrum.set_ylim(max(low, high / _DECADES), high)
        plain_log_axis(spectrum, which="x")
        plain_log_axis(spectrum, which="y")
        spectrum.set(xlabel="Frequency (Hz)", ylabel="Force (N/√Hz)")
        cycle.set(xlabel="Phase of the displacement (°)", ylabel=f"Left ({unit})")
        cycle.set_xlim(0.0, 360.0)
        cycle.set_xticks([0, 90, 180, 270, 360])
        cycle.axhline(0.0, color=MUTED, linewidth=0.8)
        if first.lag.size:
            limit = first.correlation_limit
            band = white.axhspan(-limit, limit, color=MUTED, alpha=0.28, linewidth=0.0)
            white.legend(  # above: the curves may be anywhere inside
                [band], ["95 % of white noise"], loc="lower right", bbox_to_anchor=(1.0, 1.0),
                borderaxespad=0.2, handlelength=1.2,
            )
        white.set(xlabel="Lag (ms)", ylabel="Correlation", ylim=(-1.05, 1.05))
        white.locator_params(axis="x", nbins=5)
        handles, labels = spectrum.get_legend_handles_labels()
        legend_above(figure, handles, labels, ncols=4, columnspacing=1.2)
        title = f"What is left of {record.file}: spectrum, over the cycle, correlation"
        return to_svg(figure, name=name, title=title)


def over_tests(records: Sequence[ShownRecord], *, name: str) -> str | None:
    """Draw what is left from test to test, in the campaign's order; None for under three.

    Parameters
    ----------
    records : sequence of ShownRecord
        In the campaign's order, with the response of their first model.
    name : str
        Prefix of the picture's ids.
    """
    found = [(i, r, r.responses[0]) for i, r in enumerate(records, start=1) if r.responses]
    if len(found) < 3:
        return None
    with house_style():
        figure = new_figure(620, 390)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for held_out in (False, True):
            some = [f for f in found if f[1].held_out is held_out]
            if not some:
                continue
            label = some[0][1].part
            look = {
                "linestyle": "none", "marker": "o", "markersize": 6.0,
                "markerfacecolor": "white" if held_out else MODEL, "markeredgecolor": MODEL,
            }  # fmt: skip
            numbers = [i for i, _, _ in some]
            ratio = [np.nan if x.error_over_noise is None else x.error_over_noise
                     for _, _, x in some]  # fmt: skip
            lines = upper.plot(numbers, ratio, label=label, **look)
            lines += lower.plot(numbers, [x.gain_percent for _, _, x in some], **look)
            series(lines, label)
        upper.set_yscale("log")
        for axes in (upper, lower):
            axes.margins(y=0.12)  # marks are whole at the edges too
        low, high = upper.get_ylim()
        upper.set_ylim(min(low, 0.8), max(high, 1.5))
        upper.axhline(1.0, color=ACCENT, linewidth=1.2)
        plain_log_axis(upper, which="y")
        upper.set_ylabel("Left / noise")
        lower.axhline(0.0, color=MUTED, linewidth=0.8)
        lower.set(xlabel="Test, in the campaign's order", ylabel="Gain (%)")
        lower.xaxis.get_major_locator().set_params(integer=True)
        handles, labels = upper.get_legend_handles_labels()
        legend_above(figure, handles, labels, ncols=3)
        return to_svg(figure, name=name, title="What is left from test to test")


def _peak(curves: Sequence[np.ndarray]) -> float:
    return max((float(np.nanmax(np.abs(c))) for c in curves if np.isfinite(c).any()), default=0.0)
