"""The paper's claims, each one small function that computes its verdict."""

from collections.abc import Callable

from discover.reproduction.claims import boundary, devices, fits, operators, rough_design
from discover.reproduction.claims.claim import Claim, Verdict

CLAIMS: tuple[Callable[[], Claim], ...] = (
    *devices.CLAIMS,
    *operators.CLAIMS,
    *fits.CLAIMS,
    *boundary.CLAIMS,
    *rough_design.CLAIMS,
)
"""Every claim, in the paper's order of subjects."""


def all_claims() -> tuple[Claim, ...]:
    """Return every claim, checked."""
    return tuple(check() for check in CLAIMS)


__all__ = ["CLAIMS", "Claim", "Verdict", "all_claims"]
