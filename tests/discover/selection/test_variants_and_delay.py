"""Which variant of a term stays, and what delay the force channel has."""

import numpy as np
import pytest

from discover.library.dictionary import friction_column
from discover.motion_fit import observe
from discover.records import Record
from discover.regression.support import Support
from discover.selection.delay import delay_holds, rich_delay
from discover.selection.variants import rich_weights, settle_variants
from discover.triangle import rows_of
from tests.discover.spectra import dictionary, windows

PLAN = [(a, f) for a in (0.005, 0.02) for f in (0.3, 0.7, 1.5, 3.0, 7.0)]
SHORT = [(a, f) for a in (0.005, 0.02) for f in (0.7, 1.5, 3.0)]
WIDE = [(a, f) for a in (0.005, 0.01, 0.02) for f in np.geomspace(0.1, 12.0, 14)]
TERMS = {"inertia": 300.0, "viscous-damping": 1000.0, "coulomb-friction": 50.0}
SPACE = dictionary(
    "inertia", "viscous-damping", "coulomb-friction", exponents=(0.4, 3.0), delay=True
)


@pytest.mark.parametrize("delay", [3e-4, 1e-3, -5e-4])
def test_a_delay_is_found_beside_a_rich_model_where_noise_lets_it(delay):
    tests = windows(SPACE, TERMS, WIDE, noise=1e-4, delay=delay)
    assert rich_delay(tests, SPACE) == pytest.approx(delay, rel=0.05)


def test_without_delay_none_is_found():
    for seed in range(5):
        tests = windows(SPACE, TERMS, PLAN, noise=1e-2, seed=seed)
        assert rich_delay(tests, SPACE) == 0.0


def test_a_dictionary_without_delay_gives_none():
    space = dictionary("inertia", "viscous-damping", "coulomb-friction", exponents=(0.4, 3.0))
    assert rich_delay(windows(space, TERMS, PLAN, delay=1e-3), space) == 0.0


def test_the_true_shift_holds_and_its_opposite_does_not():
    late = windows(SPACE, TERMS, PLAN, noise=5e-3, delay=1e-3)
    right = windows(SPACE, TERMS, PLAN, noise=5e-3)
    wrong = windows(SPACE, TERMS, PLAN, noise=5e-3, delay=2e-3)
    assert delay_holds(late, right, SPACE)
    assert not delay_holds(late, wrong, SPACE)
    assert not delay_holds(right, late, SPACE)


def test_a_rich_model_has_one_variant_of_each_term():
    weights = rich_weights(SPACE)
    # three plain terms, 13 orders, 3 exponents and the delay
    assert weights.shape == (SPACE.size, 3 + 13 + 3 + 1)
    assert np.linalg.matrix_rank(weights) == weights.shape[1]


def rows_with_friction(transition, noise=1e-3):
    """Return rows of records whose friction reverses over `transition`, m/s, as tanh."""
    space = SPACE.with_transitions([0.0, 0.01, 0.03, 0.1])
    rng = np.random.default_rng(0)
    rows = []
    for index, (amplitude, frequency) in enumerate(SHORT):
        time = np.arange(int(4.0 / frequency * 300.0)) / 300.0
        omega = 2.0 * np.pi * frequency
        x, v = amplitude * np.sin(omega * time), amplitude * omega * np.cos(omega * time)
        reversal = np.sign(v) if transition == 0.0 else np.tanh(v / transition)
        force = -300.0 * omega**2 * x + 1000.0 * v + 300.0 * reversal
        force += noise * force.std() * rng.standard_normal(time.size)
        record = Record(f"{index}.csv", time, force, x, frequency=frequency)
        rows += rows_of(observe(record), space, index)
    return rows, space


@pytest.mark.parametrize("transition", [0.0, 0.01, 0.03, 0.1])
def test_the_variant_that_made_the_force_stays(transition):
    rows, space = rows_with_friction(transition)
    settled, small = settle_variants(rows, space)
    assert small.transition_speeds == pytest.approx([transition])
    assert all(w.matrix.shape[1] == small.size + 1 for w in settled)
    # the kept columns are those of the variant, the force last as before
    kept = space.columns.index(friction_column(transition))
    position = small.index("coulomb-friction")
    np.testing.assert_array_equal(settled[0].matrix[:, position], rows[0].matrix[:, kept])
    np.testing.assert_array_equal(settled[0].matrix[:, -1], rows[0].matrix[:, -1])


def test_where_noise_hides_the_reversal_the_plain_jump_stays():
    rows, space = rows_with_friction(0.01, noise=1.0)
    assert settle_variants(rows, space)[1].transition_speeds == pytest.approx([0.0])
    assert Support(("coulomb-friction",)).parameters == 1
