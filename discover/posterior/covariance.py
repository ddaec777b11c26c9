"""What all models share, given its sizes: noise, a remainder, friction that differs by record.

For every unit the covariance of the rows is white noise, and beside it

- an independent error of `loud` times the record's force, on all rows but the fundamental's of a
  sine test; in other records where the force is;
- a remainder of `remainder` times the record's force: generic functions of the motion whose
  coefficients vary smoothly with frequency and amplitude, and a tenth of it from unit to unit;
- friction of `friction` N that a unit has of its own.

Given these sizes all that is asked of columns are products under the inverse covariance; they come
from plain products of each unit by Woodbury's identity, so that rows are read once for each `loud`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular

from discover.posterior.evidence import root_of
from discover.posterior.sheet import Sheet
from models.checks import Array, Indices

_INDEPENDENT = 0.1
"""Share of the remainder's variance that differs from unit to unit."""

Group = tuple[Indices, Array | None]
"""Columns, and how much of them is there in each unit (U,); None for all."""


@dataclass(frozen=True)
class Sizes:
    """Sizes of what no term explains."""

    remainder: float
    """Of the record's force."""
    loud: tuple[float, ...]
    """(L,) of each kind of independent error, likewise."""
    friction: float
    """N."""


@dataclass(frozen=True)
class Plain:
    """Columns at one size of the independent error, and their plain products within units."""

    products: Products
    """What they are of."""
    scaled: Array
    """(U, C, R) the columns."""

    @cached_property
    def across(self) -> Array:
        """(U, F + N, C) products with remainder and own friction."""
        return np.asarray(self.products.nuisance @ self.scaled.transpose(0, 2, 1))

    @cached_property
    def among(self) -> Array:
        """(U, C, C) products with each other."""
        return np.asarray(self.scaled @ self.scaled.transpose(0, 2, 1))


@dataclass(frozen=True)
class Products:
    """Plain products of columns within each unit, at one size of the independent error."""

    sheet: Sheet
    """Of the records."""
    own: Array
    """(U, N, R) columns of friction that units may have of their own, per N."""
    columns: Array
    """(U, K, R) columns, the measured force last."""
    loud: tuple[float, ...]
    """(L,) sizes of the independent error."""
    _known: dict[bytes, Plain] = field(default_factory=dict, repr=False)
    _given: dict[Sizes, Given] = field(default_factory=dict, repr=False)

    def at(self, sizes: Sizes) -> Given:
        """Return what products under the inverse covariance of sizes are made of, made once."""
        if sizes not in self._given:
            self._given[sizes] = given(self, sizes)
        return self._given[sizes]

    def has(self, sizes: Sizes) -> bool:
        """Tell whether products at these sizes are kept."""
        return sizes in self._given

    def forget(self) -> None:
        """Let go of all products, which hold this and are held by it."""
        self._given.clear()
        self._known.clear()

    @property
    def kept_bytes(self) -> int:
        """Bytes of what was made here and is kept."""
        made = {n: v for n, v in vars(self).items() if n not in ("sheet", "own", "columns")}
        return _bytes(made)

    @cached_property
    def _loud(self) -> Array:
        """(U, R) variance of the independent error, over the noise's."""
        square = np.square(self.loud)
        return np.asarray(np.einsum("l,ulr->ur", square, self.sheet.loudness**2))

    @cached_property
    def scale(self) -> Array:
        """(U, R) by which rows are divided: the standard deviation of noise and loud error."""
        return np.asarray(np.sqrt(1.0 + self._loud))

    @cached_property
    def nuisance(self) -> Array:
        """(U, F + N, R) remainder and own friction, over `scale`."""
        whole = np.concatenate([self.sheet.remainder, self.own], axis=1)
        return np.asarray(whole / self.scale[:, None])

    @cached_property
    def gram(self) -> Array:
        """(U, F + N, F + N) products of these."""
        return np.asarray(self.nuisance @ self.nuisance.transpose(0, 2, 1))

    def of(self, columns: Indices) -> Plain:
        """Return some of the columns (C,), made once."""
        key = columns.tobytes()
        if key not in self._known:
            scaled = self.columns[:, columns] / self.scale[:, None]
            self._known[key] = Plain(self, scaled)
        return self._known[key]

    @cached_property
    def log_centre(self) -> float:
        """Log density of noise and loud error at their centre, with what was left out of rows."""
        value = -0.5 * float(np.sum(np.log1p(self._loud)))
        count, energy = self.sheet.rest[:, :2].T
        grown = 1.0 + self.sheet.rest[:, 2:] @ np.square(self.loud)
        return value - 0.5 * float(np.sum(count * np.log(grown) + energy / grown))


