"""Judging a model by its motion: the carried system simulated under the measured input.

A model whose force fits may still drift, or lose its limit cycle, once it has to move something.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from discover.motion_fit import Observation, observe
from discover.records import Campaign, CarriedSystem, Finding, Record
from discover.simulate import Model, predict_record
from models.checks import Array, InputError
from models.simulation import ErrorEstimate, Load, PeriodicPast, sampled_load, simulate
from models.structure import oscillator

_STEPS_PER_PERIOD = 200
_FEWEST_AT_START = 12  # samples that the state at the start is fitted to
_NEGLIGIBLE = 1e-9  # of the largest line
_LATE = 1.0 / 3.0  # of the record: where drift and amplitude are judged


@dataclass(frozen=True)
class RecordMotion:
    """Simulated beside measured motion of one record."""

    file: str
    """Name of the record."""
    held_out: bool
    """As in the campaign."""
    time: Array
    """(N,) s, of the record."""
    measured: Array
    """(N,) m."""
    simulated: Array
    """(N,) m."""
    noise: float
    """m, root mean square, of the measured displacement."""
    force_gap_percent: float
    """100 ||F - model||/||F|| for the measured motion."""
    error: ErrorEstimate | None
    """Of the simulation itself."""

    @property
    def motion_gap_percent(self) -> float:
        """100 ||x - simulated||/||x||."""
        return 100.0 * _norm(self.measured - self.simulated) / _norm(self.measured)

    @property
    def noise_percent(self) -> float:
        """100 ||noise||/||x||."""
        return 100.0 * self.noise * math.sqrt(self.measured.size) / _norm(self.measured)

    @property
    def amplitude_ratio(self) -> float:
        """Simulated over measured root mean square about the mean, in the last third."""
        late = self._end_of_record
        measured, simulated = np.std(self.measured[late]), np.std(self.simulated[late])
        return float(simulated / measured) if measured else math.inf

    @property
    def drift_percent(self) -> float:
        """Mean of simulated less measured over the last third, of the measured rms, percent."""
        late = self._end_of_record
        scale = _norm(self.measured) / math.sqrt(self.measured.size)
        return 100.0 * float(np.mean(self.simulated[late] - self.measured[late])) / scale

    @property
    def _end_of_record(self) -> slice:
        return slice(int(self.time.size * (1.0 - _LATE)), None)

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of the document."""
        return {
            "file": self.file,
            "held_out": self.held_out,
            "motion_gap_percent": self.motion_gap_percent,
            "noise_percent": self.noise_percent,
            "force_gap_percent": self.force_gap_percent,
            "amplitude_ratio": self.amplitude_ratio,
            "drift_percent": self.drift_percent,
            "simulation_error": None if self.error is None else self.error.relative,
        }


@dataclass(frozen=True)
class MotionGap:
    """The gap on simulated motion, beside that on force."""

    model: str
    """Name of the model."""
    system: CarriedSystem
    """What is carried."""
    records: tuple[RecordMotion, ...]
    """Records with an input."""
    findings: tuple[Finding, ...]
    """Drift, lost or false limit cycles, records without an input."""

    def gap_percent(self, *, held_out: bool = False) -> float | None:
        """Return 100 ||x - simulated||/||x|| pooled over fitted or held-out records."""
        chosen = [r for r in self.records if r.held_out is held_out]
        if not chosen:
            return None
        missed = math.hypot(*(_norm(r.measured - r.simulated) for r in chosen))
        return 100.0 * missed / math.hypot(*(_norm(r.measured) for r in chosen))

    def to_dict(self) -> dict[str, Any]:
        """Return the part ``motion`` of ``gap.json``."""
        return {
            "model": self.model,
            "system": {
                "mass": self.system.mass,
                "stiffness": self.system.stiffness,
                "input": self.system.input,
            },
            "gap_percent": self.gap_percent(),
            "held_out_gap_percent": self.gap_percent(held_out=True),
            "records": [r.to_dict() for r in self.records],
            "findings": [f.to_dict() for f in self.findings],
        }


def motion_gap(model: Model, campaign: Campaign) -> MotionGap:
    """Return how far the motion that a model makes is from the measured one.

    The carried mass on its spring, with the model for the device, is driven by the record's input
    from the measured state at its start. A record that repeats starts in its steady state (Weyl),
    any other from rest (Caputo).

    Parameters
    ----------
    model : ForceModel or SegmentedModel
        Device between the mass and the base.
    campaign : Campaign
        With a carried system, and its input as a column of the records.

    Raises
    ------
    InputError
        Without a carried system or any record with its input, or for a term that has no rule in
        time.
    """
    system, driven = require_system(campaign)
    numbers = {record.file: place for place, record in enumerate(campaign.records, start=1)}
    records = tuple(_moved(model, record, system, numbers[record.file]) for record in driven)
    left = len(campaign.records) - len(driven)
    return MotionGap(model.name, system, records, _findings(records, left, system.input))


