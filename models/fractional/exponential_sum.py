"""Sum of exponentials for the kernel of a fractional derivative."""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import eigh_tridiagonal

from models.checks import InputError, number
from models.fractional.orders import Array

# Rates this many times slower than 1/horizon are constants in double precision.
_CONSTANT = 1e-17
# Slow rates up to this many times 1/horizon are merged into a few Gauss nodes.
_SLOW = 2.0
_TIGHTEST = 1e-12


def exponential_sum(
    beta: float, dt: float, horizon: float, error: float = 1e-10
) -> tuple[Array, Array]:
    r"""Approximate the memory kernel of a Caputo derivative by decaying exponentials.

    .. math:: \frac{t^{-\beta}}{\Gamma(1-\beta)} \approx \sum_l w_l e^{-r_l t},
       \qquad dt \le t \le horizon

    A convolution with the kernel then needs a state of fixed size: one number for each rate.

    Parameters
    ----------
    beta : float
        Exponent, 0 < beta < 1: the order of the derivative, less its whole part.
    dt, horizon : float
        Shortest and longest time, s, at which the sum holds.
    error : float, optional
        Largest relative error over [dt, horizon]; 1e-12 to 0.1.

    Returns
    -------
    weights : ndarray, shape (M,)
        Positive, in s^-beta.
    rates : ndarray, shape (M,)
        Ascending, not negative, in 1/s.

    Raises
    ------
    InputError
        For beta outside (0, 1), horizon <= dt, or an error that is out of reach.

    Notes
    -----
    The kernel is :math:`\frac{\sin\pi\beta}{\pi}\int_0^\infty s^{\beta-1}e^{-st}ds`; with
    s = e^u the trapezoidal rule converges exponentially. Rates slow against the horizon form a
    discrete measure that a Gauss rule of a few nodes replaces.

    References
    ----------
    Beylkin, Monzon, *Approximation by exponential sums revisited*, Appl. Comput. Harmon. Anal.
    28 (2010) 131-149. Jiang et al., Commun. Comput. Phys. 21 (2017) 650-678.

    Examples
    --------
    >>> weights, rates = exponential_sum(0.5, 1e-3, 10.0)
    >>> t = 0.25
    >>> bool(abs(weights @ np.exp(-rates * t) * math.sqrt(math.pi * t) - 1) < 1e-10)
    True
    """
    exponent = number("beta", beta, above=0.0, below=1.0)
    shortest = number("dt", dt, above=0.0)
    longest = number("horizon", horizon, above=shortest)
    wanted = number("error", error, at_least=_TIGHTEST, at_most=0.1)
    times = np.geomspace(shortest, longest, 400)
    exact = times**-exponent / math.gamma(1.0 - exponent)
    reached = math.inf
    for step in np.geomspace(1.1, 1.0 / 3.2, 25) * math.pi**2 / max(-math.log(wanted), 1.0):
        weights, rates = laplace_nodes(
            exponent, shortest, longest, step=float(step), error=wanted
        )
        weights = weights * (math.sin(math.pi * exponent) / math.pi)
        reached = float(np.max(np.abs(np.exp(-np.outer(times, rates)) @ weights / exact - 1.0)))
        if reached <= wanted:
            return weights, rates
    raise InputError("error", expected=f"at least {reached:.1e} for this kernel", found=f"{error}")


def laplace_nodes(
    beta: float, shortest: float, longest: float, *, step: float, error: float
) -> tuple[Array, Array]:
    r"""Quadrature of :math:`\int_0^\infty s^{\beta-1}f(s)e^{-st}ds` for smooth f.

    Parameters
    ----------
    beta : float
        Exponent, > 0.
    shortest, longest : float
        Range of t, s.
    step : float
        Step of the trapezoidal rule in log s.
    error : float
        Relative error of the truncation at fast rates and of the merged slow ones.

    Returns
    -------
    weights, rates : ndarray, shape (M,)

    Examples
    --------
    >>> weights, rates = laplace_nodes(1.0, 1.0, 10.0, step=0.3, error=1e-10)
    >>> bool(abs(weights @ np.exp(-2.0 * rates) - 0.5) < 1e-10)
    True
    """
    # Beyond s * shortest = y the part left out is below y^beta e^-y of the whole.
    reach = -math.log(error) + 4.0
    reach += max(beta, 0.0) * math.log(reach)
    lowest = math.log(_CONSTANT / longest)
    count = math.ceil((math.log(reach / shortest) - lowest) / step) + 1
    u = lowest + step * np.arange(count)
    rates = np.exp(u)
    weights = step * np.exp(beta * u)
    # All still slower nodes act as one constant: the sum of their geometric series.
    weights[0] /= -math.expm1(-beta * step)
    slow = rates * longest <= _SLOW
    merged_weights, merged_rates = _gauss_rule(weights[slow], rates[slow], error)
    return (
        np.concatenate([merged_weights, weights[~slow]]),
        np.concatenate([merged_rates, rates[~slow]]),
    )


def _gauss_rule(weights: Array, nodes: Array, error: float) -> tuple[Array, Array]:
    """Gauss rule of few nodes for a discrete measure on nodes that span [0, _SLOW/horizon]."""
    points = 2
    # Error of n Gauss nodes on exp(-y), 0 <= y <= _SLOW.
    while _SLOW ** (2 * points) * 2.0 ** (1 - 4 * points) / math.factorial(2 * points) > error / 10:
        points += 1
    if nodes.size <= points:
        return weights, nodes
    scale = float(nodes[-1])
    y = nodes / scale
    # Lanczos on diag(y), started at sqrt(weights): the Jacobi matrix of the measure.
    total = float(weights.sum())
    basis = np.zeros((points, y.size))
    diagonal = np.zeros(points)
    off_diagonal = np.zeros(points - 1)
    basis[0] = np.sqrt(weights / total)
    for k in range(points):
        image = y * basis[k]
        diagonal[k] = basis[k] @ image
        for _ in range(2):
            image = image - basis[: k + 1].T @ (basis[: k + 1] @ image)
        if k + 1 < points:
            off_diagonal[k] = np.linalg.norm(image)
            basis[k + 1] = image / off_diagonal[k]
    values, vectors = eigh_tridiagonal(diagonal, off_diagonal)
    merged: Array = np.clip(np.asarray(values, dtype=np.float64), 0.0, None) * scale
    return total * np.asarray(vectors[0], dtype=np.float64) ** 2, merged
