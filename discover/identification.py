"""The fractional model's parameters from records: as the paper does it, and by projection.

F = b (1 + b0) D^order x + f0 sign v (Eq. 7), f0 known. The paper searches (order, b0) with a
genetic algorithm; here `identify_by_evolution`. The force is linear in the product b (1 + b0), so
for each trial order the best product is one division: `identify_by_projection` searches the order
alone (variable projection). Both minimise the same sum of squares under the same bounds.

A record holds only the product b (1 + b0). Splitting it takes b from the device's geometry; without
a device b0 is not identified and stays None.

References: Chen & Chen, *Materials* 2025, 18(11), 2556, section 3.2; G. H. Golub, V. Pereyra,
*SIAM J. Numer. Anal.* 10 (1973) 413-432.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import optimize

from models.checks import Array, InputError, finite_array, number
from models.constitutive import FittedTerm, ForceModel
from models.device import Device
from models.motion import Motion

ULTRA_LOW = (0.0, 1.5)
"""The paper's bounds of the order at ultra-low frequency."""
INERTIAL = (1.5, 2.0)
"""The paper's bounds of the order at all other frequencies."""
B0_BOUNDS = (0.0, 30.0)
"""The paper's bounds of b0."""

_STARTS = 7  # orders, even over the bounds


@dataclass(frozen=True)
class Trial:
    """A motion and the force that was measured under it."""

    motion: Motion
    """With its derivatives of any order."""
    force: Array
    """(N,) N, at the motion's samples."""

    def __post_init__(self) -> None:
        """Refuse columns of unequal length or a force that is nothing."""
        force = finite_array("force", self.force, ndim=1, where="trial")
        if force.shape != self.motion.time.shape:
            raise InputError(
                "force",
                expected=f"of shape {self.motion.time.shape}",
                found=f"{force.shape}",
                where="trial",
            )
        if not np.any(force):
            raise InputError("force", expected="not zero throughout", where="trial")


