"""Sparse regression side by side: rows against their triangle, exact search against others.

``python -m tests.benchmarks.bench_regression`` prints the rows; `rows` returns them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np
from pysindy.optimizers import STLSQ
from sklearn.linear_model import OrthogonalMatchingPursuit

from discover.motion_fit import observe_all
from discover.regression import BestSubset, best_subsets
from discover.regression.best_subset import compress
from discover.rows import RecordRows, record_rows
from discover.rows.columns import force_columns
from discover.study.baselines import baseline_answers, candidate_terms, label
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion
from tests.benchmarks.bench_study import Row, sine_records

_SEEDS = 20
_SAMPLES = 400
"""Of each test, over four cycles."""


def timed(work: Callable[[], object], repeats: int = 3) -> float:
    """Return the least time of a few runs, s."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def rows_against_triangle() -> Iterator[Row]:
    """Yield pysindy's STLSQ on 400,000 rows and on the triangle of the same rows."""
    rng = np.random.default_rng(0)
    theta = rng.normal(size=(400_000, 20))
    force = theta[:, [1, 5, 9]] @ [2.0, -1.0, 0.5] + 0.1 * rng.normal(size=400_000)
    stacked = np.column_stack([theta, force])
    triangle = compress(stacked)

    def fit(rows: np.ndarray) -> np.ndarray:
        return STLSQ(threshold=0.1, alpha=1e-6).fit(rows[:, :-1], rows[:, -1]).coef_

    full, small = timed(lambda: fit(stacked), 2), timed(lambda: fit(triangle))
    name = "STLSQ, 400,000 x 20"
    yield f"{name}, on the rows", full, "s", ""
    yield f"{name}, on the triangle", small, "s", ""
    yield f"{name}, reducing to the triangle, once", timed(lambda: compress(stacked), 2), "s", ""
    yield f"{name}, speed", full / small, "times", "on the rows"
    difference = np.max(np.abs(fit(stacked) - fit(triangle)))
    yield f"{name}, greatest difference of coefficients (of about 1)", difference, "", ""


def neighbouring_orders(count: int = 40) -> tuple[np.ndarray, np.ndarray]:
    """Return columns of neighbouring fractional orders of a multisine, and a noisy force."""
    rng = np.random.default_rng(1)
    t = np.linspace(0.0, 1.0, 1000, endpoint=False)
    omega = 2.0 * np.pi * np.arange(1, 26)
    phase = np.outer(t, omega) + rng.uniform(0.0, 2.0 * np.pi, omega.size)
    orders = np.linspace(0.0, 2.0, count)
    columns = np.array(
        [np.cos(phase + 0.5 * np.pi * q) @ omega ** (q - 1.0) for q in orders]
    ).T
    force = columns[:, 9] / 20.0 + columns[:, 30] + 0.5 * rng.normal(size=t.size)
    return columns, force


def by_least_squares(columns: np.ndarray, force: np.ndarray, most: int) -> float:
    """Return the least misfit over all subsets, one `lstsq` each."""
    best = np.inf
    for size in range(1, most + 1):
        for subset in combinations(range(columns.shape[1]), size):
            chosen = columns[:, subset]
            fit = np.linalg.lstsq(chosen, force, rcond=None)[0]
            best = min(best, float(np.sum((force - chosen @ fit) ** 2)))
    return best


def by_normal_equations(columns: np.ndarray, force: np.ndarray, most: int) -> float:
    """Return the least misfit over all subsets, by batches of normal equations."""
    gram, product, energy = columns.T @ columns, columns.T @ force, force @ force
    best = np.inf
    for size in range(1, most + 1):
        subsets = np.array(list(combinations(range(columns.shape[1]), size)))
        small = gram[subsets[:, :, None], subsets[:, None, :]]
        right = product[subsets]
        fit = np.linalg.solve(small, right[:, :, None])[:, :, 0]
        best = min(best, float(energy - np.max(np.sum(fit * right, axis=1))))
    return best


def search_against_brute_force() -> Iterator[Row]:
    """Yield the exact search beside brute force on the same triangle."""
    columns, force = neighbouring_orders()
    triangle = compress(np.column_stack([columns / np.linalg.norm(columns, axis=0), force]))
    small, right = triangle[:, :-1], triangle[:, -1]
    best_subsets(small, right, max_terms=2)  # compiled before it is timed
    spent = {m: timed(lambda m=m: best_subsets(small, right, max_terms=m)) for m in (3, 4, 5)}
    name = "best subset, 40 neighbouring orders"
    yield f"{name}, up to 5 terms (760,098 subsets)", spent[5], "s", ""
    one_by_one = timed(lambda: by_least_squares(small, right, 3), 1)
    yield f"{name}, up to 3 terms, speed", one_by_one / spent[3], "times", "one lstsq a subset"
    batched = timed(lambda: by_normal_equations(small, right, 4), 2)
    yield f"{name}, up to 4 terms, speed", batched / spent[4], "times", "normal equations, batched"
    exact = by_least_squares(small, right, 3)
    path = best_subsets(small, right, max_terms=3)
    own = min(s[0].misfit for s in path.sizes if s)
    yield f"{name}, up to 3 terms, relative difference of misfit", abs(own / exact - 1.0), "", (
        "one lstsq a subset"
    )


