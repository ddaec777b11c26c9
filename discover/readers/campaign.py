"""A campaign folder: ``campaign.toml``, its tables, and the records that it names."""

from __future__ import annotations

import hashlib
import os
import shlex
import stat
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from discover.readers.choice import chosen_sources, one_table
from discover.readers.content import content_error
from discover.readers.draft import Draft, draft_campaign
from discover.readers.draft_tables import Answers
from discover.readers.entries import Entry, expanded
from discover.readers.formats import IN_PIECES, OPENERS, open_book
from discover.readers.guess import listed
from discover.readers.joined import joined
from discover.readers.long_record import read_record_of_any_length
from discover.readers.plausibility import implausible
from discover.readers.source import Book
from discover.readers.tables import (
    read_column_names,
    read_column_units,
    read_device,
    read_entries,
    read_guessed_units,
    read_rig,
    read_system,
)
from discover.records import Campaign, Finding, Record
from models.checks import InputError, InputErrors, nearest, printable, shown

CAMPAIGN_FILE = "campaign.toml"
_TABLES = ("title", "device", "columns", "units", "records", "rig", "system")
_LONGEST_TITLE = 400  # characters
_MOST_ERRORS = 20  # that are told of one campaign
_PIECE = 2**20  # bytes


def read_campaign(path: str | Path) -> Campaign:
    """Read a campaign folder, or one file as a campaign of its own, with everything in SI.

    Parameters
    ----------
    path : str or Path
        The folder, or its ``campaign.toml``; or a file of records, whose columns and units are
        guessed, with findings that say so.

    Returns
    -------
    Campaign
        With what reading had to mend in its ``findings``.

    Raises
    ------
    InputError
        Where anything can't be worked on: one line with file and place, what was expected and
        what was found.

    Examples
    --------
    >>> campaign = read_campaign("data/segmented")
    >>> campaign
    <Campaign 'A segmented inerter, sine tests (simulated)': 24 records (3 held out) of ...>
    >>> campaign.records[0].force.shape
    (5000,)
    """
    if not isinstance(path, str | Path):
        raise InputError(
            "path", expected="a folder or a file: Campaign.from_frames takes tables",
            found=type(path).__name__, where="read_campaign",
        )  # fmt: skip
    given = Path(path)
    folder = given.parent if given.name == CAMPAIGN_FILE and not given.is_dir() else given
    if given.is_file() and given.suffix.lower() in OPENERS:
        title = given.stem
        draft = draft_campaign(given.parent, [given.name], title=title, answers=Answers({}, {}))
        content = draft.toml(marked=False).encode()
        return _campaign(given.parent, content, str(path), _guesses(draft))
    if not folder.is_dir():
        raise InputError(
            str(path),
            expected="a campaign folder, or a file of records (" + ", ".join(OPENERS) + ")",
            found=kind_of(given, "a file of another kind"),
        )
    if not (folder / CAMPAIGN_FILE).exists():
        raise InputError(
            f"file {CAMPAIGN_FILE!r}",
            expected="in the campaign folder",
            found=f"nothing there; `inerter init {shlex.quote(str(folder))}` writes it",
            where=str(folder),
        )
    content = _bytes_of(folder, CAMPAIGN_FILE, where=str(folder))
    return _campaign(folder, content, str(path), [])


def _guesses(draft: Draft) -> list[Finding]:
    """Return what to tell of a file that no campaign describes."""
    plain = not draft.columns and not draft.units
    found = [] if plain else [Finding("note", t) for t in listed(draft.records[0].guess)]
    for doubt in draft.doubts:
        what = "column" if doubt.key == "columns" else "unit"
        others = " or ".join(doubt.choices[1:])
        text = (
            f"the {what} of {doubt.quantity} is a guess, {shown(doubt.taken)}: {doubt.why}"
            + (f"; it may be {printable(others)}" if others else "")
            + "; `inerter init` with this file writes a campaign.toml to correct"
        )
        found.append(Finding("warning", text))
    return found


