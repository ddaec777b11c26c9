"""The verdict on one band: which terms, which structure, how probable, what else it may be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.library.dictionary import Dictionary
from discover.regression.covariance import Uncertainty, uncertainty
from discover.regression.support import ProfiledFit, Support, SupportFit
from discover.selection.discrepancy import with_discrepancy
from discover.selection.evidence import Contest, contest
from discover.selection.materiality import Materiality, relative_triangle
from discover.selection.structures import STRUCTURES, named_supports, structure_of
from discover.triangle import WindowRows, triangle_of
from models.checks import Array

_ROUNDS = 4
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
        rows = window.whitened(1.0)
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

    Returns
    -------
    Judgement
    """
    start = list(supports) if keep_all else named_supports(dictionary, ())
    weighed = with_discrepancy(windows, dictionary, coordinate, start)
    result = contest(triangle_of(weighed, 1.0), dictionary, supports)
    if not keep_all:
        candidates = _material(result, Materiality(windows, dictionary))
        for _ in range(_ROUNDS):
            leading = candidates[0]
            weighed = with_discrepancy(windows, dictionary, coordinate, [leading])
            result = contest(triangle_of(weighed, 1.0), dictionary, candidates)
            candidates = [s.fit.support for s in result.scored]
            if candidates[0] == leading:
                break
    best = result.scored[0].fit.support
    final = _estimation(weighed)
    engine = ProfiledFit(triangle_of(final, 1.0), dictionary)
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
        structure=structure_of(best.ids),
        probabilities={name: result.probabilities.get(name, 0.0) for name in STRUCTURES},
    )


def _material(result: Contest, materiality: Materiality) -> list[Support]:
    """Return the supports whose terms all matter, best first, some of every structure."""
    kept: list[Support] = []
    count = dict.fromkeys(STRUCTURES, 0)
    for scored in result.scored:
        full = len(kept) >= _KEPT and count[scored.structure] >= _KEPT_OF_EACH
        if full or not np.isfinite(scored.log_evidence):
            continue
        if materiality.holds(scored.fit.support):
            kept.append(scored.fit.support)
            count[scored.structure] += 1
    return kept or [result.scored[0].fit.support]


def _clusters(windows: Sequence[WindowRows]) -> int:
    return len(windows)


def _estimation(windows: Sequence[WindowRows]) -> list[WindowRows]:
    """Return windows weighted for estimation: flat over the band within a single long record.

    There the misfit is one model error and not noise, and weighting its spectrum would trade
    force error for nothing; between records, and over harmonics, the weights stay.
    """
    if len({w.record for w in windows}) > 1:
        return list(windows)
    rows = sum(float(w.count.sum()) for w in windows)
    misfit = sum(float((w.variance + w.discrepancy) @ w.count) for w in windows)
    level = misfit / rows
    return [
        replace(w, variance=np.full_like(w.variance, level / w.share * _mean_share(windows)),
                discrepancy=np.zeros_like(w.discrepancy))
        for w in windows
    ]


def _mean_share(windows: Sequence[WindowRows]) -> float:
    return float(np.mean([w.share for w in windows]))


def relative_misfit(windows: Sequence[WindowRows], fit: SupportFit) -> float:
    """Return ||e||/||F|| over the windows' rows and what is in none of them."""
    triangle = relative_triangle(windows)
    error = triangle.matrix @ np.append(-fit.combined, 1.0)
    return float(np.sqrt((error @ error) / max(triangle.target @ triangle.target, 1e-300)))
