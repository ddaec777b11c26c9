"""Files in a campaign's folder that none of its records is of."""

from __future__ import annotations

import tomllib
from pathlib import Path, PurePath

from discover.readers.draft_tables import record_files
from discover.readers.entries import expanded
from discover.readers.tables import read_entries
from discover.records import Finding
from discover.words import counted, some_of
from models.checks import printable

_FILE = "campaign.toml"


def left_out_files(path: str | Path) -> list[str]:
    """Return the files in a campaign's folder that may be records and are in no ``[[records]]``.

    Parameters
    ----------
    path : str or Path
        The campaign as `read_campaign` has read it. Beside one file of records nothing is left
        out. What lies in a campaign further down is that one's.
    """
    given = Path(path)
    folder = given.parent if given.name == _FILE else given
    if not (folder / _FILE).is_file():
        return []
    table = tomllib.loads((folder / _FILE).read_text(encoding="utf-8-sig"))
    entries = expanded(read_entries(table.get("records")), folder, where=_FILE)
    named = {PurePath(entry.file) for entry in entries}
    others = [p.parent for p in folder.rglob(_FILE) if p.parent != folder]
    return [
        file
        for file in record_files(folder)
        if PurePath(file) not in named and not set((folder / file).parents) & set(others)
    ]


def left_out_findings(path: str | Path) -> list[Finding]:
    """Return what `inerter check` tells of such files: one note, or none."""
    files = left_out_files(path)
    if not files:
        return []
    are = "is" if len(files) == 1 else "are"
    listed = some_of([printable(file) for file in files])
    text = f"{counted(len(files), 'file')} of the folder {are} in no [[records]]: {listed}"
    return [Finding("note", text)]