def _campaign(folder: Path, content: bytes, source: str, findings: Sequence[Finding]) -> Campaign:
    """Return the campaign of a folder by the content of its ``campaign.toml``."""
    table = _parse(content)
    _check_keys(table)
    title = table.get("title", folder.resolve().name)
    if not isinstance(title, str) or len(title) > _LONGEST_TITLE:
        expected = f"text of at most {_LONGEST_TITLE} characters"
        raise InputError("title", expected=expected, found=shown(title), where=CAMPAIGN_FILE)
    names = read_column_names(table.get("columns", {}))
    stated, guessed = read_guessed_units(table.get("units", {}))
    units = read_column_units(stated)
    device = read_device(table["device"]) if "device" in table else None
    rig = read_rig(table["rig"]) if "rig" in table else None
    system = read_system(table["system"]) if "system" in table else None
    digest = hashlib.sha256(_framed(CAMPAIGN_FILE, content))
    where = f"{CAMPAIGN_FILE} [[records]]"
    entries = list(expanded(read_entries(table.get("records")), folder, where=where))
    read = _Reading(folder, names, units, digest)
    for entry in entries:
        read.take(entry)
    read.finish()
    records, findings = read.records, [*findings, *read.findings]
    findings += _guessed_units(units, guessed, read.read_units)
    _check_used(names, entries, records)
    if system is not None and not any(system.input in r.inputs for r in records):
        text = f"[system] takes {system.input} as its input, but no record has that column"
        findings.append(Finding("warning", text))
    findings.extend(implausible(records, device, rig, units=read.read_units))
    return Campaign(
        title=title,
        records=tuple(records),
        device=device,
        rig=rig,
        system=system,
        content_hash=digest.hexdigest(),
        source=source,
        findings=merged(findings, len(records)),
    )


def _guessed_units(
    units: Mapping[str, str], guessed: Sequence[str], read: Sequence[Mapping[str, str | None]]
) -> list[Finding]:
    """Return what to tell of units in ``[units]`` that `inerter init` guessed."""
    own = [quantity for quantity in guessed if any(quantity in found for found in read)]
    if not own:
        return []
    listed = ", ".join(f"{units[quantity]} for {quantity}" for quantity in own)
    text = (
        f"no file states the unit of {' and '.join(own)}: `inerter init` guessed {listed} by the"
        " size of the values; correct [units] of campaign.toml where it is wrong, and take out of"
        " its `guessed` what you know"
    )
    return [Finding("warning", text)]


class _Reading:
    """The records so far, and what was wrong with those that could not be read."""

    def __init__(
        self, folder: Path, names: Mapping[str, str], units: Mapping[str, str], digest: Any
    ) -> None:
        self.folder = folder
        self.names = names
        self.units = units
        self.digest = digest
        self.records: list[Record] = []
        self.findings: list[Finding] = []
        self.read_units: list[Mapping[str, str | None]] = []
        self.errors: list[InputError] = []
        self.hashed: set[str] = set()
        self.book: Book | None = None

    def take(self, entry: Entry) -> None:
        """Read an entry's records, or keep what is wrong with it."""
        try:
            own = {**self.names, **entry.channel}
            if entry.beside:
                tables = [one_table(self._opened(file), entry, own) for file in entry.files]
                sources = [joined(tables, entry.files, own)]
            else:
                sources = chosen_sources(self._opened(entry.file), entry, own)
        except InputError as error:
            self.errors.append(error)
            return
        for source in sources:
            part = source.part if entry.part is not None or len(sources) > 1 else ""
            try:
                found = read_record_of_any_length(
                    source, entry, names=own, units={**self.units, **entry.units}, part=part
                )
            except InputError as error:
                self.errors.append(error)
                continue
            record, findings, own_units = found
            if any(record.file == other.file for other in self.records):
                twice = {"expected": "listed once", "found": "it again", "where": record.file}
                self.errors.append(InputError("record", **twice))
                continue
            self.records.append(record)
            self.findings.extend(findings)
            self.read_units.append(own_units)

    def finish(self) -> None:
        """Raise what is wrong: alone as it is, else one line each."""
        if not self.errors:
            return
        if len(self.errors) == 1:
            raise self.errors[0]
        told = self.errors[:_MOST_ERRORS]
        more = len(self.errors) - len(told)
        count = len(self.errors) + len(self.records)
        advice = (
            f"{len(self.errors)} of {count} records can't be read"
            + (f" ({more} more than are listed)" if more else "")
            + f": mend them, or take their [[records]] out of {CAMPAIGN_FILE}"
        )
        raise InputErrors(told, advice=advice)

    def _opened(self, file: str) -> Book:
        """Return a file's book; the last one is kept, since records of one file come together."""
        if self.book is not None and self.book.name == file:
            return self.book
        where = f"{CAMPAIGN_FILE} [[records]]"
        hint = len(self.errors) < _MOST_ERRORS  # which costs a look at all names
        opener = IN_PIECES.get(Path(file).suffix.lower())
        if opener is not None:
            path = _path_of(self.folder, file, where=where, hint=hint)
            if file not in self.hashed:
                self.hashed.add(file)
                _digest_file(self.digest, file, path)
            self.book = opener(path, file)
            return self.book
        data = _bytes_of(self.folder, file, where=where, hint=hint)
        if file not in self.hashed:
            self.hashed.add(file)
            self.digest.update(_framed(file, data))
        self.book = open_book(data, file, where=where)
        return self.book


