"""Records that do not belong together: a law's coefficients differ by more than they are known to.

Every record is fitted by mass, viscous damping, dry friction and stiffness, with an offset of its
own. Such a law is a rough one, so what it leaves of a record is no noise that averages out: it
counts as one error all along the record, and its share of the force is the standard deviation of
what the fit says; beside it is what a device differs by from one test to the next. Two comparisons
follow, each of a fit that records share with fits of their own.

- Records of like motion, pair by pair: the law's faults are the same in both, and what either fit
  leaves is the uncertainty.
- A record beside all others, where motions differ: then the law's faults differ too, and by how
  much is seen where each of the others is left out and predicted by the rest. With few records
  that is not known well, which Student's distribution says.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from scipy import optimize
from scipy.special import ndtri, stdtrit

from discover.records import Finding
from discover.rows import RecordRows
from discover.rows.columns import force_columns
from discover.words import listed, percent, quantity, short_name, significant
from models.checks import Array
from models.constitutive import FittedTerm

_LAW = (
    FittedTerm("inertia", 1.0),
    FittedTerm("viscous-damping", 1.0),
    FittedTerm("coulomb-friction", 1.0, {"relative_speed": 0.03}),
    FittedTerm("stiffness", 1.0),
)
_SIGNED = 3  # place of the stiffness, which gas or a magnet may make negative
_OFFSET = FittedTerm("force-offset", 1.0)
_LEVEL = 0.01  # probability of a false word on a campaign whose records belong together
_ALIKE = 0.3  # of the logarithm of frequency and of amplitude: two motions are alike
_FEWEST = 4  # records, of which one can be told from all others
_REPEATS = 0.03
"""Of the force, standard deviation: no device repeats a test better (wear, warmth). A judgement; of
14 campaigns, 11 of them measured, the same records are named at 0, 0.01 and 0.03."""
_SEEN = 1e-6  # of the greatest singular value: directions that records hardly show are left out


@dataclass(frozen=True)
class Parting:
    """A coefficient that, if it is the record's own, mends the law that all share."""

    id: str
    """Of the term."""
    here: float
    """In the record."""
    elsewhere: float
    """In the others."""
    unit: str
    """SI unit of both."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of ``check.json``."""
        return {
            "id": self.id, "here": self.here, "elsewhere": self.elsewhere, "unit": self.unit
        }  # fmt: skip

    @property
    def text(self) -> str:
        """The same in words."""
        here, there = quantity(self.here, self.unit), quantity(self.elsewhere, self.unit)
        return f"{short_name(self.id)} ({here} here, {there} there)"


@dataclass(frozen=True)
class Differing:
    """A record that others do not agree with, and in what."""

    record: str
    """File."""
    others: tuple[str, ...]
    """Files of those with which it was compared."""
    terms: tuple[Parting, ...]
    """What it may be: each alone, the one that mends most first."""
    force_percent: float
    """What a shared law misses more than laws of their own, of the record's force."""
    deviations: float
    """That, in standard deviations."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of ``check.json``."""
        return {
            "record": self.record,
            "others": list(self.others),
            "terms": [t.to_dict() for t in self.terms],
            "force_percent": self.force_percent,
            "deviations": self.deviations,
        }

    @property
    def finding(self) -> Finding:
        """The same in words."""
        few = len(self.others) < _FEWEST
        others = listed(self.others) if few else f"the other {len(self.others)} records"
        return Finding(
            "warning",
            f"it does not belong with {others}: one law for all misses"
            f" {percent(self.force_percent)} of its force more than laws of their own,"
            f" {significant(self.deviations, 2)} standard deviations; what differs may be"
            f" {listed([t.text for t in self.terms], last='or')}. A record of another device or"
            " condition is better studied apart",
            self.record,
        )


def differing_records(rows: Sequence[RecordRows]) -> tuple[Differing, ...]:
    """Return the records that do not belong with the others, in the campaign's order.

    Parameters
    ----------
    rows : sequence of RecordRows
        Of all records, held out or not. Records without a measured displacement or without force
        are passed over.
    """
    known = [r for r in rows if not r.observation.phase_fitted and np.all(r.size > 0.0)]
    if len(known) < 2:
        return ()
    fits = _Fits(tuple(_triangle(r) for r in known))
    found = _by_pairs(fits, _pairs_of_like_motion(known))
    rest = [k for k in range(len(known)) if k not in found]
    while len(rest) >= _FEWEST:
        judged = {k: fits.beside(k, [i for i in rest if i != k]) for k in rest}
        odd = max(judged, key=lambda k: judged[k])
        if judged[odd] < _bound(len(rest), freedom=len(rest) - 2):
            break
        rest.remove(odd)
        found[odd] = list(rest), judged[odd]
    return tuple(_differing(fits, known, k, *found[k]) for k in sorted(found))


def _triangle(rows: RecordRows) -> Array:
    """Return the law's columns and the force, over the force, as a triangle (K + 1, K + 1).

    Rows are shares of the record's force; the offset is taken out of all.
    """
    columns = force_columns(rows, [*_LAW, _OFFSET])
    whole = np.concatenate([columns, rows.target[None]]) / rows.size
    offset, whole = whole[-2], np.delete(whole, -2, axis=0)
    whole = whole - np.outer(whole @ offset, offset) / max(float(offset @ offset), 1e-300)
    whole = whole / max(float(np.linalg.norm(whole[-1])), 1e-300)
    return np.asarray(np.linalg.qr(whole.T, mode="r"))


