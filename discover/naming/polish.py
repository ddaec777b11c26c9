"""A fit through a joint polished on samples: its impacts are shorter than the shortest harmonic."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from discover.naming.fit import ModelFit, fit_model, misfits
from discover.naming.rows import RecordRows, smoothed, weighed_by
from discover.naming.scattered import scattered
from models.checks import Array

_STEPS = 6
_ENOUGH = 0.003
_TURNS = 3
_SETTLED = 0.97  # of chi-square, to which another turn has to bring it
_WIDTHS = (1.0 / 40.0, 1.0 / 160.0, 0.0)  # of a cycle, over which samples are averaged
_EVEN, _HALF = 1.0, 0.5  # how evenly records count that differ in what they leave
_CLOSED = 1.3  # times the noise, up to which nothing better is sought
_FAR = 2.0  # likewise, from which another joint is
_SOUGHT = 0.9  # of the gap, to which a search for another joint has to bring it, for one more
_MOST = 1e12  # of mean squares


def polished(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    """Return a fit through a joint as the samples tell, which see when impacts happen.

    Where steps on samples end early they are smoothed first: a spike that comes a sample late
    says nothing of where to go, a smooth one does.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        As their lines tell; its last term is the joint. Returned where samples tell nothing better.
    """
    samples = [r.samples for r in rows]
    begun = _Left.by(samples, fit)
    best = min(begun, _Left.by(samples, _settled(samples, fit, _EVEN, rough=True)), key=_gap)
    impacts = fit.model.terms[-1].shape.get("contact", 0.0) > 0.0
    if impacts and best.gap > _CLOSED:
        best = min(best, _Left.by(samples, _step_by_step(samples, best.fit)), key=_gap)
    for turn in range(_TURNS if impacts else 0):
        before = best.gap
        if before <= _FAR:
            break
        other = scattered(best.tolerated(_EVEN), best.fit, best.loudest, seed=turn)
        if other is not best.fit:
            best = min(best, _Left.by(samples, _step_by_step(samples, other)), key=_gap)
        if best.gap > _SOUGHT * before:
            break
    if best is begun:
        return fit
    return fit_model(rows, best.fit.model, best.fit.parameters, iterations=0)


def counted(rows: Sequence[RecordRows], fit: ModelFit) -> list[RecordRows]:
    """Return the records' samples as rows, with the noise that a fit leaves in them."""
    return _Left.by([r.samples for r in rows], fit).tolerated(_HALF)


def _step_by_step(samples: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    """Return the fit to samples that are smoothed less and less."""
    for width in _WIDTHS:
        fit = _settled([smoothed(r, width) for r in samples], fit, _HALF, rough=False)
    return fit


def _settled(
    samples: Sequence[RecordRows], fit: ModelFit, evenly: float, *, rough: bool
) -> ModelFit:
    """Return the fit to samples of which each record counts by what it leaves, turn by turn."""
    for _ in range(_TURNS):
        seen = _Left.by(samples, fit).tolerated(evenly)
        before = fit_model(seen, fit.model, ()).chi2
        fit = fit_model(
            seen, fit.model, fit.parameters, iterations=_STEPS, enough=_ENOUGH, exact=False,
            rough=rough,
        )
        if not fit.chi2 < _SETTLED * before:
            break
    return fit


@dataclass(frozen=True)
class _Left:
    """What a fit leaves of the samples of each record."""

    samples: Sequence[RecordRows]
    """The samples as rows."""
    fit: ModelFit
    """Of a model."""
    squares: Array
    """(R,) mean square over that of the noise."""

    @classmethod
    def by(cls, samples: Sequence[RecordRows], fit: ModelFit) -> _Left:
        left = misfits(samples, fit_model(samples, fit.model, ()))
        left = left / np.array([r.target.size for r in samples])
        return cls(samples, fit, np.nan_to_num(left, nan=_MOST, posinf=_MOST))

    @property
    def _noise(self) -> Array:
        """(R,) mean square of each record's noise, N^2."""
        windows = [r.observation.windows for r in self.samples]
        return np.array([sum(w.share * w.noise_power for w in ws) for ws in windows])

    @property
    def gap(self) -> float:
        """Gap over the noise, both in N and pooled over records."""
        return float(np.sqrt(self.squares @ self._noise / np.sum(self._noise)))

    @property
    def loudest(self) -> NDArray[np.intp]:
        """(R,) which records have the greatest gaps in N, that first."""
        return np.argsort(self.squares * self._noise)[::-1]

    def tolerated(self, evenly: float) -> list[RecordRows]:
        """Return the samples with the noise that is left: a mean of the record's and of all.

        Where impacts last no longer than a sample their least delay leaves more than any noise,
        and a quiet record in which they do would outweigh all in which they show. `evenly` is the
        power of the record's own in that geometric mean: with 1 all records count alike, with 0
        by how loud they are.
        """
        own = np.clip(self.squares, 1.0 / _MOST, _MOST)
        whole = (own @ self._noise) / self._noise.size / self._noise
        times = np.sqrt(own**evenly * whole ** (1.0 - evenly))
        return [weighed_by(r, float(t)) for r, t in zip(self.samples, times, strict=True)]


def _gap(left: _Left) -> float:
    return left.gap
