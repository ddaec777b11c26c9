"""Fractional derivatives of records: the operator is asked for, the scheme chosen or named."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from models.checks import InputError, one_of
from models.fractional.band_limit import band_limited_derivative, low_pass, noise_cutoff
from models.fractional.causal import causal_derivative, weighted_sum
from models.fractional.choice import Choice, choose_causal, choose_clean, choose_steady
from models.fractional.estimate import relative_rms, truncation_error
from models.fractional.harmonics import fit_harmonics, harmonic_derivative
from models.fractional.kinks import find_starts
from models.fractional.l1 import l1_derivative
from models.fractional.noise import roughness
from models.fractional.orders import Array, checked_orders, checked_record
from models.fractional.quadrature import noise_gains
from models.fractional.result import KINDS, FractionalDerivative
from models.fractional.spectral import spectral_derivative
from models.fractional.weights import BDF_STEPS

SCHEMES = {
    "caputo": ("auto", *BDF_STEPS, "l1", "band-limited", "harmonics"),
    "riemann-liouville": ("auto", *BDF_STEPS, "band-limited", "harmonics"),
    "grunwald-letnikov": ("auto", "gl"),
    "weyl": ("auto", "spectral", "harmonics", "band-limited"),
}
"""Schemes that each operator can be computed with."""

_WIDER = 1.4


def derivative(
    x: ArrayLike, order: ArrayLike, dt: float, *, kind: str = "caputo", scheme: str = "auto"
) -> Array:
    r"""Differentiate sampled records to fractional orders.

    Parameters
    ----------
    x : array_like, shape (..., N)
        Records, uniformly sampled.
    order : float or array_like, shape (K,)
        Orders, -1 to 2; negative orders integrate.
    dt : float
        Sampling interval, s.
    kind : {"caputo", "riemann-liouville", "grunwald-letnikov", "weyl"}, optional
        The operator. The first three act from the first sample on. Caputo takes off what the
        initial value (orders above 0) and velocity (above 1) contribute; Riemann-Liouville
        keeps them. Grunwald-Letnikov is the bare weighted sum over the samples, which tends to
        the Riemann-Liouville derivative as dt falls. Weyl acts from minus infinity: steady
        state.
    scheme : str, optional
        How. "auto" chooses by noise and kind of record, takes differences over a stride where
        samples lie so close that rounding or noise would spoil them, and treats kinks apart.
        Causal kinds: "bdf2" to "bdf6" (whole derivatives by backward differences of that order
        of convergence, then a fractional integral of order 6, with starting correction), "gl"
        (the same with differences of order 1), "l1" (Caputo, orders in (0, 1)), "harmonics" or
        "band-limited" (the record replaced by its fit, or low-passed, first). Weyl: "spectral"
        (whole periods), "harmonics" (a sine test, cycles whole or not), "band-limited"
        (anything else).

    Returns
    -------
    ndarray, shape (..., N) or (K, ..., N)
        Units of x per second to the order. At the first sample, where a Riemann-Liouville
        derivative is unbounded, its finite part.

    Raises
    ------
    InputError
        For unknown kinds or schemes, orders outside [-1, 2], dt <= 0, or values that are not
        finite.

    References
    ----------
    Podlubny, *Fractional Differential Equations*, 1999, chapter 2. Lubich, SIAM J. Math. Anal.
    17 (1986) 704-719.

    Examples
    --------
    >>> t = 0.01 * np.arange(200)
    >>> y = derivative(1.0 + t**2, 0.5, 0.01)
    >>> bool(np.allclose(y, 2.0 * t**1.5 / 1.329340388179137))
    True
    """
    return _compute(x, order, dt, kind, scheme, estimate=False).values


def fractional_derivative(
    x: ArrayLike, order: ArrayLike, dt: float, *, kind: str = "caputo", scheme: str = "auto"
) -> FractionalDerivative:
    """Differentiate as `derivative` does and say how, and how well.

    Parameters
    ----------
    x, order, dt, kind, scheme
        As for `derivative`.

    Returns
    -------
    FractionalDerivative
        Values, operator, scheme, expected relative rms error for each order.

    Raises
    ------
    InputError
        As `derivative`.

    Examples
    --------
    >>> t = 0.01 * np.arange(1000)
    >>> result = fractional_derivative(np.sin(t) ** 3, 0.5, 0.01)
    >>> result.operator, result.scheme, bool(result.error < 1e-6)
    ('caputo', 'bdf6', True)
    """
    return _compute(x, order, dt, kind, scheme, estimate=True)


@dataclass(frozen=True)
class _Task:
    """Checked arguments."""

    rows: Array
    """(R, N)"""
    orders: Array
    """(K,)"""
    dt: float
    """s"""
    kind: str
    """One of `KINDS`."""


def _compute(
    x: ArrayLike, order: ArrayLike, dt: float, kind: str, scheme: str, *, estimate: bool
) -> FractionalDerivative:
    one_of("kind", kind, KINDS)
    one_of("scheme", scheme, SCHEMES[kind], where=f"kind {kind}")
    values, step = checked_record(x, dt)
    orders, scalar = checked_orders(order)
    task = _Task(values.reshape(-1, values.shape[-1]), orders, step, kind)
    choice = _choose(task, scheme)
    if kind == "weyl":
        out = _steady(task, choice)
        error = _steady_error(task, choice, out) if estimate else np.zeros(orders.size)
        label, stride = choice.scheme, 1
    else:
        clean = _smoothed(task, choice)
        rows = task.rows if clean is None else clean
        last = choice if clean is None else choose_clean(clean, orders)
        out = _causal(task, last, rows, step)
        error = np.zeros(orders.size)
        if estimate:
            error = _causal_error(task, choice, last, rows, out)
        label = last.scheme if last is choice else f"{choice.scheme}+{last.scheme}"
        stride = last.stride
    shaped = out.reshape(orders.size, *values.shape)
    return FractionalDerivative(
        values=shaped[0] if scalar else shaped,
        operator=kind,
        scheme=label,
        error=error[0] if scalar else error,
        stride=stride,
        cutoff=choice.cutoff,
    )


def _choose(task: _Task, scheme: str) -> Choice:
    """Return the scheme asked for with what it needs, or the one that suits."""
    if task.kind == "grunwald-letnikov":
        return Choice("gl")
    if scheme == "auto":
        choose = choose_steady if task.kind == "weyl" else choose_causal
        return choose(task.rows, task.orders, task.dt)
    if scheme == "harmonics":
        fits = [fit_harmonics(row) for row in task.rows]
        if any(fit is None for fit in fits):
            raise InputError(
                "x", expected="at least one and a half cycles for scheme harmonics", found="less"
            )
        return Choice(scheme, fits=tuple(fit for fit in fits if fit is not None))
    if scheme == "band-limited":
        cutoff = noise_cutoff(task.rows, task.dt, float(task.orders.max()))
        return Choice(scheme, cutoff=cutoff)
    return Choice(scheme)


def _steady(task: _Task, choice: Choice) -> Array:
    """Return derivatives from minus infinity, (K, R, N)."""
    rows, orders, dt = task.rows, task.orders, task.dt
    if choice.scheme == "harmonics":
        each = [harmonic_derivative(fit, orders, dt, rows.shape[1]) for fit in choice.fits]
        return np.stack(each, axis=1)
    if choice.scheme == "band-limited" and choice.cutoff is not None:
        return band_limited_derivative(rows, orders, dt, cutoff=choice.cutoff)
    return spectral_derivative(rows, orders, dt, cutoff=choice.cutoff)


def _steady_error(task: _Task, choice: Choice, out: Array) -> Array:
    """Return the relative rms error, (K,), of a derivative from minus infinity."""
    rows, orders, dt = task.rows, task.orders, task.dt
    if choice.scheme == "harmonics":
        shares = []
        for fit in choice.fits:
            # Each coefficient of white noise s has variance 4 s^2 / N; the frequency's share
            # is of the same size again.
            k = np.arange(1, fit.coefficients.size) * fit.omega / dt
            weight = np.sqrt(np.sum(k ** (2.0 * orders[:, None]), axis=1))
            shares.append(2.0 * fit.residual / np.sqrt(rows.shape[1]) * weight)
        size = np.sqrt(np.mean(out**2, axis=(1, 2)))
        return np.asarray(np.max(shares, axis=0) / np.maximum(size, 1e-300))
    if choice.cutoff is not None and _WIDER * choice.cutoff < 0.5 / dt:
        other = _steady(task, Choice(choice.scheme, cutoff=_WIDER * choice.cutoff))
        return relative_rms(other - out, out)
    noise = max(roughness(row).noise for row in rows)
    factors = spectral_derivative(np.eye(1, rows.shape[1]), orders, dt)
    gain = np.sqrt(np.sum(factors**2, axis=(1, 2)))
    return np.asarray(noise * gain / np.maximum(np.sqrt(np.mean(out**2, axis=(1, 2))), 1e-300))


def _smoothed(task: _Task, choice: Choice) -> Array | None:
    """Return the record without its noise where the choice asks for it."""
    if choice.scheme == "harmonics":
        zero = np.zeros(1)
        samples = task.rows.shape[1]
        return np.stack([harmonic_derivative(f, zero, task.dt, samples)[0] for f in choice.fits])
    if choice.scheme == "band-limited" and choice.cutoff is not None:
        return low_pass(task.rows, task.dt, cutoff=choice.cutoff)
    return None


def _causal(task: _Task, choice: Choice, rows: Array, dt: float) -> Array:
    """Return derivatives from the first sample on, (K, R, N)."""
    if choice.scheme == "l1":
        return l1_derivative(rows, task.orders, dt)
    if task.kind == "grunwald-letnikov":
        return weighted_sum(rows, task.orders, dt)
    return causal_derivative(
        rows,
        task.orders,
        dt,
        steps=BDF_STEPS[choice.scheme],
        stride=choice.stride,
        caputo=task.kind == "caputo",
        starts=choice.starts or None,
    )


def _causal_error(
    task: _Task, choice: Choice, last: Choice, rows: Array, out: Array
) -> Array:
    """Return the relative rms error, (K,), of a derivative from the first sample on."""
    error = _truncation(task, last, rows, out)
    if last is choice:
        return np.asarray(np.hypot(error, _noise(task, last, out)))
    if choice.cutoff is not None and _WIDER * choice.cutoff < 0.5 / task.dt:
        wider = _smoothed(task, Choice(choice.scheme, cutoff=_WIDER * choice.cutoff))
        if wider is not None:
            other = _causal(task, replace(last, starts=()), wider, task.dt)
            error = np.hypot(error, relative_rms(other - out, out))
    for fit in choice.fits:
        harmonics = float(np.linalg.norm(fit.coefficients[1:])) / np.sqrt(2.0)
        spread = 2.0 * fit.residual / np.sqrt(rows.shape[1]) * fit.coefficients.size**2
        error = np.hypot(error, spread / harmonics)
    return np.asarray(error)


def _truncation(task: _Task, choice: Choice, rows: Array, out: Array) -> Array:
    """Relative rms error, (K,), as a finer stride shows it, or else a coarser sampling."""
    if choice.stride > 1:
        finer = replace(choice, stride=choice.stride // 2)
        apart = relative_rms(_causal(task, finer, rows, task.dt) - out, out)
        noise = _noise(task, finer, out)
        return np.asarray(np.sqrt(np.clip(apart**2 - noise**2, 0.0, None)))

    def coarser(x: Array, dt: float) -> Array:
        starts = tuple(find_starts(row) for row in x) if choice.starts else ()
        return _causal(task, replace(choice, starts=starts), x, dt)

    return truncation_error(coarser, rows, task.dt, out, BDF_STEPS.get(choice.scheme, 2))


def _noise(task: _Task, choice: Choice, out: Array) -> Array:
    """Relative rms error, (K,), that the noise of the samples makes."""
    level = max(roughness(row).noise for row in task.rows)
    steps = BDF_STEPS.get(choice.scheme, 2)
    gains = noise_gains(task.orders, choice.stride)[:, steps - 1]
    noise = level * gains * task.dt**-task.orders
    size = np.sqrt(np.mean(out**2, axis=(1, 2)))
    return np.asarray(noise / np.maximum(size, 1e-300))
