"""Files in a campaign's folder that none of its records is of."""

from __future__ import annotations

import tomllib
from pathlib import Path, PurePath

from discover.readers.campaign import CAMPAIGN_FILE
from discover.readers.draft_tables import record_files
from discover.readers.entries import expanded
from discover.readers.tables import read_entries
from discover.records import Finding
from discover.words import counted, some_of
from models.checks import printable


def left_out_files(path: str | Path) -> list[PurePath]:
    """Return the files in a campaign's folder that may be records and are in no ``[[records]]``.

    Parameters
    ----------
    path : str or Path
        The campaign as `read_campaign` has read it. Beside one file of records nothing is left
        out. What lies in a campaign further down is that one's.
    """
    given = Path(path)
    folder = given.parent if given.name == CAMPAIGN_FILE else given
    if not (folder / CAMPAIGN_FILE).is_file():
        return []
    table = tomllib.loads((folder / CAMPAIGN_FILE).read_text(encoding="utf-8-sig"))
    entries = expanded(read_entries(table.get("records")), folder, where=CAMPAIGN_FILE)
    named = {PurePath(file) for entry in entries for file in entry.files}
    return [
        file
        for file in map(PurePath, record_files(folder))
        if file not in named and not _of_another(folder, file)
    ]


def _of_another(folder: Path, file: PurePath) -> bool:
    """Tell whether a file lies in a campaign further down."""
    *below, _ = file.parents
    return any((folder / parent / CAMPAIGN_FILE).is_file() for parent in below)


def left_out_findings(path: str | Path) -> list[Finding]:
    """Return what `inerter check` tells of such files: one note, or none."""
    files = left_out_files(path)
    if not files:
        return []
    are = "is" if len(files) == 1 else "are"
    listed = some_of([printable(file.as_posix()) for file in files])
    text = f"{counted(len(files), 'file')} of the folder {are} in no [[records]]: {listed}"
    return [Finding("note", text)]
