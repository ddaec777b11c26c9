"""A campaign folder: ``campaign.toml``, its tables, and the records that it names."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from discover.readers.binary_table import open_mat, open_npz, open_parquet
from discover.readers.record import Entry, read_record
from discover.readers.source import Source
from discover.readers.tables import (
    read_column_names,
    read_column_units,
    read_device,
    read_entries,
    read_rig,
    read_system,
)
from discover.readers.text_table import open_text
from discover.records import Campaign, Finding, Record
from models.checks import InputError, nearest

CAMPAIGN_FILE = "campaign.toml"
_TABLES = ("title", "device", "columns", "units", "records", "rig", "system")
_OPENERS: Mapping[str, Callable[[bytes, str], Source]] = {
    ".csv": open_text,
    ".tsv": open_text,
    ".txt": open_text,
    ".parquet": open_parquet,
    ".mat": open_mat,
    ".npz": open_npz,
}


def read_campaign(path: str | Path) -> Campaign:
    """Read a campaign folder with everything in SI.

    Parameters
    ----------
    path : str or Path
        The folder, or its ``campaign.toml``.

    Returns
    -------
    Campaign
        With what reading had to mend in its ``findings``.

    Raises
    ------
    InputError
        Where anything can't be worked on: one line with file and place, what was expected and
        what was found.
    """
    given = Path(path)
    folder = given.parent if given.name == CAMPAIGN_FILE and not given.is_dir() else given
    if not folder.is_dir():
        raise InputError(
            str(path), expected="a campaign folder", found="a file" if given.exists() else "nothing"
        )
    content = _bytes_of(folder, CAMPAIGN_FILE, where=str(folder))
    table = _parse(content)
    _check_keys(table)
    title = table.get("title", folder.resolve().name)
    if not isinstance(title, str):
        raise InputError("title", expected="text", found=repr(title), where=CAMPAIGN_FILE)
    names = read_column_names(table.get("columns", {}))
    units = read_column_units(table.get("units", {}))
    device = read_device(table["device"]) if "device" in table else None
    rig = read_rig(table["rig"]) if "rig" in table else None
    system = read_system(table["system"]) if "system" in table else None
    entries = read_entries(table.get("records"))
    digest = hashlib.sha256(_framed(CAMPAIGN_FILE, content))
    records: list[Record] = []
    findings: list[Finding] = []
    for entry in entries:
        data = _bytes_of(folder, entry.file, where=f"{CAMPAIGN_FILE} [[records]]")
        digest.update(_framed(entry.file, data))
        record, found = read_record(_open(data, entry), entry, names=names, units=units)
        records.append(record)
        findings.extend(found)
    _check_used(names, records)
    if system is not None and not any(system.input in r.inputs for r in records):
        text = f"[system] takes {system.input} as its input, but no record has that column"
        findings.append(Finding("warning", text))
    return Campaign(
        title=title,
        records=tuple(records),
        device=device,
        rig=rig,
        system=system,
        content_hash=digest.hexdigest(),
        source=str(path),
        findings=_merged(findings, len(records)),
    )


def _parse(content: bytes) -> dict[str, Any]:
    try:
        return tomllib.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputError(CAMPAIGN_FILE, expected="in UTF-8", found=error.reason) from None
    except (tomllib.TOMLDecodeError, RecursionError) as error:
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


def _bytes_of(folder: Path, name: str, *, where: str) -> bytes:
    """Return a file's bytes if it lies inside the campaign folder, symbolic links followed."""
    root = folder.resolve()
    try:
        target = (root / name).resolve()
        inside = target.is_relative_to(root) and not Path(name).is_absolute()
        if inside and target.is_file():
            return target.read_bytes()
        found = "outside of it"
        if inside:
            found = "a folder" if target.is_dir() else "nothing there"
            if not target.exists():
                found += nearest(name, [p.name for p in root.iterdir()])
    except OSError as error:
        found = error.strerror or "an unreadable file"
    except (ValueError, RuntimeError) as error:  # a zero byte in the name, a loop of links
        found = str(error)
    raise InputError(
        f"file {name[:80]!r}", expected="in the campaign folder", found=found, where=where
    )


def _open(data: bytes, entry: Entry) -> Source:
    suffix = Path(entry.file).suffix.lower()
    opener = _OPENERS.get(suffix)
    if opener is None:
        raise InputError(
            f"file {entry.file!r}",
            expected="one of " + ", ".join(_OPENERS),
            found=suffix or "no suffix",
            where=f"{CAMPAIGN_FILE} [[records]]",
        )
    return opener(data, entry.file)


def _framed(name: str, data: bytes) -> bytes:
    """Return bytes that no other division into files can give."""
    return f"{name}\0{len(data)}\0".encode() + data


def _check_used(names: Mapping[str, str], records: Iterable[Record]) -> None:
    """Raise where ``[columns]`` names a header that no record has."""
    for quantity, header in names.items():
        if quantity in ("time", "force"):
            continue
        present = any(
            quantity in r.inputs or getattr(r, quantity, None) is not None for r in records
        )
        rejected = quantity in ("velocity", "acceleration")
        if not present and not rejected:
            raise InputError(
                quantity,
                expected=f"in a column {header!r} of at least one record",
                found="none",
                where=f"{CAMPAIGN_FILE} [columns]",
            )


def _merged(findings: list[Finding], count: int) -> tuple[Finding, ...]:
    """Return the findings with one that all records share said once."""
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
