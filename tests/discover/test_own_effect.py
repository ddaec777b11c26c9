"""A user's own effect, hidden in records from a closed formula: found with its file alone."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import discover
from discover.cli import main
from discover.cli.own_effects import asked_effects
from models.checks import InputError
from models.constitutive import SegmentedModel
from models.terms import TERMS, load_term, own_terms
from tests.discover.gap_data import campaign, device

ROOT = Path(__file__).parents[2]
BASE = "fit:inertia,viscous-damping"
FORCE, PITCH = 15.0, 0.007
EVEN = '''
from models.terms import Parameter, Term
def column(motion, shape):
    return motion.displacement * motion.velocity ** 2
TERM = Term("swirl", "N s^2/m^3", "c x v^2", column)
'''
SETTLING = '''
import numpy as np
from models.terms import Parameter, Term
def column(motion, shape):
    return motion.acceleration * np.exp(-motion.time / shape["settling"])
TERM = Term("air-dissolves", "kg", "m a exp(-t/T)", column, follows="time",
            parameters=(Parameter("settling", 0.3, 30.0, 3.0, "s", spacing="log"),))
'''
SLACK = '''
from dataclasses import replace
from models.terms import Term
def transform(force_of, motion, coefficient, shape):
    x = motion.displacement
    return force_of(replace(motion, velocity=motion.velocity * (1.0 + coefficient * x)))
TERM = Term("tapered-bore", "1/m", "the fluid's speed grows along the bore", transform=transform,
            acts="input")
'''


def detent(t, x, v, a):
    return device(t, x, v, a) + FORCE * np.sin(2.0 * np.pi * x / PITCH)


def readme_block(title, language="python"):
    text = (ROOT / "docs" / "own-effect.md").read_text(encoding="utf-8")
    section = text.split(f"# {title}\n")[1].split("\n## ")[0]
    return re.search(rf"```{language}\n(.*?)```", section, re.DOTALL)[1]


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("effects") / "magnetic_detent.py"
    path.write_text(readme_block("Your own effect"))
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The campaign as files, two records held out."""
    where = tmp_path_factory.mktemp("campaigns") / "detent"
    where.mkdir()
    text = 'title = "Hidden detent"\n'
    for r in campaign(detent, held_out=(1, 6)).records:
        columns = np.column_stack([r.time, 1e3 * r.displacement, r.force])
        header = "time [s],displacement [mm],force [N]"
        np.savetxt(where / r.file, columns, "%.9g", ",", header=header, comments="")
        text += f'[[records]]\nfile = "{r.file}"\nheld_out = {str(r.held_out).lower()}\n'
    (where / "campaign.toml").write_text(text)
    return where


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_without_its_file_the_effect_is_not_named():
    found = discover.close_gap(campaign(detent, held_out=(1, 6)), BASE)
    assert found.verdict != "closed"
    assert found.final_held_out_gap_percent > 3.0 * found.noise_percent


def test_with_its_file_it_is_named_and_the_gap_falls_to_the_noise(file):
    with own_terms(load_term(file)):
        found = discover.close_gap(campaign(detent, held_out=(1, 6)), BASE)
    (only,) = found.rounds
    assert only.effect == "magnetic-detent"
    assert only.probability > 0.9
    assert only.coefficient == pytest.approx(FORCE, rel=0.01)
    assert only.parameters["pitch"] == pytest.approx(PITCH, rel=0.01)
    assert only.unit == "N"
    assert found.verdict == "closed"
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent
    (shape,) = found.figure_data.shapes
    assert (shape.effect, shape.abscissa) == ("magnetic-detent", "displacement")
    assert np.ptp(shape.force) == pytest.approx(2.0 * FORCE, rel=0.05)
    document = json.loads(json.dumps(found.model_dict(), allow_nan=False))
    with pytest.raises(InputError, match="magnetic-detent.*got none"):
        SegmentedModel.from_dict(document)
    with own_terms(load_term(file)):
        assert SegmentedModel.from_dict(document) == found.model
    assert "magnetic-detent" not in TERMS


def test_an_own_effect_that_is_not_there_is_not_named(file):
    with own_terms(load_term(file)):
        assert discover.close_gap(campaign(device), BASE).verdict == "agrees"
        offset = discover.close_gap(campaign(lambda *m: device(*m) + 25.0), BASE)
    assert [r.effect for r in offset.rounds] == ["force-offset"]


@pytest.mark.parametrize(
    ("text", "effect", "law", "size"),
    [
        (EVEN, "swirl", lambda t, x, v, a: device(t, x, v, a) + 3e5 * x * v**2, 3e5),
        (
            SETTLING, "air-dissolves",
            lambda t, x, v, a: device(t, x, v, a) + 30.0 * a * np.exp(-t / 2.5), 30.0,
        ),
        (
            SLACK, "tapered-bore",
            lambda t, x, v, a: 120.0 * a + 800.0 * v * (1.0 + 40.0 * x), 40.0,
        ),
    ],
    ids=["even", "over time", "changes the motion"],
)  # fmt: skip
def test_effects_of_other_kinds_are_named_too(tmp_path, text, effect, law, size):
    path = tmp_path / "own.py"
    path.write_text(text)
    with own_terms(load_term(path)):
        found = discover.close_gap(campaign(law), BASE)
    assert [r.effect for r in found.rounds] == [effect]
    assert found.rounds[0].coefficient == pytest.approx(size, rel=0.05)
    assert found.verdict == "closed"