@dataclass(frozen=True)
class Identification:
    """The identified fractional model and what it took to find it."""

    method: str
    """"evolution" or "projection"."""
    order: float
    """Order of the derivative."""
    product: float
    """[b (1 + b0)], N s^order/m: all that records alone identify."""
    b0: float | None
    """The correction; None without a device, whose b alone tells it from the product."""
    inertance_source: str | None
    """Where b comes from: "computed" from geometry or "measured"; None without a device."""
    friction: float
    """[f0] N, held fixed."""
    error_percent: float
    """e_d: root mean square of RMSE over the force's peak, over the records."""
    objective: float
    """Sum over records of the mean squared misfit over the force's squared peak."""
    evaluations: int
    """Force laws evaluated."""
    seconds: float
    """Wall time."""

    @property
    def model(self) -> ForceModel:
        """The model, to simulate from."""
        return ForceModel(
            (
                FittedTerm("fractional-derivative", self.product, {"order": self.order}),
                FittedTerm("coulomb-friction", self.friction),
            ),
            "FOIM",
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the result without its wall time, which no second run repeats."""
        return {
            "method": self.method,
            "order": self.order,
            "product": self.product,
            "b0": self.b0,
            "inertance_source": self.inertance_source,
            "friction": self.friction,
            "error_percent": self.error_percent,
            "objective": self.objective,
            "evaluations": self.evaluations,
        }


@dataclass(frozen=True)
class _Misfit:
    """Sum of squares of (order, product) over trials, each over its squared peak."""

    trials: tuple[Trial, ...]
    weights: tuple[float, ...]
    target: Array
    friction: float
    lowest: float
    highest: float

    def column(self, order: float) -> Array:
        """Return D^order x of all trials, weighted, in one column."""
        pairs = zip(self.trials, self.weights, strict=True)
        return np.concatenate([w * t.motion.fractional(order) for t, w in pairs])

    def best_product(self, order: float) -> tuple[float, float]:
        """Return the product within its bounds that fits best at an order, and the misfit."""
        column = self.column(order)
        # One unknown: least squares is one division, and clipping it is exact.
        free = float(column @ self.target) / float(column @ column)
        product = min(max(free, self.lowest), self.highest)
        misfit = self.target - product * column
        return product, float(misfit @ misfit)


def _misfit(
    trials: Sequence[Trial],
    device: Device | None,
    order_bounds: tuple[float, float],
    b0_bounds: tuple[float, float],
    friction: float | None,
) -> _Misfit:
    if not trials:
        raise InputError("trials", expected="at least one", found="none")
    number("lower bound of the order", order_bounds[0], at_least=0.0, at_most=2.0)
    number("upper bound of the order", order_bounds[1], above=order_bounds[0], at_most=2.0)
    known = friction if friction is not None or device is None else device.coulomb_friction
    if known is None:
        raise InputError("friction", expected="given, by the device or the call", found="nothing")
    number("friction", known, at_least=0.0)
    lowest, highest = 0.0, math.inf
    if device is not None:
        number("lower bound of b0", b0_bounds[0], above=-1.0)
        number("upper bound of b0", b0_bounds[1], above=b0_bounds[0])
        lowest, highest = (device.inertance * (1.0 + b0) for b0 in b0_bounds)
    weights = tuple(
        1.0 / (float(np.max(np.abs(t.force))) * math.sqrt(t.force.size)) for t in trials
    )
    law = ForceModel((FittedTerm("coulomb-friction", known),))
    target = np.concatenate(
        [w * (t.force - law.force(t.motion)) for t, w in zip(trials, weights, strict=True)]
    )
    return _Misfit(tuple(trials), weights, target, known, lowest, highest)


def _result(
    method: str,
    misfit: _Misfit,
    device: Device | None,
    found: tuple[float, float, float],
    evaluations: int,
    seconds: float,
) -> Identification:
    order, product, objective = found
    return Identification(
        method=method,
        order=order,
        product=product,
        b0=None if device is None else product / device.inertance - 1.0,
        inertance_source=None if device is None else device.inertance_source,
        friction=misfit.friction,
        error_percent=100.0 * math.sqrt(objective / len(misfit.trials)),
        objective=objective,
        evaluations=evaluations,
        seconds=seconds,
    )


def identify_by_evolution(
    trials: Sequence[Trial],
    device: Device,
    *,
    order_bounds: tuple[float, float] = INERTIAL,
    b0_bounds: tuple[float, float] = B0_BOUNDS,
    friction: float | None = None,
    seed: int = 0,
) -> Identification:
    """Identify (order, b0) as the paper does, by a genetic algorithm (differential evolution).

    Parameters
    ----------
    trials : sequence of Trial
        Motions and measured forces.
    device : Device
        Gives b, without which b0 means nothing.
    order_bounds, b0_bounds : tuple of float
        The paper's: `INERTIAL` (or `ULTRA_LOW`), `B0_BOUNDS`.
    friction : float, optional
        f0, N; the device's where absent.
    seed : int
        Makes the run repeatable.

    Returns
    -------
    Identification
        Run on until the population has closed in on one point to round-off.
    """
    misfit = _misfit(trials, device, order_bounds, b0_bounds, friction)
    evaluations = 0

    def cost(point: Array) -> float:
        nonlocal evaluations
        evaluations += 1
        rest = misfit.target - device.inertance * (1.0 + point[1]) * misfit.column(float(point[0]))
        return float(rest @ rest)

    begin = time.perf_counter()
    found = optimize.differential_evolution(
        cost,
        optimize.Bounds(*np.array([order_bounds, b0_bounds]).T),
        rng=np.random.default_rng(seed),
        tol=1e-14,
        maxiter=2000,
        polish=False,
    )
    seconds = time.perf_counter() - begin
    product = device.inertance * (1.0 + float(found.x[1]))
    best = (float(found.x[0]), product, float(found.fun))
    return _result("evolution", misfit, device, best, evaluations, seconds)


def identify_by_projection(
    trials: Sequence[Trial],
    device: Device | None = None,
    *,
    order_bounds: tuple[float, float] = INERTIAL,
    b0_bounds: tuple[float, float] = B0_BOUNDS,
    friction: float | None = None,
) -> Identification:
    """Identify the order and the product b (1 + b0) by variable projection.

    Parameters
    ----------
    trials : sequence of Trial
        Motions and measured forces.
    device : Device, optional
        Gives b and so b0 and its bounds; without one the product is only bounded from below by 0.
    order_bounds, b0_bounds : tuple of float
        As in `identify_by_evolution`.
    friction : float, optional
        f0, N; the device's where absent.

    Returns
    -------
    Identification
        The optimum that `identify_by_evolution` reaches.

    Examples
    --------
    >>> from models.constitutive import foim
    >>> from models.motion import sine_motion
    >>> device = Device.preset("device-12")
    >>> motion = sine_motion(0.005, 12.0)
    >>> trial = Trial(motion, foim(device, 0.57, 1.89).force(motion))
    >>> found = identify_by_projection([trial], device)
    >>> round(found.order, 6), round(found.b0, 6)
    (1.89, 0.57)
    """
    misfit = _misfit(trials, device, order_bounds, b0_bounds, friction)
    evaluations = 0

    def cost(order: float) -> float:
        nonlocal evaluations
        evaluations += 1
        return misfit.best_product(float(order))[1]

    begin = time.perf_counter()
    orders = np.linspace(*order_bounds, _STARTS)
    values = [cost(order) for order in orders]
    k = int(np.argmin(values))
    bracket = (float(orders[max(k - 1, 0)]), float(orders[min(k + 1, _STARTS - 1)]))
    found = optimize.minimize_scalar(
        cost, bounds=bracket, method="bounded", options={"xatol": 1e-9}
    )
    # The bounded search stays off the ends; the best may lie at one.
    best = float(orders[k]) if values[k] <= float(found.fun) else float(found.x)
    product, objective = misfit.best_product(best)
    seconds = time.perf_counter() - begin
    return _result(
        "projection", misfit, device, (best, product, objective), evaluations, seconds
    )
