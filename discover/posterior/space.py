"""What models may be made of, as columns in every record."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from discover.posterior.climb import Place
from discover.posterior.covariance import Given, Products, Sizes
from discover.posterior.sheet import Sheet
from discover.rows import RecordRows
from discover.rows.columns import moved
from models.checks import Array, Indices
from models.constitutive import FittedTerm
from models.terms import Scales, Shape, Term

_CURVE_SCALES = (1.0, 0.3, 0.1, 0.03, 0.01)
"""Sizes of a term with a curve of its own, over that at which it makes the whole force."""
_MOST_HELD = 2**29
"""Bytes of products at sizes that are held: the oldest are made again where they are asked for."""
_LEAST_BEGUN = 1e-9
"""Of a coefficient, in its unit, that is zero where a fit starts."""


ColumnsOf = Callable[[RecordRows, Sequence[FittedTerm]], Array]


@dataclass(frozen=True)
class Part:
    """A term, in one shape, as a model may hold it."""

    terms: tuple[FittedTerm, ...]
    """Whose coefficients its first columns have: one, or several of the same id."""
    columns: Indices
    """(K,) places of its columns."""
    spread: Array
    """(K,) standard deviations of their coefficients beforehand, over its scale."""
    sign: Array
    """(K,) 1 where a coefficient can't be negative, -1 where not positive, else 0."""
    scales: tuple[float, ...]
    """Sizes over which it is averaged."""
    slopes: tuple[str, ...] = ()
    """Shape parameters whose slopes are the columns after those of the terms."""
    within: tuple[tuple[float, float], ...] = ()
    """Bounds of each: beyond them another part stands for the term."""
    log_prior: float = 0.0
    """Nats, of its shape among those of the same term."""

    @property
    def id(self) -> str:
        """Id of its terms."""
        return self.terms[0].id


@dataclass
class Space:
    """Columns of what models are made of, and products of them at sizes that were asked for."""

    sheet: Sheet
    """The records' rows."""
    scales: Scales
    """What they cover."""
    columns: Array
    """(U, K, R)."""
    own: Array
    """(U, N, R) columns of friction that units may have of their own, per N."""
    own_unit: float
    """N at which one of these makes the whole force."""
    columns_of: ColumnsOf
    """Gives the rows (K, R_r) of terms in a record."""
    _products: dict[tuple[float, ...], Products] = field(default_factory=dict)
    _whole: Array | None = None

    @property
    def start(self) -> Place:
        """Sizes from which a search starts."""
        return Place.start(self.sheet.loudness.shape[1] - 1)

    @property
    def quiet(self) -> Place:
        """Sizes of a model that explains all but noise."""
        return Place.quiet(self.sheet.loudness.shape[1] - 1)

    def add(self, blocks: Sequence[Array]) -> Indices:
        """Add columns (K, R_r) of every record; return their places."""
        new = self.sheet.stack(blocks)
        before = self.columns.shape[1]
        self.columns = np.concatenate([self.columns, new], axis=1)
        self.forget()
        return np.arange(before, self.columns.shape[1])

    def given(self, sizes: Sizes) -> Given:
        """Return what products of the columns under the inverse covariance are made of."""
        products = self._products.pop(sizes.loud, None)  # what was asked for last stands last
        if products is None:
            if self._whole is None:
                target = self.sheet.target[:, None]
                self._whole = np.concatenate([self.columns, target], axis=1)
            products = Products(self.sheet, self.own, self._whole, sizes.loud)
        self._products[sizes.loud] = products
        if not products.has(sizes):
            self._make_room()
        return products.at(sizes)

    def _make_room(self) -> None:
        """Let go of products that were asked for longest ago, where all take too many bytes."""
        held = {loud: products.kept_bytes for loud, products in self._products.items()}
        total = sum(held.values())
        *others, latest = held
        for loud in others:
            if total <= _MOST_HELD:
                return
            total -= held[loud]
            self._products.pop(loud).forget()
        if total > _MOST_HELD:
            self._products[latest].forget()

    def forget(self) -> None:
        """Let go of products, which are many: they are made again where they are asked for."""
        for products in self._products.values():
            products.forget()
        self._products.clear()
        self._whole = None

    def scale(self, places: Indices) -> Array:
        """Return the coefficients at which columns make the whole force."""
        return self.sheet.scale(self.columns[:, places])


def unit(term: Term, shape: Shape) -> FittedTerm:
    """Return a term of coefficient one."""
    return FittedTerm(term.id, 1.0, dict(shape))


def begun(term: FittedTerm, size: float) -> FittedTerm:
    """Return a term at a size within its bounds, from which a fit may start.

    Where its sign would hold it at zero a fit can still raise it.
    """
    low, high = term.term.coefficient_bounds(term.shape)
    least = term.coefficient if term.term.acts != "force" else _LEAST_BEGUN
    return FittedTerm(term.id, float(np.clip(size, low, high)) or least, term.shape)


