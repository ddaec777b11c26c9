"""A ``campaign.toml`` from what lies in a folder: what is guessed, how surely, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from discover.readers.columns import find_column, split_header
from discover.readers.doubts import Doubt, doubts
from discover.readers.draft_units import common_units, guessed_units, own_units, settled
from discover.readers.entries import Entry
from discover.readers.fastest_motion import fastest_motion
from discover.readers.formats import OPENERS, open_file
from discover.readers.guess import Guess, TableGuess, guess_table, stated_unit
from discover.readers.long_record import first_part, read_record_of_any_length
from discover.readers.source import Book, Source
from discover.readers.toml_text import campaign_text
from discover.record_kind import classify
from discover.records import Finding, Record
from discover.sine_fit import sine_steps
from models.checks import InputError, nearest, printable, shown

_QUARTER = 4  # records, of which one is held out
_VOLTS = ("V", "mV", "volt", "volts", "Volt", "Volts")
_MOST_TOLD = 30  # headers
_NO_TIME = "no column for time among"


@dataclass(frozen=True)
class Answers:
    """What the user says in place of a guess."""

    columns: Mapping[str, str]
    """Headers by quantity."""
    units: Mapping[str, str]
    """Units by quantity, for columns whose unit the files do not state."""
    sampling_rate: float | None = None
    """Hz, of files without a time column."""


class TimeMissing(InputError):
    """Files that lack nothing but time: a sampling rate would do."""


@dataclass(frozen=True)
class DraftRecord:
    """One test that was found."""

    entry: Entry
    """What ``campaign.toml`` will say of it."""
    guess: TableGuess
    """What its columns are taken for."""
    record: Record
    """As read."""
    findings: tuple[Finding, ...]
    """Of reading it."""


@dataclass(frozen=True)
class Draft:
    """A campaign that nobody wrote yet."""

    title: str
    """The folder's name, or the user's."""
    columns: Mapping[str, str]
    """``[columns]``."""
    units: Mapping[str, str]
    """``[units]``."""
    records: tuple[DraftRecord, ...]
    """In the order of the files."""
    left_out: tuple[tuple[str, str], ...]
    """Files or parts of them that are no record, with why."""
    doubts: tuple[Doubt, ...]
    """What is unsure."""
    device: str = ""
    """A preset, "" for none."""

    def toml(self, *, marked: bool = True) -> str:
        """Return ``campaign.toml``, with why beside what was guessed, and units marked as such."""
        return campaign_text(
            title=self.title,
            device=self.device,
            columns=self.columns,
            units=self.units,
            guessed=guessed_units([r.guess for r in self.records], self.units) if marked else (),
            tests=[(record.entry, record.guess) for record in self.records],
            left_out=self.left_out,
        )


def draft_campaign(
    folder: Path, files: Sequence[str], *, title: str, answers: Answers, device: str = ""
) -> Draft:
    """Return the campaign that some files of a folder make.

    Parameters
    ----------
    folder : Path
        That the campaign will lie in.
    files : sequence of str
        Paths inside it.
    title : str
        Of the campaign.
    answers : Answers
        What the user said.
    device : str
        A preset, "" for none.

    Raises
    ------
    InputError
        Where no file holds a record; it says why of the first.
    """
    found: list[tuple[Entry, Source, TableGuess]] = []
    left_out: list[tuple[str, str]] = []
    headers: list[str] = []
    for file in files:
        entry = Entry(file, step=_step(answers))
        try:
            book = open_file(folder / file, file, where=file)
        except InputError as error:
            left_out.append((file, _without(file, error)))
            continue
        headers += [h for source in (*book.parts, book.whole) if source for h in source.headers]
        parts, lacking = _tables(book, answers, stepped=entry.step is not None)
        found += [(_named(entry, book, source), source, guess) for source, guess in parts]
        if not parts:
            left_out.append((file, lacking))
    _check_named(answers.columns, headers)
    guesses = settled([guess for _, _, guess in found], answers.units)
    units = common_units(guesses)
    columns = _columns([(source, guess) for _, source, guess in found])
    records: list[DraftRecord] = []
    read: list[tuple[Source, TableGuess]] = []
    for (entry, source, _), guess in zip(found, guesses, strict=True):
        own = _own_channel(source, guess, columns)
        entry = replace(entry, channel=own, units=own_units(guess, units))
        reading = _Reading(source, guess, {**columns, **own}, {**units, **entry.units})
        try:
            whole = reading.of(entry)
        except InputError as error:
            label = entry.label(str(entry.part or ""))
            left_out.append((label, _without(label, error)))
            continue
        records += reading.steps(whole) or [whole]
        read.append((source, guess))
    if not records:
        raise _no_record(str(folder), left_out)
    kept = {quantity for record in records for quantity in record.guess.columns}
    return Draft(
        title,
        {quantity: header for quantity, header in columns.items() if quantity in kept},
        {quantity: unit for quantity, unit in units.items() if quantity in kept},
        _held_out(records),
        tuple(left_out),
        doubts(read),
        device,
    )


def _no_record(folder: str, left_out: Sequence[tuple[str, str]]) -> InputError:
    """Return the error of files of which none is a record: why the first one is not."""
    if not left_out:
        kinds = ", ".join(OPENERS)
        return InputError(
            "files", expected=f"there that can be read ({kinds})", found="none", where=folder
        )
    file, why = left_out[0]
    more = f" (and {len(left_out) - 1} more files)" if len(left_out) > 1 else ""
    timeless = _NO_TIME in why
    return (TimeMissing if timeless else InputError)(
        "one file at least",
        expected="a record of time, displacement and force",
        found=f"{file}: {why}" + more,
        where=folder,
    )


def _lacking(source: Source, lacks: Sequence[str]) -> str:
    """Return what a table lacks and what to do about it."""
    names = printable(", ".join(source.headers[:12]))
    text = f"no column for {' and '.join(lacks)} among {names}"
    if tuple(lacks) == ("time",):
        return text + "; --sampling-rate '1 kHz' makes the times, or --column time=HEADER names it"
    volts = [h for i, h in enumerate(source.headers) if stated_unit(source, i) in _VOLTS]
    if volts:
        return text + (
            f"; {printable(volts[0])} is in volts: write its header without the unit, and give the"
            " calibration as the unit of one volt, as --unit displacement='5 mm'"
        )
    if tuple(lacks) == ("displacement",):
        return text + (
            "; --column displacement=HEADER names it; velocity or acceleration alone will not do:"
            " integrate it in the file"
        )
    return text + f"; --column {lacks[0]}=HEADER names it"


@dataclass(frozen=True)
class _Reading:
    """How a table is read."""

    source: Source
    guess: TableGuess
    names: Mapping[str, str]
    """Headers by quantity."""
    units: Mapping[str, str]
    """Units by quantity."""

    def of(self, entry: Entry) -> DraftRecord:
        """Return what an entry names."""
        record, findings, _ = read_record_of_any_length(
            self.source, entry, names=self.names, units=self.units, part=str(entry.part or "")
        )
        return DraftRecord(entry, self.guess, record, tuple(findings))

    def steps(self, whole: DraftRecord) -> list[DraftRecord]:
        """Return the sine tests of a stepped sine; none of any other record."""
        record = whole.record
        if record.displacement is None or record.long is not None:
            return []
        found = []
        for first, last in sine_steps(record.time, record.displacement):
            text = f"{first:.6g} s : {last:.6g} s"
            span = (float(f"{first:.6g}"), float(f"{last:.6g}"))
            try:
                step = self.of(replace(whole.entry, span=span, span_text=text))
                known = classify(step.record).kind == "sine"
            except InputError:
                known = False
            if not known:
                return []
            found.append(step)
        return found


def record_files(folder: Path) -> list[str]:
    """Return the files below a folder that may be records, hidden ones and results left out."""
    found = []
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        hidden = any(part.startswith(".") or part == "inerter-out" for part in inside.parts)
        if not hidden and path.suffix.lower() in OPENERS and path.is_file():
            found.append(inside.as_posix())
    return found


def _without(file: str, error: InputError) -> str:
    """Return an error's text without the file that it begins with."""
    text = str(error)
    return text.removeprefix(file).lstrip(" :") if text.startswith(file) else text


