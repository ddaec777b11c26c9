"""How well each record is predicted by the others: linear in the model's numbers, no new fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import softmax

from discover.posterior.assess import Assessed
from discover.posterior.evidence import root_of
from discover.posterior.local import Local
from discover.posterior.own_share import own_lines
from discover.posterior.sheet import Sheet
from models.checks import Array, Indices
from models.terms.between_tests import ONLY

_DRAWS = 4000  # of records' weights
_NOTHING = 1e-12  # of an energy: rounding of a sum less one of its parts


def left_out(assessed: Assessed) -> tuple[Array, Array]:
    """Return what a model leaves of each record: fitted to all, and to the others alone.

    Of one record alone, parts that move alike are left out in turn; of one in a single part, what a
    fit to all of it leaves stands for both. What belongs to a record and to no other, as an offset
    of its own, can't be known from the others: it is taken from it.

    Parameters
    ----------
    assessed : Assessed
        The model; it is left at its numbers, which should be those that predict best.

    Returns
    -------
    fitted, predicted : ndarray, shape (records,), or (parts,) of one record
        Mean square of what is left over that of the record's force. The remainder that records
        share is not used to predict.
    """
    left = _left(assessed)
    return left.fitted, left.predicted


def predicted(assessed: Assessed) -> Array:
    """Return what a model leaves (N,) of each record by which it is compared with others.

    Numbers that only the record itself tells are charged as fitted ones are (Akaike, *IEEE Trans.
    Autom. Control* 19, 1974, 716-723), each by the lines that say something of their own.
    """
    return _charged(assessed, _left(assessed.predicting))


def unseen(assessed: Assessed) -> Array:
    """Return what a model leaves (N,) of each record of which it has seen nothing.

    There what every test has of its own is known by its mean only.
    """
    return _left(assessed.predicting).unaided


def predicted_no_worse(assessed: Assessed, before: Array) -> Array | None:
    """Return `predicted`; None where a model leaves more of unseen records than was left `before`.

    What every test has of its own may be what there is: where with it but noise is left, it is
    never worse.
    """
    left = _left(assessed.predicting)
    return None if _misleads(assessed, before, left) else _charged(assessed, left)


@dataclass(frozen=True)
class _Left:
    """What a model leaves of each record, or part: mean square over that of the force."""

    fitted: Array
    """(N,) where it is fitted to all."""
    predicted: Array
    """(N,) to the others, and to the record what only the record tells."""
    unaided: Array
    """(N,) to the others; of what every test has of its own, their mean."""
    own: Array
    """(N,) how many numbers only the record tells."""


def _charged(assessed: Assessed, left: _Left) -> Array:
    charge = 2.0 * left.own / own_lines(assessed.predicting, left.own.size)
    return np.asarray(left.predicted * np.exp(charge))


def _misleads(assessed: Assessed, before: Array, left: _Left) -> bool:
    return not assessed.quiet and before.size > 1 and is_less(before, left.unaided)


def _left(assessed: Assessed) -> _Left:
    space, local = assessed.space, assessed.local
    curve = assessed.curve
    here = space.given(assessed.place.sizes(space.own_unit))
    departing = local.slopes[:, :0] if curve is None else space.columns[:, curve.columns]
    wide = np.zeros(0) if curve is None else assessed.judged.scale * curve.spread
    target = local.target(space.sheet.target)[:, None]
    columns = np.concatenate([local.slopes, departing, target], axis=1)
    gram = here.within(columns)
    spread = np.concatenate([local.spread, wide])
    records = np.array([u.record for u in space.sheet.units])
    alone = records.max() == 0
    parts = np.arange(records.size) if alone else records
    total = gram.sum(axis=0)
    free = np.ones(spread.size, dtype=bool)
    free[: local.held.size] = ~local.held
    alike = _alike(local, spread.size)
    nothing = np.zeros(spread.size)
    fit = _beside(total, spread, free, nothing)
    found = np.zeros((4, parts.max() + 1))
    for part in range(parts.max() + 1):
        inside = parts == part
        own = gram[inside].sum(axis=0)
        shown = np.diagonal(total - own)[:-1] > _NOTHING * np.diagonal(total)[:-1]
        elsewhere = free if alone and parts.size > 1 else free & shown
        only_here = free & ~elsewhere
        known = _beside(total - own, spread, elsewhere, nothing)
        aided = _beside(own, spread, only_here, known)
        others = alike @ np.where(elsewhere, known, 0.0) / np.maximum(alike @ elsewhere, 1.0)
        unaided = np.where(only_here, others, known)
        for place, values in enumerate((fit, aided, unaided)):
            left = columns[inside, -1] - np.einsum("p,upr->ur", values, columns[inside, :-1])
            found[place, part] = _relative(space.sheet, np.flatnonzero(inside), left)
        found[3, part] = np.count_nonzero(only_here & (np.diagonal(own)[:-1] > 0.0))
    return _Left(*found)


def _alike(local: Local, count: int) -> Array:
    """Return (P, P) 1 for coefficients of what every test has of its own alike, else 0."""
    kinds: dict[tuple[object, ...], list[int]] = {}
    for place, n in enumerate(local.numbers):
        fitted = local.model.terms[n.term].fitted
        if n.shape is None and fitted.shape.get(ONLY.name, 0.0) > 0.0:
            others = (v for v in fitted.shape.items() if v[0] != ONLY.name)
            kinds.setdefault((fitted.id, *others), []).append(place)
    found = np.zeros((count, count))
    for places in kinds.values():
        found[np.ix_(places, places)] = 1.0
    return found


def _beside(gram: Array, spread: Array, free: NDArray[np.bool_], values: Array) -> Array:
    """Return coefficients (P,): the free ones by products (P + 1, P + 1), beside the others."""
    if not np.any(free):
        return values
    side = gram[:-1, -1] - gram[:-1, :-1] @ np.where(free, 0.0, values)
    factor = root_of(gram[:-1, :-1][np.ix_(free, free)], spread[free])
    result = values.copy()
    half = np.linalg.solve(factor, spread[free] * side[free])
    result[free] = spread[free] * np.linalg.solve(factor.T, half)
    return result


def predicts_better(was: Assessed, now: Assessed) -> bool:
    """Tell whether a model predicts records that are left out better than another one.

    Nor may it be worse on records of which it has seen nothing, see `predicted_no_worse`. Of one
    record in a single part nothing can be left out: evidence decides.
    """
    before, after = (_left(a.predicting) for a in (was, now))
    if after.own.size < 2:
        return now.value > was.value
    better = is_less(_charged(now, after), _charged(was, before))
    return better and not _misleads(now, before.unaided, after)


def is_told_from_noise(assessed: Assessed) -> bool:
    """Tell whether records left out would be predicted better, were what is left but noise.

    Of errors a factor counts, so that one record which is far off does not hide the others.
    """
    sheet = assessed.assessor.space.sheet
    records = np.array([u.record for u in sheet.units])
    errors = left_out(assessed.predicting)[1]
    if errors.size != records.max() + 1:  # parts of a lone record
        return True
    noise = np.array([_noise(sheet, np.flatnonzero(records == r)) for r in range(errors.size)])
    return is_less(np.log(noise), np.log(np.maximum(errors, _NOTHING * noise)))


def is_needed(without: Assessed, with_it: Assessed) -> bool:
    """Tell whether a model is better with a term: by evidence where one leaves but noise.

    Where none does, by records left out. A model whose force is not finite is never better.
    """
    if not np.isfinite(without.value):
        return True
    if without.quiet or with_it.quiet:
        return with_it.value >= without.value
    return predicts_better(without, with_it)


def is_less(now: Array, was: Array) -> bool:
    """Tell whether errors (N,) are less than others, by the standard error of the mean.

    A lone one can't tell, and counts as less.
    """
    gained = was - now
    if gained.size < 2:
        return True
    return bool(np.mean(gained) > np.std(gained, ddof=1) / np.sqrt(gained.size))


def predicts_best(errors: Sequence[Array], log_prior: Array, lines: float, seed: int) -> Array:
    """Return the probability (M,) of each model by how well it predicts records.

    The likelihood of a record that is left out, under an error of the size that the model leaves in
    it, stands for the evidence; it is averaged over weights of the records drawn anew, so that few
    records are not sure (pseudo-BMA+: Yao, Vehtari, Simpson and Gelman, *Bayesian Analysis* 13,
    2018, 917-1007).

    Parameters
    ----------
    errors : sequence of ndarray, shape (N,)
        What each model leaves of the records, from `left_out`.
    log_prior : ndarray, shape (M,)
        Nats.
    lines : float
        Of a record, that say something of their own.
    seed : int
        Of the draws.
    """
    score = -0.5 * lines * np.log(np.maximum(np.array(errors), _NOTHING))
    records = score.shape[1]
    weights = records * np.random.default_rng(seed).dirichlet(np.ones(records), _DRAWS)
    return np.asarray(softmax(weights @ score.T + log_prior, axis=1).mean(axis=0))


def _relative(sheet: Sheet, units: Indices, left: Array) -> float:
    """Return the energy of what is left in units of a record, over that of the record's force."""
    squares = []
    for u, own in zip(units, left, strict=True):
        part, basis = sheet.units[int(u)].part, sheet.units[int(u)].basis
        squares.append((own[: part.size] if basis is None else basis @ own[: basis.shape[1]]) ** 2)
    return _share(sheet, units, squares)


def _noise(sheet: Sheet, units: Indices) -> float:
    """Return the energy of noise in units of a record, over that of the record's force."""
    # Of compressed rows all that terms do not tell is in one direction, noise of every row in it.
    squares = [np.ones(sheet.units[int(u)].part.size) for u in units]
    return _share(sheet, units, squares)


def _share(sheet: Sheet, units: Indices, squares: Sequence[Array]) -> float:
    """Return squares of the rows of units of a record, over the energy of the record's force."""
    rows = sheet.rows[sheet.units[int(units[0])].record]
    whole = float(np.sum((rows.target / rows.size) ** 2))
    total = sum(
        float(np.sum(s / rows.size[sheet.units[int(u)].part] ** 2))
        for u, s in zip(units, squares, strict=True)
    )
    return total / max(whole, 1e-300)