def curve_part(
    space: Space, blocks: Sequence[Array], term: Term, curves: Sequence[FittedTerm]
) -> Part:
    """Return a term with its curves: the plainest, and how the others differ from it."""
    places = space.add(differing(blocks))
    size = float(space.scale(places[:1])[0])
    spread = np.full(places.size, term.departure)
    spread[0] = 1.0
    sign = np.zeros(places.size)
    sign[0] = float(term.nonnegative)
    return Part(
        tuple(curves), places, spread, sign,
        tuple(size * s for s in _CURVE_SCALES),
    )


def differing(blocks: Sequence[Array]) -> list[Array]:
    """Return columns (K, R_r) of every record: the first, and how the others differ from it."""
    return [np.concatenate([b[:1], b[1:] - b[:1]]) for b in blocks]


def _is_open(curve: FittedTerm, identifier: str, held: Sequence[FittedTerm]) -> bool:
    """Tell whether a curve of a term has no name among effects, or that of one which is held.

    It has the name of another term's curve, or of what remembers the path.
    """
    remembers = curve.term.remembers(curve.shape) == "path"
    if curve.id == identifier and not remembers:
        return True
    return any(
        t.term.remembers(t.shape) == "path" if remembers else t.id == curve.id for t in held
    )


def departures(part: Part, held: Sequence[FittedTerm] | None) -> Part:
    """Return how a term's curves differ from the plainest, without that.

    Parameters
    ----------
    part : Part
        From `curve_part`.
    held : sequence of FittedTerm, optional
        What a model holds besides: of curves that have a name among effects only those of these
        count. All curves without it.
    """
    kept = [
        k for k, t in enumerate(part.terms)
        if k > 0 and (held is None or _is_open(t, part.id, held))
    ]
    return Part(
        tuple(part.terms[k] for k in kept), part.columns[kept], part.spread[kept],
        part.sign[kept], part.scales,
    )


def parts_of(
    space: Space,
    wanted: Sequence[tuple[FittedTerm, ...]],
    slopes: Sequence[tuple[tuple[str, float], ...]] | None = None,
) -> list[Part]:
    """Return parts of terms, as many as `wanted` has entries.

    Parameters
    ----------
    space : Space
        That takes their columns in.
    wanted : sequence of tuple of FittedTerm
        The terms of each part.
    slopes : sequence of tuple of (str, float), optional
        For each part (of one term then) shape parameters and how far each may be from its value,
        one standard deviation.
    """
    free = [()] * len(wanted) if slopes is None else list(slopes)
    flat = [t for part in wanted for t in part]
    main = len(flat)
    steps = []
    for part, names in zip(wanted, free, strict=True):
        for name, _ in names:
            shape, step = moved(part[0].term, dict(part[0].shape), name, space.scales)
            flat.append(FittedTerm(part[0].id, part[0].coefficient, shape))
            steps.append(step)
    blocks = []
    whose = [k for k, part in enumerate(_starts(wanted)) for _ in free[k]]
    firsts = _starts(wanted)
    for r in space.sheet.rows:
        whole = space.columns_of(r, flat)
        for i, (k, step) in enumerate(zip(whose, steps, strict=True)):
            whole[main + i] = (whole[main + i] - whole[firsts[k]]) / step
        blocks.append(whole)
    places = space.add(blocks)
    result, here, more = [], 0, main
    for part, names in zip(wanted, free, strict=True):
        own = np.r_[places[here : here + len(part)], places[more : more + len(names)]]
        here, more = here + len(part), more + len(names)
        size = space.scale(own[: len(part)])
        reference = float(size[0])
        spread = np.r_[size / reference, [width for _, width in names]]
        sign = np.r_[[_sign(t) for t in part], np.zeros(len(names))]
        result.append(
            Part(part, own, spread, sign, (reference,), tuple(name for name, _ in names))
        )
    return result


def _starts(wanted: Sequence[tuple[FittedTerm, ...]]) -> list[int]:
    """Return the place of each part's first term among all terms."""
    return [int(v) for v in np.cumsum([0, *(len(p) for p in wanted)])[:-1]]


def _sign(fitted: FittedTerm) -> float:
    low, high = fitted.term.coefficient_bounds(fitted.shape)
    return float(low >= 0.0) - float(high <= 0.0)


def shape_grid(bounds: tuple[float, float], step: float) -> Iterator[float]:
    """Yield values of a shape parameter in the middle of equal steps between bounds."""
    low, high = bounds
    count = max(int(np.ceil((high - low) / step - 1e-9)), 1)
    yield from (low + (np.arange(count) + 0.5) * (high - low) / count)
