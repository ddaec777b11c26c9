"""What is tried for a term without shapes of its own making: its parameters, spread over bounds."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

import numpy as np

from models.checks import Array, InputError
from models.motion import Motion
from models.terms.term import Parameter, Term

MOST_SHAPES = 100
_MOST_VALUES = 25
_FEWEST_VALUES = 2
_NOTICED = 0.02  # of a force: by so much a change of input or output alters it when it is tried
_DECADES = 10.0 ** np.arange(-12.0, 7.0)


def trial_shapes(term: Term, scales: Mapping[str, float]) -> tuple[dict[str, float], ...]:
    """Return the shapes of a term that are tried first, SI.

    The term's own `trials`, or every combination of a few values of each parameter between its
    bounds: at most `MOST_SHAPES`. A default outside the bounds stands for a limit, as a jump for
    a transition speed of 0, and is tried besides.

    Parameters
    ----------
    term : Term
        The term.
    scales : mapping
        "displacement" (m), "speed" (m/s) and "force" (N) that bounds may be fractions of.

    Raises
    ------
    InputError
        For more parameters than can be spread.

    Examples
    --------
    >>> term = Term("a", "N", "", parameters=(Parameter("gap", 0.5, 1.5, 1.0, "m"),))
    >>> shapes = trial_shapes(term, {})
    >>> len(shapes), shapes[0], shapes[-1]
    (25, {'gap': 0.5}, {'gap': 1.5})
    """
    sizes = {p.name: scales[p.scaled_by] if p.scaled_by else 1.0 for p in term.parameters}
    if term.trials:
        default = {p.name: p.default for p in term.parameters}
        return tuple(
            {name: float(value * sizes[name]) for name, value in {**default, **given}.items()}
            for given in term.trials
        )
    limits = [p for p in term.parameters if not p.lower <= p.default <= p.upper]
    count = _MOST_VALUES
    while _number(term, len(limits), count) > MOST_SHAPES:
        count -= 1
    if count < _FEWEST_VALUES:
        raise InputError(
            f"parameters of {term.id}", expected="few enough to try, or the shapes in VARIANTS",
            found=f"{len(term.parameters)}",
        )  # fmt: skip
    values = [_spread(p, count) * sizes[p.name] for p in term.parameters]
    names = [p.name for p in term.parameters]
    return tuple(
        dict(zip(names, map(float, chosen), strict=True)) for chosen in product(*values)
    )


def _number(term: Term, limits: int, count: int) -> int:
    return int((count + 1) ** limits * count ** (len(term.parameters) - limits))


def _spread(parameter: Parameter, count: int) -> Array:
    spread = np.geomspace if parameter.spacing == "log" else np.linspace
    values = spread(parameter.lower, parameter.upper, count)
    outside = not parameter.lower <= parameter.default <= parameter.upper
    return np.append(parameter.default, values) if outside else values


def chosen_parameters(term: Term) -> int:
    """Return how many shape parameters the trials choose.

    Examples
    --------
    >>> gap, side = Parameter("gap", 0.5, 1.5, 1.0, "m"), Parameter("side", -1.0, 1.0, 0.0, "")
    >>> chosen_parameters(Term("a", "N", "", parameters=(gap, side)))
    2
    >>> few = ({"gap": 0.7}, {"gap": 0.9})
    >>> chosen_parameters(Term("a", "N", "", parameters=(gap, side), trials=few))
    1
    """
    if not term.trials:
        return len(term.parameters)
    full = [{p.name: p.default for p in term.parameters} | dict(t) for t in term.trials]
    return sum(len({shape[p.name] for shape in full}) > 1 for p in term.parameters)


def trial_size(term: Term, shape: Mapping[str, float], motion: Motion, force: Array) -> float:
    """Return the coefficient at which a change of input or output alters a force noticeably.

    Parameters
    ----------
    term : Term
        With a `transform`.
    shape : mapping
        Its shape, SI.
    motion : Motion
        A typical motion, N samples.
    force : ndarray, shape (N,)
        A typical force on it, N.

    Returns
    -------
    float
        1 where no coefficient alters it.

    Examples
    --------
    >>> from models.motion import sine_motion
    >>> gain = Term("g", "1", "", transform=lambda f, m, c, s: (1.0 + c) * f(m), acts="output")
    >>> motion = sine_motion(0.01, 1.0)
    >>> round(trial_size(gain, {}, motion, motion.velocity), 6)
    0.02
    """
    if term.transform is None:
        return 1.0
    whole = float(np.sqrt(np.mean(force**2)))
    shown = motion.displacement

    def force_of(moved: Motion) -> Array:
        # A changed motion carries the force along to first order in its displacement.
        return force * (1.0 + (moved.displacement - shown) / float(np.abs(shown).max()))

    for size in _DECADES:
        changed = term.transform(force_of, motion, float(size), shape)
        change = float(np.sqrt(np.mean((changed - force) ** 2)))
        if change >= _NOTICED * whole:
            return float(size * _NOTICED * whole / change)
    return 1.0
