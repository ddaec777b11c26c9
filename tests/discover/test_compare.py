import json
import re
from pathlib import Path

import numpy as np
import pytest

from discover.cli import main
from discover.compare import comparison_document, differences, homogeneous, side_of_model
from discover.compare.side import Side, SideBand
from discover.plots.comparison import side_by_side
from discover.report.comparison import comparison_files, comparison_lines
from models.constitutive import Band, FittedTerm, ForceModel, SegmentedModel

NORMAL = 1.959963984540054


def around(value, sd):
    return (value - NORMAL * sd, value + NORMAL * sd)


def side(name, *bands, content_hash="", coordinate="speed"):
    model = SegmentedModel((Band(None, None, ForceModel((FittedTerm("inertia", 1.0),))),), "speed")
    shown = tuple(SideBand(None, None, structure, 0.9, terms) for structure, terms in bands)
    return Side(name, "study", name, content_hash, "", coordinate, shown, model)


def inertia(value, sd):
    return {"id": "inertia", "coefficient": value, "unit": "kg", "interval": around(value, sd)}


def test_values_of_one_truth_differ_as_often_as_the_level_says():
    rng = np.random.default_rng(4)
    sds = np.array([1.0, 2.0, 0.5])
    found = [
        homogeneous(values, [around(v, s) for v, s in zip(values, sds, strict=True)])
        for values in 10.0 + sds * rng.standard_normal((4000, 3))
    ]
    assert np.mean(np.array(found) < 0.05) == pytest.approx(0.05, abs=0.011)


def test_an_exact_value_is_held_against_the_other_s_interval():
    assert homogeneous([10.0, 12.0], [None, around(12.0, 1.0)]) == pytest.approx(0.0455, abs=1e-4)
    assert homogeneous([10.0, 12.0], [None, None]) is None


def test_bands_match_by_place_and_by_structure_where_their_numbers_differ():
    heavy, light = inertia(60.0, 0.1), inertia(50.0, 0.1)
    fractional = {"id": "fractional-derivative", "coefficient": 5.0, "order": 0.5,
                  "unit": "N s^0.5/m", "interval": (4.0, 6.0), "order_interval": (0.4, 0.6)}
    two = side("two", ("FOIM", (fractional,)), ("IOIM-linear", (heavy,)))
    one = side("one", ("IOIM-linear", (light,)))
    (found,) = [d for d in differences([two, one]) if d.term == "inertia"]
    assert (found.band, found.differs) == ("where IOIM-linear holds", True)
    lone = [d for d in differences([two, one]) if d.term == "fractional-derivative"]
    assert {d.quantity for d in lone} == {"coefficient", "order"}
    assert {d.why for d in lone} == {"only in two"}
    alike = side("also", ("IOIM-linear", (inertia(60.1, 0.1),)))
    (found,) = differences([side("a", ("IOIM-linear", (heavy,))), alike])
    assert (found.band, found.differs) == ("everywhere", False)


def test_coefficients_of_different_units_are_not_compared():
    def fractional(order):
        ends = (order - 0.1, order + 0.1)
        return {"id": "fractional-derivative", "coefficient": 5.0, "unit": f"N s^{order}/m",
                "interval": (4.0, 6.0), "order": order, "order_interval": ends}

    found = differences([side("a", ("FOIM", (fractional(0.5),))),
                         side("b", ("FOIM", (fractional(0.9),)))])
    coefficient, order = found
    assert coefficient.differs is None
    assert "units" in coefficient.why
    assert order.differs is True


def test_a_shape_has_its_own_unit():
    friction = {"id": "coulomb-friction", "coefficient": 60.0, "unit": "N",
                "interval": (59.0, 61.0), "transition_speed": 1e-3,
                "transition_speed_interval": (9e-4, 1.1e-3)}
    both = side("a", ("IOIM-linear", (friction,))), side("b", ("IOIM-linear", (friction,)))
    units = {d.quantity: d.units for d in differences(both)}
    assert units == {"coefficient": ("N", "N"), "transition_speed": ("m/s", "m/s")}


def test_the_axes_of_the_picture_keep_their_room_beside_names_of_bands():
    values = [{"value": v, "interval": None, "unit": "kg"} for v in (1.0, 1.2)]
    label = "Stribeck velocity of Stribeck friction (where IOIM-turbulent holds)"
    drawn = side_by_side([{"values": values}], ("a", "b"), labels=[label])
    (axes,) = drawn.figure.axes
    assert axes.get_position().width > 0.5


def test_the_same_number_without_an_interval_makes_no_picture():
    def drawn(*values):
        entries = [{"value": v, "interval": None, "unit": "N"} for v in values]
        return side_by_side([{"values": entries}], "ab", labels=["Coulomb friction"])

    assert drawn(400.0, 400.0) is None
    assert drawn(400.0, 380.0) is not None


def test_what_may_be_nothing_is_in_the_table_and_not_in_the_picture():
    def coulomb(interval):
        return {"id": "coulomb-friction", "coefficient": 5.0, "unit": "N", "interval": interval}

    for least, drawn in ((1.0, 2), (0.0, 1)):
        sides = [side(n, ("IOIM-linear", (inertia(60.0, 1.0), coulomb((least, 90.0)))))
                 for n in "ab"]  # fmt: skip
        quantities = comparison_document(sides, [], seed=0)["quantities"]
        labels = [q["term"] for q in quantities]
        picture = side_by_side(quantities, "ab", labels=labels)
        assert sum(name in picture for name in labels) == drawn


def test_answers_from_the_same_records_are_told_to_be_dependent():
    sides = [side(n, ("IOIM-linear", (inertia(60.0, 1.0),)), content_hash="ab") for n in "ab"]
    document = comparison_document(sides, [], seed=0)
    assert document["same_structures"]
    assert any("same records" in f["text"] for f in document["findings"])
    assert any(line.startswith("Agree: inertance") for line in comparison_lines(document))


