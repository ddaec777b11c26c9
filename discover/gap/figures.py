"""Curves of a gap search for pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from discover.figure_data import EffectShape, GapCurves
from discover.gap.result import NamedEffect
from discover.motion_fit import Observation
from discover.record_curves import record_view, response
from discover.rows import Accuracy, RecordRows, force_at_samples
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS

_SHOWN = 400  # points of a shape at most
_UNITS = {"velocity": "m/s", "displacement": "m", "acceleration": "m/s^2", "time": "s"}
_SCATTERS = 4.0  # times its range, that a force varies by along what it does not follow


def curves(was: Accuracy, now: Accuracy) -> GapCurves:
    """Return a record's curves, decimated: measured, and the model before and after."""
    view = record_view(now)
    return GapCurves(
        **view.measured,
        responses=(response(now), response(was)),
        before=was.model_force[view.chosen],
        after=now.model_force[view.chosen],
        gap_before_percent=was.relative_percent,
        gap_after_percent=now.relative_percent,
    )


def shape_of(
    rows: Sequence[RecordRows], models: Sequence[ForceModel], named: NamedEffect, number: int
) -> EffectShape:
    """Return the effect's force in the record where it is greatest, over what it follows.

    Parameters
    ----------
    rows : sequence of RecordRows
        All records.
    models : sequence of ForceModel
        With the effect, in each.
    named : NamedEffect
        The round as it is stated.
    number : int
        Its index.
    """
    best, added, rest = rows[0], np.zeros(0), np.zeros(0)
    seen: list[tuple[dict[str, Array], Array]] = []
    most = -1.0
    for r, model in zip(rows, models, strict=True):
        if r.observation.held_out:
            continue
        without = ForceModel(tuple(t for t in model.terms if t.id != named.effect))
        lacking = force_at_samples(r.observation, without)
        change = force_at_samples(r.observation, model) - lacking
        seen.append((_sources(r.observation), change))
        size = float(np.std(change)) / max(float(np.std(r.observation.measured)), 1e-300)
        if size > most:
            most, best, added, rest = size, r, change, lacking
    o = best.observation
    fitted = FittedTerm(named.effect, named.coefficient, named.parameters)
    abscissa = _followed(fitted, seen)
    along = _sources(o)[abscissa]
    stop = along.size
    if o.kind == "sine" and abscissa != "time":
        step = float((o.time[-1] - o.time[0]) / (o.time.size - 1))
        stop = min(stop, int(np.ceil(1.0 / (o.frequency * step))) + 1)
    chosen = np.unique(np.linspace(0, stop - 1, min(_SHOWN, stop)).astype(int))
    order = np.argsort(along[chosen], kind="stable")
    varies = float(np.abs(np.diff(added[chosen][order])).sum())
    smooth = varies < _SCATTERS * max(float(np.ptp(added[chosen])), 1e-300)
    if smooth:
        chosen = chosen[order]
    half = 0.5 * (named.interval[1] - named.interval[0])
    relative = half / abs(named.coefficient) if named.coefficient else 0.0
    band = relative * np.abs(added[chosen])
    return EffectShape(
        number, named.effect, abscissa, _UNITS[abscissa], along[chosen], added[chosen],
        added[chosen] - band, added[chosen] + band, along[chosen], (o.measured - rest)[chosen],
        joined=smooth or o.kind == "sine" or abscissa == "time",
    )


def _sources(observation: Observation) -> dict[str, Array]:
    """Return what a force may be drawn over, at the usable samples, SI."""
    motion = observation.motion
    return {
        "velocity": observation.at_samples(motion.velocity),
        "displacement": observation.at_samples(motion.displacement),
        "acceleration": observation.at_samples(motion.acceleration),
        "time": observation.time - observation.time[0],
    }


def _followed(fitted: FittedTerm, seen: Sequence[tuple[Mapping[str, Array], Array]]) -> str:
    """Return what an effect is best drawn over: that along which its force varies least.

    In all records together: in one sine test displacement and acceleration are alike.
    """
    follows = TERMS[fitted.id].remembers(fitted.shape)
    if follows != "motion":
        return "time" if follows == "time" else "displacement"

    force = np.concatenate([change for _, change in seen])

    def variation(name: str) -> float:
        along = np.concatenate([sources[name] for sources, _ in seen])
        return float(np.abs(np.diff(force[np.argsort(along, kind="stable")])).sum())

    return min(("velocity", "displacement", "acceleration"), key=variation)
