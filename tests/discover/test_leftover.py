"""What is left is described: its symmetry, harmonics, growth and memory, by hand."""

import numpy as np
import pytest

from discover.gap import prepare_baseline
from discover.gap.leftover import leftover_in_words
from discover.gap.where import places
from discover.motion_fit import observe
from discover.naming.fit import fit_model, free_parameters
from tests.discover.gap_data import campaign, device


def words(added):
    records = campaign(lambda t, x, v, a: device(t, x, v, a) + added(t, x, v, a)).records
    baseline = prepare_baseline(
        [observe(r) for r in records], "fit:inertia,viscous-damping", fixed=False
    )
    model = fit_model(baseline.rows, baseline.model, free_parameters(baseline.model)).model
    return leftover_in_words(baseline.rows, places(baseline.rows, model), model)


def test_an_even_force_of_position_and_speed_has_its_harmonic_and_powers():
    text = words(lambda t, x, v, a: 4e4 * v**2)
    assert "it is even" in text
    assert "harmonic 2" in text
    assert "frequency^(2.0" in text
    assert "amplitude^(2.0" in text
    assert "without memory" in text


def test_a_force_of_acceleration_is_no_function_of_displacement_and_velocity():
    text = words(lambda t, x, v, a: 2.0 * a * np.abs(a) ** 1.5)
    assert "it is odd" in text
    assert "stores energy" in text
    assert "no smooth function" in text


def test_nothing_left_has_no_words():
    assert words(lambda t, x, v, a: 0.0 * x) == ""


@pytest.mark.parametrize("count", [3])
def test_few_tests_tell_neither_growth_nor_memory(count):
    records = campaign(lambda t, x, v, a: device(t, x, v, a) + 4e4 * v**2).records[-count:]
    baseline = prepare_baseline(
        [observe(r) for r in records], "fit:inertia,viscous-damping", fixed=False
    )
    model = fit_model(baseline.rows, baseline.model, free_parameters(baseline.model)).model
    text = leftover_in_words(baseline.rows, places(baseline.rows, model), model)
    assert "it is even" in text
    assert "grows" not in text
    assert "memory" not in text


def test_a_spring_stores_and_friction_resists():
    assert "stores energy" in words(lambda t, x, v, a: 6e7 * x**3)
    assert "resists or drives" in words(lambda t, x, v, a: 60.0 * np.sign(v))
