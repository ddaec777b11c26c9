"""All records' rows in one array: what the posterior is computed on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from discover.rows import RecordRows
from models.checks import Array, Indices

_MOST_ROWS = 400  # of a unit of windows: those of more are compressed
_SEEN = 0.1  # of the noise, below which a direction of all columns together shows nothing
_ALIKE = 0.3  # of the logarithm of frequency and of amplitude, within which windows are one unit
_NOTHING = 1e-60  # of the force: a column that is not there; its square is still a number
_KERNEL = 1e-3  # of the greatest, below which a direction of the remainder is left out


@dataclass(frozen=True)
class Unit:
    """A record, or windows of one that are alike: what a band holds or doesn't."""

    record: int
    """Place of its record."""
    part: Indices
    """(P,) its rows among the record's."""
    frequency: float
    """Hz."""
    amplitude: float
    """m."""
    speed: float
    """m/s, velocity amplitude."""
    basis: Array | None = None
    """(P, R) directions that are kept of its rows; None where all are."""


@dataclass(frozen=True)
class Sheet:
    """The rows of all units, padded with zeros to the same number R."""

    rows: tuple[RecordRows, ...]
    """Of the records."""
    units: tuple[Unit, ...]
    """U of them, in the records' order."""
    target: Array
    """(U, R) measured force, white but for what models miss."""
    remainder: Array
    """(U, F, R) generic functions of the motion."""
    loudness: Array
    """(U, L, R) what each kind of independent error of the record's own size is in each row; the
    last one is the same in all rows, and by it all records count alike."""
    rest: Array
    """(U, 2 + L): number of rows that were left out, their sum of squares, mean loudness squared.
    """

    def stack(self, columns: Sequence[Array]) -> Array:
        """Return columns (K, R_r) of every record as one array (U, K, R)."""
        found = []
        for unit in self.units:
            own = columns[unit.record][:, unit.part]
            found.append(own if unit.basis is None else own @ unit.basis)
        return padded(found, self.target.shape[1])

    @cached_property
    def size(self) -> Array:
        """(U,) length of each unit's measured force."""
        return np.asarray(np.linalg.norm(self.target, axis=1))

    @cached_property
    def kernel(self) -> Array:
        """(U, Q) square root of how alike the remainder is in two units.

        Squared exponential in the logarithms of frequency and amplitude, of length one each.
        """
        place = np.log([[u.frequency, u.amplitude] for u in self.units])
        apart = np.sum((place[:, None] - place[None]) ** 2, axis=2)
        values, vectors = np.linalg.eigh(np.exp(-0.5 * apart))
        kept = values > _KERNEL * values[-1]
        return np.asarray(vectors[:, kept] * np.sqrt(values[kept]))

    def scale(self, column: Array) -> Array:
        """Return the coefficients (K,) at which columns (U, K, R) make the whole force."""
        share = np.linalg.norm(column, axis=2) / np.maximum(self.size, 1e-300)[:, None]
        return np.asarray(1.0 / np.maximum(np.sqrt(np.mean(share**2, axis=0)), _NOTHING))


