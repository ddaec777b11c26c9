"""Whitened rows of what is tried beside a model, and what of them the model does not span."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.naming.candidates import Variant
from discover.naming.forces import Trial
from discover.naming.rows import RecordRows
from discover.naming.unit_rows import whole_model
from models.checks import Array
from models.constitutive import ForceModel
from models.terms import TERMS


def candidate_columns(
    rows: Sequence[RecordRows], model: ForceModel, chosen: Sequence[Variant]
) -> Array:
    """Return the whitened rows of every part of every variant, (C, R).

    Where one overflows its row is zero: no candidate.
    """
    parts = [p for v in chosen for p in v.parts]
    terms = [TERMS[p.id] for p in parts]
    shapes = [t.shape(p.shape) for t, p in zip(terms, parts, strict=True)]
    blocks = []
    for r in rows:
        trial = Trial(r.observation, whole_model(r, model))
        forces = [
            trial.added(t, s, p.probe) for t, s, p in zip(terms, shapes, parts, strict=True)
        ]
        block = np.empty((len(parts), r.target.size))
        over = np.array(
            [trial.on_cycle(t, s) for t, s in zip(terms, shapes, strict=True)], dtype=np.bool_
        )
        on_cycle, at_samples = np.flatnonzero(over), np.flatnonzero(~over)
        with np.errstate(over="ignore", invalid="ignore"):
            if r.cycle_rows is not None and on_cycle.size:
                block[over] = np.stack([forces[i] for i in on_cycle]) @ r.cycle_rows
            if at_samples.size:
                block[~over] = r.project(np.stack([forces[i] for i in at_samples]))
        blocks.append(block)
    rows_of_parts = np.concatenate(blocks, axis=1)
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
