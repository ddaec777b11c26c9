"""Labelled frequency and amplitude against what the record shows."""

from __future__ import annotations

from discover.record_kind import classify
from discover.records import Finding, Record
from models.checks import InputError

FREQUENCY_TOLERANCE = 0.05
"""Relative deviation of a label above which it is an error."""
AMPLITUDE_TOLERANCE = 0.2
"""Likewise: actuators fall short of the command at high frequency, so it is wider."""
AMPLITUDE_NOTED = 0.05
"""Relative deviation of an amplitude above which it is told."""


def check_labels(record: Record) -> list[Finding]:
    """Return what to tell about the labels of a record that has them.

    Raises
    ------
    InputError
        Where a label contradicts the record beyond its tolerance; it says both.
    """
    if record.displacement is None:
        return _without_motion(record)
    if record.frequency is None and record.amplitude is None:
        return []
    kind = classify(record)
    findings: list[Finding] = []
    found = kind.frequency
    if found is None or (kind.sine is None and record.frequency is None):
        label = "frequency" if record.frequency is not None else "amplitude"
        text = (
            f"it is labelled with the {label} of a sine test but its displacement is no steady "
            f"sine of 1.5 cycles or more: treated as a {kind.kind}"
        )
        return [Finding("warning", text, record.file)]
    if record.frequency is not None:
        off = found / record.frequency - 1.0
        if abs(off) > FREQUENCY_TOLERANCE:
            raise InputError(
                "frequency",
                expected=f"that of the displacement, {found:.4g} Hz, within "
                f"{100.0 * FREQUENCY_TOLERANCE:.0f} %",
                found=f"the label {record.frequency:.4g} Hz",
                where=record.file,
            )
    if record.amplitude is not None and kind.amplitude is not None:
        findings.extend(_check_amplitude(record, record.amplitude, kind.amplitude))
    return findings


def _check_amplitude(record: Record, label: float, found: float) -> list[Finding]:
    off = found / label - 1.0
    if abs(off) > AMPLITUDE_TOLERANCE:
        peak_to_peak = abs(2.0 * found / label - 1.0) < 0.1
        raise InputError(
            "amplitude",
            expected=f"that of the displacement, {1e3 * found:.4g} mm, within "
            f"{100.0 * AMPLITUDE_TOLERANCE:.0f} %",
            found=f"the label {1e3 * label:.4g} mm"
            + (" (it looks like peak to peak)" if peak_to_peak else ""),
            where=record.file,
        )
    if abs(off) > AMPLITUDE_NOTED:
        text = (
            f"the displacement's amplitude is {1e3 * found:.4g} mm where the label says "
            f"{1e3 * label:.4g} mm: the measured one is used"
        )
        return [Finding("note", text, record.file)]
    return []


def _without_motion(record: Record) -> list[Finding]:
    """Return the note on a force curve whose motion is made from its labels."""
    if record.frequency is None or record.amplitude is None:
        raise InputError(
            "displacement",
            expected="a column, or frequency and amplitude given",
            found="neither",
            where=record.file,
        )
    cycles = float(record.time[-1] - record.time[0]) * record.frequency
    if cycles < 0.5:
        raise InputError(
            "time",
            expected="over at least half a cycle of the labelled "
            f"{record.frequency:.4g} Hz ({0.5 / record.frequency:.4g} s)",
            found=f"{cycles / record.frequency:.4g} s",
            where=record.file,
        )
    text = (
        f"it has no displacement: the motion is made from its labels, {record.frequency:.4g} Hz "
        f"and {1e3 * record.amplitude:.4g} mm, and its phase is fitted"
    )
    return [Finding("note", text, record.file)]
