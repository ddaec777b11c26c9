"""A figure as one ``<svg>`` element of a page, with what the page's script needs to read it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from io import StringIO
from typing import Any
from xml.sax.saxutils import escape, quoteattr

import matplotlib
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter

from discover.plots.drawing import Drawing

_FONTS = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
_SERIES = "series:"
_POINTS_PER_PIXEL = 0.75


def series(artists: Artist | Iterable[Artist], name: str) -> None:
    """Give curves a name by which the page's script shows their values and hides them."""
    for artist in [artists] if isinstance(artists, Artist) else artists:
        artist.set_gid(_SERIES + name)


def to_svg(figure: Figure, *, name: str, title: str) -> Drawing:
    """Return `figure` as one ``<svg>`` element that can stand in a page beside others.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Drawn inside `house_style`.
    name : str
        Prefix of every id, unique on the page; letters, digits and hyphens.
    title : str
        What a screen reader says of the picture.

    Examples
    --------
    >>> from discover.plots.style import house_style, new_figure
    >>> with house_style():
    ...     text = to_svg(new_figure(100, 80), name="empty", title="Nothing & more")
    >>> text.startswith("<svg"), "<title>Nothing &amp; more</title>" in text
    (True, True)
    """
    stream = StringIO()
    dots_per_inch = figure.dpi
    with matplotlib.rc_context({"svg.hashsalt": name}):
        # savefig would draw everything twice, the first time for the layout alone.
        canvas: Any = FigureCanvasSVG(figure)  # without types
        canvas.print_svg(stream, metadata={"Date": None, "Creator": None})
    figure.dpi = dots_per_inch  # the canvas leaves its own
    text = stream.getvalue()
    text = text[text.index("<svg") :].strip()
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(rf'\bid="{_SERIES}', 'data-series="', text)
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = re.sub(r'(href="|url\()#', rf"\g<1>#{name}-", text)
    # Inside a page a style element would reach past the picture; the root's attribute does not.
    text = re.sub(r"<style.*?</style>", "", text, flags=re.DOTALL)
    text = text.replace("'DejaVu Sans'", _FONTS)
    opening = text[: text.index(">") + 1]
    plain = re.sub(r'\b(width|height)="[\d.]+pt"', "", opening)
    width = figure.get_figwidth() * 96.0
    style = f"max-width:{width:.0f}px;width:100%;height:auto;stroke-linejoin:round"
    attributes = f'role="img" aria-label={quoteattr(title)} style="{style}"'
    read = _readable(figure)
    if read:
        attributes += f" data-axes={quoteattr(json.dumps(read, separators=(',', ':')))}"
    plain = plain.replace("<svg", f"<svg {attributes}", 1)
    return Drawing(plain + f"<title>{escape(title)}</title>" + text[len(opening) :], figure)


def _readable(figure: Figure) -> list[dict[str, Any]]:
    """Return place and scale of the axes whose curves have names, in the picture's units."""
    return [
        _scale(figure, axes, number)
        for number, axes in enumerate(figure.axes, start=1)
        if any(str(a.get_gid()).startswith(_SERIES) for a in axes.get_children())
    ]


def _scale(figure: Figure, axes: Axes, number: int) -> dict[str, Any]:
    size = figure.get_size_inches() * 72.0
    box = axes.get_position()
    scale: dict[str, Any] = {
        "n": number,
        "px": [round(box.x0 * size[0], 2), round(box.x1 * size[0], 2)],
        "py": [round((1.0 - box.y0) * size[1], 2), round((1.0 - box.y1) * size[1], 2)],
        "x": [float(v) for v in axes.get_xlim()],
        "y": [float(v) for v in axes.get_ylim()],
        "log": [axes.get_xscale() == "log", axes.get_yscale() == "log"],
        "label": [axes.get_xlabel(), axes.get_ylabel()],
    }
    if isinstance(axes.yaxis.get_major_formatter(), FixedFormatter):
        rows = zip(axes.get_yticks(), axes.get_yticklabels(), strict=True)
        scale["names"] = {str(round(float(place))): label.get_text() for place, label in rows}
    return scale
