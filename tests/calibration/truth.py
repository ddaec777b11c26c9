"""What the records can tell: the expected gap between structures at the true noise, no fit used."""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from tests.calibration.generator import Case, Test

TELLING = 10.0
_ORDERS = np.linspace(0.0, 2.0, 51)  # where the search for the best order starts


def _columns(test: Test, names: tuple[str, ...], order: float) -> np.ndarray:
    a, w, theta = test.amplitude, 2.0 * np.pi * test.frequency, test.theta
    v = a * w * np.cos(theta)
    made = {
        "inertia": -a * w**2 * np.sin(theta),
        "viscous": v,
        "quadratic": v * np.abs(v),
        "turbulent": np.sign(v) * np.abs(v) ** 1.75,
        "fractional": a * w**order * np.sin(theta + order * np.pi / 2.0),
        "friction": np.sign(v),
    }
    return np.stack([made[n] for n in names], axis=1)


def _whiten(test: Test, signal: np.ndarray) -> np.ndarray:
    step = signal[1:] - test.correlation * signal[:-1]
    return step / (test.sigma * np.sqrt(1.0 - test.correlation**2))


_RIVALS = {
    "FOIM": ("fractional", "friction"),
    "IOIM-linear": ("inertia", "viscous", "friction"),
    "IOIM-laminar": ("inertia", "viscous", "quadratic", "friction"),
    "IOIM-turbulent": ("inertia", "viscous", "quadratic", "turbulent", "friction"),
    "IOIM-turbulent, no losses": ("inertia", "viscous", "turbulent", "friction"),
}


def expected_gap(case: Case, rival: str) -> float:
    """Return the nats by which a rival structure falls short of the noise-free force."""
    force = np.concatenate([_whiten(t, t.clean) for t in case.tests])
    names = _RIVALS[rival]

    def gap(order: float) -> float:
        columns = np.concatenate([_whiten(t, _columns(t, names, order)) for t in case.tests])
        scale = np.linalg.norm(columns, axis=0)
        misfit = force - columns / scale @ np.linalg.lstsq(columns / scale, force, rcond=1e-12)[0]
        return 0.5 * float(misfit @ misfit)

    if rival != "FOIM":
        return gap(1.0)
    values = [gap(order) for order in _ORDERS]
    best = int(np.argmin(values))
    around = _ORDERS[max(best - 1, 0)], _ORDERS[min(best + 1, _ORDERS.size - 1)]
    refined = minimize_scalar(gap, bounds=around, method="bounded", options={"xatol": 1e-9})
    return min(float(refined.fun), values[best])


def separable(case: Case) -> bool:
    """Return whether every rival that does not hold the truth is at least ten nats away.

    A larger rival that holds the truth can't be told by misfit; the truth must then stand against
    the smaller ones.
    """
    truth = set(_RIVALS[case.structure])
    rivals = [
        r
        for r, names in _RIVALS.items()
        if not truth <= set(names) and not r.startswith(case.structure)
    ]
    return all(expected_gap(case, r) >= TELLING for r in rivals)
