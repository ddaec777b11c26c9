"""A term with its shape, as a feature."""

from __future__ import annotations

from dataclasses import dataclass

PLAIN = (
    "inertia",
    "viscous-damping",
    "quadratic-damping",
    "stiffness",
    "cubic-stiffness",
    "force-offset",
    "asymmetric-damping",
)
"""Ids of terms without a shape that has to be given."""


@dataclass(frozen=True)
class Column:
    """One fixed column: a term with its shape.

    Examples
    --------
    >>> Column("power-law-damping", (("exponent", 1.75),)).shape
    (('exponent', 1.75),)
    """

    id: str
    """The term."""
    shape: tuple[tuple[str, float], ...] = ()
    """Shape parameters, SI."""
