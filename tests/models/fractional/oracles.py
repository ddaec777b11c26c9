"""Exact derivatives, from closed forms that the package does not use."""

from __future__ import annotations

import math

import mpmath
import numpy as np

SMOOTHSTEPS = {
    # Ascending coefficients; continuous first, second, third derivative at both ends.
    "cubic": (0, 0, 3, -2),
    "quintic": (0, 0, 0, 10, -15, 6),
    "septic": (0, 0, 0, 0, 35, -84, 70, -20),
}


def power(k, order, t):
    """Riemann-Liouville derivative of t^k for t > 0."""
    left = k + 1.0 - order
    if left <= 0.0 and left == math.floor(left):
        return np.zeros_like(t)
    return math.gamma(k + 1.0) / math.gamma(left) * t ** (k - order)


def _power_times_wave(k, order, omega, t):
    """Riemann-Liouville derivative of t^k exp(i omega t)."""
    factor = mpmath.gamma(k + 1) * mpmath.rgamma(k + 1 - order)
    return factor * t ** (k - order) * mpmath.hyp1f1(k + 1, k + 1 - order, 1j * omega * t)


def sine(order, omega, phase, t, *, caputo):
    """Derivative of sin(omega t + phase) from t = 0 at times t > 0."""
    whole = max(math.ceil(order), 0) if caputo else 0
    turned = mpmath.expj(phase) * mpmath.mpc(0, omega) ** whole
    with mpmath.workdps(30):
        return np.array(
            [
                float(mpmath.im(turned * _power_times_wave(0, order - whole, omega, mpmath.mpf(s))))
                for s in t
            ]
        )


def sine_by_series(order, omega, phase, t):
    """Caputo derivative of sin(omega t + phase) by its power series, in digits enough for it.

    D^a t^k / k! = t^(k - a) / Gamma(k + 1 - a) for k >= a, nothing for the powers below.
    """
    values = []
    for time in t:
        size = float(omega * time)
        # The terms grow to exp(omega t) before they fall.
        with mpmath.workdps(30 + int(size)):
            s, x = mpmath.mpf(float(time)), mpmath.mpf(float(omega)) * mpmath.mpf(float(time))
            turns = [mpmath.sin(mpmath.mpf(float(phase)) + k * mpmath.pi / 2) for k in range(4)]
            total = mpmath.mpf(0)
            for k in range(max(math.ceil(order), 0), int(20 + 4 * size + 30)):
                total += turns[k % 4] * x**k * mpmath.rgamma(k + 1 - mpmath.mpf(float(order)))
            values.append(float(total * s ** -mpmath.mpf(float(order))))
    return np.array(values)


def tapered(name, length, omega, t):
    """sin(omega t) that grows over `length` by a smoothstep."""
    s = np.clip(t / length, 0.0, 1.0)
    return sum(c * s**k for k, c in enumerate(SMOOTHSTEPS[name])) * np.sin(omega * t)


def tapered_derivative(name, length, order, omega, t):
    """Derivative of `tapered` (it starts with zero value and velocity, so Caputo = RL)."""
    steps = SMOOTHSTEPS[name]
    # 1 - step(1 + s): what has to be added from t = length on.
    rest = [
        -sum(c * math.comb(i, j) for i, c in enumerate(steps) if i >= j) for j in range(len(steps))
    ]
    rest[0] += 1
    values = []
    with mpmath.workdps(30):
        for time in t:
            total = sum(
                c / mpmath.mpf(length) ** k * _power_times_wave(k, order, omega, mpmath.mpf(time))
                for k, c in enumerate(steps)
                if c
            )
            if time > length:
                late = mpmath.mpf(time) - length
                total += mpmath.expj(mpmath.mpf(omega) * length) * sum(
                    c / mpmath.mpf(length) ** k * _power_times_wave(k, order, omega, late)
                    for k, c in enumerate(rest)
                    if c
                )
            values.append(float(mpmath.im(total)))
    return np.array(values)


def relative_rms(found, exact):
    return float(np.sqrt(np.mean((found - exact) ** 2) / np.mean(exact**2)))
