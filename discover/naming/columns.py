"""Whitened rows of what is tried beside a model, and what of them the model does not span."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from discover.naming.candidates import Part, Variant
from discover.naming.forces import Trial, share_in
from discover.naming.rows import RecordRows
from discover.naming.unit_rows import whole_model
from models.checks import Array
from models.constitutive import ForceModel
from models.terms import TERMS

_MOST_KEPT = 256e6  # bytes
_THREADS = 2


class CandidateColumns:
    """Whitened rows of candidates on the same records: what adds a force is evaluated once.

    What changes the force depends on the model beside it, and is evaluated anew.
    """

    def __init__(self, rows: Sequence[RecordRows]) -> None:
        self._rows = tuple(rows)
        self._known: dict[Hashable, Array] = {}

    def of(self, model: ForceModel, chosen: Sequence[Variant]) -> Array:
        """Return the whitened rows of every part of every variant beside a model, (C, R).

        Where one overflows its row is zero: no candidate.
        """
        parts = [p for v in chosen for p in v.parts]
        keys = [_key(p) for p in parts]
        size = sum(r.target.size for r in self._rows)
        result = np.empty((len(parts), size))
        first: dict[Hashable, int] = {}
        for i, key in enumerate(keys):
            if key in self._known:
                result[i] = self._known[key]
            else:
                first.setdefault(i if key is None else key, i)
        new = list(first.values())
        if new:
            result[new] = _columns(self._rows, model, [parts[i] for i in new])
        for i, key in enumerate(keys):
            if key in first:
                result[i] = result[first[key]]
        for key, i in first.items():
            if keys[i] is not None and (len(self._known) + 1) * size * 8.0 < _MOST_KEPT:
                self._known[key] = result[i].copy()
        return result


def candidate_columns(
    rows: Sequence[RecordRows], model: ForceModel, chosen: Sequence[Variant]
) -> Array:
    """Return the whitened rows of every part of every variant, (C, R), that are used once."""
    return _columns(rows, model, [p for v in chosen for p in v.parts])


def _key(part: Part) -> Hashable:
    """Return what tells a part that adds a force from others; None where it changes one."""
    return (part.id, tuple(part.shape.items())) if TERMS[part.id].column is not None else None


def _columns(
    rows: Sequence[RecordRows], model: ForceModel, parts: Sequence[Part]
) -> Array:
    terms = [TERMS[p.id] for p in parts]
    shapes = [t.shape(p.shape) for t, p in zip(terms, parts, strict=True)]

    def block_of(r: RecordRows) -> Array:
        trial = Trial(r.observation, whole_model(r, model))
        there = [i for i, s in enumerate(shapes) if share_in(r.observation, s) > 0.0]
        forces = {i: trial.added(terms[i], shapes[i], parts[i].probe) for i in there}
        block = np.zeros((len(parts), r.target.size))
        over_cycle = {i: trial.on_cycle(terms[i], shapes[i]) for i in there}
        on_cycle = [i for i in there if over_cycle[i]]
        at_samples = [i for i in there if not over_cycle[i]]
        with np.errstate(over="ignore", invalid="ignore"):
            if r.cycle_rows is not None and on_cycle:
                block[on_cycle] = np.stack([forces[i] for i in on_cycle]) @ r.cycle_rows
            if at_samples:
                block[at_samples] = r.project(np.stack([forces[i] for i in at_samples]))
        return block

    # Products and joints let others run; nothing says that a user's own term may be shared.
    with ThreadPoolExecutor(1 if any(t.source for t in terms) else _THREADS) as pool:
        rows_of_parts = np.concatenate(list(pool.map(block_of, rows)), axis=1)
    with np.errstate(over="ignore", invalid="ignore"):
        rows_of_parts[~np.isfinite(np.sum(rows_of_parts**2, axis=1))] = 0.0
    return rows_of_parts


def without_span(columns: Array, tangents: Array) -> Array:
    """Return what of `columns` (C, R) the `tangents` (P, R) do not span."""
    return without_basis(columns, span_of(tangents))


def span_of(tangents: Array) -> Array:
    """Return an orthonormal basis (B, R) of what `tangents` (P, R) span."""
    scale = np.linalg.norm(tangents, axis=1)
    used = tangents[scale > 0.0] / scale[scale > 0.0, None]
    if not used.size:
        return tangents[:0]
    _, values, right = np.linalg.svd(used, full_matrices=False)
    return np.asarray(right[values > 1e-9 * values[0]])


def without_basis(columns: Array, basis: Array) -> Array:
    """Return what of `columns` (C, R) an orthonormal basis (B, R) does not span."""
    return np.asarray(columns - (columns @ basis.T) @ basis) if basis.size else columns