def _pairs_of_like_motion(rows: Sequence[RecordRows]) -> list[tuple[int, int]]:
    """Return the pairs of records of one kind whose frequencies and amplitudes are alike."""
    seen = [r.observation for r in rows]
    place = np.log([[max(o.frequency, 1e-12), max(o.amplitude, 1e-12)] for o in seen])
    return [
        (i, k)
        for i, k in combinations(range(len(rows)), 2)
        if np.all(np.abs(place[i] - place[k]) < _ALIKE)
        and (seen[i].kind == "sine") == (seen[k].kind == "sine")
    ]


def _by_pairs(
    fits: _Fits, pairs: Sequence[tuple[int, int]]
) -> dict[int, tuple[list[int], float]]:
    """Return records that differ from at least half of those of like motion.

    With them: from which, and by how many standard deviations at least.
    """
    bound = _bound(len(pairs), freedom=None)
    apart: dict[int, dict[int, float]] = {}
    for i, k in pairs:
        apart.setdefault(i, {})[k] = apart.setdefault(k, {})[i] = fits.pair(i, k)
    found = {}
    for record, judged in apart.items():
        some = {k: d for k, d in judged.items() if d > bound}
        if some and 2 * len(some) >= len(judged):
            found[record] = sorted(some), min(some.values())
    return found


def _bound(number: int, *, freedom: int | None) -> float:
    """Return the deviations, of so many, that the greatest exceeds at the level by chance."""
    level = _LEVEL / (2.0 * max(number, 1))
    return -float(ndtri(level) if freedom is None else stdtrit(freedom, level))


@dataclass(frozen=True)
class _Fits:
    """Fits of the law to records, each of which counts by its share of the force."""

    triangles: tuple[Array, ...]
    """Of the records."""

    @property
    def scale(self) -> Array:
        """(K,) coefficients at which columns have unit length over all records."""
        squares = sum(np.sum(t[:, :-1] ** 2, axis=0) for t in self.triangles)
        return np.asarray(1.0 / np.sqrt(np.maximum(squares, 1e-300)))

    def fit(self, some: Sequence[int]) -> tuple[float, Array]:
        """Return the misfit's square and coefficients (K,) of records that share a law."""
        whole = np.concatenate([self.triangles[k] for k in some])
        left, values, right = np.linalg.svd(whole[:, :-1] * self.scale, full_matrices=False)
        kept = values > _SEEN * values[0]
        found = left[:, kept].T @ whole[:, -1]
        misfit = max(float(whole[:, -1] @ whole[:, -1]) - float(found @ found), 0.0)
        return misfit, self.scale * (right[kept].T @ (found / values[kept]))

    def freed(
        self, record: int, others: Sequence[int], term: int | None
    ) -> tuple[float, float, float]:
        """Return the misfit's square with one coefficient a record's own; it here and elsewhere.

        All are at least zero but the stiffness: which of two terms it is that a test hardly tells
        apart would else be a matter of their difference.
        """
        parts = []
        for k in (record, *others):
            shared = self.triangles[k][:, :-1] * self.scale
            own = np.zeros(shared.shape[0])
            if term is not None and k == record:
                own = shared[:, term].copy()
                shared[:, term] = 0.0
            parts.append(np.column_stack([shared, -shared[:, _SIGNED], own, -own]))
        force = np.concatenate([self.triangles[k][:, -1] for k in (record, *others)])
        whole = np.concatenate(parts)
        if term != _SIGNED:
            whole[:, -1] = 0.0
        found, misfit = optimize.nnls(whole, force)
        law = found[: len(_LAW)]
        law[_SIGNED] -= found[len(_LAW)]
        own = found[-2] - found[-1]
        if term is None:
            return float(misfit) ** 2, 0.0, 0.0
        return float(misfit) ** 2, self.scale[term] * own, self.scale[term] * law[term]

    def left(self, record: int, coefficients: Array) -> float:
        """Return the square of what coefficients leave of a record."""
        rest = self.triangles[record] @ np.append(coefficients, -1.0)
        return float(rest @ rest)

    def shift(self, record: int, others: Sequence[int]) -> float:
        """Return the square by which a shared law misses more than laws of their own."""
        together = self.fit([record, *others])[0]
        return max(together - self.fit([record])[0] - self.fit(others)[0], 0.0)

    def pair(self, one: int, other: int) -> float:
        """Return by how many standard deviations two records of like motion differ."""
        apart = 0.5 * (self.fit([one])[0] + self.fit([other])[0]) + _REPEATS**2
        return float(np.sqrt(self.shift(one, [other]) / apart))

    def beside(self, record: int, others: Sequence[int]) -> float:
        """Return by how many standard deviations a record differs from others."""
        missed = [
            self.left(k, self.fit([i for i in others if i != k])[1]) for k in others
        ]
        apart = max(float(np.mean(missed)), self.fit([record])[0]) + _REPEATS**2
        return float(np.sqrt(self.shift(record, others) / apart))


def _differing(
    fits: _Fits, rows: Sequence[RecordRows], record: int, others: Sequence[int], deviations: float
) -> Differing:
    shared, _, _ = fits.freed(record, others, None)
    freed = [fits.freed(record, others, term) for term in range(len(_LAW))]
    mended = np.array([shared - misfit for misfit, _, _ in freed])
    order = [i for i in np.argsort(-mended) if mended[i] >= 0.5 * mended.max()]
    return Differing(
        record=rows[record].file,
        others=tuple(rows[k].file for k in others),
        terms=tuple(
            Parting(_LAW[i].id, freed[i][1], freed[i][2], _LAW[i].term.unit) for i in order
        ),
        force_percent=100.0 * float(np.sqrt(fits.shift(record, others))),
        deviations=deviations,
    )
