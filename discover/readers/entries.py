"""What a table of ``[[records]]`` asks for: files, and the part of them that is a test."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from discover.readers.formats import OPENERS
from models.checks import InputError, shown

_GLOB = "*?["


@dataclass(frozen=True)
class Entry:
    """One table of ``[[records]]``."""

    file: str
    """Path inside the campaign folder, as written; a pattern stands for every file that fits."""
    frequency: float | None = None
    """Hz, as labelled."""
    amplitude: float | None = None
    """m, as labelled."""
    held_out: bool = False
    """Never fitted, only predicted."""
    key: str = "group"
    """What the user called the part: "sheet" or "group"."""
    part: str | int | None = None
    """Name, pattern or number from 1 of the sheet, group or table; None where not given."""
    channel: Mapping[str, str] = field(default_factory=dict)
    """Headers by quantity that are this record's own."""
    channel_told: bool = False
    """Whether its name has to tell them, since other records are of the same samples."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Units by quantity that are this record's own, in place of those of ``[units]``."""
    cells: str = ""
    """Range of a sheet's cells, "" for all."""
    span: tuple[float | None, float | None] = (None, None)
    """s, first and last time that is read; None where open."""
    span_text: str = ""
    """The span as written."""
    step: float | None = None
    """s, the sampling interval where the file states none."""
    beside: tuple[str, ...] = ()
    """Paths of further files of the same test, with the rest of its channels."""

    @property
    def files(self) -> tuple[str, ...]:
        """Return the paths of all files of the test."""
        return self.file, *self.beside

    def label(self, part: str) -> str:
        """Return the record's name: its file, with what tells it from others of that file.

        Examples
        --------
        >>> Entry("a.xlsx").label(""), Entry("a.xlsx", span_text="1 s : 2 s").label("Test 3")
        ('a.xlsx', 'a.xlsx [Test 3, 1 s : 2 s]')
        >>> Entry("a_force.csv", beside=("a_stroke.csv",)).label("")
        'a_force.csv + a_stroke.csv'
        """
        channels = self.channel.values() if self.channel_told else ()
        told = [part, *channels, self.cells, self.span_text]
        inside = ", ".join(text for text in told if text)
        files = " + ".join(self.files)
        return f"{files} [{inside}]" if inside else files


def expanded(entries: Sequence[Entry], folder: Path, *, where: str) -> Iterator[Entry]:
    """Yield the entries, one for each file that a pattern fits and that no entry names itself.

    Parameters
    ----------
    entries : sequence of Entry
        As written.
    folder : Path
        The campaign's.
    where : str
        What holds the entries, for messages.

    Raises
    ------
    InputError
        Where a pattern leads out of the folder or fits nothing.
    """
    named = {file for entry in entries for file in entry.files}
    for entry in entries:
        if entry.beside:
            _check_names(entry, folder, where)
            yield entry
            continue
        if not any(mark in entry.file for mark in _GLOB) or _is_file(folder / entry.file):
            yield entry
            continue
        if Path(entry.file).is_absolute() or ".." in Path(entry.file).parts:
            raise InputError(
                f"file {shown(entry.file)}", expected="in the campaign folder",
                found="outside of it", where=where,
            )  # fmt: skip
        try:
            fitting = sorted(p.relative_to(folder).as_posix() for p in folder.glob(entry.file))
        except (ValueError, OSError, NotImplementedError) as error:
            raise InputError(
                f"file {shown(entry.file)}", expected="a name or a pattern", found=str(error),
                where=where,
            ) from None  # fmt: skip
        files = [f for f in fitting if Path(f).suffix.lower() in OPENERS and f not in named]
        if not files and not named & set(fitting):
            raise InputError(
                f"file {shown(entry.file)}", expected="a pattern that some record's name fits",
                found="none that does", where=where,
            )  # fmt: skip
        for file in files:
            named.add(file)
            yield replace(entry, file=file)


def _check_names(entry: Entry, folder: Path, where: str) -> None:
    """Refuse a pattern among the files of one test: which belong together only names can tell."""
    for file in entry.files:
        if any(mark in file for mark in _GLOB) and not _is_file(folder / file):
            raise InputError(
                f"file {shown(file)}", expected="a name, in a list of the files of one test",
                found="a pattern; write [[records]] for each test", where=where,
            )  # fmt: skip


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (ValueError, OSError):
        return False