def _parse(content: bytes) -> dict[str, Any]:
    try:
        return tomllib.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputError(CAMPAIGN_FILE, expected="in UTF-8", found=error.reason) from None
    except (ValueError, RecursionError) as error:  # of TOML, and of integers of 5,000 digits
        raise InputError(f"{CAMPAIGN_FILE} is not valid TOML", found=str(error)) from None


def _check_keys(table: Mapping[str, Any]) -> None:
    for key in table:
        if key not in _TABLES:
            raise InputError(
                f"key {key!r}",
                expected="one of " + ", ".join(_TABLES),
                found="an unknown key" + nearest(key, _TABLES),
                where=CAMPAIGN_FILE,
            )


def _bytes_of(folder: Path, name: str, *, where: str, hint: bool = True) -> bytes:
    """Return a file's bytes if it lies inside the campaign folder, symbolic links followed."""
    target = _path_of(folder, name, where=where, hint=hint)
    try:
        return target.read_bytes()
    except OSError as error:
        raise _not_read(name, error.strerror or "an unreadable file", where) from None


def _path_of(folder: Path, name: str, *, where: str, hint: bool = True) -> Path:
    """Return a file's path if it lies inside the campaign folder, symbolic links followed."""
    root = folder.resolve()
    try:
        target = (root / name).resolve()
        inside = target.is_relative_to(root) and not Path(name).is_absolute()
        if inside and target.is_file():
            return target
        found = kind_of(target) if inside else "outside of it"
        if hint and inside and not target.exists():
            found += nearest(name, _names(root))
    except OSError as error:
        found = error.strerror or "an unreadable file"
    except (ValueError, RuntimeError) as error:  # a zero byte in the name, a loop of links
        found = str(error)
    raise _not_read(name, found, where)


def _not_read(name: str, found: str, where: str) -> InputError:
    return InputError(
        f"file {shown(name)}", expected="in the campaign folder", found=found, where=where
    )


def kind_of(target: Path, file: str = "a file") -> str:
    """Return in words what lies at a path."""
    if not target.exists():
        return "nothing there"
    if target.is_file():
        return file
    mode = target.stat().st_mode
    kinds = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))
    return next((text for test, text in kinds if test(mode)), "a device")


def _names(root: Path) -> tuple[str, ...]:
    """Return what a folder holds."""
    with os.scandir(root) as items:
        return tuple(item.name for item in items)


def _framed(name: str, data: bytes) -> bytes:
    """Return bytes that no other division into files can give."""
    return _frame(name, len(data)) + data


def _frame(name: str, size: int) -> bytes:
    return f"{name}\0{size}\0".encode()


def _digest_file(digest: Any, name: str, path: Path) -> None:
    """Let a file's framed bytes into a digest, without holding them."""
    try:
        with path.open("rb") as file:
            digest.update(_frame(name, os.fstat(file.fileno()).st_size))
            while data := file.read(_PIECE):
                digest.update(data)
    except OSError as error:
        raise content_error("readable", error, name) from None


def _check_used(
    names: Mapping[str, str], entries: Sequence[Entry], records: Iterable[Record]
) -> None:
    """Raise where ``[columns]`` names a header that no record has."""
    for quantity, header in names.items():
        if quantity in ("time", "force"):
            continue
        present = any(
            quantity in r.inputs or getattr(r, quantity, None) is not None for r in records
        )
        rejected = quantity in ("velocity", "acceleration")
        own = any(quantity in entry.channel for entry in entries)
        if not present and not rejected and not own:
            raise InputError(
                quantity,
                expected=f"in a column {header!r} of at least one record",
                found="none",
                where=f"{CAMPAIGN_FILE} [columns]",
            )


def merged(findings: list[Finding], count: int) -> tuple[Finding, ...]:
    """Return the findings, with one that all records share said once."""
    same: dict[tuple[str, str], list[Finding]] = {}
    for finding in findings:
        same.setdefault((finding.level, finding.text), []).append(finding)
    result = []
    for (level, text), group in same.items():
        if count > 1 and len(group) == count:
            result.append(Finding(level, f"all records: {text}"))
        else:
            result.extend(group)
    return tuple(result)