def _step(answers: Answers) -> float | None:
    return None if answers.sampling_rate is None else 1.0 / answers.sampling_rate


def _tables(
    book: Book, answers: Answers, *, stepped: bool
) -> tuple[list[tuple[Source, TableGuess]], str]:
    """Return the tables that can be records, or none and what the first one lacks."""
    whole = [] if book.whole is None else [book.whole]
    first = ""
    for sources in (book.parts, whole):
        able = []
        for source in sources:
            guess = _guessed(source, answers)
            lacks = [q for q in guess.lacks if not (q == "time" and stepped)]
            if not lacks:
                able.append((source, guess))
            elif not first:
                first = _lacking(source, lacks)
        if able:
            return able, ""
    return [], first


def _guessed(source: Source, answers: Answers) -> TableGuess:
    """Return a table's guess with the columns that the user named."""
    guess = guess_table(first_part(source))
    columns = dict(guess.columns)
    if answers.sampling_rate is not None:
        columns.pop("time", None)  # the rate is asked for in its place
    for quantity, header in answers.columns.items():
        index = find_column(source, quantity, header)
        if index is None:
            continue
        named = source.headers[index]
        columns = {q: g for q, g in columns.items() if g.header != named or q == quantity}
        stated = stated_unit(source, index) or ""
        unit = (
            stated or answers.units.get(quantity, "") or _unit_of(columns.get(quantity), quantity)
        )
        columns[quantity] = Guess(quantity, named, "sure", "you said so", unit, bool(stated))
    missing = [q for q in ("time", "force", "displacement") if q not in columns]
    timed = source.step is not None
    lacks = tuple(q for q in missing if not (q == "time" and timed))
    return TableGuess(columns, lacks)


