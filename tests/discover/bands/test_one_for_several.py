"""Numbers of every test's own give way to one that all share, once another term explains the rest.
"""

from dataclasses import replace

import numpy as np

from discover.bands.ways import found
from discover.study import StudyOptions
from discover.study.prepare import prepare
from tests.discover.exact import campaign


def two_valves(amplitude, omega, theta):
    """A damper of two rates under a constant force, with a harmonic that no term has."""
    v = amplitude * omega * np.cos(theta)
    odd = 90.0 * amplitude * omega * np.sin(3.0 * theta)
    return np.where(v > 0.0, 2000.0, 500.0) * v + odd - 180.0


def test_the_offsets_of_tests_become_one_once_the_asymmetry_has_joined():
    records = campaign(
        two_valves, frequencies=(0.3, 1.0, 3.0), amplitudes=(0.01, 0.03), noise=0.003
    )
    device = prepare(records, StudyOptions()).device
    device = replace(device, bands=1, extras=("force-offset", "asymmetric-damping"))
    joined = {j.id: j.terms for j in found(device).joined}
    assert set(joined) == {"force-offset", "asymmetric-damping"}
    (shared,) = joined["force-offset"]
    assert shared.shape["only"] == 0.0


def weighted_valve(amplitude, omega, theta):
    """A damper whose loss differs by direction, under a small constant force."""
    x, v = amplitude * np.sin(theta), amplitude * omega * np.cos(theta)
    odd = -55.0 * omega**2 * x + 55.0 * v + 930.0 * v * np.abs(v) + 0.77 * np.sign(v)
    return odd - 4.0 * np.abs(v) - 0.07


def test_a_constant_force_is_no_drift_once_the_loss_by_direction_has_joined():
    frequencies, amplitudes = (0.16, 0.28, 0.6, 1.3, 3.3, 10.9), (0.002, 0.008, 0.024)
    records = campaign(
        weighted_valve, frequencies=frequencies, amplitudes=amplitudes, noise=0.01
    )
    device = prepare(records, StudyOptions()).device
    even = ("sensor-drift", "force-offset", "asymmetric-damping")
    joined = {j.id: j for j in found(replace(device, bands=1, extras=even)).joined}
    assert set(joined) == {"force-offset", "asymmetric-damping"}
    (offset,) = joined["force-offset"].terms
    (loss,) = joined["asymmetric-damping"].terms
    assert np.isclose(offset.coefficient, -0.07, rtol=0.05)
    assert loss.shape == {"power": 1.0, "side": 0.0}
    assert np.isclose(loss.coefficient, -4.0, rtol=0.05)
    for name, one in joined.items():
        assert one.step.best.id == name
        assert one.step.probabilities[name] > 0.9
