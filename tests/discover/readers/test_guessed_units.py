"""Units that nobody states, by the values; lines that hold nothing below a header."""

import numpy as np
import pytest

from discover.readers import read_campaign
from discover.readers.guess import guess_table
from discover.readers.source import Source
from tests.discover.readers.folder import DISPLACEMENT, FORCE, HEADER, TIME, campaign, rows


@pytest.mark.parametrize(("stroke", "unit"), [(0.005, "m"), (0.1, "m"), (0.8, "mm"), (40.0, "mm")])
def test_a_stroke_of_less_than_a_hand_s_width_is_of_metres(stroke, unit):
    columns = [TIME, stroke / 10.0 * DISPLACEMENT, FORCE]
    table = Source("a.csv", ("Time [s]", "Weg", "Kraft [kN]"), lambda i: [columns[k] for k in i])
    guess = guess_table(table).columns["displacement"]
    assert (guess.header, guess.unit, guess.unit_guessed) == ("Weg", unit, True)


@pytest.mark.parametrize(
    ("step", "unit"), [(5e-4, "s"), (5e-2, "s"), (5.0, "ms"), (5e3, "us"), (5e6, "ns")]
)
def test_time_has_the_coarsest_unit_that_samples_a_motion(step, unit):
    columns = [step * np.arange(TIME.size), DISPLACEMENT, FORCE]
    headers = ("time", "displacement [mm]", "force [kN]")
    table = Source("a.csv", headers, lambda i: [columns[k] for k in i])
    assert guess_table(table).columns["time"].unit == unit


@pytest.mark.parametrize("count", [10, TIME.size])
def test_what_has_no_unit_is_in_si(count):
    names = {
        "force": "N", "velocity": "m/s", "acceleration": "m/s^2", "temperature": "degC",
    }  # fmt: skip
    columns = [c[:count] for c in (TIME, 1e-3 * DISPLACEMENT, FORCE, FORCE, FORCE, FORCE)]
    table = Source("a.csv", ("time", "displacement", *names), lambda i: [columns[k] for k in i])
    found = guess_table(table)
    assert not found.lacks
    units = {quantity: guess.unit for quantity, guess in found.columns.items()}
    assert units == {"time": "s", "displacement": "m", **names}


@pytest.mark.parametrize("before", [0, 1, 3])
def test_marks_instead_of_numbers_are_told_wherever_they_stand_below_the_header(tmp_path, before):
    marks = ["-,-,-\n"] * (before + 1)
    text = HEADER + "\n" + "".join(marks) + rows(TIME, DISPLACEMENT, FORCE)
    found = read_campaign(campaign(tmp_path / "c", text))
    told = " ".join(f.text for f in found.findings)
    for line in range(2, before + 3):
        assert f"line {line} " in told
    np.testing.assert_allclose(found.records[0].force, 1e3 * FORCE, rtol=1e-6, atol=1e-3)
