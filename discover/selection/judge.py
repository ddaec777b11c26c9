"""The verdict on one band: which terms, which structure, how probable, what else it may be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.library.dictionary import Dictionary
from discover.regression.covariance import Uncertainty, uncertainty
from discover.regression.support import (
    PLAIN_SHAPES,
    SAME_SHAPE,
    ProfiledFit,
    Support,
    SupportFit,
)
from discover.selection.discrepancy import with_discrepancy, witnesses_of
from discover.selection.drift import with_zero_drift
from discover.selection.evidence import Contest, contest, name_of
from discover.selection.materiality import (
    Materiality,
    Worth,
    record_power,
    relative_triangle,
)
from discover.selection.prediction import leave_out
from discover.selection.structures import STRUCTURES, named_supports
from discover.triangle import WindowRows, triangle_of
from models.checks import Array

_ROUNDS = 4
_CROSS_CHECKED = 4  # records from which they check one another, and evidence alone decides
_NOISE_LIMITED = (0.3, 0.7)  # share of noise in the error: below it models err, above only noise
_KEPT = 120
_KEPT_OF_EACH = 3


@dataclass(frozen=True)
class Judgement:
    """What a band's windows say."""

    windows: tuple[WindowRows, ...]
    """With the model error that the best support leaves."""
    contest: Contest
    """Of the supports whose terms all matter."""
    engine: ProfiledFit
    """On which the fit stands."""
    fit: SupportFit
    """The best support's."""
    uncertainty: Uncertainty
    """Of the fit."""
    structure: str
    """Name of the best support's structure."""
    probabilities: dict[str, float]
    """Of each structure."""

    @property
    def support(self) -> Support:
        """The terms."""
        return self.fit.support


def score_meat(windows: Sequence[WindowRows], fit: SupportFit) -> Array:
    """Return the sum over windows of outer products of their scores, (K, K).

    Windows of one record count as a cluster each; residuals inside one may be correlated.
    """
    size = windows[0].matrix.shape[1] - 1
    meat = np.zeros((size, size))
    combined = fit.combined
    for window in windows:
        rows = window.whitened
        gradient = rows[:, :-1].T @ (rows[:, -1] - rows[:, :-1] @ combined)
        meat += np.outer(gradient, gradient)
    count = len(windows)
    used = max(count - fit.support.parameters, 1)
    return meat * (count / used)


def judge(
    windows: Sequence[WindowRows],
    dictionary: Dictionary,
    supports: Sequence[Support],
    coordinate: Array,
    *,
    keep_all: bool = False,
    seed: int = 0,
) -> Judgement:
    """Return the verdict on the windows of one band.

    Parameters
    ----------
    windows : sequence of WindowRows
        Fitted windows of the band.
    dictionary : Dictionary
        Of their columns, one variant of each term.
    supports : sequence of Support
        The competitors; a single one is only fitted.
    coordinate : ndarray, shape (W,)
        By which neighbours are found.
    keep_all : bool
        Leave out the rule that every term must explain more than remains.
    seed : int
        Of the bootstrap over records.

    Returns
    -------
    Judgement
    """
    windows = with_zero_drift(windows, dictionary)
    start = list(supports) if keep_all else named_supports(dictionary, ())
    weighed = with_discrepancy(windows, dictionary, coordinate, start)
    result = contest(triangle_of(weighed), dictionary, supports)
    if not keep_all:
        worth = Worth(windows, [s.fit for s in result.scored])
        few = len({w.record for w in windows}) < _CROSS_CHECKED
        materiality = Materiality(windows, dictionary) if few else None
        candidates = _leading(result, worth, materiality) or [result.scored[0].fit.support]
        for _ in range(_ROUNDS):
            leading = candidates[0]
            weighed = with_discrepancy(windows, dictionary, coordinate, [leading])
            result = contest(triangle_of(weighed), dictionary, candidates)
            candidates = [s.fit.support for s in result.scored]
            if candidates[0] == leading:
                break
    best, probabilities = result.scored[0].fit.support, result.probabilities
    several = len({w.record for w in windows}) >= _CROSS_CHECKED
    by_noise = several
    if several and not keep_all:
        best, probabilities, by_noise = _predictive(
            windows, dictionary, result, coordinate, seed
        )
    elif not several and not keep_all:
        whole = contest(triangle_of(weighed), dictionary, supports)
        probabilities = _few(result, whole, weighed)
        first = max((s.structure for s in result.scored), key=lambda name: probabilities[name])
        best = (result.best(first) or result.scored[0]).fit.support
    final = list(weighed) if by_noise else _alike(weighed)
    engine = ProfiledFit(triangle_of(final), dictionary)
    fit = engine.fit(best)
    freedom = max(_clusters(final) - best.parameters, 1)
    spread = uncertainty(
        engine,
        fit,
        scale=max(fit.chi2 / max(engine.triangle.rows - best.parameters, 1), 1.0),
        freedom=float(freedom),
        meat=score_meat(final, fit) if freedom > best.parameters else None,
    )
    return Judgement(
        windows=tuple(final),
        contest=result,
        engine=engine,
        fit=fit,
        uncertainty=spread,
        structure=name_of(fit),
        probabilities={name: probabilities.get(name, 0.0) for name in STRUCTURES},
    )


