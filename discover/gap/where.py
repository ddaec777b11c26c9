"""Where a model and the measurement disagree: which records, and what the misfit follows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.figure_data import MisfitCell
from discover.motion_fit import Observation
from discover.rows import RecordRows, force_at_samples, force_rows
from models.checks import Array, Indices
from models.constitutive import ForceModel

_CELLS = 12  # of the map of the misfit, along each side
_REVERSAL = 0.05  # of the stroke, at each of its ends
_PHASES = 64  # parts of a cycle


@dataclass(frozen=True)
class Place:
    """One record's part in the misfit."""

    record: str
    """File of the record."""
    share: float
    """Its share of the misfit's energy over all records."""
    ratio: float
    """Whitened misfit over what noise explains; 1 where there is only noise."""
    significant: bool
    """Whether its misfit is above noise, counting how many records were looked at."""
    follows: tuple[tuple[str, float], ...]
    """What the misfit follows, and the share of it that each explains alone, greatest first."""
    reversal: float
    """Share of the misfit within 5 % of the stroke around reversal."""
    odd: float
    """Share of the misfit in odd harmonics; NaN where the record is no sine test."""

    @property
    def words(self) -> str:
        """In words."""
        if not self.significant:
            return "within the noise"
        parts = []
        if self.follows and self.follows[0][1] > 0.1:
            name, share = self.follows[0]
            parts.append(f"follows {name} ({100.0 * share:.0f} %)")
        if self.reversal > 0.3:
            parts.append(f"{100.0 * self.reversal:.0f} % near reversal")
        if np.isfinite(self.odd):
            if self.odd > 0.8:
                parts.append("odd harmonics")
            elif self.odd < 0.2:
                parts.append("even harmonics")
        return "; ".join(parts) or "follows nothing simple"

    def to_dict(self) -> dict[str, object]:
        """Return the document's entry."""
        return {
            "record": self.record,
            "share": self.share,
            "significant": self.significant,
            "misfit_over_noise": self.ratio,
            "profile": self.words,
            "follows": {name: share for name, share in self.follows},
            "near_reversal": self.reversal,
            "odd_harmonics": self.odd if np.isfinite(self.odd) else None,
        }


def misfit_at_samples(rows: RecordRows, model: ForceModel) -> Array:
    """Return measured less model at the usable samples, N."""
    return rows.observation.measured - force_at_samples(rows.observation, model)


def places(rows: Sequence[RecordRows], models: Sequence[ForceModel]) -> tuple[Place, ...]:
    """Return each record's part in the misfit of models.

    Parameters
    ----------
    rows : sequence of RecordRows
        All records.
    models : sequence of ForceModel
        The model in each.
    """
    energies = []
    for r, model in zip(rows, models, strict=True):
        left = misfit_at_samples(r, model)
        energies.append(float(np.mean(left**2)) * left.size)
    total = max(sum(energies), 1e-300)
    return tuple(
        _place(r, model, energy / total, len(rows))
        for r, model, energy in zip(rows, models, energies, strict=True)
    )


def _place(rows: RecordRows, model: ForceModel, share: float, count: int) -> Place:
    o = rows.observation
    left = misfit_at_samples(rows, model)
    whitened = rows.target - force_rows(rows, model)
    ratio = float(np.mean(whitened**2))
    limit = 1.2 + np.sqrt(2.0 / whitened.size) * np.sqrt(2.0 * np.log(20.0 * count))
    x, v, a = (
        o.at_samples(c)
        for c in (o.motion.displacement, o.motion.velocity, o.motion.acceleration)
    )
    late = 2.0 * (o.time - o.time[0]) / (o.time[-1] - o.time[0]) - 1.0
    smooth = _smooth_misfit(rows, left)
    groups = {
        "displacement": _powers(x),
        "speed": _powers(v),
        "acceleration": _powers(a),
        "direction": np.stack([np.sign(v), np.sign(v) * x / np.abs(x).max()]),
        "time": np.stack([late, late**2, late * v / np.abs(v).max()]),
    }
    follows = sorted(
        ((name, _explained(smooth, columns)) for name, columns in groups.items()),
        key=lambda item: -item[1],
    )
    near = np.abs(x - 0.5 * (x.max() + x.min())) > (0.5 - _REVERSAL) * (x.max() - x.min())
    energy = max(float(np.sum(smooth**2)), 1e-300)
    return Place(
        o.file, share, ratio, bool(ratio > limit), tuple(follows),
        float(np.sum(smooth[near] ** 2)) / energy, _odd(rows, model),
    )


