import math

import numpy as np
import pytest
from fluids.core import Dean, Reynolds

from models.checks import InputError
from models.device import Device
from models.flow import critical_frequency, critical_speed, dean, reynolds

TWELVE = Device.preset("device-12")
TEN = Device.preset("device-10")

# The table of critical frequencies in Hz at De = 100, to three printed digits.
PUBLISHED = [
    (TWELVE, 0.005, 0.664, 1.877),
    (TWELVE, 0.010, 0.332, 0.938),
    (TWELVE, 0.020, 0.166, 0.469),
    (TEN, 0.005, 0.0737, 0.2085),
    (TEN, 0.010, 0.0369, 0.1043),
    (TEN, 0.0175, 0.0211, 0.0596),
]


@pytest.mark.parametrize(("device", "amplitude", "paper", "standard"), PUBLISHED)
def test_critical_frequencies_are_the_published_ones(device, amplitude, paper, standard):
    def three_digits(value):
        return 0.5 * 10.0 ** (math.floor(math.log10(value)) - 2)

    assert critical_frequency(device, amplitude) == pytest.approx(paper, abs=three_digits(paper))
    found = critical_frequency(device, amplitude, convention="standard")
    assert found == pytest.approx(standard, abs=three_digits(standard))


def test_equation_16_as_printed():
    d, amplitude = TWELVE, 0.007
    expected = 250.0 / (8.0 * math.sqrt(2.0) * math.pi * amplitude) * (0.027 / 800.0)
    expected *= math.sqrt(d.channel_radius * d.helix_radius)
    expected /= d.cylinder_radius**2 - d.rod_radius**2
    assert critical_frequency(d, amplitude, dean=250.0) == pytest.approx(expected, rel=1e-12)


def test_standard_convention_is_that_of_fluids():
    speed = 0.25
    u = speed * TEN.area_ratio
    re = Reynolds(V=u, D=2 * TEN.channel_radius, rho=802.0, mu=0.00168)
    assert reynolds(TEN, speed, convention="standard") == pytest.approx(re, rel=1e-12)
    expected = Dean(Re=re, Di=2 * TEN.channel_radius, D=2 * TEN.helix_radius)
    assert dean(TEN, speed, convention="standard") == pytest.approx(expected, rel=1e-12)


def test_paper_counts_twice_and_two_root_two_times():
    speed = np.array([-0.3, 0.0, 0.01])
    paper, standard = (reynolds(TEN, speed, convention=c) for c in ("paper", "standard"))
    np.testing.assert_allclose(paper, 2.0 * standard, rtol=1e-14)
    paper, standard = (dean(TEN, speed, convention=c) for c in ("paper", "standard"))
    np.testing.assert_allclose(paper, 2.0 * math.sqrt(2.0) * standard, rtol=1e-14)
    assert np.all(paper >= 0.0)


def test_the_papers_first_model_lies_above_its_own_boundary():
    speed = 2.0 * math.pi * 0.5 * 0.02
    assert float(dean(TWELVE, speed)) == pytest.approx(301.0, abs=0.5)
    assert float(dean(TWELVE, speed, convention="standard")) == pytest.approx(107.0, abs=0.5)


@pytest.mark.parametrize("convention", ["paper", "standard"])
def test_critical_speed_inverts_dean(convention):
    speed = critical_speed(TEN, dean=321.0, convention=convention)
    assert dean(TEN, speed, convention=convention) == pytest.approx(321.0, rel=1e-13)


def test_frequency_times_amplitude_is_constant():
    amplitude = np.array([0.001, 0.01, 0.1])
    amplitude.flags.writeable = False
    product = critical_frequency(TWELVE, amplitude) * amplitude
    np.testing.assert_allclose(product, product[0], rtol=1e-14)


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="amplitude must be above 0"):
        critical_frequency(TWELVE, [0.01, 0.0])
    with pytest.raises(InputError, match="convention must be one of paper, standard"):
        dean(TWELVE, 1.0, convention="mine")
    with pytest.raises(InputError, match="dean"):
        critical_frequency(TWELVE, 0.01, dean=0.0)