def test_models_alone_have_no_intervals_and_still_a_page():
    model = ForceModel((FittedTerm("inertia", 60.0), FittedTerm("viscous-damping", 10.0)))
    sides = [side_of_model(n, SegmentedModel((Band(None, None, model),), "speed")) for n in "ab"]
    document = comparison_document(sides, [], seed=0)
    assert {q["why"] for q in document["quantities"]} == {"none has an interval"}
    files = comparison_files(document, command="inerter compare a b")
    assert "none has an interval" in files["report.html"]
    assert files["coefficients.csv"].count("inertia") == 2
    assert any("folder of results" in f["text"] for f in document["findings"])


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaigns") / "laminar"
    plan = ["--frequencies", "0.5,2", "--amplitudes", "10"]
    arguments = ["--device", "device-12", "--model", "ioim-laminar", "--noise", "0.5%", *plan]
    assert main(["synth", str(folder), *arguments]) == 0
    return folder


def test_the_model_that_made_records_is_best_on_them_and_pictures_come_in_each_format(
    campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    arguments = ["compare", "ioim-turbulent", "ioim-laminar", "--on", str(campaign)]
    assert main([*arguments, "--figures", "png,pdf"]) == 0
    (folder,) = Path("inerter-out").iterdir()
    assert folder.name == "compare-ioim-turbulent-ioim-laminar"
    document = json.loads((folder / "comparison.json").read_text())
    assert document["schema"] == "inerter.comparison/1"
    (entry,) = document["errors"]
    ranks = {m["name"]: m["rank"] for m in entry["models"]}
    assert ranks == {"ioim-laminar": 1, "ioim-turbulent": 2}
    assert (folder / "figures" / "errors-1.png").read_bytes()[1:4] == b"PNG"
    assert (folder / "figures" / "errors-1.pdf").read_bytes()[:4] == b"%PDF"
    assert re.search(r"Errors: of the force on .+”, ioim-laminar ", capsys.readouterr().out)


def test_simulate_has_a_page_beside_its_tables(campaign, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["simulate", "ioim-laminar", "ioim-turbulent", str(campaign), "-o", "out"]) == 0
    page = (tmp_path / "out" / "report.html").read_text()
    assert "ioim-turbulent" in page
    assert "dashes are the model ioim-laminar" in page
    assert "left by ioim-laminar" in page
    assert (tmp_path / "out" / "figures" / "errors.svg").is_file()
    assert len(list((tmp_path / "out").glob("*.csv"))) == 2


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["ioim-laminar"], "two or more"),
        (["ioim-laminar", "ioim-laminar"], "each once"),
        (["no-such-thing", "ioim-laminar"], "no-such-thing"),
        (["ioim-laminar", "foim", "--figures", "gif"], "--figures"),
    ],
)
def test_what_can_t_be_compared_is_told_in_a_line(arguments, told, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["compare", *arguments]) == 2
    out, err = capsys.readouterr()
    assert (out, len(err.splitlines())) == ("", 1)
    assert told in err
    assert not Path("inerter-out").exists() or not list(Path("inerter-out").iterdir())


def test_what_one_answer_alone_has_is_told_as_that_and_not_as_undecided(
    campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert main(["compare", "foim", "ioim-laminar", "--on", str(campaign)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "Only in foim: fractional derivative." in lines
    (laminar,) = [line for line in lines if line.startswith("Only in ioim-laminar: ")]
    assert "inertance" in laminar and "quadratic damping" in laminar
    assert not any("fractional" in line for line in lines if line.startswith("Can't be told"))
    assert not any(line.startswith(("Differ", "Agree")) for line in lines)  # none can be compared


def test_simulate_fits_terms_first_where_it_is_asked_to(campaign, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    models = ["ioim-laminar", "fit:inertia,stiffness"]
    assert main(["simulate", *models, str(campaign), "-o", "out", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    ranks = {m["name"]: m["rank"] for m in document["models"]}
    assert ranks == {"ioim-laminar": 1, "fit:inertia,stiffness": 2}
    assert any(f["text"].endswith("not held out: fit:inertia,stiffness.")
               for f in document["findings"])  # fmt: skip


def test_simulate_finds_fitted_terms_as_good_as_those_that_made_the_records(
    campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    terms = "fit:inertia,viscous-damping,quadratic-damping,coulomb-friction"
    assert main(["simulate", "ioim-laminar", terms, str(campaign), "-o", "out", "--json"]) == 0
    made, fitted = json.loads(capsys.readouterr().out)["models"]
    assert fitted["relative_error_percent"] < 1.05 * made["relative_error_percent"]


def test_simulate_says_where_a_name_needs_a_device(campaign, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (file,) = list(campaign.glob("*2hz*.csv"))[:1]
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "a.csv").write_text(file.read_text())
    (tmp_path / "own" / "campaign.toml").write_text('[[records]]\nfile = "a.csv"\n')
    assert main(["simulate", "foim", "own"]) == 2
    assert "simulate: foim must be used with a device" in capsys.readouterr().err


def test_compare_fits_terms_to_the_records_that_it_is_given(
    campaign, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    terms = "fit:inertia,viscous-damping,quadratic-damping,coulomb-friction"
    assert main(["compare", terms, "ioim-laminar", "--on", str(campaign), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    (inertance,) = [q for q in document["quantities"] if q["term"] == "inertia"]
    fitted, made = (v["value"] for v in inertance["values"])
    assert fitted == pytest.approx(made, rel=0.01)
    assert main(["compare", terms, "ioim-laminar"]) == 2
    assert "with --on CAMPAIGN, which it is fitted to" in capsys.readouterr().err
