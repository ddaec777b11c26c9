"""Long names in tables: where they may be broken on a narrow screen."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

_CELL = re.compile(r"<t[dh]\b.*?</t[dh]>", re.DOTALL)
_CODE = re.compile(r'(<span class="pre">)([^<]*)(</span>)')


def breakable(body: str) -> str:
    """Return a page whose code in tables may be broken after a dot or an underscore.

    Examples
    --------
    >>> breakable('<td><span class="pre">bands[].lower_hz</span></td>')
    '<td><span class="pre">bands[].<wbr>lower_<wbr>hz</span></td>'
    """
    return _CELL.sub(lambda cell: _CODE.sub(_with_breaks, cell[0]), body)


def _with_breaks(code: re.Match[str]) -> str:
    opening, name, closing = code.groups()
    return opening + re.sub(r"(?<=[\w\]])([._])(?=\w)", r"\1<wbr>", name) + closing


def _on_page(
    app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object
) -> None:
    if "body" in context:
        context["body"] = breakable(context["body"])


def setup(app: Sphinx) -> dict[str, bool]:
    """Let every page be changed before it is written."""
    app.connect("html-page-context", _on_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
