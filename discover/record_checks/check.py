"""What `inerter check` says of each record and of the campaign as data."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from discover.record_checks.apparent import Apparent, apparent
from discover.record_checks.noise import noise_floor
from discover.record_kind import RecordKind, classify
from discover.records import Campaign, Finding, Record

_SIGNIFICANT = 0.02  # of the force: a smaller share's sign says nothing
_BEYOND_SKEW = 0.5  # of the force: no plausible delay turns that much of inertia into damping
_FEW_CYCLES = 3.0
_FEW_SAMPLES = 20.0  # a cycle
_NOISY = 20.0  # percent


@dataclass(frozen=True)
class RecordCheck:
    """One record's entry in ``check.json``."""

    file: str
    """As in ``campaign.toml``."""
    held_out: bool
    """Never fitted."""
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
    """100 times the force's noise over its root mean square; None where it can't be told."""
    displacement_noise_m: float | None
    """Standard deviation, m; None where it can't be told."""
    apparent: Apparent | None
    """Apparent mass and damping; None without displacement."""

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


def check_record(record: Record) -> RecordCheck:
    """Judge one record: its kind, its sampling and the noise floors of its channels.

    Examples
    --------
    >>> t = np.arange(2000) / 500.0
    >>> x = 0.01 * np.sin(10.0 * t)
    >>> found = check_record(Record("r.csv", t, -200.0 * np.sin(10.0 * t), x))
    >>> found.kind.kind, found.samples, round(found.sampling_hz, 6)
    ('sine', 2000, 500.0)
    """
    kind = classify(record)
    force_noise, displacement_noise = None, None
    even = record.even
    if even.displacement is not None:
        displacement_noise = noise_floor(even.displacement, record.step, kind)
        level = noise_floor(even.force, record.step, kind)
        size = float(np.sqrt(np.mean(record.force[kind.usable] ** 2)))
        force_noise = 100.0 * level / size if level is not None and size > 0.0 else None
    return RecordCheck(
        file=record.file,
        held_out=record.held_out,
        kind=kind,
        samples=record.time.size,
        sampling_hz=1.0 / record.step,
        frequency_hz=kind.frequency,
        amplitude_m=record.amplitude if record.displacement is None else kind.amplitude,
        force_noise_percent=force_noise,
        displacement_noise_m=displacement_noise,
        apparent=apparent(record, kind),
    )


def check_records(campaign: Campaign) -> CampaignCheck:
    """Judge every record, and the campaign as a whole: signs, copies, what is held out.

    Parameters
    ----------
    campaign : Campaign
        As read.

    Returns
    -------
    CampaignCheck
        Its findings begin with those of reading.
    """
    records = tuple(check_record(record) for record in campaign.records)
    findings = list(campaign.findings)
    findings.extend(_signs(records))
    findings.extend(_copies(campaign.records))
    findings.extend(_roles(campaign))
    for record in records:
        findings.extend(_quality(record))
    order = {"error": 0, "warning": 1, "note": 2}
    findings.sort(key=lambda finding: order.get(finding.level, 3))
    return CampaignCheck(records, tuple(findings))


def data_errors(campaign: Campaign) -> tuple[Finding, ...]:
    """Return what is wrong with the records, not merely remarkable: signs, above all."""
    return tuple(
        f
        for f in check_records(campaign).findings
        if f.level == "error" and f not in campaign.findings
    )


def _signs(records: tuple[RecordCheck, ...]) -> list[Finding]:
    """Return findings on records whose force gives energy instead of taking it.

    A passive device never gives energy, so its apparent damping is never negative. Its apparent
    mass may be: at low frequency it can act as a spring.
    """
    known = [(r.file, r.apparent) for r in records if r.apparent is not None]
    giving = [file for file, a in known if _gives_energy(a)]
    if not giving:
        return []
    undecided = [file for file, a in known if not _gives_energy(a) and not _takes_energy(a)]
    if len(giving) + len(undecided) == len(known):
        found = [a for _, a in known]
        inertia = sum(np.sign(a.mass) * a.mass_share**2 for a in found)
        turned = max(a.damping_share for a in found if a.damping < 0.0)
        if inertia > 0.0 and turned < _BEYOND_SKEW:
            text = (
                "the device gives energy in every record (its apparent damping is negative, its "
                "mass is not): force and displacement are skewed in time, or a channel is delayed"
            )
            return [Finding("warning", text)]
        text = (
            "apparent mass and damping are negative throughout: the force column has the wrong "
            "sign for the displacement's direction; multiply the force (or the displacement) by -1"
        )
        return [Finding("error", text)]
    text = (
        "the device gives energy here (its apparent damping is negative) but not in other records: "
        "the force has another sign or delay here than there"
    )
    return [Finding("error", text, file) for file in giving]


def _gives_energy(found: Apparent) -> bool:
    if found.damping_share > _SIGNIFICANT:
        return found.damping < 0.0
    return found.mass < 0.0 and found.mass_share > _BEYOND_SKEW


def _takes_energy(found: Apparent) -> bool:
    if found.damping_share > _SIGNIFICANT:
        return found.damping > 0.0
    return found.mass > 0.0 and found.mass_share > _BEYOND_SKEW


def _copies(records: tuple[Record, ...]) -> list[Finding]:
    """Return findings on records with the same samples."""
    findings: list[Finding] = []
    seen: dict[str, Record] = {}
    for record in records:
        digest = hashlib.sha256(record.force.tobytes())
        if record.displacement is not None:
            digest.update(record.displacement.tobytes())
        first = seen.setdefault(digest.hexdigest(), record)
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
        what = "start-up and run-down" if kind.kind == "sine" else "what isn't whole periods"
        text = f"{used} of {record.samples} samples are used: {what} cut off"
        findings.append(Finding("note", text, file))
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
