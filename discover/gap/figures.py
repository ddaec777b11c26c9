"""Curves of a gap search for pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from discover.figure_data import EffectShape, GapCurves
from discover.gap.accuracy import Misfit
from discover.gap.rounds import Round
from discover.gap.stages import without
from discover.naming.forces import model_force, needs_cycle
from discover.naming.rows import RecordRows
from discover.naming.unit_rows import whole_model
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel, SegmentedModel
from models.terms import Term

_POINTS = 600
_SHOWN = 400
_CYCLES = 2.0
_FOLLOWS = {
    "inertia": "acceleration",
    "stiffness": "displacement",
    "cubic-stiffness": "displacement",
    "end-stop": "displacement",
    "hysteresis": "displacement",
    "backlash": "displacement",
    "position-dependent-friction": "displacement",
    "sensor-drift": "time",
    "thermal-drift": "time",
}
_UNITS = {"velocity": "m/s", "displacement": "m", "acceleration": "m/s^2", "time": "s"}
_LOOPS = ("time-delay", "series-compliance", "sensor-gain", "sensor-clipping", "cavitation",
          "fractional-derivative", "backlash")


def curves(rows: RecordRows, before: Array, after: Array, was: Misfit, now: Misfit) -> GapCurves:
    """Return a record's curves, decimated; `before` and `after` are on the motion's grid."""
    o = rows.observation
    sine = o.kind == "sine"
    stop = o.time.size
    if sine:
        step = float((o.time[-1] - o.time[0]) / (o.time.size - 1))
        stop = min(stop, int(np.ceil(_CYCLES / (o.frequency * step))) + 1)
    chosen = np.unique(np.linspace(0, stop - 1, min(_POINTS, stop)).astype(int))
    return GapCurves(
        file=o.file,
        held_out=o.held_out,
        frequency=o.frequency if sine else None,
        amplitude=o.amplitude if sine else None,
        time=o.time[chosen] - o.time[0],
        displacement=o.at_samples(o.motion.displacement)[chosen],
        velocity=o.at_samples(o.motion.velocity)[chosen],
        force=o.measured[chosen],
        before=o.at_samples(before)[chosen],
        after=o.at_samples(after)[chosen],
        noise_percent=now.noise_percent,
        gap_before_percent=was.percent,
        gap_after_percent=now.percent,
    )


def shape_of(
    rows: Sequence[RecordRows], entry: Round, number: int, relative_error: float
) -> EffectShape:
    """Return the effect's force in the record where it is greatest, over what it follows.

    Parameters
    ----------
    rows : sequence of RecordRows
        Fitted records.
    entry : Round
        The round.
    number : int
        Its index.
    relative_error : float
        Standard error of the coefficient over the coefficient.
    """
    model = entry.after.fit.model
    rest = without(model, entry.effect)

    def change(r: RecordRows) -> Array:
        o = r.observation
        return model_force(o, whole_model(r, model)) - model_force(o, whole_model(r, rest))

    sizes = [
        float(np.std(change(r))) / max(float(np.std(r.observation.measured)), 1e-300) for r in rows
    ]
    r = rows[int(np.argmax(sizes))]
    o = r.observation
    sources = {
        "velocity": o.motion.velocity,
        "displacement": o.motion.displacement,
        "acceleration": o.motion.acceleration,
        "time": o.motion.time - o.motion.time[0],
    }
    added = change(r)
    abscissa = _FOLLOWS.get(entry.effect, "velocity")
    term = next((t.term for t in model.terms if t.id == entry.effect), None)
    if term is not None and term.source is not None:
        abscissa = _followed(term, sources, added)
    unit = _UNITS[abscissa]
    along, force = o.at_samples(sources[abscissa]), o.at_samples(added)
    left = o.measured - o.at_samples(model_force(o, whole_model(r, rest)))
    stop = along.size
    if o.kind == "sine" and abscissa != "time":
        step = float((o.time[-1] - o.time[0]) / (o.time.size - 1))
        stop = min(stop, int(np.ceil(1.0 / (o.frequency * step))) + 1)
    chosen = np.unique(np.linspace(0, stop - 1, min(_SHOWN, stop)).astype(int))
    looped = any(needs_cycle(t.term, t.shape) for t in model.terms if t.id == entry.effect)
    if abscissa == "velocity" and entry.effect not in _LOOPS and not looped:
        chosen = chosen[np.argsort(along[chosen], kind="stable")]
    band = 1.96 * relative_error * np.abs(force[chosen])
    return EffectShape(
        number, entry.effect, abscissa, unit, along[chosen], force[chosen],
        force[chosen] - band, force[chosen] + band, along[chosen], left[chosen],
    )


def _followed(term: Term, sources: Mapping[str, Array], force: Array) -> str:
    """Return what a user's effect is best drawn over: that along which its force varies least."""
    if term.follows == "time":
        return "time"
    if term.follows == "path":
        return "displacement"

    def variation(name: str) -> float:
        return float(np.abs(np.diff(force[np.argsort(sources[name], kind="stable")])).sum())

    return min(("velocity", "displacement", "acceleration"), key=variation)


def added_to(whole: SegmentedModel, terms: Sequence[FittedTerm]) -> SegmentedModel:
    """Return a model by bands with the same terms added in each."""
    bands = tuple(
        type(b)(b.lower, b.upper, ForceModel((*b.model.terms, *terms), b.model.name))
        for b in whole.bands
    )
    added = (*whole.added, *(t.id for t in terms))
    return replace(whole, bands=bands, added=added)
