"""What stands for something else gives way to it: a test's own numbers, another term, bands."""

from dataclasses import replace

import numpy as np
import pytest

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


def sprung(amplitude, omega, theta):
    """A damper with a spring beside it."""
    x, v = amplitude * np.sin(theta), amplitude * omega * np.cos(theta)
    return -80.0 * omega**2 * x + 300.0 * v + 6.0 * np.tanh(v / 2e-3) + 300.0 * x


@pytest.mark.parametrize("frequencies", [(0.2, 0.7, 2.5, 8.0), (0.3, 0.6, 1.2, 2.4)])
def test_bands_do_not_stand_for_a_spring(frequencies):
    records = campaign(
        sprung, frequencies=frequencies, amplitudes=(0.004, 0.01, 0.02), noise=0.02
    )
    device = prepare(records, StudyOptions()).device
    extras = ("stiffness", "cubic-stiffness", "force-offset")
    answer = found(replace(device, extras=extras))
    (spring,) = answer.joined
    assert spring.id == "stiffness" and answer.quiet
    assert np.isclose(spring.terms[0].coefficient, 300.0, rtol=0.05)
    assert answer.banded.bands == 1 and answer.device.bands is None


def switched(amplitude, omega, theta):
    """A damper that is stiffer above a frequency: no term stands for that."""
    x, v = amplitude * np.sin(theta), amplitude * omega * np.cos(theta)
    viscous = 300.0 if omega < 2.0 * np.pi else 900.0
    return -80.0 * omega**2 * x + viscous * v + 6.0 * np.tanh(v / 2e-3)


def test_no_term_stands_for_bands():
    records = campaign(
        switched, frequencies=(0.2, 0.5, 1.5, 4.0), amplitudes=(0.004, 0.01, 0.02), noise=0.02
    )
    device = prepare(records, StudyOptions()).device
    answer = found(replace(device, extras=("stiffness", "force-offset", "time-delay")))
    assert not answer.joined and answer.quiet
    assert answer.banded.bands == 2 and answer.banded.coordinate == "frequency"
