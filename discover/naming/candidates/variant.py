"""A shape that is tried for an effect: one term, or several of the same id fitted together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from discover.naming.scales import Scales

_FEW_TESTS = 4.0  # in which a gradual change is not told from a jump
_MOST_OWN = 64  # tests, of which each may have its own value


@dataclass(frozen=True)
class Part:
    """One term of a variant."""

    id: str
    """Of the term."""
    shape: Mapping[str, float] = field(default_factory=dict)
    """Its shape."""
    probe: float = 1.0
    """Coefficient at which a change of input or output is tried."""


@dataclass(frozen=True)
class Variant:
    """One shape of an effect: one term or several of the same id, fitted together."""

    effect: str
    """Id."""
    parts: tuple[Part, ...]
    """At least one."""
    shapes: int
    """Number of shape parameters that were chosen."""


def one(effect: str, shapes: int = 0, probe: float = 1.0, **shape: float) -> Variant:
    """Return a shape of a single term."""
    return Variant(effect, (Part(effect, shape, probe),), shapes)


def between_tests(effect: str, scales: Scales) -> list[Variant]:
    """Return an effect that grows from test to test, over the campaign or its first tests."""
    tests = scales.tests - 1.0
    shares = (1.0, 0.5, 0.25) if tests > _FEW_TESTS else ()
    return [one(effect, 1, 1e-3, from_test=2.0, over=share * tests) for share in shares]


def numbered(scales: Scales) -> tuple[float, ...]:
    """Return the numbers of tests of which each may have its own value; none where they are few."""
    several = _FEW_TESTS < len(scales.numbers) <= _MOST_OWN and 0 not in scales.numbers
    return tuple(float(n) for n in scales.numbers) if several else ()


def each_its_own(sets: Sequence[Sequence[Part]]) -> list[Variant]:
    """Return what has a value of its own in every test: one term for each."""
    return [Variant(parts[0].id, tuple(parts), 0) for parts in sets if parts]