@dataclass(frozen=True)
class Further:
    """Columns that are not among a space's, compared with these."""

    columns: Array
    """(U, T, R)."""
    _known: dict[tuple[tuple[float, ...], bytes], tuple[Array, Array]] = field(
        default_factory=dict, repr=False
    )

    def plain(self, products: Products, columns: Indices) -> tuple[Array, Array]:
        """Return plain products, made once for each size of the independent error.

        With the remainder, own friction and some of the space's columns (U, F + N + K, T), and
        with each other, summed over units (T, T).
        """
        key = products.loud, columns.tobytes()
        if key not in self._known:
            new = (self.columns / products.scale[:, None]).transpose(0, 2, 1)
            parts = [products.nuisance @ new]
            if columns.size:
                parts.append(products.of(columns).scaled @ new)
            flat = new.reshape(-1, new.shape[2])
            self._known[key] = np.concatenate(parts, axis=1), flat.T @ flat
        return self._known[key]


@dataclass(frozen=True)
class Kept:
    """Columns of the space beside which others are compared."""

    columns: Indices
    """(K,) their places."""
    spread: Array
    """(K,) standard deviations of their coefficients beforehand, at scale one."""
    taken: Array
    """(U (F + N), K) what units have of their own takes of them."""
    shared: Array
    """(Q F, K) what the remainder that units share takes of them."""
    gram: Array
    """(K, K) their products."""

    @cached_property
    def axes(self) -> tuple[Array, Array]:
        """How well (K,) directions of their coefficients are told, and these directions (K, K).

        At a scale s the coefficients' covariance is s^2 / (1 + s^2 how well) along each: the
        directions are the same at all scales.
        """
        strength, vectors = np.linalg.eigh(self.spread[:, None] * self.gram * self.spread)
        return np.maximum(strength, 0.0), self.spread[:, None] * vectors


@dataclass(frozen=True)
class Seen:
    """Columns under the inverse covariance of given sizes, unit by unit."""

    taken: Array
    """(U, F + N, C) what units have of their own takes of them."""
    smooth: Array
    """(U, F, C) products with the remainder, that taken out."""
    left: Array
    """(U, C, C) products with each other, that taken out."""


@dataclass(frozen=True)
class Given:
    """What products under the inverse covariance of given sizes are made of."""

    products: Products
    """At the same `loud`."""
    taken: Array
    """(U, F + N, F) what units have of their own takes of the remainder's functions."""
    inner: Array
    """(U, F + N, F + N) lower factor of one and what units have of their own."""
    spread: Array
    """(F + N,) its standard deviations."""
    smooth: Array
    """(U, Q) of the remainder that units share."""
    outer: Array
    """(Q F, Q F) lower factor of one and what that adds."""
    log_centre: float
    """Log density of rows at its centre, without constants, nats."""
    _kept: dict[bytes, Kept] = field(default_factory=dict, repr=False)

    @property
    def functions(self) -> int:
        """F, the number of the remainder's functions."""
        return int(self.products.sheet.remainder.shape[1])

    @property
    def force(self) -> int:
        """Place of the measured force among the columns."""
        return int(self.products.columns.shape[1]) - 1

    @cached_property
    def whole(self) -> Seen:
        """All columns, for what asks for many of them."""
        return self._seen(np.arange(self.products.columns.shape[1]))

    def _seen(self, columns: Indices) -> Seen:
        """Return some columns (C,) under the inverse covariance."""
        plain = self.products.of(columns)
        taken = np.asarray(
            np.linalg.solve(self.inner, self.spread[:, None] * plain.across), dtype=float
        )
        turned = taken.transpose(0, 2, 1)
        smooth = plain.across[:, : self.functions] - self.taken.transpose(0, 2, 1) @ taken
        return Seen(taken, smooth, plain.among - turned @ taken)

    def gram(self, groups: Sequence[Group]) -> Array:
        """Return products of groups of columns, one after the other."""
        seen = self.whole
        ends = np.cumsum([0, *(c.size for c, _ in groups)])
        result = np.empty((ends[-1], ends[-1]))
        shared = []
        ones = np.ones(self.smooth.shape[0])
        for a, (columns, share) in enumerate(groups):
            weight = ones if share is None else share
            here = slice(ends[a], ends[a + 1])
            for b, (others, other) in enumerate(groups[: a + 1]):
                both = weight * (ones if other is None else other)
                block = np.tensordot(both, seen.left[:, columns[:, None], others], (0, 0))
                there = slice(ends[b], ends[b + 1])
                result[here, there], result[there, here] = block, block.T
            weighted = (self.smooth * weight[:, None]).T
            each = np.tensordot(weighted, seen.smooth[:, :, columns], (1, 0))
            shared.append(each.reshape(self.outer.shape[0], -1))
        whole = solve_triangular(
            self.outer, np.concatenate(shared, axis=1), lower=True, check_finite=False
        )
        return result - whole.T @ whole

    def by_unit(self, columns: Indices) -> tuple[Array, Array]:
        """Return products of columns within units (U, K, K), and the shared part's (U, S, K).

        The products of sums over units are the sums of the first less products of sums of the
        second.
        """
        within = self.whole.left[:, columns[:, None], columns]
        each = np.einsum("uq,umk->qmuk", self.smooth, self.whole.smooth[:, :, columns])
        shape = self.outer.shape[0], self.smooth.shape[0], columns.size
        shared = solve_triangular(
            self.outer, each.reshape(shape[0], -1), lower=True, check_finite=False
        )
        return within, shared.reshape(shape).transpose(1, 0, 2)

    def within(self, more: Array) -> Array:
        """Return products (U, T, T) of further columns (U, T, R) within units."""
        p = self.products
        new = more / p.scale[:, None]
        plain = p.nuisance @ new.transpose(0, 2, 1)
        taken = np.linalg.solve(self.inner, self.spread[:, None] * plain)
        return np.asarray(new @ new.transpose(0, 2, 1) - taken.transpose(0, 2, 1) @ taken)

    def kept(self, columns: Indices, spread: Array) -> Kept:
        """Return columns (K,) beside which others are compared, made once at these sizes."""
        key = columns.tobytes() + spread.tobytes()
        if key not in self._kept:
            seen = self._seen(columns)
            shared = self._across(seen.smooth)
            gram = seen.left.sum(axis=0) - shared.T @ shared
            taken = seen.taken.reshape(self.inner[..., 0].size, columns.size)
            self._kept[key] = Kept(columns, spread, taken, shared, gram)
        return self._kept[key]

    def beside(self, kept: Kept, further: Further) -> tuple[Array, Array]:
        """Return products of further columns: with those that are kept (K, T), and (T, T)."""
        p, f, nuisance = self.products, self.functions, self.spread.size
        plain, among = further.plain(p, kept.columns)
        taken = np.linalg.solve(self.inner, self.spread[:, None] * plain[:, :nuisance])
        flat = taken.reshape(-1, taken.shape[2])
        shared = self._across(plain[:, :f] - self.taken.transpose(0, 2, 1) @ taken)
        among = among - flat.T @ flat - shared.T @ shared
        if not kept.columns.size:
            return np.zeros((0, among.shape[0])), among
        across = plain[:, nuisance:].sum(axis=0) - kept.taken.T @ flat - kept.shared.T @ shared
        return across, among

    def _across(self, left: Array) -> Array:
        """Return what the remainder that units share takes of products with it (U, F, T)."""
        units, functions, count = left.shape
        each = self.smooth.T @ left.reshape(units, functions * count)
        each = each.reshape(self.smooth.shape[1] * functions, count)
        return np.asarray(solve_triangular(self.outer, each, lower=True, check_finite=False))


