import dataclasses
import math
import re
import xml.etree.ElementTree as ElementTree

import pytest

from discover.figure_data import PlanFigureData, PlannedTest
from discover.plots.plan_map import plan_map
from discover.plots.separation_matrix import separation_matrix
from models.device import Device
from models.flow import dean_per_speed
from tests.discover.data_check.plan import SINGLE, WIDE, checked

SVG = "{http://www.w3.org/2000/svg}"


def words(svg):
    return [t.text for t in ElementTree.fromstring(svg).iter(f"{SVG}text")]


def planned(frequency, amplitude, **options):
    values = {"kind": "sine", "held_out": False, "noise_percent": 1.3, "level": ""} | options
    return PlannedTest(file="a.csv", frequency=frequency, amplitude=amplitude, **values)


GRID = tuple(planned(f, a) for f in (0.1, 0.5, 2.0, 10.0) for a in (0.002, 0.01))


@pytest.fixture(scope="module")
def single():
    return checked(SINGLE)


def test_map_has_both_axes_in_units_and_each_tests_noise():
    labels = words(plan_map(PlanFigureData(GRID)))
    assert {"Frequency (Hz)", "Displacement amplitude (mm)", "noise 0.5 to 2 %"} <= set(labels)
    assert labels.count("1.3 %") == len(GRID)


def test_map_leaves_out_numbers_that_would_lie_on_each_other():
    beside = planned(0.101, 0.01, noise_percent=1.4)
    above = planned(0.1, 0.0101, noise_percent=1.5)
    labels = words(plan_map(PlanFigureData((*GRID, beside, above))))
    assert labels.count("1.3 %") == len(GRID) - 1
    assert "1.4 %" not in labels


def test_tests_of_which_the_same_noise_is_written_have_one_colour():
    plan = (planned(0.5, 0.005, noise_percent=1.98), planned(5.0, 0.005, noise_percent=2.02))
    labels = words(plan_map(PlanFigureData(plan)))
    assert labels.count("2 %") == 2
    assert sum(label.startswith("noise") for label in labels) == 1


def test_map_tells_findings_held_out_tests_and_unknown_noise_apart():
    odd = (
        planned(1.0, 0.005, level="warning"),
        planned(2.0, 0.005, level="error"),
        planned(4.0, 0.005, held_out=True),
        planned(8.0, 0.005, noise_percent=None),
        planned(8.0, 0.009, noise_percent=40.0),
    )
    labels = set(words(plan_map(PlanFigureData(odd))))
    assert {"warning", "error", "noise 0.5 to 2 %, held out", "noise not known"} <= labels
    assert "noise above 20 %" in labels
    assert not {"warning", "error"} & set(words(plan_map(PlanFigureData(GRID))))


def test_map_draws_dean_100_by_both_conventions_where_it_lies_among_the_tests():
    device = Device.preset("device-12")
    scale = [dean_per_speed(device, convention=c) for c in ("paper", "standard")]
    labels = words(plan_map(PlanFigureData(GRID, *scale)))
    assert labels.count("De 100") == 2
    assert {"De 100, paper convention", "De 100, standard convention"} <= set(labels)
    slow = tuple(dataclasses.replace(t, frequency=1e-3 * t.frequency) for t in GRID)
    assert "De 100" not in words(plan_map(PlanFigureData(slow, *scale)))
    assert "De 100" not in words(plan_map(PlanFigureData(GRID)))


def test_map_leaves_out_a_number_that_would_lie_on_the_label_of_a_dean_line():
    plan = (*GRID, planned(0.1, 0.02, noise_percent=1.7))
    assert "1.7 %" in words(plan_map(PlanFigureData(plan)))
    at_test = 2.0 * math.pi * 0.1 * 0.02  # m/s
    found = {
        share: words(plan_map(PlanFigureData(plan, 100.0 / (share * at_test), None)))
        for share in (0.5, 0.6, 0.7, 0.8, 0.9)
    }
    assert all("De 100" in labels for labels in found.values())
    assert not all("1.7 %" in labels for labels in found.values())


def test_dean_lines_lie_at_a_hundred():
    """Slope -1 through speed 100 / (De per speed), by the paper's formula written out."""
    device = Device.preset("device-12")
    area = math.pi * (device.cylinder_radius**2 - device.rod_radius**2)
    channel = math.pi * device.channel_radius**2
    per_speed = 2.0 * 2.0 * device.channel_radius * area / channel
    per_speed *= device.fluid.density / device.fluid.viscosity
    per_speed *= math.sqrt(2.0 * device.channel_radius / device.helix_radius)
    at_criterion = 100.0 / per_speed / (2.0 * math.pi * 0.5)  # m, at 0.5 Hz
    tests = tuple(planned(0.5 * k, k * at_criterion) for k in (0.5, 1.0, 2.0))
    svg = plan_map(PlanFigureData(tests, dean_per_speed(device), None))
    point = r"([-\d.]+) ([-\d.]+)"
    line = re.search(rf'<path d="M {point} *\n?L {point}[^"]*"[^>]*dasharray', svg)
    x0, y0, x1, y1 = map(float, line.groups())
    marks = [
        (float(x), float(y))
        for x, y in re.findall(r'<use [^>]*x="([\d.]+)" y="([\d.]+)"[^>]*fill: #21918c', svg)
    ]
    on_line = [abs(y - (y0 + (y1 - y0) * (x - x0) / (x1 - x0))) < 0.5 for x, y in marks]
    assert sum(on_line) == 1


def test_no_map_without_a_frequency():
    assert plan_map(PlanFigureData(())) is None


@pytest.mark.parametrize("frequency", [0.1, 0.17, 1.3, 3.0, 7.0])
def test_map_of_one_test_has_two_labels_on_each_axis(frequency):
    svg = plan_map(PlanFigureData((planned(frequency, 0.003, noise_percent=None),)))
    numbers = [w for w in words(svg) if re.fullmatch(r"[\d.]+", w)]
    assert len(numbers) >= 4


def test_matrix_shows_every_gap_and_what_is_open(single):
    labels = words(separation_matrix(single.to_dict()))
    assert labels.count("nested") == 2
    assert labels.count("0") >= 4  # FOIM against each other structure, and IOIM-linear against FOIM
    assert {"True structure", "Fitted structure", "Expected gap (nats)"} <= set(labels)
    assert "below 3 nats: can't be told apart" in labels
    assert "Condition number" in labels
    assert len([w for w in labels if "rank 3 of 3" in w]) == 2


def test_matrix_of_a_wide_plan_leaves_nothing_open():
    wide = checked(WIDE).to_dict()
    labels = words(separation_matrix(wide))
    assert "below 3 nats: can't be told apart" not in labels
    assert "above 100 nats: told apart" in labels


def test_matrix_says_where_a_structure_has_no_unique_solution(single):
    document = single.to_dict()
    document["structures"][2] |= {"condition": None, "rank": 3}
    assert "no unique solution · rank 3 of 4" in words(separation_matrix(document))
    assert separation_matrix(document | {"structures": []}) is None


def test_windows_of_a_trajectory_stand_on_the_map_too(single):
    assert [t.frequency for t in single.figure_data.tests] == pytest.approx([2.0] * 3, rel=1e-3)
    window = planned(1.0, 0.01, kind="trajectory")
    labels = words(plan_map(PlanFigureData((window,))))
    assert "noise 0.5 to 2 %" in labels
    assert "1.3 %" not in labels


def test_drawing_twice_gives_the_same_bytes(single):
    document = single.to_dict()
    assert separation_matrix(document) == separation_matrix(document)
    assert plan_map(single.figure_data) == plan_map(single.figure_data)
