"""The curve along which friction reverses: its harmonics hardly tell, the samples beside it do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from discover.gap.accuracy import Misfit
from discover.gap.stages import record_misfit
from discover.naming.fit import ModelFit, Parameter, fit_model, free_parameters, kind_of
from discover.naming.forces import has_impacts, has_joint
from discover.naming.reversal import reversing_friction
from discover.naming.rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel

_AREA = float(np.log(2.0))  # between sign and tanh, of that between sign and v/sqrt(v^2 + v_t^2)
_CLEARER = 0.99  # of the sum of records' squared gaps, below which another curve is preferred
_ANOTHER_WIDTH = 1.5  # times the range of reversal: then it stands for something else
_FINE = 1.1  # of a record's noise, up to which no other curve is sought
_LINES = 0.85  # of the number of rows: chi-square up to which their lines show noise alone
_MET = 1.13  # of their noise, up to which a curve of its own has to bring the records' gaps
_ANY = 1.45  # likewise, of each one, whose noise is known that well
_BY_A_KNEE = 0.6  # of what is left above the noise, to which a knee has to bring it
_OTHER = (4.0, 0.25)  # times the range of reversal, over which a part of it may reverse instead
_OTHER_SHARE = 0.3
_KNEE = {"sharpness": 1.0}
_FARTHEST = 20.0  # times one part's range, to which the other's may reach: beyond it, a resistance
WIDEST = 0.05  # of the greatest speed, likewise
_STEPS = 12  # of a fit, to harmonics, with a curve of its own


def reversing_as_sampled(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    """Return the fit with the curve along which its friction reverses as the samples tell.

    A knee of its own (`sharpness`), or a part that reverses over another range, could stand for an
    effect that is missing: they are taken only where nothing is left then.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        Of a model; returned as it is where none of its friction's range of reversal is free, or
        behind a joint with impacts. Behind another joint only plain curves are tried.
    """
    place = _free_reversal(fit)
    if place is None or has_impacts(fit.model):
        return fit
    best, left = fit, _misfits(rows, fit)
    curve = _curve(fit, place)
    speed = curve["transition_speed"]
    if curve["sharpness"] == 0.0:
        as_wide = speed / _AREA if curve["form"] else speed * _AREA
        other = {"form": 1.0 - curve["form"], "transition_speed": as_wide}
        trial = _with_curve(rows, fit, place, other)
        width = _curve(trial, place)["transition_speed"] / as_wide
        now = _misfits(rows, trial)
        if 1.0 / _ANOTHER_WIDTH < width < _ANOTHER_WIDTH and _gap(now) < _CLEARER * _gap(left):
            best, left = trial, now
    if has_joint(fit.model) or _fine(best, left):
        return best
    return _own_curve(rows, best, place, left)


def curves_of_its_own(rows: Sequence[RecordRows], fit: ModelFit) -> Iterator[ModelFit]:
    """Return fits whose friction reverses along curves of its own, however much they leave.

    The simplest first: a knee, then a part that reverses over another range.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        Of a model; where its friction has a curve of its own already, there are no others.
    """
    place = _free_reversal(fit)
    if place is None or has_impacts(fit.model):
        return
    curve = _curve(fit, place)
    if curve["sharpness"] > 0.0 or curve["other_share"] > 0.0:
        return
    speeds = [times * curve["transition_speed"] for times in _OTHER]
    for own in (_KNEE, *(two for speed in speeds for two in _in_two_parts(speed))):
        model = _model_with(fit, place, {**curve, **own})
        found = fit_model(rows, model, free_parameters(model), iterations=_STEPS)
        wide = _curve(found, place)["transition_speed"] > WIDEST * _fastest(rows)
        if _reverses(rows, found, place) and not (wide and own == _KNEE):
            yield found


def _in_two_parts(speed: float) -> list[dict[str, float]]:
    """Return curves of which a part reverses over another range of speed, m/s."""
    other = {**_KNEE, "other_speed": speed, "other_share": _OTHER_SHARE}
    return [{**other, "form": form} for form in (0.0, 1.0)]


def _free_reversal(fit: ModelFit) -> int | None:
    """Return the place of friction whose range of reversal is fitted; None without one."""
    place = reversing_friction(fit.model)
    free = place is not None and Parameter(place, "transition_speed") in fit.parameters
    return place if free else None


def with_curve_of(
    rows: Sequence[RecordRows], fit: ModelFit, other: ModelFit
) -> ModelFit | None:
    """Return a fit with the friction's curve that another fit has found; None where it has none.

    Only coefficients are fitted: beside what is missing the curve would move away again.
    """
    place, found = _free_reversal(fit), reversing_friction(other.model)
    if place is None or found is None:
        return None
    curve = _curve(other, found)
    if kind_of(curve) == kind_of(_curve(fit, place)):
        return None
    model = _model_with(fit, place, curve)
    linear = [p for p in free_parameters(model) if p.shape is None]
    solved = fit_model(rows, model, linear)
    return fit_model(rows, solved.model, free_parameters(solved.model), iterations=0)


def noise_alone(fit: ModelFit) -> bool:
    """Tell whether the lines of what is left are noise alone."""
    return fit.chi2 <= _LINES * fit.residual.size


def _own_curve(
    rows: Sequence[RecordRows], fit: ModelFit, place: int, left: Sequence[Misfit]
) -> ModelFit:
    """Return the fit with a curve of its own, where that is all that was missing.

    The simplest first: a knee, then a part that reverses over another range.
    """
    curve = _curve(fit, place)
    if curve["other_share"] > 0.0:
        return fit
    speed = curve["transition_speed"]
    trials = [_as_sampled(rows, fit, place, _KNEE)]
    bent, now = trials[0]
    if not _met(now) and _above(now) > _BY_A_KNEE * _above(left):
        return fit
    for times in () if _fine(bent, now) else _OTHER:
        trials += [_as_sampled(rows, fit, place, two) for two in _in_two_parts(times * speed)]
        if any(_fine(found, now) for found, now in trials):
            break
    met = [
        found for found, now in trials
        if _met(now) and noise_alone(found) and _reverses(rows, found, place)
        and _gap(now) < _CLEARER * _gap(left)
    ]
    return min(met, key=lambda f: f.chi2, default=fit)


def _reverses(rows: Sequence[RecordRows], fit: ModelFit, place: int) -> bool:
    """Tell whether both parts of a curve are friction that reverses, and none a resistance."""
    curve = _curve(fit, place)
    if curve["other_share"] == 0.0:
        return True
    less, more = sorted((curve["transition_speed"], curve["other_speed"]))
    return more < min(_FARTHEST * less, WIDEST * _fastest(rows))


def _fastest(rows: Sequence[RecordRows]) -> float:
    return max(r.sizes["speed"] for r in rows)


def _as_sampled(
    rows: Sequence[RecordRows], fit: ModelFit, place: int, own: Mapping[str, float]
) -> tuple[ModelFit, list[Misfit]]:
    """Return the fit with another curve and what it leaves; harmonics leave the curve open."""
    begun = _with_curve(rows, fit, place, own)
    samples = [r.samples for r in rows]
    found = fit_model(samples, begun.model, begun.parameters)
    found = fit_model(rows, found.model, begun.parameters, iterations=0)
    return found, _misfits(rows, found)


def _curve(fit: ModelFit, place: int) -> Mapping[str, float]:
    return fit.model.terms[place].shape


def _with_curve(
    rows: Sequence[RecordRows], fit: ModelFit, place: int, other: Mapping[str, float]
) -> ModelFit:
    model = _model_with(fit, place, {**_curve(fit, place), **other})
    return fit_model(rows, model, free_parameters(model))


def _model_with(fit: ModelFit, place: int, curve: Mapping[str, float]) -> ForceModel:
    """Return the fitted model with another curve of its friction, which is its term at `place`."""
    terms = list(fit.model.terms)
    friction = terms[place]
    terms[place] = FittedTerm(friction.id, friction.coefficient, curve)
    return ForceModel(tuple(terms), fit.model.name)


def _misfits(rows: Sequence[RecordRows], fit: ModelFit) -> list[Misfit]:
    return [record_misfit(r, fit.model) for r in rows]


def _gap(left: Sequence[Misfit]) -> float:
    """Return the sum of squared gaps, each record's by its own force."""
    return sum(m.error / max(m.force, 1e-300) for m in left)


def _shares(left: Sequence[Misfit]) -> Array:
    """Return the squares of the records' gaps over their noise."""
    return np.array([(m.percent / max(m.noise_percent, 1e-300)) ** 2 for m in left])


def _fine(fit: ModelFit, left: Sequence[Misfit]) -> bool:
    """Tell whether neither samples nor harmonics show that the curve is another one."""
    return bool(_shares(left).max() <= _FINE**2) and noise_alone(fit)


def _met(left: Sequence[Misfit]) -> bool:
    """Tell whether the samples of what is left are noise alone, by all records and by each."""
    shares = _shares(left)
    return bool(shares.max() <= _ANY**2 and shares.mean() <= _MET**2)


def _above(left: Sequence[Misfit]) -> float:
    """Return how much of the gaps is above the noise."""
    return float(np.sum(np.maximum(_shares(left) - _MET**2, 0.0)))
