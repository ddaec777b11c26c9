"""What the records can tell: the expected gap between structures at the true noise, no fit used.

Under a sine every closed form is a combination of five waves, so each test is whitened by its
true noise and reduced to a small triangle once; every gap then comes from the triangles.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar

from tests.calibration.generator import Case, Test

TELLING = 10.0
_ORDERS = np.linspace(0.0, 2.0, 51)  # where the search for the best order starts
_RIVALS = {
    "FOIM": ("fractional", "friction"),
    "IOIM-linear": ("inertia", "viscous", "friction"),
    "IOIM-laminar": ("inertia", "viscous", "quadratic", "friction"),
    "IOIM-turbulent": ("inertia", "viscous", "quadratic", "turbulent", "friction"),
    "IOIM-turbulent, no losses": ("inertia", "viscous", "turbulent", "friction"),
}


def _mixture(name: str, amplitude: float, omega: float, order: float) -> np.ndarray:
    """Return a term of unit coefficient as (5,) shares of the waves.

    sin, cos, cos |cos|, sign(cos) |cos|^1.75 and sign(cos).
    """
    a, w = amplitude, omega
    turn = order * np.pi / 2.0
    return np.array(
        {
            "inertia": (-a * w**2, 0.0, 0.0, 0.0, 0.0),
            "viscous": (0.0, a * w, 0.0, 0.0, 0.0),
            "quadratic": (0.0, 0.0, (a * w) ** 2, 0.0, 0.0),
            "turbulent": (0.0, 0.0, 0.0, (a * w) ** 1.75, 0.0),
            "fractional": (
                a * w**order * np.cos(turn), a * w**order * np.sin(turn), 0.0, 0.0, 0.0,
            ),
            "friction": (0.0, 0.0, 0.0, 0.0, 1.0),
        }[name]
    )


def whitened_triangle(test: Test) -> np.ndarray:
    """Return (6, 6) R of the whitened waves and, last, the exact force."""
    cosine = np.cos(test.theta)
    sign = np.sign(cosine)
    waves = [
        np.sin(test.theta), cosine, cosine * np.abs(cosine), sign * np.abs(cosine) ** 1.75, sign,
        test.clean,
    ]
    return np.linalg.qr(test.noise.whiten(np.stack(waves, axis=1)) / test.sigma, mode="r")


def expected_gaps(
    tests: Sequence[Test], rivals: Sequence[str], triangles: Sequence[np.ndarray] | None = None
) -> list[float]:
    """Return the nats by which each rival falls short of the tests' exact force."""
    reduced = [whitened_triangle(t) for t in tests] if triangles is None else triangles
    force = np.concatenate([r[:, -1] for r in reduced])

    def gap(names: tuple[str, ...], order: float) -> float:
        columns = np.concatenate(
            [
                r[:, :-1] @ np.stack(
                    [_mixture(n, t.amplitude, 2.0 * np.pi * t.frequency, order) for n in names],
                    axis=1,
                )
                for t, r in zip(tests, reduced, strict=True)
            ]
        )
        scale = np.linalg.norm(columns, axis=0)
        misfit = force - columns / scale @ np.linalg.lstsq(columns / scale, force, rcond=1e-12)[0]
        return 0.5 * float(misfit @ misfit)

    def least(rival: str) -> float:
        names = _RIVALS[rival]
        if rival != "FOIM":
            return gap(names, 1.0)
        values = [gap(names, order) for order in _ORDERS]
        best = int(np.argmin(values))
        around = _ORDERS[max(best - 1, 0)], _ORDERS[min(best + 1, _ORDERS.size - 1)]
        refined = minimize_scalar(
            lambda order: gap(names, order), bounds=around, method="bounded",
            options={"xatol": 1e-9},
        )
        return min(float(refined.fun), values[best])

    return [least(r) for r in rivals]


def expected_gap(case: Case, rival: str) -> float:
    """Return the nats by which a rival structure in one band falls short of the exact force."""
    return expected_gaps(case.tests, [rival])[0]


def least_gap(case: Case) -> float:
    """Return the gap to the nearest rival that does not hold the truth.

    A larger rival that holds the truth can't be told by misfit; the truth must then stand against
    the smaller ones. Where there are two bands, a rival is any structure in one band, or another
    structure in either of the two.
    """
    if case.boundary == "none":
        return _least(case.tests, case.structure)
    sides = [[t for t in case.tests if t.upper is above] for above in (False, True)]
    one_band = min(expected_gaps(case.tests, list(_RIVALS)))
    return min(one_band, *(_least(side, "FOIM") for side in sides))


def _least(tests: Sequence[Test], structure: str) -> float:
    truth = set(_RIVALS[structure])
    rivals = [
        r
        for r, names in _RIVALS.items()
        if not truth <= set(names) and not r.startswith(structure)
    ]
    return min(expected_gaps(tests, rivals))


def separable(case: Case) -> bool:
    """Return whether every rival is at least ten nats away."""
    return least_gap(case) >= TELLING
