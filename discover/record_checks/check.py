"""What `inerter check` says of each record and of the campaign as data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from discover.motion_fit import Observation
from discover.record_checks.asked_once import apparent_of, digest_of, returns, turns, work_of
from discover.record_kind import RecordKind, classify
from discover.records import Campaign, Finding, Record
from discover.rows import compared_with
from discover.sine_fit import sine_steps

_BEYOND_SKEW = 0.5  # of the force: no plausible delay turns that much of inertia into damping
_FEW_CYCLES = 3.0  # below which a warning says so
_FEW_SAMPLES = 20.0  # a cycle
_NOISY = 20.0  # percent


@dataclass(frozen=True)
class RecordCheck:
    """One record's entry in ``check.json``."""

    file: str
    """As in ``campaign.toml``."""
    held_out: bool
    """True where it is never fitted."""
    kind: RecordKind
    """What the motion shows."""
    samples: int
    """In the record, usable or not."""
    sampling_hz: float
    """Mean sampling frequency, Hz."""
    frequency_hz: float | None
    """Of a sine test or a repeated waveform, Hz."""
    amplitude_m: float | None
    """Of a sine test: measured, or as labelled where the displacement is not; m."""
    force_noise_percent: float | None
    """100 times the force's noise over its root mean square, as every verb says it; None where
    the force is zero."""
    displacement_noise_m: float | None
    """Standard deviation, m; None where displacement is not measured."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of ``check.json``."""
        return {
            "file": self.file,
            "held_out": self.held_out,
            "kind": self.kind.kind,
            "frequency_hz": self.frequency_hz,
            "amplitude_m": self.amplitude_m,
            "cycles": self.kind.cycles,
            "samples": self.samples,
            "usable_samples": self.kind.usable.stop - self.kind.usable.start,
            "sampling_hz": self.sampling_hz,
            "force_noise_percent": self.force_noise_percent,
            "displacement_noise_m": self.displacement_noise_m,
        }


@dataclass(frozen=True)
class CampaignCheck:
    """The data's part of ``check.json``."""

    records: tuple[RecordCheck, ...]
    """In the campaign's order."""
    findings: tuple[Finding, ...]
    """What reading mended or found odd, then what these checks found; errors first."""

    @property
    def passed(self) -> bool:
        """Return whether no finding is an error."""
        return all(finding.level != "error" for finding in self.findings)

    def to_dict(self) -> dict[str, Any]:
        """Return ``records`` and ``findings`` of ``check.json``."""
        return {
            "records": [record.to_dict() for record in self.records],
            "findings": [finding.to_dict() for finding in self.findings],
        }


def check_record(observation: Observation) -> RecordCheck:
    """Judge one record: its kind, its sampling and the noise of its channels.

    Examples
    --------
    >>> from discover.motion_fit import observe
    >>> t = np.arange(2000) / 500.0
    >>> x = 0.01 * np.sin(10.0 * t)
    >>> found = check_record(observe(Record("r.csv", t, -200.0 * np.sin(10.0 * t), x)))
    >>> found.kind.kind, found.samples, round(found.sampling_hz, 6)
    ('sine', 2000, 500.0)
    """
    record = observation.record
    kind = classify(record)
    if observation.kind == "sine" and record.long is not None:
        start = kind.usable.start or 0
        kind = replace(
            kind,
            usable=slice(start, record.samples),
            period=1.0 / observation.frequency,
            cycles=observation.duration * observation.frequency,
        )
    measured = record.displacement is not None
    seen = compared_with(observation, np.zeros_like(observation.measured))
    return RecordCheck(
        file=record.file,
        held_out=record.held_out,
        kind=kind,
        samples=record.samples,
        sampling_hz=1.0 / record.step,
        frequency_hz=kind.frequency,
        amplitude_m=kind.amplitude if measured else record.amplitude,
        force_noise_percent=seen.noise_percent if seen.force_power > 0.0 else None,
        displacement_noise_m=observation.displacement_noise if measured else None,
    )


def check_records(campaign: Campaign, observations: Sequence[Observation]) -> CampaignCheck:
    """Judge every record, and the campaign as a whole: signs, copies, what is held out.

    Parameters
    ----------
    campaign : Campaign
        As read.
    observations : sequence of Observation
        Of all its records, in order.

    Returns
    -------
    CampaignCheck
        Its findings hold those of reading.
    """
    records = tuple(check_record(observation) for observation in observations)
    findings = [*campaign.findings, *_of_campaign(campaign), *_stepped(campaign.records)]
    for record in records:
        findings.extend(_quality(record))
    order = {"error": 0, "warning": 1, "note": 2}
    findings.sort(key=lambda finding: order.get(finding.level, 3))
    return CampaignCheck(records, tuple(findings))


def data_errors(campaign: Campaign) -> tuple[Finding, ...]:
    """Return what is wrong with the records, not merely remarkable: signs, above all."""
    return tuple(f for f in _of_campaign(campaign) if f.level == "error")