def sheet_of(rows: Sequence[RecordRows], columns: Sequence[Array]) -> Sheet:
    """Return the sheet of records.

    Parameters
    ----------
    rows : sequence of RecordRows
        One record or more.
    columns : sequence of ndarray, shape (K, R_r)
        What models are made of, in every record: of windows only directions in which these, the
        remainder or the measured force show are kept.
    """
    kinds = max(r.loudness.shape[0] for r in rows)
    least = min(r.size.size for r in rows)
    rows = [replace(r, loudness=_all_kinds(r, kinds, least)) for r in rows]
    units: list[Unit] = []
    parts: list[tuple[Array, Array, Array]] = []
    rest = []
    for place, (r, own) in enumerate(zip(rows, columns, strict=True)):
        for unit in _units(r, place):
            target, loudness = r.target[unit.part], r.loudness[:, unit.part]
            remainder = r.remainder[:, unit.part]
            left = np.zeros(2 + loudness.shape[0])
            if unit.part.size > _MOST_ROWS:
                basis = _basis(own[:, unit.part], remainder, target, r.size[unit.part])
                unit = Unit(
                    unit.record, unit.part, unit.frequency, unit.amplitude, unit.speed, basis
                )
                energy = float(target @ target)
                mean = np.mean(loudness**2, axis=1)
                target, remainder = target @ basis, remainder @ basis
                loudness = np.sqrt(loudness**2 @ basis**2)
                lost = max(energy - float(target @ target), 0.0)
                left = np.array([unit.part.size - basis.shape[1], lost, *mean])
            units.append(unit)
            parts.append((target[None], remainder, loudness))
            rest.append(left)
    size = max(p[0].shape[1] for p in parts)
    functions = max(p[1].shape[0] for p in parts)
    remainder = np.zeros((len(parts), functions, size))
    for i, p in enumerate(parts):
        remainder[i, : p[1].shape[0], : p[1].shape[1]] = p[1]
    return Sheet(
        tuple(rows), tuple(units), padded([p[0] for p in parts], size)[:, 0], remainder,
        padded([p[2] for p in parts], size), np.array(rest),
    )  # fmt: skip


def _all_kinds(rows: RecordRows, kinds: int, least: int) -> Array:
    """Return loudness (L + 1, R) with as many kinds as other records have, and one that is flat.

    By the flat one a record counts as much as one of the `least` rows, however many it has.
    """
    own = rows.loudness
    none = np.zeros((kinds - own.shape[0], own.shape[1]))
    windows = np.sum((rows.target / rows.size) ** 2)  # the size is of one
    flat = rows.size * np.sqrt(windows / least)
    return np.concatenate([own, none, flat[None]])


def padded(blocks: Sequence[Array], size: int) -> Array:
    """Return blocks (K, R_i) as one array (n, K, size), with zeros at the end of rows."""
    result = np.zeros((len(blocks), blocks[0].shape[0], size))
    for i, block in enumerate(blocks):
        result[i, :, : block.shape[1]] = block
    return result


def _units(rows: RecordRows, place: int) -> list[Unit]:
    """Return a record's units: itself, or neighbouring windows that are alike."""
    groups: list[list[int]] = []
    windows = rows.observation.windows
    for i, w in enumerate(windows):
        if groups:
            first = windows[groups[-1][0]]
            apart = max(
                abs(np.log(max(w.frequency, 1e-12) / max(first.frequency, 1e-12))),
                abs(np.log(max(w.amplitude, 1e-12) / max(first.amplitude, 1e-12))),
            )
            if apart < _ALIKE:
                groups[-1].append(i)
                continue
        groups.append([i])
    found = []
    for group in groups:
        part = np.concatenate(
            [np.arange(rows.windows[i].start, rows.windows[i].stop) for i in group]
        )
        share = np.array([windows[i].share for i in group])
        share = share / share.sum()
        frequency, amplitude, speed = (
            float(np.exp(share @ np.log([max(getattr(windows[i], name), 1e-12) for i in group])))
            for name in ("frequency", "amplitude", "speed")
        )
        found.append(Unit(place, part, frequency, amplitude, speed))
    return found


def _basis(columns: Array, remainder: Array, target: Array, level: Array) -> Array:
    """Return orthonormal directions (P, R) in which the target or columns show.

    In them an error that is the same in all rows, `level` (P,) of white ones, is independent.
    """
    size = float(np.linalg.norm(target))
    whole = np.concatenate([columns, remainder])
    norm = np.linalg.norm(whole, axis=1)
    whole = whole[norm > 0.0] * (size / norm[norm > 0.0])[:, None]
    _, values, directions = np.linalg.svd(whole, full_matrices=False)
    shown = int(np.count_nonzero(values > _SEEN))
    kept = directions[: min(shown, _MOST_ROWS - 1)]
    left = target - kept.T @ (kept @ target)
    length = float(np.linalg.norm(left))
    if length > 1e-9 * max(size, 1e-300):
        kept = np.concatenate([kept, left[None] / length])
    _, turn = np.linalg.eigh((kept * level**2) @ kept.T)
    return np.asarray(kept.T @ turn)
