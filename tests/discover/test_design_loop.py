"""The loop: a designed device on the virtual rig, and what discovery says of its records."""

import math

import numpy as np
import pytest

from discover.cli.design_loop import close_loop, judge, one_foim, rig_campaign
from discover.records import Campaign, Record
from models.design import minimise_critical_frequency
from models.device import Device

TWELVE = Device.preset("device-12")


def fractional_campaign(order, product, frequencies, amplitudes, *, noise=0.01, seed=0):
    """Records of an exact fractional law, by Eq. 4, with friction."""
    rng = np.random.default_rng(seed)
    records = []
    for f in frequencies:
        for a in amplitudes:
            t = np.arange(2000) / (250.0 * f)
            omega = 2 * math.pi * f
            x, v = a * np.sin(omega * t), a * omega * np.cos(omega * t)
            force = product * a * omega**order * np.sin(omega * t + order * math.pi / 2)
            force = force + 400.0 * np.sign(v)
            force = force + noise * np.std(force) * rng.standard_normal(t.size)
            x = x + 1e-7 * rng.standard_normal(t.size)
            name = f"{f:g}hz-{1e3 * a:g}mm.csv"
            records.append(Record(name, t, force, x, frequency=f, amplitude=a))
    return Campaign("exact fractional records", tuple(records), device=TWELVE)


@pytest.mark.sweep
def test_designed_device_runs_on_the_rig_and_the_report_says_whether_one_model_serves():
    result = minimise_critical_frequency(TWELVE, front=False)
    loop = close_loop(result)
    assert loop["records"] >= 10 and loop["bands"]
    # Where one model does not serve, its misfit shows it: far above the noise.
    if loop["one_foim_serves"]:
        assert len(loop["bands"]) == 1 and " serves the whole range" in loop["text"]
    else:
        assert loop["one_foim"]["error_percent"] > 3.0 * loop["noise_percent"]
        assert "does not serve" in loop["text"]
    # The seals are not to blame alone: the flow by itself is judged beside.
    assert loop["one_foim_without_seal"]["error_percent"] > 0.0
    # The rig's device has the designed inertance in it: its order lies between 1 and 2.
    assert 1.0 < loop["one_foim"]["order"] < 2.0


@pytest.mark.slow
def test_records_of_one_fractional_law_are_found_to_be_served_by_one():
    campaign = fractional_campaign(1.8, 700.0, (0.5, 1.0, 2.0, 4.0, 8.0), (0.005, 0.01))
    assert judge(campaign)["one_foim_serves"]


def test_best_single_model_of_exact_records_is_the_truth():
    campaign = fractional_campaign(1.8, 700.0, (0.5, 2.0, 8.0), (0.005,))
    found = one_foim(campaign)
    assert found["order"] == pytest.approx(1.8, abs=0.01)
    assert TWELVE.inertance * (1 + found["b0"]) == pytest.approx(700.0, rel=0.03)
    assert found["error_percent"] < 2.0


def test_rig_campaign_keeps_within_the_limits_and_repeats():
    ask = {"frequencies": [1.0, 50.0], "amplitudes": [0.005], "seed": 3}
    once, twice = rig_campaign(TWELVE, **ask), rig_campaign(TWELVE, **ask)
    assert [r.frequency for r in once.records] == [1.0]
    assert np.array_equal(once.records[0].force, twice.records[0].force)
    assert once.device == TWELVE


def test_without_seals_a_slow_record_is_nearly_free_of_force():
    ask = {"frequencies": [0.1], "amplitudes": [0.005]}
    rubbing, free = (rig_campaign(TWELVE, seal=seal, **ask).records[0] for seal in (True, False))
    assert np.std(free.force) < 0.1 * np.std(rubbing.force)
