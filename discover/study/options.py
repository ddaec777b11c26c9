"""What a user may fix in a study."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class StudyOptions:
    """Choices of a study; the defaults leave everything to the data.

    Examples
    --------
    >>> StudyOptions(terms=("inertia", "viscous-damping"), bands=1).coordinate is None
    True
    """

    terms: tuple[str, ...] | None = None
    """Only these terms, all kept; None for the free search."""
    orders: tuple[float, ...] | None = None
    """Grid of fractional orders: its ends bound the search."""
    exponents: tuple[float, ...] | None = None
    """Grid of velocity exponents, likewise."""
    bands: int | None = None
    """Number of bands; None lets the evidence choose."""
    coordinate: str | None = None
    """"dean", "speed" or "frequency"; None: Dean number with a device, else speed."""
    convention: str = "paper"
    """Convention of the Dean number."""
    criterion: float = 100.0
    """Critical Dean number in that convention."""
    seed: int = 0
    """Of everything random."""
    jobs: int = 1
    """Processes that observe the records."""
