"""The named structures: which terms make each, beside friction and what else a device may have."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from itertools import combinations


@dataclass(frozen=True)
class Core:
    """A structure by its terms."""

    name: str
    """As documents state it."""
    family: str
    """"fractional" or "integer"."""
    required: tuple[str, ...]
    """Ids of terms that it always has."""
    optional: tuple[str, ...] = ()
    """Ids of terms that it may have besides."""
    within: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Range of a term's shape parameter, by the term's id, where it is not the term's own."""
    alone: tuple[str, ...] = ()
    """Ids of terms each of which makes it by itself, too."""
    plain: tuple[str, ...] = ()
    """Likewise, of terms that every structure may have besides."""
    beside: tuple[str, ...] = ()
    """Ids of other structures' terms with which a device is this one still: what it has besides."""

    @property
    def variants(self) -> tuple[tuple[str, ...], ...]:
        """Every set of ids that is this structure."""
        sets = [
            (*self.required, *more)
            for size in range(len(self.optional) + 1)
            for more in combinations(self.optional, size)
        ]
        return (*sets, *((i,) for i in (*self.alone, *self.plain)))


FRICTION = "coulomb-friction"
"""Dry friction: every structure may have it."""

OTHER = "other"
"""Name of what none of the structures is."""

CORES = (
    Core("FOIM", "fractional", ("fractional-derivative",), beside=("inertia",)),
    Core("IOIM-linear", "integer", ("inertia",), ("viscous-damping",)),
    Core("IOIM-laminar", "integer", ("inertia", "quadratic-damping"), ("viscous-damping",)),
    Core(
        "IOIM-turbulent", "integer", ("inertia", "power-law-damping"),
        ("viscous-damping", "quadratic-damping"), {"power-law-damping": (1.5, 2.0)},
    ),
    Core(
        OTHER, "integer", (), ("viscous-damping", "quadratic-damping"),
        alone=("power-law-damping",), plain=("stiffness",),
    ),
)  # fmt: skip
"""Chen & Chen, *Materials* 2025, 18(11), 2556, Eqs. 5 to 7; the last is a device without inertance,
whose loss may go with any power of speed, as in viscous dampers of buildings, or a spring: what a
fractional derivative of order 0 would be otherwise.
"""

TELLING = frozenset(i for c in CORES for i in (*c.required, *c.optional, *c.alone))
"""Ids of terms that tell structures apart."""


def family_of(ids: Collection[str]) -> str:
    """Return "fractional", "integer" or "mixed" (a fractional term beside inertia or damping).

    Parameters
    ----------
    ids : collection of str
        Of a model's terms.

    Returns
    -------
    str

    Examples
    --------
    >>> family_of(["fractional-derivative", "coulomb-friction"])
    'fractional'
    """
    fractional = {i for c in CORES if c.family == "fractional" for i in c.required}
    if not fractional & set(ids):
        return "integer"
    return "mixed" if (TELLING - fractional) & set(ids) else "fractional"


def core_of(ids: Collection[str]) -> str:
    """Return the name of the structure that is made of these terms and what all may have.

    Parameters
    ----------
    ids : collection of str
        Of a model's terms.

    Returns
    -------
    str
        "FOIM", "IOIM-linear", "IOIM-laminar", "IOIM-turbulent" or "other".

    Examples
    --------
    >>> core_of(["inertia", "viscous-damping", "coulomb-friction", "stiffness"])
    'IOIM-linear'
    >>> core_of(["fractional-derivative", "inertia"])
    'FOIM'
    """
    own = TELLING & set(ids)
    for core in CORES:
        known = {*core.required, *core.optional, *core.beside}
        if set(core.required) <= own <= known and core.required:
            return core.name
    return OTHER
