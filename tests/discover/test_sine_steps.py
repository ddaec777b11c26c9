"""A stepped sine in one record is several sine tests; nothing else is."""

import datetime

import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.readers import read_campaign
from discover.readers.draft import draft_campaign
from discover.readers.draft_tables import Answers
from discover.record_checks import check_records
from discover.records import Campaign, Record
from discover.sine_fit import sine_steps

RATE = 500.0
TIME = np.arange(20_000) / RATE


def stepped(steps, *, noise=1e-3, seed=0):
    """Return time and displacement of steps of (frequency, amplitude, cycles), each from zero."""
    parts = []
    for frequency, amplitude, cycles in steps:
        t = np.arange(round(cycles / frequency * RATE)) / RATE
        parts.append(amplitude * np.sin(2.0 * np.pi * frequency * t))
    x = np.concatenate(parts)
    x = x + noise * np.abs(x).max() * np.random.default_rng(seed).standard_normal(x.size)
    return np.arange(x.size) / RATE, x


BEGIN = datetime.datetime(2026, 5, 3, 23, 59, 56, 123_400, datetime.UTC)
FREQUENCIES = ((0.5, 0.01, 4), (1.0, 0.01, 5), (2.0, 0.01, 8), (5.0, 0.01, 12))
AMPLITUDES = ((1.0, 0.002, 6), (1.0, 0.004, 6), (1.0, 0.01, 6))


@pytest.mark.parametrize("steps", [FREQUENCIES, AMPLITUDES])
@pytest.mark.parametrize("offset", [0.0, 0.03])
def test_each_step_is_found_within_its_own_time(steps, offset):
    time, x = stepped(steps)
    found = sine_steps(time, x + offset)
    ends = np.cumsum([0.0, *(cycles / frequency for frequency, _, cycles in steps)])
    assert len(found) == len(steps)
    for (first, last), begin, end, (frequency, _, _) in zip(
        found, ends[:-1], ends[1:], steps, strict=True
    ):
        assert begin - 0.05 / frequency < first < last < end + 0.05 / frequency
        assert (last - first) * frequency > 2.0
        # The first cycle is left out: the device settles in it.
        assert first > begin + 0.9 / frequency


OTHERS = {
    "sine": np.sin(9.0 * TIME),
    "linear sweep": np.sin(2.0 * np.pi * (0.5 * TIME + 0.05 * TIME**2)),
    "slow sweep": np.sin(2.0 * np.pi * (TIME + 0.002 * TIME**2)),
    "logarithmic sweep": np.sin(2.0 * np.pi * 0.3 * 11.76 * (30.0 ** (TIME / 40.0) - 1.0)),
    "growing sine": (1.0 + TIME / 40.0) * np.sin(9.0 * TIME),
    "free decay": np.exp(-TIME / 9.0) * np.sin(9.0 * TIME),
    "two sines": np.sin(9.0 * TIME) + 0.5 * np.sin(13.0 * TIME),
    "random": np.convolve(np.random.default_rng(0).standard_normal(20_000), np.hanning(99), "same"),
    "ramp": TIME,
    "steps": np.round(TIME / 4.0),
}


@pytest.mark.parametrize("name", OTHERS)
def test_no_other_motion_is_one(name):
    x = OTHERS[name] + 1e-3 * np.random.default_rng(1).standard_normal(TIME.size)
    assert sine_steps(TIME, x) == []


def written(folder, clock="{:.4f}".format):
    """Write a stepped sine of a spring and a damper with 1 % of noise, its times by `clock`."""
    time, x = stepped(FREQUENCIES, noise=0.0)
    force = 2e4 * x + 300.0 * np.gradient(x, time)
    force += 0.01 * force.std() * np.random.default_rng(3).standard_normal(x.size)
    text = "time [s],displacement [mm],force [N]\n"
    rows = zip(time, 1e3 * x, force, strict=True)
    text += "".join(f"{clock(t)},{p:.6f},{f:.4f}\n" for t, p, f in rows)
    (folder / "all.csv").write_text(text)
    return time, x, force


def of_day(time):
    return (BEGIN + datetime.timedelta(seconds=time)).strftime("%H:%M:%S.%f")[:-2]


def of_date(time):
    return (BEGIN + datetime.timedelta(seconds=time)).strftime("%Y-%m-%d %H:%M:%S.%f")[:-2]


def of_unix(time):
    return f"{BEGIN.timestamp() + time:.4f}"


@pytest.mark.parametrize("clock", ["{:.4f}".format, of_day, of_date, of_unix])
def test_a_drafted_campaign_has_a_sine_test_of_each_step(tmp_path, clock):
    written(tmp_path, clock)
    draft = draft_campaign(tmp_path, ["all.csv"], title="t", answers=Answers({}, {}))
    (tmp_path / "campaign.toml").write_text(draft.toml())
    campaign = read_campaign(tmp_path)
    observed = observe_all(campaign.records, 1)
    assert [o.kind for o in observed] == ["sine"] * len(FREQUENCIES)
    found = [o.frequency for o in observed]
    assert found == pytest.approx([f for f, _, _ in FREQUENCIES], rel=1e-3)
    assert [r.held_out for r in campaign.records].count(True) == 1
    checks = check_records(campaign, observed).records
    for check, (frequency, _, _) in zip(checks, FREQUENCIES, strict=True):
        # 1 % is of all steps; each has its own share of the force.
        assert check.force_noise_percent < 2.5
        assert check.frequency_hz == pytest.approx(frequency, rel=1e-3)


def test_a_record_of_several_steps_is_warned_of(tmp_path):
    time, x, force = written(tmp_path)
    campaign = Campaign("t", (Record("all.csv", time, force, x),))
    findings = check_records(campaign, observe_all(campaign.records, 1)).findings
    (finding,) = (f for f in findings if "stepped sine" in f.text)
    assert finding.level == "warning"
    assert finding.record == "all.csv"
    assert "of 4 steps" in finding.text
