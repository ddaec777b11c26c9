import numpy as np
import pytest

from models.checks import InputError
from models.rig import Chain, measure

RATE = 1000.0
TIME = np.arange(40000) / RATE
SINE = 500.0 * np.sin(2 * np.pi * 1.5 * TIME)
RMS = 500.0 / np.sqrt(2.0)
STROKE = 0.005 * np.cos(2 * np.pi * 1.5 * TIME)
for _values in (TIME, SINE, STROKE):
    _values.flags.writeable = False
QUIET = {"hum": 0.0, "displacement_noise": 0.0, "bits": 0}


def taken(chain, seed=0, **options):
    return measure(TIME, STROKE, SINE, chain, np.random.default_rng(seed), **options)


def test_ideal_chain_changes_nothing():
    x, f = taken(Chain.ideal())
    np.testing.assert_array_equal(x, STROKE)
    np.testing.assert_array_equal(f, SINE)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_noise_has_the_size_and_colour_asked_for(share):
    _, f = taken(Chain(noise=0.02, low_frequency=share, correlation_time=0.02, **QUIET))
    error = f - SINE
    assert np.sqrt(np.mean(error**2)) == pytest.approx(0.02 * RMS, rel=0.05)
    lag = 20
    correlation = np.mean(error[lag:] * error[:-lag]) / np.mean(error**2)
    assert correlation == pytest.approx(share * np.exp(-1.0), abs=0.05)


def test_reference_replaces_the_records_own_force():
    _, f = taken(Chain(noise=0.01, **QUIET), reference=1e4)
    assert np.std(f - SINE) == pytest.approx(100.0, rel=0.05)


def test_hum_is_at_the_mains_with_its_amplitude():
    chain = Chain(noise=0.0, hum=0.01, mains=60.0, displacement_noise=0.0, bits=0)
    _, f = taken(chain)
    lines = np.abs(np.fft.rfft(f - SINE)) * 2 / TIME.size
    rates = np.fft.rfftfreq(TIME.size, 1 / RATE)
    assert rates[np.argmax(lines)] == pytest.approx(60.0)
    assert np.max(lines) == pytest.approx(0.01 * RMS, rel=1e-6)
    assert lines[np.argmin(np.abs(rates - 180.0))] == pytest.approx(0.01 * RMS / 3, rel=1e-6)


def test_delay_turns_the_phase():
    _, f = taken(Chain(noise=0.0, delay=0.0023, **QUIET))
    expected = 500.0 * np.sin(2 * np.pi * 1.5 * (TIME - 0.0023))
    np.testing.assert_allclose(f[10:], expected[10:], atol=1e-3)


def test_resolution_and_range():
    chain = Chain(
        noise=0.0,
        hum=0.0,
        displacement_noise=0.0,
        bits=12,
        force_range=400.0,
        displacement_range=0.01,
    )
    x, f = taken(chain)
    step = 800.0 / 4096
    np.testing.assert_allclose(f / step, np.round(f / step), atol=1e-9)
    assert np.max(f) == 400.0
    inside = np.abs(SINE) < 399.0
    assert np.max(np.abs(f - SINE)[inside]) <= 0.5001 * step
    assert np.max(np.abs(x - STROKE)) <= 0.5001 * 0.02 / 4096


def test_some_cycles_break_and_the_others_stay():
    chain = Chain(noise=0.0, broken_cycles=0.2, **QUIET)
    _, f = taken(chain, frequency=1.5)
    cycles = np.floor(TIME * 1.5).astype(int)
    broken = {int(c) for c in np.unique(cycles[f != SINE])}
    assert 4 <= len(broken) <= 24
    _, whole = taken(chain)
    np.testing.assert_array_equal(whole, SINE)


def test_displacement_noise():
    x, _ = taken(Chain(noise=0.0, hum=0.0, displacement_noise=3e-6, bits=0))
    assert np.std(x - STROKE) == pytest.approx(3e-6, rel=0.05)


def test_one_generator_decides_everything():
    chain = Chain(broken_cycles=0.1)
    one, two, three = (taken(chain, seed, frequency=1.5)[1] for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, two)
    assert not np.array_equal(one, three)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"noise": -0.1}, "noise"),
        ({"low_frequency": 1.5}, "low_frequency"),
        ({"bits": 64}, "bits"),
        ({"delay": np.nan}, "delay"),
        ({"force_range": 0.0}, "force_range"),
        ({"reference": "peak"}, "reference must be one of record, campaign"),
    ],
)
def test_impossible_chains_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        Chain(**values)


def test_bad_records_are_refused():
    rng = np.random.default_rng(0)
    with pytest.raises(InputError, match="force must be of shape"):
        measure(TIME, STROKE, SINE[:-1], Chain(), rng)
    with pytest.raises(InputError, match="time must be uniform"):
        measure(TIME**2, STROKE, SINE, Chain(), rng)
    with pytest.raises(InputError, match="displacement must be finite"):
        measure(TIME, STROKE * np.nan, SINE, Chain(), rng)
