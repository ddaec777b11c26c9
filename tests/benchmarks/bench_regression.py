"""Sparse regression side by side, in one run: rows against triangle, exact search against others.

``python -m tests.benchmarks.bench_regression`` prints the rows; `rows` returns them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np
from pysindy.optimizers import STLSQ
from sklearn.linear_model import OrthogonalMatchingPursuit

from discover.library.dictionary import PLAIN, Column, Dictionary, standard_dictionary
from discover.regression import BestSubset, baseline_answers, best_subsets
from discover.regression.best_subset import compress
from discover.triangle import Triangle, reduce_rows
from models.constitutive import FittedTerm, ForceModel
from models.motion import sine_motion

Row = tuple[str, float, str, str]
"""What was measured, value, unit, beside what."""

_SEEDS = 20
_ORDERS = np.linspace(0.0, 2.0, 21)
_EXPONENTS = np.array([0.5, 0.75, 1.25, 1.5, 1.75, 2.5])


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


def _problem(
    model: ForceModel, noise: float, seed: int
) -> tuple[Triangle, Dictionary, np.ndarray, list[str]]:
    """Return triangle and dictionary of 36 sine tests, and the grid's columns with labels."""
    rng = np.random.default_rng(seed)
    plan = [(f, a) for f in np.geomspace(0.1, 15.0, 12) for a in (0.005, 0.01, 0.02)]
    frequencies, amplitudes = np.array(plan).T
    omegas = 2.0 * np.pi * frequencies
    standard = standard_dictionary(omegas * amplitudes, omegas, delay=False)
    fixed = (*(Column(t) for t in PLAIN), Column("coulomb-friction", (("transition_speed", 0.0),)))
    dictionary = Dictionary(fixed, standard.families, delay=False)
    blocks = []
    for frequency, amplitude in plan:
        motion = sine_motion(amplitude, frequency, samples=128)
        force = model.force(motion)
        size = np.sqrt(np.mean(force**2))
        force = force + noise * size * rng.normal(size=force.size)
        blocks.append(np.vstack([dictionary.evaluate(motion), force]).T / size)
    rows = np.concatenate(blocks)
    triangle = Triangle(reduce_rows(rows), len(rows), 0.0)
    labels = [c.id for c in fixed]
    columns = [triangle.columns[:, i] for i in range(len(fixed))]
    grids = {"order": _ORDERS[[q not in (0.0, 1.0, 2.0) for q in _ORDERS]], "exponent": _EXPONENTS}
    for family in dictionary.families:
        _, where = dictionary.family(family.id)
        values = grids[family.parameter]
        columns.extend((triangle.columns[:, where] @ family.weights(values)).T)
        labels.extend(f"{family.id} {value:.4g}" for value in values)
    return triangle, dictionary, np.array(columns).T, labels


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
    """Yield how often each method finds exactly the true terms, in twenty seeds."""
    friction = FittedTerm("coulomb-friction", 400.0)
    inertia, viscous = FittedTerm("inertia", 370.0), FittedTerm("viscous-damping", 2000.0)
    models = {
        "FOIM": (FittedTerm("fractional-derivative", 580.0, {"order": 1.9}), friction),
        "IOIM-linear": (inertia, viscous, friction),
        "IOIM-laminar": (inertia, viscous, FittedTerm("quadratic-damping", 3e4), friction),
    }
    for name, terms in models.items():
        model = ForceModel(terms)
        truth = {t.id + "".join(f" {t.shape[k]:.4g}" for k in t.shape if k == "order")
                 for t in terms}
        for noise in (0.02, 0.1):
            hits: dict[str, int] = {}
            for seed in range(_SEEDS):
                triangle, dictionary, columns, labels = _problem(model, noise, seed)
                samples = float(triangle.rows)
                # All methods are judged by the same criterion.
                subset = BestSubset(max_terms=5, criterion="bic", effective_samples=samples)
                chosen = {"best subset": subset.fit(columns, triangle.target).coef_[0]}
                chosen["scikit-learn OMP"] = _pursuit(columns, triangle.target, triangle.rows)
                answers = {m: {labels[i] for i in np.flatnonzero(c)} for m, c in chosen.items()}
                for answer in baseline_answers(
                    triangle, dictionary, order_grid=_ORDERS, exponent_grid=_EXPONENTS
                ):
                    answers[f"pysindy {answer.method}"] = {label for label, _ in answer.terms}
                for method, found in answers.items():
                    hits[method] = hits.get(method, 0) + (found == truth)
            for method, count in hits.items():
                yield f"exact terms, {name}, {noise:.0%} noise: {method}", count, (
                    f"of {_SEEDS}"
                ), ""


def rows() -> list[Row]:
    """Return all rows of this file."""
    return [*rows_against_triangle(), *search_against_brute_force(), *exact_support()]


if __name__ == "__main__":
    for what, value, unit, beside in rows():
        print(f"{what:<82} {value:>10.3g} {unit}" + (f" (beside {beside})" if beside else ""))
