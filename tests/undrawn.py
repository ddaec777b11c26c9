"""Pages with blank pictures, where a test shows something else.

Of a small campaign the pictures take longer than its study.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO

import pytest
from matplotlib.figure import Figure

BLANK = '<svg width="1pt" height="1pt"></svg>'


@contextmanager
def blank_pictures() -> Iterator[None]:
    """Lay pictures of pages out in the block, and leave them blank; files are drawn."""
    draw = Figure.savefig

    def savefig(figure, place, **options):
        if isinstance(place, StringIO):
            place.write(BLANK)
        else:
            draw(figure, place, **options)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", savefig)
        yield
