"""One record: from its file to a `Record`, with what had to be mended or was odd."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from discover.readers.columns import QUANTITIES, assumed_units, missing_column, read_columns
from discover.readers.consistency import derivative_agreement
from discover.readers.labels import check_labels
from discover.readers.sampling import jitter_text, regular
from discover.readers.source import Source
from discover.record_kind import classify
from discover.records import Finding, Record
from models.checks import Array, InputError

_MAY_LACK = tuple(name for name in QUANTITIES if name not in ("time", "force"))


@dataclass(frozen=True)
class Entry:
    """One table of ``[[records]]``."""

    file: str
    """Path inside the campaign folder, as written."""
    frequency: float | None
    """Hz, as labelled."""
    amplitude: float | None
    """m, as labelled."""
    held_out: bool
    """Never fitted, only predicted."""


def read_record(
    source: Source, entry: Entry, *, names: Mapping[str, str], units: Mapping[str, str]
) -> tuple[Record, list[Finding]]:
    """Read one record, judge it, and say what had to be mended.

    Parameters
    ----------
    source : Source
        Its opened file.
    entry : Entry
        What ``campaign.toml`` says of it.
    names, units : mapping
        ``[columns]`` and ``[units]``.

    Returns
    -------
    Record
    list of Finding

    Raises
    ------
    InputError
        On anything that leaves no usable record.
    """
    columns = read_columns(source, names=names, units=units, may_lack=_MAY_LACK)
    if "displacement" not in columns.values and None in (entry.frequency, entry.amplitude):
        raise missing_column(
            source,
            "displacement",
            names.get("displacement", "displacement"),
            instead=", or the record's frequency and amplitude given",
        )
    findings = [
        Finding(
            "warning",
            f"column {header!r} is not read: it is nearly {quantity!r}; rename it, or name it in "
            "[columns]",
            entry.file,
        )
        for header, quantity in columns.unused.items()
    ]
    if columns.assumed:
        findings.append(Finding("warning", assumed_units(columns.assumed), entry.file))
    values = dict(columns.values)
    has_motion = "displacement" in values
    time, measured = values.pop("time"), values
    sampled = regular(
        time,
        values,
        raw_time=columns.raw_time,
        resample=has_motion,
        where=entry.file,
        place=source.place,
    )
    for name in ("displacement", "force"):
        if name in values and not np.ptp(values[name]) > 0.0:
            found = f"{values[name][0]:.6g} throughout"
            raise InputError(name, expected="varying", found=found, where=entry.file)
    step = float(sampled.time[-1] - sampled.time[0]) / (sampled.time.size - 1)
    clipped = clipping_text(values["force"])
    if clipped:
        findings.append(Finding("warning", clipped, entry.file))
    values = dict(sampled.columns)
    for order, name in enumerate(("velocity", "acceleration"), start=1):
        if name not in values:
            continue
        if not has_motion:
            del values[name]
            continue
        agreement = derivative_agreement(values["displacement"], values[name], step, order=order)
        if not agreement.accepted:
            del values[name]
            text = (
                f"the measured {name} disagrees with the displacement: {agreement.reason}; "
                "it is not used"
            )
            findings.append(Finding("warning", text, entry.file))
    record = Record(
        file=entry.file,
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
    if sampled.jitter:
        resampled = classify(record).kind != "sine"
        level, text = jitter_text(sampled.jitter, step, resampled=resampled)
        findings.append(Finding(level, text, entry.file))
        if not resampled:
            record = record.sampled(time, measured)
    findings.extend(check_labels(record))
    return record, findings


def clipping_text(force: Array) -> str:
    """Return what to tell about a force that stays at its extreme value, else an empty string.

    A smooth extreme passes through neighbouring values too, even when quantised; a clipped one
    piles its samples up on exactly one value.

    Examples
    --------
    >>> x = np.sin(np.arange(2000) / 50.0)
    >>> clipping_text(x), clipping_text(np.clip(x, -0.9, 0.9)) != ""
    ('', True)
    """
    parts = []
    for sign, name in ((1.0, "largest"), (-1.0, "smallest")):
        signed = sign * force
        top = float(signed.max())
        at_top = signed == top
        count = int(np.count_nonzero(at_top))
        edges = np.flatnonzero(np.diff(np.r_[0, at_top.astype(np.int8), 0]))
        longest = int((edges[1::2] - edges[::2]).max())
        if longest < 4 or count < 8:
            continue
        below = signed[~at_top]
        if below.size == 0:
            continue
        second = float(below.max())
        # A quantised smooth peak has 2.4 times as many samples at its top value as at the next.
        if count > 6 * int(np.count_nonzero(below == second)):
            share = 100.0 * count / force.size
            parts.append(f"{name} value {sign * top:.6g} N for {count} samples ({share:.2g} %)")
    if not parts:
        return ""
    return (
        "the force stays at its " + " and its ".join(parts) + ": the channel looks clipped; "
        "raise its range and measure again, or leave the record out"
    )