def require_system(campaign: Campaign) -> tuple[CarriedSystem, list[Record]]:
    """Return what is carried and the records that drive it.

    Raises
    ------
    InputError
        Where there is no carried system, or no record with its input and a displacement.
    """
    system = campaign.system
    if system is None:
        raise InputError(
            "carried system", expected="given as [system] in campaign.toml", found="nothing",
            where=campaign.source,
        )  # fmt: skip
    column = system.input
    driven = [r for r in campaign.records if column in r.inputs and r.displacement is not None]
    if not driven:
        raise InputError(
            f"column {column!r}", expected="in a record with displacement", found="in none",
            where=campaign.source,
        )  # fmt: skip
    return system, driven


def motion_before_and_after(campaign: Campaign, before: Model, after: Model) -> dict[str, Any]:
    """Return the part ``motion`` of ``gap.json``: a model and the mended one, by their motion.

    An effect that has no rule in time (a record's filter, play in a joint) leaves ``after`` None,
    with the reason.
    """
    result: dict[str, Any] = {"before": motion_gap(before, campaign).to_dict()}
    try:
        result["after"] = motion_gap(after, campaign).to_dict()
    except InputError as error:
        result["after"], result["reason"] = None, str(error)
    return result


def _moved(model: Model, record: Record, system: CarriedSystem, number: int) -> RecordMotion:
    record = record.even  # a simulation in time has equal steps
    observation = replace(observe(record), test=number)
    usable = observation.usable
    time = record.time[usable]
    elapsed = time - time[0]
    load = _load(record, system, usable, elapsed)
    structure = oscillator(system.mass, system.stiffness, model)
    past = _past(observation, float(time[0]))
    natural = math.sqrt(system.stiffness / system.mass) / (2.0 * math.pi)
    fastest = max(natural, observation.frequency)
    parts = max(math.ceil(record.step * fastest * _STEPS_PER_PERIOD), 1)
    if record.displacement is None:
        raise InputError("displacement", expected="given", where=record.file)
    measured = record.displacement[usable]
    position, velocity = _start(measured, record.step, observation)
    response = simulate(
        structure,
        load,
        step=record.step / parts,
        duration=float(elapsed[-1]),
        displacement=position,
        velocity=velocity,
        past=past,
        keep_every=parts,
    )
    return RecordMotion(
        file=record.file,
        held_out=record.held_out,
        time=time,
        measured=measured,
        simulated=response.displacement[:, 0],
        noise=observation.displacement_noise,
        force_gap_percent=predict_record(observation, model).accuracy.relative_percent,
        error=response.error,
    )


def _start(measured: Array, step: float, observation: Observation) -> tuple[float, float]:
    """Return displacement and velocity at the first usable sample.

    By a cubic through the first half period of the band's end: at a record's very end, band-limited
    derivatives lean on what is not there.
    """
    end = observation.cutoff or 8.0 * observation.frequency
    count = min(max(round(0.5 / end / step), _FEWEST_AT_START), measured.size)
    line = np.polynomial.Polynomial.fit(step * np.arange(count), measured[:count], 3)
    return float(line(0.0)), float(line.deriv()(0.0))


def _load(record: Record, system: CarriedSystem, usable: slice, elapsed: Array) -> Load:
    values = record.inputs[system.input][usable]
    of_the_base = system.input == "base_acceleration"
    return sampled_load(elapsed, values, acts="base" if of_the_base else "force")


def _past(observation: Observation, start: float) -> PeriodicPast | None:
    """Return the steady state of a record that repeats, its phase from the first usable sample."""
    cycle = observation.motion if observation.kind == "periodic" else observation.cycle
    if cycle is None:
        return None
    lines = np.fft.rfft(cycle.displacement) / cycle.displacement.size
    lines[1:] *= 2.0
    keep = int(np.flatnonzero(np.abs(lines) > _NEGLIGIBLE * np.abs(lines[1:]).max())[-1]) + 1
    frequency = 1.0 / (cycle.displacement.size * cycle.step)
    # A sine test's cycle starts at the record's t = 0, a periodic record's at its first sample.
    late = start if observation.kind == "sine" else 0.0
    turn = np.exp(2j * np.pi * frequency * late * np.arange(keep))
    return PeriodicPast((lines[:keep] * turn)[:, None], frequency)


def _norm(values: Array) -> float:
    return float(np.linalg.norm(values))


def _findings(
    records: Sequence[RecordMotion], without_input: int, column: str
) -> tuple[Finding, ...]:
    found = []
    if without_input:
        found.append(Finding("note", f"{without_input} records have no {column}: not simulated."))
    for r in records:
        if r.amplitude_ratio < 0.5:
            text = "the simulated motion dies out: {:.0%} of the measured amplitude is left"
            found.append(Finding("warning", text.format(r.amplitude_ratio), r.file))
        elif r.amplitude_ratio > 2.0:
            text = "the simulated motion grows to {:.1f} times the measured amplitude"
            found.append(Finding("warning", text.format(r.amplitude_ratio), r.file))
        if abs(r.drift_percent) > max(20.0, 3.0 * r.noise_percent):
            text = f"the simulated motion drifts by {r.drift_percent:.0f} %"
            found.append(Finding("warning", text, r.file))
        if r.error is not None and 100.0 * r.error.relative > 0.3 * r.motion_gap_percent + 0.1:
            found.append(
                Finding(
                    "warning",
                    f"the simulation itself errs by {100.0 * r.error.relative:.2g} %: sample the"
                    " input faster",
                    r.file,
                )
            )
    return tuple(found)