def _smooth_misfit(rows: RecordRows, left: Array) -> Array:
    """Return the part of a sine test's misfit that repeats every cycle; others as they are."""
    o = rows.observation
    if o.kind != "sine":
        return np.asarray(left - left.mean())
    mean, phase = phase_means(o, left)
    return np.asarray(mean[phase])


def phase_means(observation: Observation, values: Array) -> tuple[Array, Indices]:
    """Return a sine test's values averaged by phase (64,), and each sample's phase (N,)."""
    cycles = observation.time * observation.frequency
    phase = (np.mod(cycles, 1.0) * _PHASES).astype(np.int_)
    count = np.maximum(np.bincount(phase, minlength=_PHASES), 1)
    return np.bincount(phase, weights=values, minlength=_PHASES) / count, phase


def _powers(value: Array) -> Array:
    scaled = value / max(float(np.abs(value).max()), 1e-300)
    return np.stack([scaled, scaled * np.abs(scaled), scaled**3])


def _explained(left: Array, columns: Array) -> float:
    solution = np.linalg.lstsq(columns.T, left, rcond=1e-9)[0]
    power = max(float(left @ left), 1e-300)
    return float(np.clip(1.0 - np.sum((left - solution @ columns) ** 2) / power, 0.0, 1.0))


def _odd(rows: RecordRows, model: ForceModel) -> float:
    o = rows.observation
    if o.kind != "sine":
        return float("nan")
    window = o.windows[0]
    lines = window.force - window.project(force_at_samples(o, model))
    power = np.abs(lines) ** 2
    return float(power[1::2].sum() / max(power.sum(), 1e-300))


def surface(rows: Sequence[RecordRows], models: Sequence[ForceModel]) -> tuple[MisfitCell, ...]:
    """Return the misfit over displacement and velocity, all records together."""
    total = np.zeros((_CELLS, _CELLS))
    count = np.zeros((_CELLS, _CELLS))
    for r, model in zip(rows, models, strict=True):
        o = r.observation
        left = misfit_at_samples(r, model)
        level = max(float(np.sqrt(np.mean(left**2))), 1e-300)
        x = o.at_samples(o.motion.displacement)
        v = o.at_samples(o.motion.velocity)
        row, column = (
            np.clip(((c / np.abs(c).max() + 1.0) * 0.5 * _CELLS).astype(int), 0, _CELLS - 1)
            for c in (v, x - x.mean())
        )
        np.add.at(total, (row, column), left / level)
        np.add.at(count, (row, column), 1.0)
    middle = (np.arange(_CELLS) + 0.5) * 2.0 / _CELLS - 1.0
    return tuple(
        MisfitCell(float(middle[j]), float(middle[i]), float(total[i, j] / count[i, j]))
        for i in range(_CELLS)
        for j in range(_CELLS)
        if count[i, j] > 0
    )


def where_in_words(found: Sequence[Place]) -> str:
    """Return one sentence about where the misfit lies."""
    above = [p for p in found if p.significant]
    if not above:
        return "No record's misfit stands above its noise."
    greatest = max(above, key=lambda p: p.share)
    weights = np.array([p.share for p in above])
    mean: dict[str, float] = {}
    for p in above:
        for name, share in p.follows:
            mean[name] = mean.get(name, 0.0) + share * p.share
    name, value = max(mean.items(), key=lambda item: item[1])
    value /= max(float(weights.sum()), 1e-300)
    near = float(weights @ np.array([p.reversal for p in above]) / max(weights.sum(), 1e-300))
    most = f", {100.0 * greatest.share:.0f} % of its energy in {greatest.record}"
    place = f"in {len(above)} of {len(found)} records{most}" if len(found) > 1 else "in the record"
    follows = "it follows nothing simple"
    if value > 0.1:
        follows = f"{100.0 * value:.0f} % of it follows {name}"
    return (
        f"The misfit stands above the noise {place}; {follows}, and {100.0 * near:.0f} % lies"
        " within 5 % of the stroke around reversal."
    )
