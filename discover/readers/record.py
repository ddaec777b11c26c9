"""One record: from its file to a `Record`, with what had to be mended or was odd."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from discover.readers.clipping import clipped_motion_text, clipping_text
from discover.readers.columns import (
    QUANTITIES,
    Columns,
    assumed_units,
    missing_column,
    read_columns,
    within,
)
from discover.readers.consistency import derivative_agreement
from discover.readers.entries import Entry
from discover.readers.labels import check_labels
from discover.readers.odd_samples import Place, odd_samples
from discover.readers.one_clock import NEAR
from discover.readers.other_times import other_times
from discover.readers.own_clocks import on_one_clock
from discover.readers.sampling import Sampled, regular, resampling_text
from discover.readers.source import Source
from discover.readers.time_text import time_text
from discover.readers.units import SMALLEST
from discover.record_kind import classify
from discover.records import Finding, Record
from models.checks import Array, InputError, shown

_FEW = 50  # samples, below which a warning says so
MAY_LACK = tuple(name for name in QUANTITIES if name not in ("time", "force"))


def read_record(
    source: Source,
    entry: Entry,
    *,
    names: Mapping[str, str],
    units: Mapping[str, str],
    part: str = "",
) -> tuple[Record, list[Finding], Mapping[str, str | None]]:
    """Read one record, judge it, and say what had to be mended.

    Parameters
    ----------
    source : Source
        Its opened file.
    entry : Entry
        What ``campaign.toml`` says of it.
    names, units : mapping
        ``[columns]``, with the entry's own channels, and ``[units]``.
    part : str
        The sheet, group or table, where the file has several.

    Returns
    -------
    Record
    list of Finding
    mapping
        Units by quantity, as read; None where none is stated.

    Raises
    ------
    InputError
        On anything that leaves no usable record.
    """
    file = entry.label(part)
    table, findings = _on_one_clock(source, entry, names, units, file)
    columns, place = _asked_columns(table, entry, names, units, file)
    findings += _header_findings(columns, file)
    told = other_times(source, names) if columns.step is None and table is source else []
    findings += [Finding("note", text, file) for text in (*told, *_other_rate(source, columns))]
    measured = dict(columns.values)
    time = measured.pop("time")
    sampled = regular(
        time, measured, raw_time=columns.raw_time, resample="displacement" in measured,
        where=file, place=place,
    )  # fmt: skip
    _check_varying(measured, file)
    findings += _value_findings(time, measured, place, file)
    step = float(sampled.time[-1] - sampled.time[0]) / (sampled.time.size - 1)
    values, disagreeing = _checked_by_motion(sampled.columns, step, file)
    findings += disagreeing
    record = _record(entry, file, sampled, values)
    if sampled.uneven:
        record, resampled = _with_fitting_times(record, sampled, time, measured)
        findings.append(resampled)
    findings.extend(check_labels(record))
    return record, findings, columns.units


def _on_one_clock(
    source: Source, entry: Entry, names: Mapping[str, str], units: Mapping[str, str], file: str
) -> tuple[Source, list[Finding]]:
    """Return a table with its channels on one clock, and what to tell where they had several."""
    if entry.step is not None:  # a rate replaces whatever times the file has
        return source, []
    found = on_one_clock(source, names, units)
    # A format says which times are a channel's; in a table its place says so.
    level = "warning" if source.times is None else "note"
    told = [Finding(level, text, file) for text in found.told[len(source.told) :]]
    return (replace(found, told=source.told) if told else found), told


def _other_rate(source: Source, columns: Columns) -> list[str]:
    """Return what to tell where a file states another rate than its times have."""
    time = columns.values["time"]
    if columns.step is not None or source.step is None or time.size < 2:
        return []
    step = float(np.median(np.diff(time)))
    if abs(step - source.step) <= NEAR * source.step:
        return []
    return [
        f"the file states a sampling interval of {source.step:.6g} s, but its times are every"
        f" {step:.6g} s: its times are taken"
    ]


def _asked_columns(
    source: Source, entry: Entry, names: Mapping[str, str], units: Mapping[str, str], file: str
) -> tuple[Columns, Place]:
    """Return the columns that an entry asks for over its span of time, and its rows' places."""
    columns = read_columns(
        source, names=names, units=units, may_lack=MAY_LACK, step=entry.step, span=entry.span
    )
    if "displacement" not in columns.values and None in (entry.frequency, entry.amplitude):
        raise missing_column(
            source,
            "displacement",
            names.get("displacement", "displacement"),
            instead=", or the record's frequency and amplitude given",
        )
    return _within(columns, entry, file, source.place)


