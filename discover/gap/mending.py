"""The model with a named effect added, fitted from where the contest stopped."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.gap.accuracy import pooled
from discover.gap.reversing import reversing_as_sampled
from discover.gap.stages import left_out, record_misfit, without
from discover.naming.contest import Contest
from discover.naming.evidence import Entry
from discover.naming.fit import ModelFit, fit_model, free_parameters
from discover.naming.forces import has_impacts, is_joint, of_each_test
from discover.naming.polish import polished
from discover.naming.refine import as_begun, at_most_filtered, extended, pulls
from discover.naming.restart import best_range, restarted
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel

_SUPERFLUOUS = 6.0  # nats that an earlier effect has to be worth
_BEGIN = 3  # steps, after which the best way to make a delay shows
_CLEARER = 0.99  # of a gap, below which another kind of delay is preferred
_LAWS = 3  # of an effect, that are fitted instead of values of every test's own
_MOSTLY = 0.95  # of what these explain, that such a law has to
_AS_WELL = 1.1  # times the gap that these leave, up to which such a law is preferred
_PREDICTS = 0.7  # of a gap on records left out, below which such a law is preferred


def mended(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    contest: Contest,
    name: str,
    begun: ModelFit | None,
) -> ModelFit:
    """Return the fit with an effect added, from where the contest's own refinement stopped."""
    entry = next(e for e in contest.entries if e.effects and e.effects[0] == name)
    model = extended(fit.model, entry) if begun is None else begun.model
    found = fit_model(rows, model, free_parameters(model))
    if pulls(found.model.terms[len(fit.model.terms) :]):
        found = as_begun(rows, model)
    if of_each_test(found.model, name):
        found = _shared(rows, fit, contest.starts[name], found)
    if name == "time-delay" and not of_each_test(found.model, name):
        found = _aligned(rows, found)
    elif name == "sensor-gain":
        found = best_range(rows, found)
    else:
        found = restarted(rows, found) if is_joint(name) else found
        found = polished(rows, found) if has_impacts(found.model) else found
    curved = reversing_as_sampled(rows, found)
    return found if impossible(curved.model, name) else curved


def _shared(
    rows: Sequence[RecordRows], fit: ModelFit, starts: Sequence[Entry], own: ModelFit
) -> ModelFit:
    """Return the fit with one law for all tests, where that predicts tests that are left out.

    Values of every test's own fit any law, and of another test predict no more than their mean.
    """
    begun = [extended(fit.model, start) for start in starts]
    models = [m for m in begun if not of_each_test(m, m.terms[-1].id)]
    if not models:
        return own
    trials = [fit_model(rows, m, free_parameters(m)) for m in models[:_LAWS]]
    best = min(trials, key=lambda f: f.chi2)
    if fit.chi2 - best.chi2 < _MOSTLY * (fit.chi2 - own.chi2):
        return own
    if _gap(rows, best) < _AS_WELL * _gap(rows, own):
        return best
    predicts = pooled(left_out(rows, best)) < _PREDICTS * pooled(left_out(rows, own))
    return best if predicts else own


def _aligned(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    """Return the fit with the delay made as its samples tell: its lines hardly do."""
    *others, delay = fit.model.terms
    shapes = [{**delay.shape, **made} for made in _made(delay.coefficient)]
    late = [FittedTerm(delay.id, delay.coefficient, s) for s in shapes if s != delay.shape]
    models = [ForceModel((*others, t), fit.model.name) for t in late]
    parameters = free_parameters(fit.model)
    begun = [fit_model(rows, m, parameters, iterations=_BEGIN) for m in models]
    first = min(begun, key=lambda f: float(np.nan_to_num(_gap(rows, f), nan=np.inf)))
    best = fit_model(rows, first.model, parameters)
    return best if _gap(rows, best) < _CLEARER * _gap(rows, fit) else fit


def _made(delay: float) -> list[dict[str, float]]:
    """Return how a delay (s) may be made: sampled later, aligned from samples, or by a filter."""
    made = [(degree, 0.0, 0.0) for degree in (0.0, 1.0, 3.0)]
    if delay > 0.0:
        made += [(0.0, order, digital) for order in (1.0, 2.0, 4.0) for digital in (0.0, 1.0)]
    return [{"resampled": d, "filter_order": o, "digital": digital} for d, o, digital in made]


def _gap(rows: Sequence[RecordRows], fit: ModelFit) -> float:
    return pooled([record_misfit(r, fit.model) for r in rows])


def without_superfluous(
    rows: Sequence[RecordRows], fit: ModelFit, names: Sequence[str]
) -> tuple[ModelFit, tuple[str, ...]]:
    """Return the fit without earlier effects that the newest made worth next to nothing."""
    dropped: list[str] = []
    for name in names[::-1]:
        less = without(fit.model, name)
        trial = fit_model(rows, less, free_parameters(less), iterations=4)
        if trial.chi2 - fit.chi2 < 2.0 * _SUPERFLUOUS:
            fit = trial
            dropped.append(name)
    return fit, tuple(dropped)


def impossible(model: ForceModel, name: str) -> bool:
    """Tell whether some part of an effect has a sign or a size that it can't have."""
    own = [t for t in model.terms if t.id == name]
    return pulls(own) or at_most_filtered(own)
