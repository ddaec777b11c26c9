"""Named structures, and the supports that a search goes through."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from discover.library.dictionary import DELAY, Dictionary
from discover.regression.support import Support

FRACTIONAL = "fractional-derivative"
POWER = "power-law-damping"
TURBULENT_EXPONENT = 1.75  # Blasius friction, as in the paper's Eq. 6
TURBULENT_RANGE = (1.5, 2.0)
STRUCTURES = ("FOIM", "IOIM-linear", "IOIM-laminar", "IOIM-turbulent", "other")
NUISANCE = ("coulomb-friction", "force-offset", "asymmetric-damping", DELAY)
"""Terms that any structure may carry without being another structure."""
ELASTIC = ("stiffness", "cubic-stiffness")
"""Terms that it may carry where their force is minor: seals and oil yield a little."""
MINOR = 0.25
"""Share of the force up to which it is."""
EXTRAS = (
    "coulomb-friction",
    "force-offset",
    "stiffness",
    "cubic-stiffness",
    "asymmetric-damping",
    DELAY,
)
_CORES: tuple[tuple[str, ...], ...] = (
    ("inertia",),
    ("inertia", "viscous-damping"),
    ("inertia", "quadratic-damping"),
    ("inertia", "viscous-damping", "quadratic-damping"),
    ("viscous-damping",),
    ("quadratic-damping",),
    ("viscous-damping", "quadratic-damping"),
    (),
)


def structure_of(ids: Sequence[str], exponent: float = TURBULENT_EXPONENT) -> str:
    """Return the name of the structure that these terms make.

    Power-law damping is turbulent friction where its exponent is between 1.5 and 2.

    Examples
    --------
    >>> structure_of(["inertia", "viscous-damping", "coulomb-friction"])
    'IOIM-linear'
    """
    core = set(ids) - set(NUISANCE)
    if core == {FRACTIONAL}:
        return "FOIM"
    if "inertia" not in core:
        return "other"
    if core <= {"inertia", "viscous-damping"}:
        return "IOIM-linear"
    if core <= {"inertia", "viscous-damping", "quadratic-damping"}:
        return "IOIM-laminar"
    turbulent = TURBULENT_RANGE[0] <= exponent <= TURBULENT_RANGE[1]
    if POWER in core and turbulent and core - {POWER} <= set(_CORES[3]):
        return "IOIM-turbulent"
    return "other"


def family_of(ids: Sequence[str]) -> str:
    """Return "fractional", "integer" or "mixed" (a fractional term beside inertia or damping).

    Examples
    --------
    >>> family_of(["fractional-derivative", "coulomb-friction"])
    'fractional'
    """
    if FRACTIONAL not in ids:
        return "integer"
    others = {"inertia", "viscous-damping", "quadratic-damping", POWER, "asymmetric-damping"}
    return "mixed" if others & set(ids) else "fractional"


def _subsets(items: Sequence[str], most: int) -> Iterator[tuple[str, ...]]:
    for size in range(min(most, len(items)) + 1):
        yield from combinations(items, size)


def candidate_supports(
    dictionary: Dictionary,
    *,
    extras: Sequence[str] = EXTRAS,
    most_extras: int = 4,
    mixed: bool = True,
) -> list[Support]:
    """Return every support that the free search weighs.

    Parameters
    ----------
    dictionary : Dictionary
        Terms that it lacks are left out.
    extras : sequence of str
        Terms that may join any core.
    most_extras : int
        How many of them at once.
    mixed : bool
        Whether a fractional derivative may stand beside integer-order inertia or damping.

    Returns
    -------
    list of Support
        Without repeats, from few terms to many.
    """
    present = [e for e in extras if dictionary.has(e)]
    cores = [c for c in _CORES if all(dictionary.has(i) for i in c)]
    shaped: list[Support] = [Support(c) for c in cores]
    if dictionary.family(POWER) is not None:
        shaped += [Support(c, fixed=((POWER, TURBULENT_EXPONENT),)) for c in cores]
        shaped += [Support(c, free=(POWER,)) for c in cores if "quadratic-damping" not in c]
    if dictionary.family(FRACTIONAL) is not None:
        shaped.append(Support((), free=(FRACTIONAL,)))
        if mixed:
            shaped += [Support(c, free=(FRACTIONAL,)) for c in cores if c]
    result = [
        Support((*s.plain, *e), s.free, s.fixed)
        for s in shaped
        for e in _subsets(present, most_extras)
        if s.ids or e
    ]
    return sorted(result, key=lambda s: s.parameters)


def named_supports(dictionary: Dictionary, extras: Sequence[str]) -> list[Support]:
    """Return one support for each named structure, with and without friction, plus `extras`."""
    cores = [
        Support((), free=(FRACTIONAL,)),
        Support(("inertia", "viscous-damping")),
        Support(("inertia", "viscous-damping", "quadratic-damping")),
        Support(("inertia", "quadratic-damping")),
        Support(("inertia", "viscous-damping"), fixed=((POWER, TURBULENT_EXPONENT),)),
        Support(("inertia",), fixed=((POWER, TURBULENT_EXPONENT),)),
        Support(
            ("inertia", "viscous-damping", "quadratic-damping"),
            fixed=((POWER, TURBULENT_EXPONENT),),
        ),
    ]
    kept = [e for e in extras if e != "coulomb-friction" and dictionary.has(e)]
    friction = [(), ("coulomb-friction",)] if dictionary.has("coulomb-friction") else [()]
    return [
        Support((*c.plain, *f, *kept), c.free, c.fixed)
        for c in cores
        for f in friction
        if all(dictionary.has(i) for i in c.plain)
        and all(dictionary.family(i) is not None for i in (*c.free, *(j for j, _ in c.fixed)))
    ]