def _record(entry: Entry, file: str, sampled: Sampled, values: Mapping[str, Array]) -> Record:
    """Return the record of an entry's values on their final time."""
    return Record(
        file=file,
        time=sampled.time,
        force=values["force"],
        displacement=values.get("displacement"),
        velocity=values.get("velocity"),
        acceleration=values.get("acceleration"),
        temperature=values.get("temperature"),
        inputs={k: values[k] for k in ("base_acceleration", "applied_force") if k in values},
        frequency=entry.frequency,
        amplitude=entry.amplitude,
        held_out=entry.held_out,
        uniform=sampled.uniform,
    )


def _with_fitting_times(
    record: Record, sampled: Sampled, time: Array, measured: Mapping[str, Array]
) -> tuple[Record, Finding]:
    """Return a record whose steps were not equal: a sine test at its times as measured.

    Every verb has to see the sine test in those times too; else the record stays on its grid.
    """
    as_measured = record.sampled(time, measured)
    resampled = any(classify(found).kind != "sine" for found in (record, as_measured))
    level, text = resampling_text(sampled, resampled=resampled)
    return record if resampled else as_measured, Finding(level, text, record.file)


def _header_findings(columns: Columns, file: str) -> list[Finding]:
    """Return what was odd in the headers: columns not read, times made, units assumed."""
    findings = [
        Finding(
            "warning",
            f"column {shown(header)} is not read: it is nearly {quantity!r}; rename it, or name it"
            " in [columns]",
            file,
        )
        for header, quantity in columns.unused.items()
    ]
    findings += [Finding("note", text, file) for text in columns.notes]
    if columns.step is not None:
        text = "no time column is read: the times are made of the sampling rate"
        findings.append(Finding("note", text, file))
    if columns.assumed:
        findings.append(Finding("warning", assumed_units(columns.assumed), file))
    return findings


def _check_varying(values: Mapping[str, Array], file: str) -> None:
    """Refuse a displacement or a force that is the same throughout."""
    for name in ("displacement", "force"):
        if name in values and not np.ptp(values[name]) > SMALLEST:
            low, high = float(np.min(values[name])), float(np.max(values[name]))
            found = f"{low:.6g} throughout" if low == high else f"{low:.6g} to {high:.6g}"
            expected = "varying" if low == high else f"varying by more than {SMALLEST:g}"
            raise InputError(name, expected=expected, found=found, where=file)


def _value_findings(
    time: Array, values: Mapping[str, Array], place: Place, file: str
) -> list[Finding]:
    """Return what is odd in the values as measured: clipped channels, spikes, too few samples."""
    force = values["force"]
    odd = [clipping_text(force), *odd_samples(time, force, values.get("displacement"), place)]
    if "displacement" in values:
        odd.append(clipped_motion_text(values["displacement"]))
        if force.size < _FEW:
            odd.append(f"only {force.size} samples: too few to tell a law from noise")
    return [Finding("warning", text, file) for text in odd if text]


def _checked_by_motion(
    columns: Mapping[str, Array], step: float, file: str
) -> tuple[dict[str, Array], list[Finding]]:
    """Return the columns without a velocity and an acceleration that the displacement denies.

    Without a displacement there is nothing that they could be checked by, and both go.
    """
    values, findings = dict(columns), []
    for order, name in enumerate(("velocity", "acceleration"), start=1):
        if name not in values:
            continue
        column = values.pop(name)
        if "displacement" not in values:
            continue
        agreement = derivative_agreement(values["displacement"], column, step, order=order)
        if agreement.accepted:
            values[name] = column
            continue
        if agreement.is_hidden:
            text = f"the measured {name} is not used: its noise hides what the displacement tells"
            findings.append(Finding("note", text, file))
            continue
        text = (
            f"the measured {name} disagrees with the displacement: {agreement.reason}; "
            "it is not used"
        )
        findings.append(Finding("warning", text, file))
    return values, findings


def _within(
    columns: Columns, entry: Entry, file: str, place: Place
) -> tuple[Columns, Place]:
    """Return the columns over the span of time that the entry asks for, and its rows' places."""
    if entry.span == (None, None):
        return columns, place
    time = columns.values["time"]
    inside = within(time, entry.span)
    if not inside.any():
        ends = float(np.nanmin(time)), float(np.nanmax(time))
        first, last = (time_text(end, (ends[1] - ends[0]) / time.size) for end in ends)
        raise InputError(
            "range",
            expected=f"inside the record, {first} to {last} s",
            found=entry.span_text, where=file,
        )  # fmt: skip
    values = {name: column[inside] for name, column in columns.values.items()}
    rows = np.flatnonzero(inside)
    cut = replace(columns, values=values, raw_time=columns.raw_time[inside])
    return cut, lambda row: place(int(rows[row]))
