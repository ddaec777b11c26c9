"""A campaign folder: ``campaign.toml``, its tables, and the records that it names."""

from __future__ import annotations

import hashlib
import shlex
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from discover.executor import Executor
from discover.readers.draft import Draft, draft_campaign
from discover.readers.draft_tables import Answers
from discover.readers.entries import Entry, expanded
from discover.readers.formats import OPENERS
from discover.readers.guess import listed
from discover.readers.inside import bytes_of, digest_file, framed, kind_of, path_of
from discover.readers.plausibility import implausible
from discover.readers.tables import (
    read_column_names,
    read_column_units,
    read_device,
    read_entries,
    read_guessed_units,
    read_rig,
    read_system,
)
from discover.readers.taken import Taken, parted, taken, taken_over
from discover.records import Campaign, Finding, Record
from models.checks import InputError, InputErrors, nearest, printable, shown

CAMPAIGN_FILE = "campaign.toml"
_TABLES = ("title", "device", "columns", "units", "records", "rig", "system")
_LONGEST_TITLE = 400  # characters
_MOST_ERRORS = 20  # that are told of one campaign


def read_campaign(
    path: str | Path,
    *,
    over: Executor | None = None,
    tell: Callable[[str], None] | None = None,
) -> Campaign:
    """Read a campaign folder, or one file as a campaign of its own, with everything in SI.

    Parameters
    ----------
    path : str or Path
        The folder, or its ``campaign.toml``; or a file of records, whose columns and units are
        guessed, with findings that say so.
    over : Executor, optional
        Of `discover.executor`: reads the files and finds in each record what verbs ask of its
        samples. Of a longer sine test the record then holds the first `HELD` samples alone,
        beside what was found in all.
    tell : callable, optional
        Is told how many files an executor has done.

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
        return _campaign(given.parent, content, str(path), _guesses(draft), over, tell)
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
    content = bytes_of(folder, CAMPAIGN_FILE, where=str(folder))
    return _campaign(folder, content, str(path), [], over, tell)


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


def _campaign(
    folder: Path,
    content: bytes,
    source: str,
    findings: Sequence[Finding],
    over: Executor | None,
    tell: Callable[[str], None] | None,
) -> Campaign:
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
    where = f"{CAMPAIGN_FILE} [[records]]"
    entries = list(expanded(read_entries(table.get("records")), folder, where=where))
    read = _Reading()
    asked = parted(
        entries, folder, names=names, units=units, where=where, inertial=device is not None
    )
    for each in taken_over(asked, over, tell) if over else (t for a in asked for t in taken(a)):
        read.take(each)
    read.finish()
    digest = hashlib.sha256(framed(CAMPAIGN_FILE, content))
    for file in dict.fromkeys(file for entry in entries for file in entry.files):
        digest_file(digest, file, path_of(folder, file, where=where))
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


@dataclass
class _Reading:
    """The records so far, and what was wrong with those that could not be read."""

    records: list[Record] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    read_units: list[Mapping[str, str | None]] = field(default_factory=list)
    errors: list[InputError] = field(default_factory=list)

    def take(self, each: Taken | InputError) -> None:
        """Take a record, or keep what is wrong with it."""
        if isinstance(each, InputError):
            self.errors.append(each)
        elif any(each.record.file == other.file for other in self.records):
            twice = {"expected": "listed once", "found": "it again", "where": each.record.file}
            self.errors.append(InputError("record", **twice))
        else:
            self.records.append(each.record)
            self.findings.extend(each.findings)
            self.read_units.append(each.units)

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