def one_direction(campaign: Campaign) -> list[Finding]:
    """Return a finding where no motion turns back, but some model may still be told."""
    fitted = campaign.fitted
    if any(turns(r) for r in fitted) or not any(returns(r) for r in fitted):
        return []
    text = (
        "no fitted record turns back: dry friction and a constant force are one number here;"
        " measure a stroke out and back"
    )
    return [Finding("warning", text)]


def _of_campaign(campaign: Campaign) -> list[Finding]:
    return [
        *_signs(campaign.records),
        *_one_way(campaign),
        *one_direction(campaign),
        *_copies(campaign.records),
        *_roles(campaign),
    ]


def _one_way(campaign: Campaign) -> list[Finding]:
    """Return findings on records whose motion never comes back: an error where there is no other.

    Two of them at other speeds tell something, if little.
    """
    fitted = campaign.fitted
    lone = len(fitted) == 1
    text = (
        "the motion goes one way, and its speed does not both rise and fall: any force can be a"
        " law of the place as well as of the speed or of the time, and no model can be told from"
        " another; measure a stroke from rest to rest at least, better several cycles"
    )
    return [
        Finding("error" if lone else "warning", text, r.file) for r in fitted if not returns(r)
    ]


def _signs(records: tuple[Record, ...]) -> list[Finding]:
    """Return findings on records whose force gives energy over closed loops of the motion."""
    known = [(r, work) for r in records if (work := work_of(r)) is not None]
    giving = [r for r, work in known if work.gives]
    if not giving:
        return []
    if not any(work.takes for _, work in known):
        turned = max(-work.share for _, work in known)
        if turned < _BEYOND_SKEW and _inertia(giving) > 0.0:
            text = (
                "the work over closed loops is negative in every record, though little, and the"
                " apparent mass is not: force and displacement are skewed in time, or a channel is"
                " delayed"
            )
            return [Finding("warning", text)]
        text = (
            "the work over closed loops is negative throughout: the force column has the wrong"
            " sign for the displacement's direction; multiply it by -1, as `force = \"-1 N\"` in"
            " [units] of campaign.toml does (with the column's own unit for N)"
        )
        return [Finding("error", text)]
    text = (
        "the device gives energy here (the work over closed loops is negative) but not in other"
        " records: the force has another sign or delay here than there"
    )
    return [Finding("error", text, r.file) for r in giving]


def _stepped(records: tuple[Record, ...]) -> list[Finding]:
    """Return findings on records that are several sine tests in one."""
    found = []
    for r in records:
        if r.displacement is None or classify(r).kind not in ("trajectory", "transient"):
            continue
        count = len(sine_steps(r.time, r.displacement))
        if count:
            text = (
                f"it is a stepped sine of {count} steps; as sine tests, each with a `range` of its"
                " own, they tell noise and model better: `inerter init` writes them"
            )
            found.append(Finding("warning", text, r.file))
    return found


def _inertia(records: Sequence[Record]) -> float:
    """Return how much of the force acts as a mass (positive) or as a spring (negative)."""
    found = [apparent_of(r) for r in records]
    return float(sum(np.sign(a.mass) * a.mass_share**2 for a in found if a is not None))


def _copies(records: tuple[Record, ...]) -> list[Finding]:
    """Return findings on records with the same samples."""
    findings: list[Finding] = []
    seen: dict[str, Record] = {}
    for record in records:
        first = seen.setdefault(digest_of(record), record)
        if first is record:
            continue
        if first.held_out != record.held_out:
            text = f"it is a copy of {first.file}: one is fitted and the other held out"
            findings.append(Finding("error", text + ", so holding out proves nothing", record.file))
        else:
            text = f"it is a copy of {first.file}: its samples would count twice"
            findings.append(Finding("warning", text, record.file))
    return findings


def _roles(campaign: Campaign) -> list[Finding]:
    if not campaign.fitted:
        return [Finding("error", "every record is held out: nothing is left to fit")]
    if not campaign.held_out and len(campaign.records) > 1:
        text = (
            "no record is held out: predictions are then only judged by leaving records out in turn"
        )
        return [Finding("note", text)]
    return []


def _quality(record: RecordCheck) -> list[Finding]:
    """Return findings on one record's length, sampling and noise."""
    findings = []
    kind, file = record.kind, record.file
    used = kind.usable.stop - kind.usable.start
    if used < record.samples:
        what = "start-up and run-down" if kind.kind == "sine" else "samples beyond whole periods"
        findings.append(Finding("note", f"{what} are cut off", file))
    if kind.kind == "sine" and kind.sine is not None and kind.cycles is not None:
        if kind.cycles < _FEW_CYCLES:
            text = f"only {kind.cycles:.2f} usable cycles: its noise floor is uncertain"
            findings.append(Finding("warning", text, file))
        per_cycle = record.sampling_hz / kind.sine.frequency
        if per_cycle < _FEW_SAMPLES:
            text = f"only {per_cycle:.1f} samples a cycle: the force's harmonics are cut off"
            findings.append(Finding("warning", text, file))
    if record.force_noise_percent is not None and record.force_noise_percent > _NOISY:
        text = f"the force's noise is {record.force_noise_percent:.0f} % of the force"
        findings.append(Finding("warning", text, file))
    return findings