def _problem(model: ForceModel, noise: float, seed: int) -> list[RecordRows]:
    """Return the rows of 33 sine tests of a model."""

    def law(omega: float, angle: Array, x: Array, v: Array) -> Array:
        return model.force(_steady(angle, omega, float(np.hypot(x, v / omega).max())))

    plan = [(a, f) for f in np.geomspace(0.1, 15.0, 12) for a in (0.005, 0.01, 0.02)]
    records = sine_records(
        law, plan, _SAMPLES, cycles=4.0, noise=noise, displacement_noise=1e-7, seed=seed
    )
    return [record_rows(o) for o in observe_all(records, 1)]


def _steady(angle: Array, omega: float, amplitude: float) -> Motion:
    """Return the motion A sin(angle) with its derivatives, (N,)."""

    def differentiate(orders: Array) -> Array:
        turned = angle + 0.5 * np.pi * orders[:, None]
        return np.asarray(amplitude * omega ** orders[:, None] * np.sin(turned))

    x, v, a = differentiate(np.array([0.0, 1.0, 2.0]))
    return Motion(angle / omega, x, v, a, differentiate, "weyl")


def _columns(rows: list[RecordRows], terms: list[FittedTerm]) -> tuple[np.ndarray, np.ndarray]:
    """Return columns of terms and the measured force, each record over its own force."""
    sizes = [float(np.linalg.norm(r.target)) for r in rows]
    blocks = [force_columns(r, terms) / s for r, s in zip(rows, sizes, strict=True)]
    force = np.concatenate([r.target / s for r, s in zip(rows, sizes, strict=True)])
    return np.concatenate(blocks, axis=1).T, force


def _pursuit(columns: np.ndarray, force: np.ndarray, rows: int) -> np.ndarray:
    units = columns / np.linalg.norm(columns, axis=0)
    scored = []
    for size in range(1, 7):
        fit = OrthogonalMatchingPursuit(n_nonzero_coefs=size, fit_intercept=False)
        coefficients = fit.fit(units, force).coef_
        misfit = np.sum((force - units @ coefficients) ** 2)
        scored.append((rows * np.log(misfit) + size * np.log(rows), tuple(coefficients)))
    return np.array(min(scored)[1])


def exact_support() -> Iterator[Row]:
    """Yield how often each method finds exactly the true terms."""
    friction = FittedTerm("coulomb-friction", 400.0)
    inertia, viscous = FittedTerm("inertia", 370.0), FittedTerm("viscous-damping", 2000.0)
    models = {
        "FOIM": (FittedTerm("fractional-derivative", 580.0, {"order": 1.9}), friction),
        "IOIM-linear": (inertia, viscous, friction),
        "IOIM-laminar": (inertia, viscous, FittedTerm("quadratic-damping", 3e4), friction),
    }
    for name, terms in models.items():
        for noise in (0.02, 0.1):
            hits: dict[str, int] = {}
            for seed in range(_SEEDS):
                answers = _answers(_problem(ForceModel(terms), noise, seed), friction)
                for method, found in answers.items():
                    hits[method] = hits.get(method, 0) + (found == {label(t) for t in terms})
            for method, count in hits.items():
                yield f"exact terms, {name}, {noise:.0%} noise: {method}", count, (
                    f"of {_SEEDS}"
                ), ""


def _answers(rows: list[RecordRows], friction: FittedTerm) -> dict[str, set[str]]:
    """Return the terms that each method chooses on the same columns, by the same criterion."""
    terms = candidate_terms([friction])
    columns, force = _columns(rows, terms)
    subset = BestSubset(max_terms=5, criterion="bic", effective_samples=float(force.size))
    chosen = {"best subset": subset.fit(columns, force).coef_[0]}
    chosen["scikit-learn OMP"] = _pursuit(columns, force, force.size)
    answers = {m: {label(terms[i]) for i in np.flatnonzero(c)} for m, c in chosen.items()}
    for answer in baseline_answers(rows, [friction]):
        answers[f"pysindy {answer.method}"] = {name for name, _ in answer.terms}
    return answers


def rows() -> list[Row]:
    """Return all rows of this file."""
    return [*rows_against_triangle(), *search_against_brute_force(), *exact_support()]


if __name__ == "__main__":
    for what, value, unit, beside in rows():
        print(f"{what:<82} {value:>10.3g} {unit}" + (f" (beside {beside})" if beside else ""))
