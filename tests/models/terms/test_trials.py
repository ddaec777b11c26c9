"""Shapes that are tried: within bounds, few, scaled by the campaign."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from models.checks import InputError
from models.motion import sine_motion
from models.terms import Parameter, Term
from models.terms.trials import MOST_SHAPES, chosen_parameters, trial_shapes, trial_size

SCALES = {"displacement": 0.02, "speed": 0.3, "force": 500.0}


def term(*parameters, **more):
    return Term("t", "N", "", lambda m, s: m.velocity, parameters=tuple(parameters), **more)


@pytest.mark.parametrize("number", range(1, 7))
def test_combinations_stay_few_and_reach_every_bound(number):
    parameters = [Parameter(f"p{i}", 1.0, 2.0 + i, 1.5, "") for i in range(number)]
    shapes = trial_shapes(term(*parameters), SCALES)
    assert 2**number <= len(shapes) <= MOST_SHAPES
    assert len({tuple(s.values()) for s in shapes}) == len(shapes)
    for p in parameters:
        values = {s[p.name] for s in shapes}
        assert (min(values), max(values)) == (p.lower, p.upper)


def test_more_parameters_than_can_be_spread_are_refused():
    parameters = [Parameter(f"p{i}", 1.0, 2.0, 1.5, "") for i in range(7)]
    with pytest.raises(InputError, match="parameters of t must be few enough .* VARIANTS, got 7"):
        trial_shapes(term(*parameters), SCALES)
    few = term(*parameters, trials=({"p3": 1.7},))
    assert trial_shapes(few, SCALES) == ({**{f"p{i}": 1.5 for i in range(7)}, "p3": 1.7},)


@given(st.sampled_from(["displacement", "speed", "force"]), st.floats(1e-3, 1e3))
def test_scaled_bounds_follow_the_campaign(name, factor):
    shaped = term(Parameter("p", 0.1, 2.0, 1.0, "m", name, "log"))
    small = [s["p"] for s in trial_shapes(shaped, SCALES)]
    large = [s["p"] for s in trial_shapes(shaped, {**SCALES, name: factor * SCALES[name]})]
    np.testing.assert_allclose(large, factor * np.array(small), rtol=1e-12)
    ratios = np.array(small[1:]) / small[:-1]
    np.testing.assert_allclose(ratios, ratios[0], rtol=1e-9)


def test_a_default_outside_the_bounds_is_a_limit_that_is_tried():
    shapes = trial_shapes(term(Parameter("p", 0.1, 2.0, 0.0, "m", "speed", "log")), SCALES)
    assert shapes[0] == {"p": 0.0}
    assert shapes[1]["p"] == pytest.approx(0.03)


def test_named_shapes_are_tried_as_they_are():
    own = term(
        Parameter("p", 0.1, 2.0, 1.0, "m", "displacement"), Parameter("q", 0.0, 1.0, 0.5, ""),
        trials=({"p": 0.5}, {"p": 1.5, "q": 0.5}),
    )  # fmt: skip
    assert trial_shapes(own, SCALES) == ({"p": 0.01, "q": 0.5}, {"p": 0.03, "q": 0.5})
    assert chosen_parameters(own) == 1


def test_a_term_without_parameters_has_one_shape():
    assert trial_shapes(term(), SCALES) == ({},)
    assert chosen_parameters(term()) == 0


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1.0, 1e4])
def test_a_change_is_tried_at_a_size_that_shows(scale):
    def late(force_of, motion, coefficient, shape):
        return (1.0 + coefficient / scale) * force_of(motion)

    shifted = Term("t", "s", "", transform=late, acts="output")
    motion = sine_motion(0.01, 1.0)
    assert trial_size(shifted, {}, motion, motion.velocity) == pytest.approx(0.02 * scale)


def test_a_change_of_the_motion_is_tried_at_a_size_that_shows():
    from dataclasses import replace

    def softer(force_of, motion, coefficient, shape):
        return force_of(replace(motion, displacement=motion.displacement * (1.0 - coefficient)))

    own = Term("t", "1", "", transform=softer, acts="input")
    motion = sine_motion(0.01, 1.0)
    size = trial_size(own, {}, motion, motion.displacement)
    assert 1e-3 < size < 0.1
