"""The Dean-number verdict from evidence whose boundary is stated."""

import numpy as np
import pytest

from discover.dean import VERDICTS, amplitude_exponent, check_dean
from models.device import Device

DEVICE = Device.preset("device-12")
AMPLITUDES = (0.005, 0.01, 0.02)
FREQUENCIES = tuple(np.geomspace(0.1, 5.0, 12))
PLAN = [(a, f) for a in AMPLITUDES for f in FREQUENCIES]


def dean(speed, convention="paper"):
    """Return the Dean number from Eqs. 12-14, or by its usual definition."""
    s1, s2 = np.pi * (0.028**2 - 0.012**2), np.pi * 0.005**2
    pipe = speed * s1 / s2
    if convention == "paper":
        return 2.0 * 800.0 * 0.01 * pipe / 0.027 * np.sqrt(0.01 / 0.1)
    return 800.0 * 0.01 * pipe / 0.027 * np.sqrt(0.005 / 0.1)


def evidence(plan, k, *, at=0.7, nats=5.0):
    """Return log evidence of divisions where each test on its own side of f = at (A / 10 mm)^k
    speaks with so many nats.
    """
    above = np.array([f >= at * (a / 0.01) ** k for a, f in plan])

    def of(upper):
        return nats * np.count_nonzero(upper == above, axis=1).astype(float)

    return of


def exponent(plan, k, **options):
    amplitude, frequency = np.array(plan).T
    return amplitude_exponent(frequency, amplitude, evidence(plan, k, **options))


@pytest.mark.parametrize("k", [-1.5, -1.0, -0.5, 0.0, 0.8])
def test_the_amplitude_exponent_is_recovered(k):
    found = exponent(PLAN, k)
    assert found.value == pytest.approx(k, abs=0.35)


def test_intervals_hold_exponents_drawn_at_random():
    """Where the truth is drawn evenly, as the posterior assumes, 95 % must hold it."""
    rng = np.random.default_rng(0)
    held = 0
    for _ in range(120):
        k, at = rng.uniform(-2.0, 1.0), np.exp(rng.uniform(np.log(0.3), np.log(1.7)))
        found = exponent(PLAN, k, at=at)
        held += found.interval[0] <= k <= found.interval[1]
    assert 106 <= held <= 119  # 114, three standard deviations below


def test_finer_plans_pin_the_exponent_down():
    fine = [(a, f) for a in AMPLITUDES for f in np.geomspace(0.1, 5.0, 60)]
    wide = exponent(PLAN, -1.0)
    tight = exponent(fine, -1.0)
    assert np.ptp(tight.interval) < 0.6 * np.ptp(wide.interval)
    assert tight.value == pytest.approx(-1.0, abs=0.08)


def test_evidence_that_says_nothing_leaves_the_exponent_open():
    found = exponent(PLAN, -1.0, nats=0.0)
    assert found.interval[0] < -2.0
    assert found.interval[1] > 1.0


def test_the_boundary_s_speed_is_that_of_the_stated_line():
    found = exponent(PLAN, -1.0, at=0.7)
    assert found.speed[0] < 2.0 * np.pi * 0.01 * 0.7 < found.speed[1]


def test_one_amplitude_tells_nothing_of_the_exponent():
    plan = [(0.01, f) for f in FREQUENCIES] + [(0.0105, f) for f in FREQUENCIES]
    assert exponent(plan, -1.0) is None


def test_one_frequency_tells_nothing_of_the_exponent():
    plan = [(a, 0.7) for a in np.geomspace(0.002, 0.02, 8)]
    assert exponent(plan, -1.0) is None


def verdict(boundary, follows, *, device=DEVICE, convention="paper"):
    return check_dean(device, boundary, follows, convention=convention, criterion=100.0)


def place(number, spread=1.3, convention="paper"):
    speed = number / dean(1.0, convention)
    return speed, (speed / spread, speed * spread)


def exponent_of(k, plan=None):
    plan = plan or [(a, f) for a in AMPLITUDES for f in np.geomspace(0.1, 5.0, 40)]
    return exponent(plan, k)


@pytest.mark.parametrize("convention", ["paper", "standard"])
def test_a_boundary_at_the_criterion_that_moves_with_amplitude_is_consistent(convention):
    found = verdict(place(100.0, convention=convention), exponent_of(-1.0), convention=convention)
    assert found.verdict == "consistent"
    assert found.boundary_dean == pytest.approx(100.0, rel=1e-9)
    assert found.interval == pytest.approx((100.0 / 1.3, 130.0))
    assert found.boundary_dean_paper == pytest.approx(
        found.boundary_dean_standard * 2.0 * np.sqrt(2.0)
    )


def test_a_boundary_fixed_in_frequency_contradicts():
    found = verdict(place(100.0), exponent_of(0.0))
    assert found.verdict == "contradicted"
    assert "k = -1" in found.reason


def test_a_boundary_elsewhere_contradicts():
    found = verdict(place(250.0), exponent_of(-1.0))
    assert found.verdict == "contradicted"
    assert "leaves 100 out" in found.reason


def test_one_amplitude_leaves_it_open_and_says_what_would_decide():
    found = verdict(place(100.0), None)
    assert found.verdict == "undetermined"
    assert "half and at twice the amplitude" in found.reason
    assert found.amplitude_exponent is None


def test_amplitudes_too_close_leave_it_open():
    plan = [(a, f) for a in (0.009, 0.011) for f in FREQUENCIES]
    found = verdict(place(100.0), exponent_of(-1.0, plan))
    assert found.verdict == "undetermined"


def test_without_boundary_or_geometry_it_says_so():
    assert verdict(None, exponent_of(-1.0)).verdict == "no-boundary"
    assert verdict(None, exponent_of(-1.0)).amplitude_exponent is None
    assert verdict(place(100.0), exponent_of(-1.0), device=None).verdict == "no-geometry"
    assert {verdict(None, None).verdict, "consistent"} <= set(VERDICTS)


def test_the_document_has_the_contract_s_keys():
    assert set(verdict(place(100.0), exponent_of(-1.0)).to_dict()) >= {
        "convention", "criterion", "verdict", "boundary_dean", "interval", "boundary_dean_paper",
        "boundary_dean_standard", "amplitude_exponent", "amplitude_exponent_interval",
    }  # fmt: skip
