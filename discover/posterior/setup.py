"""From records to the space of models: friction's curve, and what units may have of their own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from discover.posterior.sheet import Sheet, sheet_of
from discover.posterior.space import Part, Space, curve_part, differing
from discover.rows import RecordRows
from discover.rows.columns import force_columns, scales_of
from models.checks import Array
from models.constitutive import FittedTerm
from models.terms import Term, curves_of

_OWN = (0.1, 0.5, 0.9)
"""Shares of a term's curves, in their order, at which one may be a unit's own."""

ColumnsOf = Callable[[RecordRows, Sequence[FittedTerm]], Array]
"""Gives the rows (K, R) of terms in a record."""


def space_of(
    rows: Sequence[RecordRows],
    term: Term,
    *,
    columns_of: ColumnsOf = force_columns,
    targets: Sequence[Array] | None = None,
) -> tuple[Space, Part]:
    """Return the space of models of records, and friction with its curves.

    Parameters
    ----------
    rows : sequence of RecordRows
        Of the records that are fitted.
    term : Term
        Friction: what units may have of their own, besides what all share.
    columns_of : callable
        Gives terms' rows in a record.
    targets : sequence of ndarray, shape (R_r,), optional
        What models shall make, where not the measured force.
    """
    scales = scales_of(rows)
    units = [FittedTerm(name, 1.0, dict(s)) for name, s in curves_of(term, scales)]
    blocks = [columns_of(r, units) for r in rows]
    shown = rows
    if targets is not None:
        shown = [replace(r, target=t) for r, t in zip(rows, targets, strict=True)]
    sheet = sheet_of(shown, blocks)
    own = _own(sheet, blocks, units)
    empty = np.zeros((len(sheet.units), 0, sheet.target.shape[1]))
    space = Space(sheet, scales, empty, own, float(sheet.scale(own[:, :1])[0]), columns_of)
    return space, curve_part(space, blocks, term, units)


def behind(space: Space, curve: Part, columns_of: ColumnsOf) -> Space:
    """Return a space that holds a curve only, with other columns of the same terms.

    Parameters
    ----------
    space : Space
        As `space_of` returns it.
    curve : Part
        Likewise: its places stay.
    columns_of : callable
        Gives terms' rows in a record, as changes of motion and of force pass them on.
    """
    blocks = [columns_of(r, curve.terms) for r in space.sheet.rows]
    own = _own(space.sheet, blocks, curve.terms)
    empty = space.columns[:, :0]
    changed = Space(space.sheet, space.scales, empty, own, space.own_unit, columns_of)
    changed.add(differing(blocks))
    return changed


def _own(sheet: Sheet, blocks: Sequence[Array], curves: Sequence[FittedTerm]) -> Array:
    """Return the columns (U, N, R) that units may have of their own: of the term's own curves."""
    own = [k for k, t in enumerate(curves) if t.id == curves[0].id]
    chosen = sorted({own[min(int(share * len(own)), len(own) - 1)] for share in _OWN} - {0})
    return sheet.stack([differing([b])[0][[0, *chosen]] for b in blocks])
