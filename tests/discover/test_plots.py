import dataclasses
import re
import xml.etree.ElementTree as ElementTree

import matplotlib

from discover.plots.errors import error_by_record
from discover.plots.loops import record_curves
from discover.plots.probabilities import probability_bars
from discover.plots.record_map import record_map, relative_interval
from discover.plots.representative import representative
from discover.plots.style import STRUCTURE_COLOURS, house_style
from tests.discover.sample_study import AMPLITUDES, FREQUENCIES, sample_data, sample_document

SVG = "{http://www.w3.org/2000/svg}"


def words(svg):
    return [t.text for t in ElementTree.fromstring(svg).iter(f"{SVG}text")]


def marks(svg, colour):
    """Return the number of markers filled or edged with `colour`, legend included."""
    return len(re.findall(rf"<use [^>]*(?:fill|stroke): {colour}", svg))


def test_map_shows_every_test_once_with_axes_in_units():
    data = sample_data()
    svg = record_map(sample_document(), data)
    labels = words(svg)
    assert {"Frequency (Hz)", "Displacement amplitude (mm)", "De 100"} <= set(labels)
    fitted = [r for r in data.records if not r.held_out]
    drawn = sum(marks(svg, STRUCTURE_COLOURS[s]) for s in {r.structure for r in data.records})
    legend = len({(r.structure, r.held_out) for r in data.records})
    assert drawn == len(data.records) + legend
    assert len(fitted) < len(data.records) < len(FREQUENCIES) * len(AMPLITUDES)


def test_map_names_the_convention_of_its_dean_lines():
    document = sample_document()
    document["dean_check"]["convention"] = "standard"
    assert "Dean number (standard convention)" in words(record_map(document, sample_data()))


def test_map_without_device_or_sine_tests():
    data = dataclasses.replace(sample_data(), dean_per_speed_paper=None)
    assert not [w for w in words(record_map(sample_document(), data)) if w.startswith("De ")]
    other = tuple(dataclasses.replace(r, frequency=None, amplitude=None) for r in data.records)
    assert record_map(sample_document(), dataclasses.replace(data, records=other)) is None


def test_map_of_one_test_has_axes_of_finite_width():
    data = dataclasses.replace(sample_data(), records=sample_data().records[:1])
    assert "Frequency (Hz)" in words(record_map(sample_document(), data))


def test_interval_of_a_boundary_else_its_bracket():
    boundary = {"coordinate": 2.0, "bracket": [1.0, 4.0]}
    assert relative_interval(boundary) == (0.5, 2.0)
    assert relative_interval(boundary | {"interval": [1.5, 3.0]}) == (0.75, 1.5)
    assert relative_interval({"coordinate": 2.0}) is None
    assert relative_interval({"coordinate": 2.0, "bracket": [1.0, None]}) is None


def test_a_boundary_in_frequency_stands_upright():
    document = sample_document()
    document["coordinate"] = "frequency"
    document["boundaries"][0] |= {"coordinate": 1.2, "interval": [1.0, 1.4], "frequency_hz": 9.9}
    svg = record_map(document, sample_data())
    line = next(
        path
        for path in re.findall(r'<path d="([^"]+)"[^>]*stroke: #1d2733; stroke-width: 1.8', svg)
    )
    abscissae = {float(a) for a in re.findall(r"[ML] ([\d.]+) ", line)}
    assert len(abscissae) == 1


def test_loops_show_both_curves_in_prefixed_units():
    fast = max(sample_data().records, key=lambda r: abs(r.force).max())
    labels = words(record_curves(fast, name="fast"))
    assert {"Time (s)", "Force (kN)", "Velocity (m/s)", "measured", "model"} <= set(labels)


def test_file_names_are_shown_as_they_are_not_as_formulas():
    record = dataclasses.replace(sample_data().records[0], file="a_$x$<1>.csv", frequency=None)
    data = dataclasses.replace(sample_data(), records=(record,))
    assert "a_$x$<1>.csv" in words(error_by_record(data)[0])


def test_errors_show_each_record_once_in_two_pictures_with_one_axis():
    data = sample_data()
    pictures = error_by_record(data)
    assert len(pictures) == 2
    rows = [w for svg in pictures for w in words(svg) if w.endswith(" mm")]
    assert len(rows) == len(set(rows)) == len(data.records)
    axes = [[w for w in words(svg) if w.replace(".", "").isdigit()] for svg in pictures]
    assert axes[0] == axes[1]
    few = dataclasses.replace(data, records=data.records[:3])
    assert len(error_by_record(few)) == 1
    assert error_by_record(dataclasses.replace(data, records=())) == []


def test_a_few_records_cover_bands_and_a_held_out_one():
    data = sample_data()
    chosen = representative(data.records)
    assert len(chosen) == 4
    assert {r.band for r in chosen} == {0, 1}
    assert any(r.held_out for r in chosen)
    assert representative(()) == []


def test_probabilities_fall_back_on_the_document():
    data = dataclasses.replace(sample_data(), probabilities=())
    assert {"Band 1", "Band 2", "81 %", "17 %"} <= set(
        words(probability_bars(sample_document(), data))
    )
    document = sample_document()
    for band in document["bands"]:
        band |= {"probability": None, "equivalents": []}
    assert probability_bars(document, data) is None


def test_drawing_twice_gives_the_same_bytes_and_leaves_the_settings_alone():
    before = dict(matplotlib.rcParams)
    first, second = (record_map(sample_document(), sample_data()) for _ in range(2))
    assert first == second
    assert dict(matplotlib.rcParams) == before
    with house_style():
        assert matplotlib.rcParams["text.parse_math"] is False