def _tempered(
    probabilities: dict[str, float], windows: Sequence[WindowRows]
) -> dict[str, float]:
    """Return the probabilities that few tests support where models err by more than the noise.

    What a model gets wrong in a record is one thing: its harmonics and windows are not independent
    witnesses of it. So the evidence counts two numbers a record, size and phase, and all rows only
    in so far as noise is the limit.
    """
    rows = sum(float(w.count.sum()) for w in windows)
    tests = len({w.record for w in windows})
    noise = sum(float(w.variance @ w.count) / max(w.power, 1e-300) for w in windows)
    total = sum(float(w.total_variance @ w.count) / max(w.power, 1e-300) for w in windows)
    low, high = _NOISE_LIMITED
    share = float(np.clip((noise / max(total, 1e-300) - low) / (high - low), 0.0, 1.0))
    power = share + (1.0 - share) * min(2.0 * tests / rows, 1.0)
    raised = {name: p**power if p > 0.0 else 0.0 for name, p in probabilities.items()}
    whole = max(sum(raised.values()), 1e-300)
    return {name: p / whole for name, p in raised.items()}


def _few(result: Contest, whole: Contest, windows: Sequence[WindowRows]) -> dict[str, float]:
    """Return the structures' probabilities where few records check one another.

    The evidence over all models and that over those whose terms all matter (`result`) count alike.
    Where only unnamed ones are among the latter the former speaks alone: that a structure's further
    term does not show is no reason to think that it is absent.
    """
    named = {s.structure for s in result.scored} != {"other"}
    views = [
        _tempered(c.probabilities, windows) for c in ((whole, result) if named else (whole,))
    ]
    return {name: sum(v[name] for v in views) / len(views) for name in STRUCTURES}


def _leading(result: Contest, worth: Worth, materiality: Materiality | None) -> list[Support]:
    """Return the supports whose terms are all worth a name, best first, some of every structure.

    Where few records check one another, `materiality` judges them too.
    """
    kept: list[Support] = []
    count = dict.fromkeys(STRUCTURES, 0)
    for scored in result.scored:
        full = len(kept) >= _KEPT and count[scored.structure] >= _KEPT_OF_EACH
        if full or not np.isfinite(scored.log_evidence) or not worth.all_terms(scored.fit):
            continue
        if materiality is None or materiality.holds(scored.fit.support):
            kept.append(scored.fit.support)
            count[scored.structure] += 1
    return kept


def _predictive(
    windows: Sequence[WindowRows],
    dictionary: Dictionary,
    result: Contest,
    coordinate: Array,
    seed: int,
) -> tuple[Support, dict[str, float], bool]:
    """Return the best support, the structures' probabilities, and whether noise is the limit.

    Where noise is the limit evidence decides; where models err by more, the prediction of records
    left out does; between, in proportion to what of the error is noise. Of models that predict
    alike the one with fewest terms stands for its structure.
    """
    engine = ProfiledFit(relative_triangle(windows), dictionary)
    fits = [engine.fit(s.fit.support) for s in result.scored]
    fits = [f for f in fits if f.valid] or fits
    low, high = _NOISE_LIMITED
    noise_share = leave_out(windows, fits).noise_share
    share = float(np.clip((noise_share - low) / (high - low), 0.0, 1.0))
    fits = [f for f in fits if _identified(f, dictionary)] or fits
    names = [name_of(f) for f in fits]
    predictions = leave_out(windows, fits)
    parameters = np.array([f.support.parameters for f in fits])
    smallest = predictions.parsimonious(parameters)
    near = [i for i, p in enumerate(parameters) if p <= parameters[smallest] + 2]
    standing = {}
    for name in dict.fromkeys(names[i] for i in near):
        own = [i for i in near if names[i] == name]
        standing[name] = own[predictions.only(own).parsimonious(parameters[own])]
    shares = predictions.only(list(standing.values())).shares(
        list(standing),
        np.random.default_rng(seed),
        witnesses=witnesses_of(windows, fits[smallest], coordinate),
    )
    mixed = {
        name: share * result.probabilities.get(name, 0.0) + (1.0 - share) * shares.get(name, 0.0)
        for name in STRUCTURES
    }
    leading = max(mixed, key=lambda name: mixed[name])
    if share > 0.5:
        scored = result.best(leading) or result.scored[0]
        return scored.fit.support, mixed, True
    return fits[standing.get(leading, smallest)].support, mixed, False


def _identified(fit: SupportFit, dictionary: Dictionary) -> bool:
    """Return False where a free shape is at its bound, or is a plain term's to within little."""
    for identifier, shape in zip(fit.support.free, fit.shapes, strict=False):
        found = dictionary.family(identifier)
        if found is None:
            continue
        ends = (found[0].lower, found[0].upper)
        if min(abs(shape - v) for v in (*ends, *PLAIN_SHAPES[identifier])) < SAME_SHAPE:
            return False
    return True


def _clusters(windows: Sequence[WindowRows]) -> int:
    return len(windows)


def _alike(windows: Sequence[WindowRows]) -> list[WindowRows]:
    """Return windows weighted so that every record's relative error counts alike.

    Where models err by more than the noise, the misfit is one model error: weighting its spectrum
    would trade force error for nothing.
    """
    power = record_power(windows)
    rows = sum(float(w.count.sum()) for w in windows)
    misfit = sum(
        float((w.variance + w.discrepancy) @ w.count) * w.share / power[w.record] for w in windows
    )
    return [
        replace(
            w,
            variance=np.full_like(w.variance, misfit / rows * power[w.record] / w.share),
            discrepancy=np.zeros_like(w.discrepancy),
        )
        for w in windows
    ]
