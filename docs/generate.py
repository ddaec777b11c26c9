"""Pages that the program itself tells: commands, terms, documents, constants, notebooks, the API.

They are written to ``_generated`` when the site is built and are not kept.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from page_commands import commands_page
from page_constants import constants_page
from page_documents import documents_page
from page_terms import terms_pages
from sphinx.application import Sphinx

HERE = Path(__file__).parent
_NOTEBOOKS = HERE.parent / "notebooks"


def write_pages(folder: Path) -> None:
    """Write every generated page into a folder, which is emptied first."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    pages = {
        "commands.md": commands_page(), "constants.md": constants_page(),
        "documents.md": documents_page(), **terms_pages(),
    }  # fmt: skip
    for name, text in pages.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    shutil.copytree(_NOTEBOOKS, folder / "notebooks", ignore=shutil.ignore_patterns(".*"))


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before Sphinx looks for them."""
    app.connect("builder-inited", lambda _: write_pages(HERE / "_generated"))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