def _bytes(held: object) -> int:
    """Return the bytes of arrays that something holds, without those of its products."""
    if isinstance(held, np.ndarray):
        return int(held.nbytes)
    if isinstance(held, dict):
        return sum(_bytes(v) for v in held.values())
    if isinstance(held, Plain | Given | Seen | Kept):
        return sum(_bytes(v) for n, v in vars(held).items() if n != "products")
    return 0


def given(products: Products, sizes: Sizes) -> Given:
    """Return what products under the inverse covariance of these sizes are made of.

    Parameters
    ----------
    products : Products
        At the same `loud`.
    sizes : Sizes
        Of the covariance.
    """
    gram, kernel = products.gram, products.sheet.kernel
    functions, own = products.sheet.remainder.shape[1], products.own.shape[1]
    spread = np.concatenate(
        [
            np.full(functions, np.sqrt(_INDEPENDENT) * sizes.remainder),
            np.full(own, sizes.friction),
        ]
    )
    inner = root_of(gram, spread)
    among = gram[:, :, :functions]
    taken = np.asarray(np.linalg.solve(inner, spread[:, None] * among), dtype=float)
    left = among[:, :functions] - taken.transpose(0, 2, 1) @ taken
    log_det = 2.0 * float(np.sum(np.log(np.diagonal(inner, axis1=1, axis2=2))))
    smooth = kernel * (np.sqrt(1.0 - _INDEPENDENT) * sizes.remainder)
    units, count = smooth.shape[0], smooth.shape[1] * functions
    pairs = (smooth[:, :, None] * smooth[:, None]).reshape(units, -1)
    square = (pairs.T @ left.reshape(units, -1)).reshape(
        smooth.shape[1], smooth.shape[1], functions, functions
    )
    square = square.transpose(0, 2, 1, 3).reshape(count, count)
    square[np.diag_indices(count)] += 1.0
    outer = np.linalg.cholesky(square)
    log_det += 2.0 * float(np.sum(np.log(np.diag(outer))))
    centre = products.log_centre - 0.5 * log_det
    return Given(products, taken, inner, spread, smooth, outer, centre)