def _check_named(named: Mapping[str, str], headers: Sequence[str]) -> None:
    """Refuse a header that the user named and no file has."""
    there = list(dict.fromkeys(headers))
    source = Source("", tuple(there), lambda _: [])
    for quantity, header in named.items():
        if there and not _has(source, quantity, header):
            known = {split_header(h)[0].lower(): h for h in there}
            near = nearest(split_header(header)[0].lower(), known)
            raise InputError(
                f"column of {quantity}",
                expected="one that some file has: " + ", ".join(there[:_MOST_TOLD]),
                found=shown(header) + near,
                where="--column",
            )


def _has(source: Source, quantity: str, header: str) -> bool:
    try:
        return find_column(source, quantity, header) is not None
    except InputError:  # several files have it, each in its own case
        return True


def _unit_of(guess: Guess | None, quantity: str) -> str:
    return guess.unit if guess else {"time": "s", "force": "N"}.get(quantity, "m")


def _named(entry: Entry, book: Book, source: Source) -> Entry:
    """Return the entry with the part of the file, where it has several."""
    if len(book.parts) == 1 or not source.part:
        return entry
    return replace(entry, key=book.key, part=source.part)


def _columns(tables: Sequence[tuple[Source, TableGuess]]) -> dict[str, str]:
    """Return ``[columns]``: the usual headers, where they are not found by the quantity's name."""
    columns = {}
    for quantity in ("time", "displacement", "force", "velocity", "acceleration", "temperature"):
        own = [(s, g.columns[quantity]) for s, g in tables if quantity in g.columns]
        names = Counter(_short(s, g) for s, g in own)
        if names and any(not _found(s, quantity, quantity, g.header) for s, g in own):
            columns[quantity] = names.most_common(1)[0][0]
    return columns


def _short(source: Source, guess: Guess) -> str:
    """Return a header's name without its unit, where that finds it too."""
    plain = split_header(guess.header)[0]
    return plain if _found(source, guess.quantity, plain, guess.header) else guess.header


def _found(source: Source, quantity: str, wanted: str, header: str) -> bool:
    try:
        index = find_column(source, quantity, wanted)
    except InputError:
        return False
    return index is not None and source.headers[index] == header


def _own_channel(source: Source, guess: TableGuess, columns: Mapping[str, str]) -> dict[str, str]:
    """Return a record's own headers, where they are not those of ``[columns]``."""
    return {
        quantity: _short(source, own)
        for quantity, own in guess.columns.items()
        if not _found(source, quantity, columns.get(quantity, quantity), own.header)
    }


def _held_out(records: Sequence[DraftRecord]) -> tuple[DraftRecord, ...]:
    """Return the records with a quarter of them held out, evenly over their speeds."""
    count = max(1, len(records) // _QUARTER) if len(records) > 2 else 0
    order = sorted(range(len(records)), key=lambda i: (_speed(records[i].record), i))
    places = np.linspace(0.0, len(records) - 1.0, 2 * count + 1)[1::2].round().astype(int)
    chosen = {order[place] for place in places}
    return tuple(
        replace(
            r, entry=replace(r.entry, held_out=True), record=replace(r.record, held_out=True)
        )
        if i in chosen
        else r
        for i, r in enumerate(records)
    )  # fmt: skip


def _speed(record: Record) -> float:
    if record.displacement is None:
        return 0.0
    return float(np.ptp(record.displacement)) * fastest_motion(record.time, record.displacement)
