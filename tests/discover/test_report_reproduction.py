"""The reproduction's and the design's pages: whole, self-contained, and saying what was found."""

import json
import re
import xml.etree.ElementTree as ET

import pytest

from discover.cli import main
from discover.report.design import design_figures, design_lines, design_report
from discover.report.reproduction import (
    reproduction_figures,
    reproduction_lines,
    reproduction_report,
)
from discover.reproduction import reproduce
from models.design import DesignBounds, minimise_critical_frequency
from models.device import Device


@pytest.fixture(scope="module")
def result():
    return reproduce()


@pytest.fixture(scope="module")
def figures(result):
    return reproduction_figures(result)


def test_figures_are_well_formed_and_complete(figures):
    expected = {f"figure-{n}" for n in (2, 3, 4, 5, 7, 8, 9)} | {"table-3", "orders"}
    assert set(figures) == expected
    for svg in figures.values():
        ET.fromstring(svg)
        assert "mathdefault" not in svg


def test_page_holds_every_claim_and_nothing_from_outside(result, figures):
    page = reproduction_report(result, figures, command="inerter reproduce --seed 0")
    for claim in result.claims:
        assert f'id="claim-{claim.id}"' in page
    assert page.count("<svg") == len(figures)
    assert not re.search(r'(?:src|href)="(?:https?:)?//', page)
    assert "inerter reproduce --seed 0" in page
    assert "not public" in page


def test_lines_count_the_claims(result):
    counts = result.counts
    first = reproduction_lines(result)[0]
    for number in (*counts.values(), len(result.claims)):
        assert str(number) in first


def test_verb_writes_document_report_and_figures(tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["reproduce", "-o", str(out), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document == json.loads((out / "reproduction.json").read_text(encoding="utf-8"))
    assert document["schema"] == "inerter.reproduction/1"
    assert len(document["identification"]) == 3
    assert (out / "report.html").is_file()
    assert len(list((out / "figures").glob("*.svg"))) == 9


def document_of(**bounds):
    device = Device.preset("device-12")
    found = minimise_critical_frequency(device, bounds=DesignBounds.around(device, **bounds))
    return {
        "schema": "inerter.design/1", "version": "0", "seed": 0,
        "campaign": {"title": "Rough design", "hash": ""}, **found.to_dict(), "loop": None,
    }


def test_design_page_shows_design_front_and_prices():
    document = document_of()
    figures = design_figures(document)
    assert set(figures) == {"sections", "front", "prices"}
    for svg in figures.values():
        ET.fromstring(svg)
    page = design_report(document, figures, command="inerter design")
    assert page.count("<svg") == 3
    assert "cylinder inside helix" in page
    assert "0.114 Hz" in design_lines(document)[0]


def test_design_page_says_why_nothing_fits():
    document = document_of(damping_ratio=0.005)
    page = design_report(document, design_figures(document), command="inerter design")
    assert "Nothing fits" in page and "Why nothing fits" in page
    assert "parasitic damping" in design_lines(document)[0]
