"""Which structure holds, in one band or several: every variant of every core, weighed at once.

Given the sizes of what no term explains, all that evidence needs of the terms' columns are their
products within each unit and what the shared part takes of them. Sums of these over a band's units
serve every division into bands, sharp or gradual.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from discover.posterior.covariance import Given
from discover.posterior.evidence import root_of, solved
from discover.posterior.space import Part
from models.checks import Array, Indices

_TURNS = 3  # of choosing each band's variant beside the others'


@dataclass(frozen=True)
class Variant:
    """One set of terms that is a structure, each in one shape."""

    core: str
    """Name of the structure."""
    parts: tuple[Part, ...]
    """Of its terms."""
    log_prior: float
    """Nats, of the core and of the variant among the core's."""


@dataclass(frozen=True)
class Choice:
    """Variants as places, spreads and signs of at most so many columns."""

    columns: Indices
    """(V, C) places of columns; those beyond a variant's own are the spare, empty one."""
    spread: Array
    """(V, C) standard deviations beforehand; 0 for the spare one."""
    sign: Array
    """(V, C)."""
    log_prior: Array
    """(V,) nats."""

    def of(self, variants: Indices) -> Choice:
        """Return some variants only."""
        return Choice(
            self.columns[variants], self.spread[variants], self.sign[variants],
            self.log_prior[variants],
        )  # fmt: skip


def choice_of(variants: Sequence[Variant], spare: int) -> Choice:
    """Return variants side by side; `spare` is the place of an empty column."""
    size = max(1, *(sum(p.columns.size for p in v.parts) for v in variants))
    columns = np.full((len(variants), size), spare)
    spread, sign = np.zeros(columns.shape), np.zeros(columns.shape)
    for i, v in enumerate(variants):
        if not v.parts:
            continue
        own = np.concatenate([p.columns for p in v.parts])
        columns[i, : own.size] = own
        spread[i, : own.size] = np.concatenate([p.scales[0] * p.spread for p in v.parts])
        sign[i, : own.size] = np.concatenate([p.sign for p in v.parts])
    return Choice(columns, spread, sign, np.array([v.log_prior for v in variants]))


@dataclass(frozen=True)
class Sums:
    """Products of the cores' columns in bands, and of the measured force, for D divisions."""

    gram: Array
    """(D, B, B, K + 1, K + 1) of bands' columns, the last one empty."""
    side: Array
    """(D, B, K + 1) with the measured force."""
    log_normal: float
    """Log density of the measured force without a core, nats."""


def sums_of_one(
    here: Given, core: Indices, common: Sequence[Part], scales: Array, shares: Array,
    power: float = 1.0,
) -> list[Sums]:
    """Return the sums of one division into bands, at several scales of what bands share.

    Parameters
    ----------
    here : Given
        At sizes of what no term explains.
    core : ndarray of int, shape (K,)
        Places of the cores' columns.
    common : sequence of Part
        What all bands share.
    scales : ndarray, shape (S, P)
        Of each part.
    shares : ndarray, shape (B, U)
        How much of each unit is in each band.
    power : float
        To which the likelihood is taken: below 1, the lines say less than as many of their own.
    """
    at = _columns(common)
    gram = power * here.gram(
        [(at, None), *((core, share) for share in shares), (np.array([here.force]), None)]
    )
    found = []
    for some in scales:
        spread = _spreads(common, some)
        factor = root_of(gram[: at.size, : at.size], spread)
        half = np.linalg.solve(factor, spread[:, None] * gram[: at.size, at.size :])
        left = gram[at.size :, at.size :] - half.T @ half
        normal = power * here.log_centre
        normal -= float(np.sum(np.log(np.diag(factor)))) + 0.5 * left[-1, -1]
        bands, size = shares.shape[0], core.size
        whole = left[:-1, :-1].reshape(bands, size, bands, size).transpose(0, 2, 1, 3)
        side = left[:-1, -1].reshape(bands, size)
        found.append(Sums(_spare(whole[None]), _spare_last(side[None]), float(normal)))
    return found


def sums_of_many(
    here: Given, core: Indices, common: Sequence[Part], scales: Array, shares: Array
) -> Sums:
    """Return the sums of many divisions (D, B, U), at one scale (P,) of each part shared."""
    at = _columns(common)
    kept = np.r_[at, core, here.force]
    within, shared = here.by_unit(kept)
    count = at.size
    spread = _spreads(common, scales)
    taken = shared.sum(axis=0)
    whole = within[:, :count].sum(axis=0) - taken[:, :count].T @ taken
    factor = root_of(whole[:, :count], spread)
    across = within[:, :count] - np.einsum("sc,usk->uck", taken[:, :count], shared)
    more = np.linalg.solve(factor, spread[:, None] * across[..., count:])
    shared = np.concatenate([shared[..., count:], more], axis=1)
    within = within[:, count:, count:]
    all_taken = shared[..., -1].sum(axis=0)
    force = float(within[:, -1, -1].sum() - all_taken @ all_taken)
    normal = here.log_centre - float(np.sum(np.log(np.diag(factor)))) - 0.5 * force
    divisions, bands, units = shares.shape
    sums = np.tensordot(shares, shared[..., :-1], axes=(2, 0))  # (D, B, S, K)
    pairs = (shares[:, :, None] * shares[:, None]).reshape(-1, units)
    size = core.size
    gram = (pairs @ within[:, :-1, :-1].reshape(units, -1)).reshape(
        divisions, bands, bands, size, size
    )
    gram = gram - np.matmul(sums.transpose(0, 1, 3, 2)[:, :, None], sums[:, None])
    side = np.tensordot(shares, within[:, :-1, -1], axes=(2, 0))
    side = side - np.einsum("dbsk,s->dbk", sums, all_taken)
    return Sums(_spare(gram), _spare_last(side), normal)


