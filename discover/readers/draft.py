"""A ``campaign.toml`` from what lies in a folder: what is guessed, how surely, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from discover.readers.columns import find_column, read_columns, split_header
from discover.readers.doubts import Doubt, doubts
from discover.readers.draft_tables import NO_TIME, Answers, found_tables, without
from discover.readers.draft_units import common_units, guessed_units, own_units, settled
from discover.readers.entries import Entry
from discover.readers.fastest_motion import fastest_motion
from discover.readers.formats import OPENERS
from discover.readers.guess import Guess, TableGuess
from discover.readers.long_record import read_record_of_any_length
from discover.readers.own_clocks import on_one_clock
from discover.readers.record import MAY_LACK
from discover.readers.source import Source
from discover.readers.time_text import time_text
from discover.readers.toml_text import campaign_text
from discover.record_kind import classify
from discover.records import Finding, Record
from discover.sine_fit import sine_steps
from models.checks import InputError

_QUARTER = 4  # records, of which one is held out


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
    found, left_out = found_tables(folder, files, answers)
    guesses = settled([guess for _, _, guess in found], answers.units)
    units = common_units(guesses)
    columns = _columns([(source, guess) for _, source, guess in found])
    readings = []
    for (entry, source, _), guess in zip(found, guesses, strict=True):
        own = _own_channel(source, guess, columns)
        own_entry = replace(entry, channel=own, units=own_units(guess, units))
        names, in_units = {**columns, **own}, {**units, **own_entry.units}
        readings.append((own_entry, _Reading(source, guess, names, in_units)))
    records, read = _read_all(readings, left_out)
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


def _read_all(
    readings: Sequence[tuple[Entry, _Reading]], left_out: list[tuple[str, str]]
) -> tuple[list[DraftRecord], list[tuple[Source, TableGuess]]]:
    """Return the records, a stepped sine's steps each, and the tables that could be read.

    What could not be is added to `left_out`.
    """
    records: list[DraftRecord] = []
    read: list[tuple[Source, TableGuess]] = []
    for entry, reading in readings:
        try:
            whole = reading.of(entry)
        except InputError as error:
            label = entry.label(str(entry.part or ""))
            left_out.append((label, without(label, error)))
            continue
        records += reading.steps(whole) or [whole]
        read.append((reading.source, reading.guess))
    return records, read


def _no_record(folder: str, left_out: Sequence[tuple[str, str]]) -> InputError:
    """Return the error of files of which none is a record: why the first one is not."""
    if not left_out:
        kinds = ", ".join(OPENERS)
        return InputError(
            "files", expected=f"there that can be read ({kinds})", found="none", where=folder
        )
    file, why = left_out[0]
    more = f" (and {len(left_out) - 1} more files or tables)" if len(left_out) > 1 else ""
    timeless = NO_TIME in why
    return (TimeMissing if timeless else InputError)(
        "one file at least",
        expected="a record of time, displacement and force",
        found=f"{file}: {why}" + more,
        where=folder,
    )


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
        steps = sine_steps(record.time, record.displacement)
        shift = self._first_time(whole.entry) - float(record.time[0]) if steps else 0.0
        found = []
        for ends in steps:
            first, last = (time_text(shift + end, record.step) for end in ends)
            text = f"{first} s : {last} s"
            span = (float(first), float(last))
            try:
                step = self.of(replace(whole.entry, span=span, span_text=text))
                known = classify(step.record).kind == "sine"
            except InputError:
                known = False
            if not known:
                return []
            found.append(step)
        return found

    def _first_time(self, entry: Entry) -> float:
        """Return the file's first time, s, from which a clock's record counts."""
        source = self.source
        if entry.step is None:
            source = on_one_clock(source, self.names, self.units)
        columns = read_columns(
            source, names=self.names, units=self.units, may_lack=MAY_LACK, step=entry.step
        )
        return float(columns.values["time"][0])


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
