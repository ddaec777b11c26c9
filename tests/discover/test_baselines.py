"""STLSQ, SR3 and SSR as comparisons: their answers hold in SI, and nothing stops a study."""

import re
import warnings

import numpy as np
import pytest

from discover.library.dictionary import standard_dictionary
from discover.regression import baseline_answers, baselines
from discover.triangle import Triangle, reduce_rows
from models.motion import sine_motion

PLAN = [(f, a) for f in (0.2, 0.5, 1.0, 3.0, 8.0) for a in (0.005, 0.02)]


def formula(label, a, w, phase):
    """Return a term of x = a sin(phase), by its label, from its textbook formula."""
    v = a * w * np.cos(phase)
    number = float(match[0]) if (match := re.search(r"[\d.]+(e-?\d+)?", label)) else 0.0
    match label.split()[0]:
        case "inertia":
            return -a * w**2 * np.sin(phase)
        case "viscous-damping":
            return v
        case "quadratic-damping":
            return v * np.abs(v)
        case "stiffness":
            return a * np.sin(phase)
        case "cubic-stiffness":
            return (a * np.sin(phase)) ** 3
        case "force-offset":
            return np.ones_like(phase)
        case "asymmetric-damping":
            return np.abs(v)
        case "coulomb-friction":
            return np.tanh(v / number) if number else np.sign(v)
        case "fractional-derivative":
            return a * w**number * np.sin(phase + 0.5 * np.pi * number)
        case "power-law-damping":
            return np.sign(v) * np.abs(v) ** number
    raise AssertionError(label)


def force_of(terms, samples=64):
    """Return the force in every record of the plan, (R, samples), over its root mean square."""
    phase = 2.0 * np.pi * (np.arange(samples) + 0.25) / samples
    rows = []
    for f, a in PLAN:
        w = 2.0 * np.pi * f
        rows.append(sum(c * formula(label, a, w, phase) for label, c in terms))
    return np.array(rows)


def problem(terms, *, noise=0.0, delay=False, seed=0):
    """Return triangle, dictionary and every record's scale for a force given by labels."""
    samples = 64
    speeds = np.array([2.0 * np.pi * f * a for f, a in PLAN])
    omegas = np.array([2.0 * np.pi * f for f, _ in PLAN])
    dictionary = standard_dictionary(speeds, omegas, delay=delay)
    force = force_of(terms, samples)
    size = np.sqrt(np.mean(force**2, axis=1, keepdims=True))
    force = force + noise * size * np.random.default_rng(seed).normal(size=force.shape)
    blocks = []
    for (f, a), measured, scale in zip(PLAN, force, size[:, 0], strict=True):
        # A quarter of a sample later, so that no sample lies on a reversal.
        fine = dictionary.evaluate(sine_motion(a, f, samples=4 * samples))[:, 1::4]
        slope = [-np.gradient(measured)] if delay else []
        blocks.append(np.vstack([fine, *slope, measured]).T / scale)
    rows = np.concatenate(blocks)
    return Triangle(reduce_rows(rows), len(rows), 0.0), dictionary, force, size


TRUTHS = {
    "fractional": [("fractional-derivative 1.9", 580.0), ("coulomb-friction", 400.0)],
    "integer": [("inertia", 370.0), ("viscous-damping", 2e4), ("coulomb-friction", 400.0)],
    "turbulent": [("inertia", 370.0), ("power-law-damping 1.75", 9e4)],
}


@pytest.mark.parametrize("truth", TRUTHS)
def test_answers_hold_in_si_units(truth):
    """The terms as printed, put in their textbook formulas, leave the error that is stated."""
    triangle, dictionary, force, size = problem(TRUTHS[truth], noise=0.02)
    answers = baseline_answers(triangle, dictionary, band=3)
    assert [(a.method, a.band) for a in answers] == [("STLSQ", 3), ("SR3", 3), ("SSR", 3)]
    for answer in answers:
        error = (force - force_of(answer.terms)) / size
        relative = 100.0 * np.linalg.norm(error) / np.linalg.norm(force / size)
        assert answer.relative_error_percent == pytest.approx(relative, rel=2e-3)
        assert relative < 2.3
        assert answer.seconds > 0.0


def test_a_single_plain_term_is_found_by_all():
    triangle, dictionary, _, _ = problem([("inertia", 370.0)], noise=0.02)
    for answer in baseline_answers(triangle, dictionary):
        assert dict(answer.terms) == pytest.approx({"inertia": 370.0}, rel=2e-3)


def test_a_delay_is_a_candidate_where_the_dictionary_has_it():
    triangle, dictionary, _, _ = problem(TRUTHS["integer"], delay=True)
    matrix = triangle.matrix.copy()
    matrix[:, -1] += 3.0 * matrix[:, -2] + matrix[:, 3]  # the slope's column, and stiffness
    for answer in baseline_answers(Triangle(matrix, 640, 0.0), dictionary):
        assert "time-delay" in dict(answer.terms)


def test_columns_that_stand_already_and_zero_columns_are_left_out():
    triangle, dictionary, _, _ = problem(TRUTHS["integer"])
    found = baselines._candidates(
        triangle, dictionary, np.array([0.0, 1.0, 1.5, 2.0, 2.5]), np.array([1.0, 1.5, 2.0, 9.0])
    )
    # sin(2 pi f t) has no mean, so order 0 is stiffness.
    assert [name for name in found.labels if name[:4] in ("frac", "powe")] == [
        "fractional-derivative 1.5", "power-law-damping 1.5",
    ]
    matrix = triangle.matrix.copy()
    matrix[:, dictionary.index("viscous-damping")] = 0.0
    small = baselines._candidates(
        Triangle(matrix, 640, 0.0), dictionary, np.array([]), np.array([])
    )
    assert "viscous-damping" not in small.labels
    np.testing.assert_allclose(np.linalg.norm(small.units, axis=0), 1.0)
    for answer in baseline_answers(
        Triangle(matrix, 640, 0.0), dictionary, order_grid=[], exponent_grid=[]
    ):
        assert "viscous-damping" not in dict(answer.terms)


def test_no_force_no_model():
    triangle, dictionary, _, _ = problem(TRUTHS["integer"])
    matrix = triangle.matrix.copy()
    matrix[:, -1] = 0.0
    for answer in baseline_answers(Triangle(matrix, 640, 0.0), dictionary):
        assert answer.terms == () and answer.relative_error_percent is None


def test_no_columns_no_model():
    triangle, dictionary, _, _ = problem(TRUTHS["integer"])
    matrix = np.zeros_like(triangle.matrix)
    matrix[:, -1] = triangle.target
    for answer in baseline_answers(Triangle(matrix, 640, 0.0), dictionary):
        assert answer.terms == () and answer.relative_error_percent is None


def test_a_method_that_fails_or_warns_is_one_without_an_answer(monkeypatch):
    def broken(*args, **kwargs):
        warnings.warn("thresholds removed every term", UserWarning, stacklevel=2)
        raise np.linalg.LinAlgError("singular")

    monkeypatch.setattr(baselines, "SSR", broken)
    triangle, dictionary, _, _ = problem([("inertia", 370.0)])
    answers = {a.method: a for a in baseline_answers(triangle, dictionary)}
    assert answers["SSR"].terms == () and answers["SSR"].relative_error_percent is None
    assert "inertia" in dict(answers["STLSQ"].terms)
