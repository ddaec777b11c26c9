"""Sampling, labels, clipping and measured derivatives of a record, against known truth."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.readers import read_campaign
from discover.readers.clipping import clipped_motion_text, clipping_text
from discover.readers.consistency import derivative_agreement
from discover.readers.sampling import regular
from discover.readers.source import row_place
from discover.records import Campaign
from models.checks import InputError
from tests.discover.readers.folder import (
    DISPLACEMENT,
    FORCE,
    HEADER,
    ONE,
    TIME,
    VELOCITY,
    campaign,
    rows,
)


def _read(
    folder: Path,
    time: np.ndarray = TIME,
    displacement: np.ndarray = DISPLACEMENT,
    force: np.ndarray = FORCE,
    *,
    labels: str = "",
) -> Campaign:
    content = HEADER + "\n" + rows(time, displacement, force)
    return read_campaign(campaign(folder / "c", content, toml=ONE + labels))


@pytest.mark.parametrize("decimals", [4, 6, 9])
def test_rounded_time_is_put_back_on_its_grid_silently(tmp_path: Path, decimals: int) -> None:
    exact = 3.7 + np.arange(2000) / 300.0
    found = _read(tmp_path, np.round(exact, decimals))
    assert found.findings == ()
    np.testing.assert_allclose(found.records[0].time, exact, atol=10.0**-decimals)
    assert found.records[0].step == pytest.approx(1.0 / 300.0, rel=1e-6)


def test_time_rounded_to_repeats_is_put_back_if_the_digit_is_fine_enough(tmp_path: Path) -> None:
    found = _read(tmp_path, np.round(np.arange(2000) / 1500.0, 3))
    assert found.records[0].step == pytest.approx(1.0 / 1500.0, rel=1e-5)
    with pytest.raises(InputError, match="time must be strictly increasing"):
        _read(tmp_path, np.round(np.arange(2000) / 4000.0, 3))


def _jittered(seed: int, share: float) -> np.ndarray:
    return TIME + share * np.random.default_rng(seed).uniform(-1.0, 1.0, TIME.size)


def test_jitter_is_resampled_to_the_true_signal_and_said(tmp_path: Path) -> None:
    time = _jittered(0, 2e-4)

    def motion(t: np.ndarray) -> np.ndarray:
        return 8.0 * np.sin(9.0 * t) + 5.0 * np.sin(5.3 * t) + 2.0 * np.sin(3.1 * t)

    found = _read(tmp_path, time, motion(time), 0.1 * motion(time + 0.03))
    (record,) = found.records
    assert np.ptp(np.diff(record.time)) < 1e-12
    np.testing.assert_allclose(record.displacement, 1e-3 * motion(record.time), atol=2e-8)
    inner = slice(5, -5)
    exact = 1e2 * motion(record.time + 0.03)
    np.testing.assert_allclose(record.force[inner], exact[inner], atol=2e-3)
    (finding,) = found.findings
    assert finding.level == "note"
    assert "resampled onto a uniform grid by a cubic spline" in finding.text


def test_a_sine_test_keeps_the_times_at_which_it_was_measured(tmp_path: Path) -> None:
    """A spline would ring beside every jump of friction, and that is no noise."""
    time = _jittered(0, 1e-3)
    turn = 2 * np.pi * 1.5
    friction = np.sign(np.cos(turn * time))
    found = _read(tmp_path, time, 10.0 * np.sin(turn * time), friction)
    (record,) = found.records
    np.testing.assert_allclose(record.time, time, atol=1e-6)
    np.testing.assert_allclose(record.force, 1e3 * friction)
    assert np.ptp(np.diff(record.even.time)) < 1e-12
    assert np.abs(record.even.force).max() > 1.1e3
    (finding,) = found.findings
    assert (finding.level, "times as measured" in finding.text) == ("note", True)


def test_resampling_error_falls_with_the_fourth_power_of_the_step() -> None:
    errors = []
    for count in (200, 400, 800):
        rng = np.random.default_rng(1)
        step = 2.0 / count
        time = np.arange(count) * step
        time[1:-1] += 0.2 * step * rng.uniform(-1.0, 1.0, count - 2)
        found = regular(
            time,
            {"x": np.sin(9.0 * time)},
            raw_time=time,
            resample=True,
            where="x",
            place=row_place,
        )
        error = found.columns["x"] - np.sin(9.0 * found.time)
        errors.append(float(np.sqrt(np.mean(error[10:-10] ** 2))))
    assert errors[1] < errors[0] / 10.0
    assert errors[2] < errors[1] / 10.0


def test_strong_jitter_is_a_warning(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    time = np.cumsum(0.005 * rng.uniform(0.6, 1.4, TIME.size))
    found = _read(tmp_path, time, 10.0 * np.sin(time**1.5))
    assert found.findings[0].level == "warning"
    assert "costs accuracy" in found.findings[0].text


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: np.insert(t, 50, t[50]),
         "line 53: time must be strictly increasing, .* repeats"),
        (lambda t: np.r_[t[:50], t[:40]],
         "line 52: time must be strictly increasing, .* it falls"),
        (lambda t: t[::-1], "time must be strictly increasing"),
        (lambda t: t[:10], "samples must be at least 16, got 10"),
        (lambda t: 0.0 * t, "time must be strictly increasing"),
    ],
)  # fmt: skip
def test_time_that_cant_be_mended(tmp_path: Path, change: object, message: str) -> None:
    time = change(TIME)
    size = time.size
    x, force = np.resize(DISPLACEMENT, size), np.resize(FORCE, size)
    with pytest.raises(InputError, match=message):
        _read(tmp_path, time, x, force)


def _three_tones(time: np.ndarray) -> np.ndarray:
    return sum(a * np.sin(w * time) for a, w in ((8.0, 9.0), (5.0, 5.3), (2.0, 3.1)))


def test_a_record_that_is_sampled_coarser_from_some_time_on_is_resampled(tmp_path: Path) -> None:
    """A quasi-static loop whose logger went from 5 to 10 ms."""
    time = np.r_[np.arange(0.0, 6.0, 0.005), np.arange(6.0, 14.0, 0.01)]
    found = _read(tmp_path, time, _three_tones(time), 0.1 * _three_tones(time + 0.03))
    (record,) = found.records
    assert record.step == pytest.approx(0.01, rel=1e-3)
    np.testing.assert_allclose(record.displacement, 1e-3 * _three_tones(record.time), atol=2e-7)
    (finding,) = found.findings
    assert finding.level == "note"
    assert "the sampling changes within the record, from 0.005 to 0.01 s" in finding.text


def test_a_logger_that_saves_little_at_rest_loses_nothing_there(tmp_path: Path) -> None:
    """One sample a second at rest, 500 Hz in a test of 5 Hz: seen to 1 % on a grid of 10 ms."""
    rest = np.arange(0.0, 40.0)
    time = np.r_[rest, np.arange(40.0, 48.0, 0.002), rest + 48.0]

    def motion(t: np.ndarray) -> np.ndarray:
        inside = (t > 40.0) & (t < 48.0)
        return np.where(inside, np.sin(10 * np.pi * t) * np.sin(np.pi * (t - 40.0) / 8.0), 0.0)

    (record,) = _read(tmp_path, time, motion(time), motion(time)).records
    assert record.step == pytest.approx(0.01, rel=0.1)
    np.testing.assert_allclose(record.displacement, 1e-3 * motion(record.time), atol=1e-5)
    moved = motion(time) + (time > 60.0) * np.sin(time)  # and now it does not rest
    with pytest.raises(InputError, match=r"time must be without gaps of more than 0.0\d+ s"):
        _read(tmp_path, time, moved, moved)


@pytest.mark.parametrize("frequency", [1.0, 2.5, 5.0])
def test_a_sine_test_whose_sampling_changes_is_one_to_every_verb(
    tmp_path: Path, frequency: float
) -> None:
    time = np.r_[0.0:4.0:0.01, 4.0:10.0:0.002]
    turn = 2 * np.pi * frequency * time
    text = HEADER + "\n" + rows(time, 10.0 * np.sin(turn), np.sin(turn + 0.3))
    found = read_campaign(campaign(tmp_path, text))
    (observed,) = observe_all(found.records, 1)
    assert observed.kind == "sine"
    assert observed.frequency == pytest.approx(frequency, rel=1e-6)
    assert any("the sampling changes within the record" in f.text for f in found.findings)


def test_a_short_gap_is_bridged_and_a_long_one_loses_the_motion(tmp_path: Path) -> None:
    for first, count in ((100, 1), (400, 10)):
        time = np.delete(TIME, slice(first, first + count))
        (record,) = _read(tmp_path, time, _three_tones(time), time).records
        np.testing.assert_allclose(record.displacement, 1e-3 * _three_tones(record.time), atol=1e-6)
    (finding,) = _read(tmp_path, time, _three_tones(time), time).findings
    assert "a gap of 0.055 s, short beside its fastest motion" in finding.text
    time = np.delete(TIME, slice(400, 500))
    with pytest.raises(InputError, match=r"line 402: time must be without .* 0.505 s from 1.9"):
        _read(tmp_path, time, _three_tones(time), time)


def _begin_again(time: np.ndarray) -> np.ndarray:
    """A motion that is where it was after 2 s."""
    return sum(a * np.sin(np.pi * n * time) for a, n in ((8.0, 3), (5.0, 2), (2.0, 1)))


@pytest.mark.parametrize("rate", [200.0, 5000.0])
def test_a_gap_amid_motion_is_refused_at_any_rate(tmp_path: Path, rate: float) -> None:
    """At a high rate nothing moves far from sample to sample; the gap is lost all the same."""
    time = np.arange(0.0, 10.0, 1.0 / rate)
    time = time[(time < 3.03) | (time > 5.03)]
    with pytest.raises(InputError, match=r"time must be without .* 2\.?\d* s from 3.0\d* s on"):
        _read(tmp_path, time, _begin_again(time), time)


def test_a_gap_while_nothing_moves_is_bridged_and_told_as_such(tmp_path: Path) -> None:
    time = np.arange(0.0, 12.0, 0.001)
    time = time[(time < 4.5) | (time > 7.5)]

    def motion(t: np.ndarray) -> np.ndarray:
        return _begin_again(np.clip(t, 0.0, 4.0)) + _begin_again(np.clip(t, 8.0, 12.0))

    found = _read(tmp_path, time, motion(time), motion(time))
    np.testing.assert_allclose(
        found.records[0].displacement, 1e-3 * motion(found.records[0].time), atol=1e-6
    )
    (finding,) = found.findings
    assert "a gap of 3.002 s, at rest or short beside its fastest motion" in finding.text


def test_a_sine_test_with_samples_missing_is_fitted_as_measured(tmp_path: Path) -> None:
    time = np.delete(TIME, slice(100, 110))
    x = 10.0 * np.sin(2 * np.pi * 1.5 * time)
    found = _read(tmp_path, time, x, x)
    assert found.records[0].time.size == TIME.size - 10
    assert "fitted at the times as measured" in found.findings[0].text


def test_standing_channels_are_errors(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a.csv: displacement must be varying, got 0 throughout"):
        _read(tmp_path, displacement=0.0 * TIME)
    with pytest.raises(InputError, match="a.csv: force must be varying, got 2000 throughout"):
        _read(tmp_path, force=2.0 + 0.0 * TIME)


def test_wrong_frequency_label_says_both(tmp_path: Path) -> None:
    turn = 2 * np.pi * 8.0
    with pytest.raises(
        InputError, match=r"a.csv: frequency .* 8 Hz, within 5 %, got the label 5 H"
    ):
        _read(tmp_path, TIME, 5 * np.sin(turn * TIME), labels='frequency = "5 Hz"\n')


@pytest.mark.parametrize("label", [1.43, 1.57])
def test_rounded_frequency_label_passes(tmp_path: Path, label: float) -> None:
    assert _read(tmp_path, labels=f'frequency = "{label} Hz"\n').findings == ()


def test_amplitude_labels(tmp_path: Path) -> None:
    assert _read(tmp_path, labels='amplitude = "10.3 mm"\n').findings == ()
    (noted,) = _read(tmp_path, labels='amplitude = "9 mm"\n').findings
    assert "amplitude is 10 mm where the label says 9 mm: the measured one is used" in noted.text
    with pytest.raises(InputError, match="10 mm, within 20 %, got the label 14 mm$"):
        _read(tmp_path, labels='amplitude = "14 mm"\n')
    with pytest.raises(InputError, match=r"got the label 20 mm \(it looks like peak to peak\)"):
        _read(tmp_path, labels='amplitude = "20 mm"\n')


def test_label_on_a_record_that_is_no_sine_is_told(tmp_path: Path) -> None:
    sweep = 10.0 * np.sin(2 * np.pi * (0.5 + 0.2 * TIME) * TIME)
    (finding,) = _read(tmp_path, displacement=sweep, labels='frequency = "1 Hz"\n').findings
    assert "is no steady sine of 1.5 cycles or more: treated as a trajectory" in finding.text


def test_force_curve_without_displacement(tmp_path: Path) -> None:
    time = np.sort(np.random.default_rng(3).uniform(0.0, 2.0, 60))
    content = "time [s],force [kN]\n" + rows(time, np.sin(3.0 * time))
    labels = 'frequency = "0.5 Hz"\namplitude = "20 mm"\n'
    found = read_campaign(campaign(tmp_path / "c", content, toml=ONE + labels))
    (record,) = found.records
    assert (record.displacement, record.uniform) == (None, False)
    np.testing.assert_allclose(record.time, time, rtol=1e-8)
    assert "the motion is made from its labels, 0.5 Hz and 20 mm" in found.findings[0].text
    for labels in ("", 'frequency = "0.5 Hz"\n'):
        with pytest.raises(InputError, match="'displacement' .* or the record's frequency and amp"):
            read_campaign(campaign(tmp_path / "c", content, toml=ONE + labels))
    labels = 'frequency = "0.1 Hz"\namplitude = "20 mm"\n'
    with pytest.raises(InputError, match="time must be over at least half a cycle"):
        read_campaign(campaign(tmp_path / "c", content, toml=ONE + labels))


def test_clipped_force_is_found_and_smooth_quantised_or_noisy_force_is_not(tmp_path: Path) -> None:
    found = _read(tmp_path, force=np.clip(FORCE, -0.8, 0.9))
    assert "largest value 900 N" in found.findings[0].text
    assert "smallest value -800 N" in found.findings[0].text
    rng = np.random.default_rng(4)
    for quantum in (1e-4, 0.01, 0.1, 0.3):
        assert clipping_text(quantum * np.round(FORCE / quantum)) == ""
    assert clipping_text(FORCE + 0.01 * rng.standard_normal(TIME.size)) == ""


@pytest.mark.parametrize("share", [0.7, 0.9, 0.97])
def test_a_clipped_displacement_is_told_from_a_drive_that_rests(
    tmp_path: Path, share: float
) -> None:
    rng = np.random.default_rng(6)
    x = DISPLACEMENT + 0.005 * rng.standard_normal(TIME.size)
    found = _read(tmp_path, displacement=np.clip(x, -10.0 * share, 10.0 * share))
    assert (
        f"displacement stays at its largest value {0.01 * share:g} m for" in found.findings[0].text
    )
    ramp = np.clip(np.abs((TIME % 2.0) - 1.0) * 1.5 - 0.25, 0.0, 1.0)  # to and fro, with rests
    eased = np.convolve(ramp, np.hanning(33) / np.hanning(33).sum(), mode="same")
    assert clipped_motion_text(np.round(eased, 4)) == ""
    assert clipped_motion_text(np.round(DISPLACEMENT, 1)) == ""


def test_a_handful_of_samples_is_a_warning(tmp_path: Path) -> None:
    found = _read(tmp_path, TIME[:16], DISPLACEMENT[:16], FORCE[:16])
    assert "only 16 samples: too few to tell a law from noise" in found.findings[0].text


@pytest.mark.parametrize("cycles", [2.3, 15.0])
def test_integration_by_parts_needs_no_whole_cycles(cycles: float) -> None:
    step = cycles / 1.5 / 1999
    turn = 2 * np.pi * 1.5
    t = np.arange(2000) * step
    x = np.sin(turn * t) + 0.3 * np.cos(3 * turn * t) + 5.0
    v = turn * (np.cos(turn * t) - 0.9 * np.sin(3 * turn * t))
    a = -(turn**2) * (np.sin(turn * t) + 2.7 * np.cos(3 * turn * t))
    for order, signal in ((1, v), (2, a)):
        found = derivative_agreement(x, signal, step, order=order)
        assert found.gain == pytest.approx(1.0, abs=1e-6)
        assert found.phase == pytest.approx(0.0, abs=1e-6)
        assert found.residual < 1e-5
    delayed = turn * np.cos(turn * (t - 0.01))
    assert derivative_agreement(np.sin(turn * t), delayed, step, order=1).phase == pytest.approx(
        -0.01 * turn, abs=0.01
    )


def test_noisy_but_true_derivatives_are_kept() -> None:
    rng = np.random.default_rng(5)
    turn = 2 * np.pi * 1.5
    x = np.sin(turn * TIME) + 1e-3 * rng.standard_normal(TIME.size)
    a = -(turn**2) * np.sin(turn * TIME)
    noisy = a + 0.2 * np.std(a) * rng.standard_normal(TIME.size)
    assert derivative_agreement(x, noisy, 0.005, order=2).accepted


@pytest.mark.parametrize(
    ("factor", "reason"),
    [
        (1.0, None),
        (-1.0, "its sign is opposite"),
        (1e3, "it is off by a factor of 1000: its unit?"),
        (1e-3, "it is off by a factor of 0.001: its unit?"),
        (1.2, r"it is \+20.0 % off"),
    ],
)
def test_measured_velocity_is_kept_or_rejected_with_a_reason(
    tmp_path: Path, factor: float, reason: str | None
) -> None:
    content = HEADER + ",velocity [mm/s]\n" + rows(TIME, DISPLACEMENT, FORCE, factor * VELOCITY)
    found = read_campaign(campaign(tmp_path / "c", content))
    (record,) = found.records
    if reason is None:
        np.testing.assert_allclose(record.velocity, 1e-3 * VELOCITY, rtol=1e-7, atol=1e-9)
        assert found.findings == ()
    else:
        assert record.velocity is None
        text = found.findings[0].text
        assert "the measured velocity disagrees with the displacement" in text
        assert re.search(reason, text)


def _with_acceleration(folder: Path, acceleration: np.ndarray) -> Campaign:
    content = HEADER + ",acceleration [m/s^2]\n"
    content += rows(TIME, DISPLACEMENT, FORCE, acceleration)
    return read_campaign(campaign(folder, content))


def test_unrelated_acceleration_is_rejected(tmp_path: Path) -> None:
    wandering = 0.05 * np.cumsum(np.random.default_rng(6).standard_normal(TIME.size))
    for place, signal in enumerate((wandering, np.cos(16.0 * TIME))):
        found = _with_acceleration(tmp_path / str(place), signal)
        assert found.records[0].acceleration is None
        assert "the measured acceleration disagrees" in found.findings[0].text
        assert found.findings[0].level == "warning"


def test_an_acceleration_whose_noise_hides_the_motion_is_not_called_wrong(tmp_path: Path) -> None:
    true = -0.01 * (2 * np.pi * 1.5) ** 2 * np.sin(2 * np.pi * 1.5 * TIME)
    noise = 9.8 * np.random.default_rng(6).standard_normal(TIME.size)
    for place, signal in enumerate((noise, true + noise)):
        found = _with_acceleration(tmp_path / str(place), signal)
        assert found.records[0].acceleration is None
        (finding,) = found.findings
        assert "acceleration is not used: its noise hides" in finding.text
        assert finding.level == "note"
