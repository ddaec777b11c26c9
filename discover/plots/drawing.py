"""A drawing as it stands in a page, which can be saved in other formats too."""

from __future__ import annotations

from io import BytesIO

from matplotlib.figure import Figure

from discover.plots.style import house_style

_DPI = 192  # twice the page's, for print


class Drawing(str):
    """One ``<svg>`` element as text, which still knows the figure that it was drawn from.

    Examples
    --------
    >>> from discover.plots.style import new_figure
    >>> from discover.plots.svg import to_svg
    >>> picture = to_svg(new_figure(100, 80), name="empty", title="Nothing")
    >>> picture.startswith("<svg"), picture.saved("png")[1:4]
    (True, b'PNG')
    """

    figure: Figure

    def __new__(cls, svg: str, figure: Figure) -> Drawing:
        """Keep the figure beside the text."""
        made = super().__new__(cls, svg)
        made.figure = figure
        return made

    def __reduce__(self) -> tuple[type[Drawing], tuple[str, Figure]]:
        """Pickle text and figure."""
        return (Drawing, (str(self), self.figure))

    def saved(self, kind: str) -> bytes:
        """Return the drawing in a format that matplotlib writes, as "png" or "pdf"."""
        stream = BytesIO()
        stamp = {"CreationDate": None} if kind == "pdf" else {}
        with house_style():
            self.figure.savefig(stream, format=kind, dpi=_DPI, metadata=stamp)
        return stream.getvalue()