def test_the_shapes_that_a_file_names_are_those_that_are_tried(tmp_path, file):
    near = tmp_path / "near.py"
    near.write_text(file.read_text() + 'VARIANTS = [{"pitch": 0.55}]\n')
    with own_terms(load_term(near)):
        found = discover.close_gap(campaign(detent), BASE)
    assert found.rounds[0].parameters["pitch"] == pytest.approx(PITCH, rel=0.01)


def test_two_own_effects_are_told_apart(tmp_path, file):
    other = tmp_path / "swirl.py"
    other.write_text(EVEN)
    with own_terms(load_term(file), load_term(other)):
        found = discover.close_gap(
            campaign(lambda t, x, v, a: detent(t, x, v, a) + 3e5 * x * v**2), BASE
        )
    assert {r.effect for r in found.rounds} == {"magnetic-detent", "swirl"}
    assert found.verdict == "closed"


@pytest.mark.parametrize(
    ("only", "files", "named"),
    [
        (None, ("{file}",), None),
        (("coulomb-friction", "{file}"), (), ("coulomb-friction", "magnetic-detent")),
        (("coulomb-friction",), ("{file}",), ("coulomb-friction", "magnetic-detent")),
        (("magnetic-detent",), ("{file}",), ("magnetic-detent",)),
    ],
)
def test_a_file_is_named_among_the_effects_or_beside_them(file, only, files, named):
    listed = None if only is None else [name.format(file=file) for name in only]
    found, own = asked_effects(listed, [Path(f.format(file=file)) for f in files])
    assert found == named
    assert [term.id for term in own] == ["magnetic-detent"]


def test_the_command_names_it_and_stores_its_hash(file, folder, here, capsys):
    given = ["--effects", f"coulomb-friction, {file}", "--jobs", "2"]
    assert main(["gap", str(folder), "--model", BASE, *given, "-o", "out", "--json"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    document = json.loads(out)
    assert [r["effect"] for r in document["rounds"]] == ["magnetic-detent"]
    source = load_term(file).source.to_dict()
    assert document["own_effects"] == [{"id": "magnetic-detent", **source}]
    stored = json.loads((here / "out" / "model.json").read_text())
    assert stored["bands"][0]["terms"][-1]["source"] == source
    page = (here / "out" / "report.html").read_text()
    assert "magnetic detent" in page
    assert f"magnetic_detent.py, sha256 {source['sha256'][:12]}" in page
    assert (here / "out" / "figures" / "shape-1.svg").stat().st_size > 1000
    assert "magnetic-detent" not in TERMS


def test_the_mended_model_is_used_again_with_its_file_alone(file, folder, here, capsys):
    search = ["gap", str(folder), "--model", BASE, "--effect-file", str(file), "-o", "out"]
    assert main(search) == 0
    model, changed = str(Path("out", "model.json")), here / "changed.py"
    changed.write_text(file.read_text() + "\n")
    capsys.readouterr()
    for verb in (["simulate", model, str(folder)], ["gap", str(folder), "--model", model],
                 ["synth", "made", "--device", "device-12", "--model", model]):  # fmt: skip
        for extra, said in ([], "got none"), (["--effect-file", str(changed)], "changed.py with"):
            assert main([*verb, *extra]) == 2
            err = capsys.readouterr().err
            assert err.count("\n") == 1
            assert "out/model.json: " in err.replace("\\", "/")
            assert "magnetic-detent" in err
            assert said in err
    assert {p.name for p in here.iterdir()} == {"out", "changed.py"}
    assert main(["simulate", model, str(folder), "--effect-file", str(file), "--json"]) == 0
    (answer,) = json.loads(capsys.readouterr().out)["models"]
    assert answer["held_out_relative_error_percent"] < 1.2
    assert main(["gap", str(folder), "--model", model, "--effect-file", str(file), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["verdict"] == "agrees"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, "no such file"),
        ("def column(:", "invalid syntax"),
        (EVEN.replace('"swirl"', '"inertia"'), "catalogue"),
        (EVEN.replace(", column)", ")"), "neither column nor transform"),
        (EVEN.replace("motion.displacement * ", "0.0 / motion.displacement * "), "finite"),
        (EVEN.replace("motion.displacement * motion.velocity ** 2", "0.0"), "shape"),
        ((EVEN + "\n").replace("return ", "return (4e-5 - motion.displacement**2)**0.5 * "), "nan"),
    ],
    ids=["missing", "syntax", "taken", "empty", "at rest", "scalar", "on the records"],
)  # fmt: skip
def test_a_bad_file_exits_2_with_one_line_and_nothing_written(
    folder, here, capsys, text, said
):
    path = here / "bad.py"
    if text is not None:
        path.write_text(text)
    given = ["--effects", "stiffness,bad.py"]
    assert main(["gap", str(folder), "--model", BASE, *given]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert "bad.py" in err
    assert said in err
    assert "Traceback" not in err
    assert {p.name for p in here.iterdir()} <= {"bad.py"}


def test_the_readme_s_term_for_the_catalogue_is_a_term(tmp_path):
    path = tmp_path / "air_drag.py"
    path.write_text(readme_block("Adding a term"))
    assert load_term(path).id == "air-drag"
