r"""Memory of a fractional term: the increment of its impulse over a step, at constant cost.

The impulse of :math:`D^\alpha x` is :math:`J = I^{2-\alpha} w`, with w = v - v(0) for orders above
one and w = v below (Caputo, from rest). Working with the impulse rather than with the force keeps
second order from the first step on, where the force itself rises with a power of time. For v linear
between steps,

.. math:: J_{n+1} - J_n = c_0 w_{n+1} + c_1 w_n + c_2 w_{n-1} + \sum_l Y_l(t_{n-1})

where the last two intervals are exact and older ones sum exponentials:
each mode is :math:`Y_l(t) = g_l \int_0^t e^{-r_l (t - s)} w(s) ds`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import gamma

import numpy as np

from models.checks import Array, number
from models.fractional import exponential_sum


@dataclass(frozen=True)
class ImpulseMemory:
    """Coefficients of the recurrence for one order and one step."""

    order: float
    """In (0, 2), not whole."""
    recent: Array
    """(3,) weights of w at the end, the start and one step before the start of the step."""
    first: float
    """Weight of w at the start in the first step of all, which has no interval before it."""
    bank: Array
    """(3, M) of the modes, each scaled by its weight in the impulse: decay over a step, what w at
    the start and at the end of an interval adds at its end."""
    gain: Array
    """(M,) the modes' scales."""
    rates: Array
    """(M,) 1/s."""

    @property
    def from_rest(self) -> bool:
        """True where w = v - v(0): orders above one."""
        return self.order > 1.0


def impulse_memory(
    order: float, step: float, horizon: float, *, error: float = 1e-10
) -> ImpulseMemory:
    """Return the recurrence for D^order x at a step of `step` seconds, over `horizon` seconds.

    `error` bounds the relative error of the kernel beyond the last two steps.
    """
    number("order", order, above=0.0, below=2.0)
    sigma = 2.0 - order
    # Second antiderivatives of the kernel t^(sigma - 1)/Gamma(sigma), on 0, h, 2h, 3h.
    ramp = (np.arange(4.0) * step) ** (sigma + 1.0) / gamma(sigma + 2.0)
    area = (np.arange(4.0) * step) ** sigma / gamma(sigma + 1.0)

    def interval(near: int) -> tuple[float, float]:
        """Weights of w at the far and the near end of the interval [near, near + 1] steps back."""
        rise = (ramp[near + 1] - ramp[near]) / step
        return float(area[near + 1] - rise), float(rise - area[near])

    far0, near0 = interval(0)
    far1, near1 = interval(1)
    recent = np.array([near0, far0 + near1 - near0, far1 - far0])

    beta = order - 1.0 if order > 1.0 else order
    # Towards a whole order the kernel vanishes like 1 - beta, and rounding is relative to it.
    reachable = max(error, min(2e-16 / (1.0 - beta), 0.1))
    weights, rates = exponential_sum(beta, step, max(horizon, 2.0 * step) + step, reachable)
    z = rates * step
    decay = np.exp(-z)
    mean = phi_one(z)  # integral of exp(-z s) over s in [0, 1]
    if order > 1.0:
        change = -weights * z * mean  # of the kernel itself over a step
    else:
        change = weights * step * mean  # the kernel is the antiderivative of the sum
    ramped = phi_two(z)  # integral of (1 - s) exp(-z s): the weight of the value at the near end
    new = step * ramped
    old = step * (mean - ramped)
    gain = change * decay
    bank = np.stack([decay, gain * old, gain * new])
    return ImpulseMemory(order, recent, far0, bank, gain, rates)


def phi_one(z: Array) -> Array:
    """Return the integral of exp(-z s) over s in [0, 1]."""
    safe = np.where(z < 1e-8, 1.0, z)
    return np.where(z < 1e-8, 1.0 - z / 2.0, -np.expm1(-safe) / safe)


def phi_two(z: Array) -> Array:
    """Return the integral of (1 - s) exp(-z s) over s in [0, 1]."""
    small = z < 0.1
    safe = np.where(small, 1.0, z)
    series = np.zeros_like(z)
    factor = np.full_like(z, 0.5)
    for k in range(3, 14):
        series += factor
        factor = -factor * z / k
    return np.where(small, series, (np.expm1(-safe) + safe) / safe**2)
