"""How far forces are from measured ones: errors that are known shares of the measured force."""

from functools import cache

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.records import Record
from discover.rows import (
    accuracy,
    alike_percent,
    compared_with,
    noise_percent,
    pooled_percent,
    record_rows,
    unexplained,
)
from discover.rows.held_out import held_out_findings
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import device, record


def sine(frequency=1.0, amplitude=0.01, *, noise=0.01, seed=0, cycles=8):
    rng = np.random.default_rng(seed)
    return observe(record(frequency, amplitude, device, rng, noise=noise, cycles=cycles))


def lines(frequencies, *, noise=0.01, seed=0):
    """Return a test whose motion has lines of equal size at some frequencies, Hz."""
    time = np.arange(6000) / 200.0
    omega = 2.0 * np.pi * np.asarray(frequencies)
    turn = np.outer(time, omega) + 1.7 * np.arange(omega.size) ** 2
    x, v = 1e-3 * np.sin(turn).sum(axis=1), 1e-3 * (np.cos(turn) * omega).sum(axis=1)
    force = 800.0 * v + 4e3 * x
    force = force + noise * np.std(force) * np.random.default_rng(seed).standard_normal(time.size)
    return observe(Record(f"lines-{seed}.csv", time, force, x))


def repeating(**options):
    return lines(np.linspace(0.5, 6.0, 23), **options)


def random(**options):
    return lines(np.geomspace(0.51, 6.1, 23), **options)


KINDS = {"sine": sine, "periodic": repeating, "trajectory": random}


def off(observation, share):
    """Return the accuracy of the measured force less a share of it."""
    return compared_with(observation, (1.0 - share) * observation.measured)


@pytest.mark.parametrize("kind", KINDS)
def test_a_share_of_the_force_is_that_many_percent(kind):
    seen = KINDS[kind]()
    found = off(seen, 0.1)
    assert found.relative_percent == pytest.approx(10.0, rel=1e-9)
    assert found.samples == seen.measured.size
    peak = np.abs(found.model_force).max()
    assert found.peak == peak
    of_peak = 100.0 * np.sqrt(found.error_power) / peak
    assert found.of_peak_percent == pytest.approx(of_peak, rel=1e-12)
    assert compared_with(seen, 0.0 * seen.measured).of_peak_percent == float("inf")
    # Its power is the mean square in the band, but for the ends of what does not repeat.
    assert found.force_power == pytest.approx(np.mean(seen.measured**2), rel=0.1)
    assert found.error_power == pytest.approx(0.01 * found.force_power, rel=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_what_lies_above_the_band_is_no_error_where_the_band_s_slope_is(kind):
    seen = KINDS[kind]()
    assert seen.kind == kind
    wave = np.sin(2.0 * np.pi * 45.0 * seen.time)
    found = compared_with(seen, seen.measured + wave)
    expected = 0.0 if kind == "trajectory" else 0.5
    assert found.error_power == pytest.approx(expected, abs=1e-3)


def test_the_exact_law_is_met_to_the_noise():
    law = ForceModel((FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0)))
    found = accuracy(sine(noise=0.02, cycles=20), law)
    assert found.noise_percent == pytest.approx(2.0, rel=0.1)
    assert found.relative_percent == pytest.approx(2.0, rel=0.1)


def test_records_together_count_by_samples_and_power_or_alike():
    loud, quiet = sine(2.0, 0.02, cycles=8), sine(1.0, 0.005, cycles=16)
    parts = [off(loud, 0.1), off(quiet, 0.3)]
    force = [o.samples * np.mean(o.measured**2) for o in (loud, quiet)]
    error = 0.1**2 * force[0] + 0.3**2 * force[1]
    assert loud.samples < quiet.samples
    assert pooled_percent(parts) == pytest.approx(100.0 * np.sqrt(error / sum(force)), rel=1e-9)
    assert alike_percent(parts) == pytest.approx(100.0 * np.sqrt((0.01 + 0.09) / 2.0), rel=1e-9)
    noise = sum(a.samples * a.noise_power for a in parts)
    assert noise_percent(parts) == pytest.approx(100.0 * np.sqrt(noise / sum(force)), rel=1e-9)
    assert pooled_percent([]) == noise_percent([]) == alike_percent([]) == 0.0


@pytest.mark.parametrize("share", [0.03, 0.1])
def test_unexplained_is_what_is_left_beyond_the_noise(share):
    seen = [sine(1.0, 0.01, seed=1), sine(2.0, 0.004, seed=2), random(seed=3)]
    rows = [record_rows(o) for o in seen]
    found = unexplained(rows, [(1.0 - share) * r.target for r in rows])
    assert found.percent == pytest.approx(100.0 * share, rel=0.02)
    low, high = found.interval
    assert low < found.percent < high < 1.2 * found.percent
    assert found.to_dict() == {"value": found.percent, "interval": [low, high]}


def test_nothing_is_unexplained_where_noise_is_all_that_is_left():
    rng = np.random.default_rng(0)
    rows = [record_rows(o) for o in (sine(seed=1), random(seed=2))]
    found = unexplained(rows, [r.target - rng.standard_normal(r.target.size) for r in rows])
    assert found.interval[0] == 0.0
    assert found.interval[1] < 1.0


@cache
def fitted():
    return [off(sine(f, a, seed=4), 0.01) for f, a in ((1.0, 0.01), (2.0, 0.02))]


def held_out(*unseen):
    return held_out_findings(fitted(), [off(sine(f, a, seed=5), s) for f, a, s in unseen])


@pytest.mark.parametrize(
    ("frequency", "amplitude", "beyond"),
    [
        (1.5, 0.012, ""),
        (4.0, 0.01, "; it goes beyond them in frequency (4 Hz, they up to 2)"),
        (0.7, 0.02, "; it goes beyond them in frequency (0.7 Hz, they from 1)"),
        (2.0, 0.004, "; it goes beyond them in amplitude (4 mm, they from 10) and speed"
         " (0.0503 m/s, they from 0.0628)"),
        (1.0, 0.03, "; it goes beyond them in amplitude (30 mm, they up to 20)"),
    ],
)  # fmt: skip
def test_a_record_that_is_not_met_is_told_with_what_is_beyond_the_fitted(
    frequency, amplitude, beyond
):
    (finding,) = held_out((frequency, amplitude, 0.2))
    assert finding.level == "warning"
    assert finding.record == f"{frequency:g}hz-{1e3 * amplitude:g}mm.csv"
    start = "1 of 1 records that are held out is met worse than the fitted ones, this one to 20 %"
    assert finding.text.startswith(start)
    assert f"){beyond}. What only it shows" in finding.text


def test_the_worst_of_several_is_told_and_those_that_are_met_are_not_counted():
    met, bad, worse = (1.0, 0.01, 0.005), (1.5, 0.012, 0.1), (1.2, 0.015, 0.3)
    (finding,) = held_out(met, bad, worse)
    assert finding.record == "1.2hz-15mm.csv"
    assert finding.text.startswith("2 of 3 records that are held out are met worse")
    assert held_out(met) == []
    assert held_out() == []
