import pytest

from discover.records import RigLimits
from discover.report.check import check_figures, check_lines, check_report, next_step
from tests.discover.data_check.plan import SINGLE, WIDE, checked
from tests.discover.test_report_study import Page


def page_of(found):
    document = found.to_dict()
    figures = check_figures(document, found.figure_data)
    return Page(
        check_report(
            document,
            found.figure_data,
            figures,
            campaign="plan",
            command="inerter check plan --seed 0",
        )
    )


@pytest.fixture(scope="module")
def single():
    return checked(SINGLE)


@pytest.fixture(scope="module")
def wide():
    return checked(WIDE)


def test_page_is_well_formed_self_contained_and_its_ids_are_unique(single):
    page = page_of(single)
    assert page.open == []
    assert len(page.ids) == len(set(page.ids)) > 20
    assert all(a.startswith("#") for a in page.addresses)
    assert not {"script", "link", "img", "iframe"} & set(page.tags)


def test_page_carries_pictures_numbers_findings_and_records(single):
    page = page_of(single)
    for part in (
        "Where the tests stand",
        "What they tell apart",
        "Displacement amplitude (mm)",
        "Rank and conditioning",
        "3 of 5",
        "all tests run at 2 Hz",
        "2-10.csv",
        "inerter check plan --seed 0",
    ):
        assert part in page.text
    assert page.tags.count("svg") == 2


def test_pairs_with_one_reason_are_named_in_one_sentence(single):
    (line,) = [w for w in check_lines(single.to_dict(), campaign="plan") if "told apart:" in w]
    assert line.count("single frequency") == 1
    assert "FOIM and IOIM-linear, FOIM and IOIM-laminar, FOIM and IOIM-turbulent need" in line


def test_next_comes_the_added_test_or_the_study(single, wide):
    text = next_step(single.to_dict(), campaign="my-plan")
    added = single.added_test
    assert f"{added.frequency_hz:.2g} Hz and {1e3 * added.amplitude_m:.2g} mm" in text
    assert "`inerter check my-plan`" in text
    text = next_step(wide.to_dict(), campaign="my-plan")
    assert text.startswith("`inerter discover my-plan`")


def test_without_a_test_to_add_the_limits_are_named():
    found = checked(SINGLE, rig=RigLimits(max_force=1e-6))
    assert "[rig]" in next_step(found.to_dict(), campaign="plan")


def test_much_noise_asks_for_less_of_it():
    """A gap goes with the inverse square of the noise."""
    document = checked(WIDE[1:3], noise=0.3).to_dict()
    document["added_test"] |= {"gap_nats": 0.75}
    assert "noise 2 times lower would do" in next_step(document, campaign="plan")


def test_errors_come_before_a_study(wide):
    document = wide.to_dict() | {"passed": False}
    assert "mend what is in error" in next_step(document, campaign="plan")
    assert check_lines(document, campaign="plan")[-1] == "Check: failed."


def test_a_campaign_that_is_all_held_out_still_reports():
    found = checked(((2.0, 0.01), (1.0, 0.01)), held_out=True)
    page = page_of(found)
    assert "no record may be fitted" in " ".join(check_lines(found.to_dict(), campaign="p"))
    assert "Rank and conditioning" not in page.text
    assert "Where the tests stand" in page.text


def test_a_parameter_that_the_tests_can_not_see_is_said(wide):
    document = wide.to_dict()
    document["structures"][2]["rank"] = 3
    lines = check_lines(document, campaign="plan")
    assert any("IOIM-laminar's 4 parameters these tests see 3" in line for line in lines)
