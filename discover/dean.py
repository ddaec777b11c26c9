"""The Dean-number criterion, checked: the boundary lies where, and moves as, it says, or not.

Under the criterion De = 100 the boundary's frequency falls as the inverse of the amplitude,
f_low ~ A^k with k = -1; a boundary fixed in frequency has k = 0. With the bands' models held, a
line log f = c + k log A divides the tests in two, and the evidence of every such division gives
the posterior of k and of the boundary's place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from discover.words import capitalize_first, significant
from models.checks import Array
from models.device import Device
from models.flow import dean_per_speed

VERDICTS = ("consistent", "contradicted", "undetermined", "no-boundary", "no-geometry")
_EXPONENTS = np.linspace(-3.0, 2.0, 101)  # k in f_low ~ A^k, each as probable beforehand
_PLACES = 400  # of the boundary, even in the logarithm of frequency
_SAME = 1.15  # ratio below which amplitudes, or frequencies, count as one


@dataclass(frozen=True)
class DeanCheck:
    """Whether the lowest boundary agrees with the Dean-number criterion."""

    convention: str
    """Convention of the Dean number that is checked."""
    criterion: float
    """Critical Dean number in that convention."""
    verdict: str
    """"consistent", "contradicted", "undetermined", "no-boundary" or "no-geometry"."""
    boundary_dean: float | None
    """Dean number at the boundary, in that convention."""
    interval: tuple[float, float] | None
    """95 %, in that convention; at least the bracket between neighbouring tests."""
    boundary_dean_paper: float | None
    """Dean number at the boundary by the paper's convention."""
    boundary_dean_standard: float | None
    """Dean number at the boundary by the standard convention."""
    amplitude_exponent: float | None
    """k in f_low ~ A^k, the boundary's frequency over the amplitude: -1 under the criterion."""
    amplitude_exponent_interval: tuple[float, float] | None
    """95 %, of that exponent."""
    reason: str
    """The verdict in words, and what would decide it where it is open."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "convention": self.convention,
            "criterion": self.criterion,
            "verdict": self.verdict,
            "boundary_dean": self.boundary_dean,
            "interval": self.interval,
            "boundary_dean_paper": self.boundary_dean_paper,
            "boundary_dean_standard": self.boundary_dean_standard,
            "amplitude_exponent": self.amplitude_exponent,
            "amplitude_exponent_interval": self.amplitude_exponent_interval,
            "reason": self.reason,
        }


@dataclass(frozen=True)
class AmplitudeExponent:
    """Posterior of k in f_low ~ A^k."""

    value: float
    """Mean."""
    interval: tuple[float, float]
    """Central 95 %."""
    speed: tuple[float, float]
    """95 % of the boundary's speed amplitude (m/s) at the plan's middle, any k."""


def amplitude_exponent(
    frequency: Array, amplitude: Array, evidence: Callable[[NDArray[np.bool_]], Array]
) -> AmplitudeExponent | None:
    """Return how the boundary's frequency follows the amplitude.

    Parameters
    ----------
    frequency, amplitude : ndarray, shape (T,)
        Of the tests in the two bands, Hz and m.
    evidence : callable
        Log evidence (D,) of divisions, given which tests are in the upper band (D, T).

    Returns
    -------
    AmplitudeExponent or None
        None where the tests have one amplitude or one frequency only.
    """
    a, f = np.log(amplitude), np.log(frequency)
    if min(np.ptp(a), np.ptp(f)) < np.log(_SAME):
        return None
    centre = a.mean()
    low, high = f.min() - 1.0, f.max() + 1.0
    places = np.linspace(low, high, _PLACES)
    shifted = f - _EXPONENTS[:, None] * (a - centre)
    upper = shifted[:, None] > places[None, :, None]
    masks, which = np.unique(
        np.packbits(upper.reshape(-1, f.size), axis=1), axis=0, return_inverse=True
    )
    divisions = np.unpackbits(masks, axis=1, count=f.size).astype(bool)
    logs = evidence(divisions)[which.ravel()].reshape(_EXPONENTS.size, _PLACES)
    inside = (places > f.min()) & (places < f.max())
    logs = np.where(inside, logs, -np.inf)
    posterior = np.exp(logs - logsumexp(logs))
    of_k = posterior.sum(axis=1)
    of_place = posterior.sum(axis=0)
    return AmplitudeExponent(
        float(of_k @ _EXPONENTS),
        _central(_EXPONENTS, of_k),
        tuple(  # type: ignore[arg-type]
            float(2.0 * np.pi * np.exp(p + centre)) for p in _central(places, of_place)
        ),
    )


def _central(values: Array, probabilities: Array) -> tuple[float, float]:
    total = np.cumsum(probabilities)
    low = values[np.searchsorted(total, 0.025)]
    high = values[min(int(np.searchsorted(total, 0.975)), values.size - 1)]
    return float(low), float(high)


def check_dean(
    device: Device | None,
    boundary: tuple[float, tuple[float, float]] | None,
    exponent: AmplitudeExponent | None,
    *,
    convention: str,
    criterion: float,
) -> DeanCheck:
    """Return the verdict on the criterion.

    Parameters
    ----------
    device : Device or None
        Without it there is no Dean number.
    boundary : tuple or None
        Speed amplitude at the lowest boundary and its interval, m/s; None where there is none.
    exponent : AmplitudeExponent or None
        None where the tests have one amplitude or one frequency.
    convention, criterion
        What is checked.

    Returns
    -------
    DeanCheck
    """
    moved = None if boundary is None else exponent
    without = DeanCheck(
        convention=convention,
        criterion=criterion,
        verdict="no-boundary",
        boundary_dean=None,
        interval=None,
        boundary_dean_paper=None,
        boundary_dean_standard=None,
        amplitude_exponent=None if moved is None else moved.value,
        amplitude_exponent_interval=None if moved is None else moved.interval,
        reason="One structure holds over all tests: there is no boundary.",
    )
    if device is not None and boundary is None:
        return without
    if device is None or boundary is None:
        return replace(
            without,
            verdict="no-geometry",
            reason="Without the device's geometry there is no Dean number; give [device] in"
            " campaign.toml.",
        )
    speed, (low, high) = boundary
    scale = dean_per_speed(device, convention=convention)
    interval = (scale * low, scale * high)
    verdict, reason = _verdict_and_reason(
        interval, exponent, convention=convention, criterion=criterion
    )
    return replace(
        without,
        verdict=verdict,
        boundary_dean=scale * speed,
        interval=interval,
        boundary_dean_paper=dean_per_speed(device, convention="paper") * speed,
        boundary_dean_standard=dean_per_speed(device, convention="standard") * speed,
        reason=reason,
    )


def _verdict_and_reason(
    interval: tuple[float, float],
    exponent: AmplitudeExponent | None,
    *,
    convention: str,
    criterion: float,
) -> tuple[str, str]:
    """Return the verdict on a boundary whose Dean number is known, and its reason."""
    lies = (
        f"The boundary lies at a Dean number of {significant(interval[0], 3)} to"
        f" {significant(interval[1], 3)}"
        f" ({convention} convention)"
    )
    if exponent is None:
        return "undetermined", (
            f"{lies}, but the tests beside it have one amplitude or one frequency: a boundary"
            " fixed in frequency would look the same. Repeat them at half and at twice the"
            " amplitude and the frequency."
        )
    low, high = exponent.interval
    follows = f"the boundary's frequency goes as amplitude^k, k from {low:.2f} to {high:.2f}"
    if not low <= -1.0 <= high:
        return "contradicted", f"{capitalize_first(follows)}: the criterion needs k = -1."
    if not interval[0] <= criterion <= interval[1]:
        return "contradicted", f"{lies}, which leaves {criterion:g} out; {follows}."
    if low <= 0.0 <= high:
        return "undetermined", (
            f"{lies}, but {follows}, which holds both -1 (the criterion) and 0 (fixed in"
            " frequency). Amplitudes further apart would tell."
        )
    return "consistent", (
        f"{lies}, which holds {criterion:g}; {follows}, which holds -1 (the criterion) and not 0"
        " (fixed in frequency)."
    )
