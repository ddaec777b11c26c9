"""What is there in some of a campaign's tests only, or grows from test to test."""

from __future__ import annotations

from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start

FROM_TEST = Parameter("from_test", 0.0, 1e6, 0.0, "", fitted=False)
"""Number of the first test with the term, in the order of the campaign's records, from 1."""
OVER = Parameter("over", 0.0, 1e6, 0.0, "", fitted=False)
"""Tests over which it grows until it is whole; 0: at once."""
ONLY = Parameter("only", 0.0, 1e6, 0.0, "", fitted=False)
"""Number of the one test that has it; 0: all."""
_FEW = 4  # tests, in which a gradual change can't be told from a jump
_MOST = 64  # tests, of which each may have a value of its own


def share(motion: Motion, shape: Shape) -> float:
    """Return how much of a term is there in a motion's test, from 0 to 1.

    All of it where the motion's test isn't known.
    """
    if motion.test == 0:
        return 1.0
    only = shape.get("only", 0.0)
    if only > 0.0:
        return float(motion.test == only)
    late = motion.test - shape.get("from_test", 0.0) + 1.0
    return min(max(late / max(shape.get("over", 0.0), 1.0), 0.0), 1.0)


def is_alike(shape: Shape) -> bool:
    """Tell whether a term is the same in all tests."""
    return not any(shape.get(p.name, 0.0) for p in (FROM_TEST, ONLY))


def growing(scales: Scales, probe: float = 1.0, **shape: float) -> list[Start]:
    """Return what grows from test to test, over the campaign or its first tests."""
    last = max(scales.tests, default=0) - 1.0
    shares = (1.0, 0.5, 0.25) if last > _FEW else ()
    return [Start.one(probe, from_test=2.0, over=s * last, **shape) for s in shares]


def numbered(scales: Scales) -> tuple[float, ...]:
    """Return the numbers of tests of which each may have its own value; none where they are few."""
    several = 2 <= len(scales.tests) <= _MOST
    return tuple(float(n) for n in scales.tests) if several else ()
