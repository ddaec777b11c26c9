"""One record as it was read: displacement and force over time, and force over displacement."""

from __future__ import annotations

import numpy as np

from discover.plots.style import ACCENT, INK, house_style, new_figure, scaled
from discover.plots.svg import to_svg
from discover.records import Record
from models.checks import Array

_COLUMNS = 300  # stretches of a record whose least and greatest values are drawn
_POINTS = 1200  # of the loops


def record_view(record: Record, *, name: str) -> str:
    """Draw a record as one ``<svg>`` element.

    Parameters
    ----------
    record : Record
        With displacement or without.
    name : str
        Prefix of the picture's ids, unique on the page.
    """
    with house_style():
        figure = new_figure(620, 310)
        grid = figure.add_gridspec(2, 2, width_ratios=(1.6, 1.0))
        upper = figure.add_subplot(grid[0, 0])
        lower = figure.add_subplot(grid[1, 0], sharex=upper)
        loops = figure.add_subplot(grid[:, 1])
        force_scale, force_unit = scaled(float(np.abs(record.force).max()), "N")
        lower.plot(*_envelope(record.time, force_scale * record.force), color=INK, linewidth=0.9)
        lower.set(xlabel="Time (s)", ylabel=f"Force ({force_unit})")
        upper.tick_params(labelbottom=False)
        if record.displacement is not None:
            scale, unit = scaled(float(np.abs(record.displacement).max()), "m")
            x = scale * record.displacement
            upper.plot(*_envelope(record.time, x), color=ACCENT, linewidth=0.9)
            upper.set_ylabel(f"Displ. ({unit})")
            thin = slice(None, None, max(1, x.size // _POINTS))
            loops.plot(x[thin], force_scale * record.force[thin], color=INK, linewidth=0.6)
            loops.set(xlabel=f"Displacement ({unit})", ylabel=f"Force ({force_unit})")
        for axes in (upper, lower, loops):
            axes.locator_params(nbins=4)
        figure.align_ylabels([upper, lower])
        return to_svg(figure, name=name, title=f"Displacement and force of {record.file}")


def _envelope(time: Array, values: Array) -> tuple[Array, Array]:
    """Return the values thinned so that every peak stays."""
    if values.size <= 4 * _COLUMNS:
        return time, values
    edges = np.linspace(0, values.size, _COLUMNS + 1).astype(int)
    kept: list[int] = []
    for first, last in zip(edges[:-1], edges[1:], strict=True):
        ends = first + np.array([np.argmin(values[first:last]), np.argmax(values[first:last])])
        kept += sorted(ends.tolist())
    return time[kept], values[kept]