def _columns(parts: Sequence[Part]) -> Indices:
    return np.concatenate([p.columns for p in parts]) if parts else np.zeros(0, dtype=int)


def _spreads(parts: Sequence[Part], scales: Array) -> Array:
    if not parts:
        return np.zeros(0)
    return np.concatenate([s * p.spread for s, p in zip(scales, parts, strict=True)])


def _spare(gram: Array) -> Array:
    """Return products with an empty column after the others."""
    return np.pad(gram, [(0, 0)] * (gram.ndim - 2) + [(0, 1), (0, 1)])


def _spare_last(side: Array) -> Array:
    return np.pad(side, [(0, 0)] * (side.ndim - 1) + [(0, 1)])


@dataclass(frozen=True)
class Divided:
    """Divisions with the best variant of every band."""

    value: Array
    """(D,) log evidence, nats: of the best variants, and of each band's others beside these."""
    best: Indices
    """(D, B) places of the variants."""
    by_variant: Array
    """(D, B, V) log evidence of each variant of a band, beside the best of the others."""


def divided(sums: Sums, choice: Choice, start: Indices) -> Divided:
    """Return divisions of the units into bands, with the best variant in each.

    Parameters
    ----------
    sums : Sums
        Of D divisions.
    choice : Choice
        Variants that a band may have, by places among the sums' columns.
    start : ndarray of int, shape (D, B)
        Variants to begin with.
    """
    best = start.copy()
    count, bands = best.shape
    variants = choice.columns.shape[0]
    by_variant = np.full((count, bands, variants), -np.inf)
    for _ in range(_TURNS if bands > 1 else 1):
        before = best.copy()
        for band in range(bands):
            by_variant[:, band] = _of_band(sums, choice, best, band)
            best[:, band] = by_variant[:, band].argmax(axis=1)
        if np.array_equal(before, best):
            break
    rows = np.arange(count)
    value = by_variant[rows, -1, best[:, -1]]
    for b in range(bands):
        value = value + logsumexp(by_variant[:, b], axis=1) - by_variant[rows, b, best[:, b]]
    return Divided(np.asarray(value), best, by_variant)


def as_started(sums: Sums, choice: Choice, start: Indices) -> Divided:
    """Return one division with the variants (B,) that it starts with, and no others."""
    own = choice.of(start)
    kept = np.arange(start.size)
    found = _of_band(sums, own, kept[None], 0)[0, :1]
    by_variant = np.full((1, start.size, choice.columns.shape[0]), -np.inf)
    by_variant[0, kept, start] = found
    return Divided(found, start[None].copy(), by_variant)


def _of_band(sums: Sums, choice: Choice, best: Indices, band: int) -> Array:
    """Return the log evidence (D, V) of a band's variants beside the best ones of the others."""
    count, bands = best.shape
    variants, width = choice.columns.shape
    shape = (count, variants, bands, width)
    columns = np.broadcast_to(choice.columns[best][:, None], shape).copy()
    spread = np.broadcast_to(choice.spread[best][:, None], shape).copy()
    sign = np.broadcast_to(choice.sign[best][:, None], shape).copy()
    columns[:, :, band], spread[:, :, band] = choice.columns, choice.spread
    sign[:, :, band] = choice.sign
    prior = choice.log_prior[best].sum(axis=1) - choice.log_prior[best[:, band]]
    d = np.arange(count).reshape(-1, 1, 1, 1, 1, 1)
    b = np.arange(bands)
    gram = sums.gram[
        d, b[:, None, None, None], b[:, None],
        columns[:, :, :, :, None, None], columns[:, :, None, None],
    ]  # fmt: skip
    side = sums.side[d[..., 0, 0], b[:, None], columns]
    flat = bands * width
    found = solved(
        gram.reshape(count, variants, flat, flat), side.reshape(count, variants, flat),
        spread.reshape(count, variants, flat), sign.reshape(count, variants, flat),
        sums.log_normal,
    )  # fmt: skip
    return np.asarray(found.log_evidence + prior[:, None] + choice.log_prior)
