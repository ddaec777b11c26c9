"""A user's own term: read from its file, checked, known for a while, stored with its hash."""

import copy
import hashlib
import pickle
import subprocess
import sys

import joblib
import numpy as np
import pytest

from models.checks import InputError
from models.constitutive import Band, FittedTerm, ForceModel, SegmentedModel
from models.motion import sine_motion
from models.terms import CATALOGUE, TERMS, find_term, load_term, own_terms

DRAG = '''
from models.terms import Parameter, Term
def column(motion, shape):
    return abs(motion.velocity) ** shape["power"] * motion.displacement
TERM = Term("odd-drag", "N s^{power}/m^{power}", "c |v|^p x", column,
            parameters=(Parameter("power", 1.0, 3.0, 2.0, ""),))
'''
GAIN = '''
from models.terms import Term
def transform(force_of, motion, coefficient, shape):
    return (1.0 + coefficient) * force_of(motion)
TERM = Term("my-gain", "1", "g F", transform=transform, acts="output")
'''
WARMED = '''
import numpy as np
from models.terms import Parameter, Term
def column(motion, shape):
    rate = shape["rate"]
    return np.sign(motion.velocity) * (np.exp(-rate * motion.time) if rate > 0.0 else 1.0)
def follows(shape):
    return "time" if shape["rate"] > 0.0 else "motion"
TERM = Term("warmed", "N", "f sign v exp(-rt)", column, follows=follows,
            parameters=(Parameter("rate", 0.0, 1.0, 0.5, "1/s"),))
'''
PLAIN = '''
from models.terms import Term, Parameter
TERM = Term("mine", "N", "f", {})
'''


@pytest.fixture
def file(tmp_path):
    def write(text, name="mine.py"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_a_file_becomes_a_term_with_its_hash(file):
    path = file(DRAG)
    term = load_term(path)
    assert (term.id, term.unit) == ("odd-drag", "N s^{power}/m^{power}")
    assert term.source.path == path
    assert term.source.to_dict() == {
        "file": "mine.py", "sha256": hashlib.sha256(DRAG.encode()).hexdigest()
    }
    motion = sine_motion(0.01, 2.0)
    expected = np.abs(motion.velocity) ** 1.5 * motion.displacement
    np.testing.assert_allclose(term.column(motion, {"power": 1.5}), expected, rtol=1e-14)


def test_what_a_term_follows_may_depend_on_its_shape(file):
    term = load_term(file(WARMED))
    assert term.remembers({"rate": 0.0}) == "motion"
    assert term.remembers({"rate": 0.2}) == "time"


def test_a_term_is_known_inside_the_block_alone(file):
    term = load_term(file(DRAG))
    with own_terms(term), own_terms(term):
        assert find_term("odd-drag") is term
    assert "odd-drag" not in TERMS
    with pytest.raises(ZeroDivisionError), own_terms(term):
        raise ZeroDivisionError
    assert tuple(sorted(TERMS)) == CATALOGUE


def test_two_files_with_one_id_are_told_apart(file):
    one, other = load_term(file(DRAG)), load_term(file(DRAG + "# more\n", "other.py"))
    with pytest.raises(InputError, match=r"other\.py: effects .* odd-drag twice"):
        with own_terms(one, other):
            pass
    assert "odd-drag" not in TERMS


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("TERM = (", r"mine\.py:1: the file must be Python, got '\(' was never closed"),
        ("x = 1", r"mine\.py: TERM must be a models\.terms\.Term, got nothing"),
        ("TERM = 3", "got int"),
        ("x = 1\nimport no_such_module", r"mine\.py:2: the file must be able to run, got Module"),
        ("raise SystemExit", "SystemExit"),
        (PLAIN.format("lambda m, s: m.velocity").replace("mine", "inertia"), "catalogue does not"),
        (PLAIN.format("lambda m, s: m.velocity").replace("mine", "unknown"), "not agrees or unkn"),
        (PLAIN.format("lambda m, s: m.velocity").replace("mine", "My Term"), "lower-case words"),
        (PLAIN.format("None"), "neither column nor transform"),
        (PLAIN.format("lambda m, s: m.velocity, acts='input'"), "given a function transform"),
        (PLAIN.format("lambda m, s: 3.0"), r"shape \(64,\), got shape \(\)"),
        (PLAIN.format("lambda m, s: m.velocity[1:]"), r"shape \(64,\), got shape \(63,\)"),
        (PLAIN.format("lambda m, s: None"), r"got shape \(\)"),
        (PLAIN.format("lambda m, s: m.velocity / abs(m.velocity)"), "finite throughout, got nan"),
        (PLAIN.format("lambda m, s: 1.0 / m.velocity"), "finite throughout, got inf"),
        (PLAIN.format("lambda m, s: m.velocity * 1j"), "real, got complex"),
        (PLAIN.format("lambda m, s: m.velocity if m.velocity > 0 else 0"), r"py:3: column of"),
        (PLAIN.format("lambda m, s: m.velocity.sort()"), "read-only"),
        (PLAIN.format("lambda m, s: s['gap'] * m.velocity"), "KeyError: 'gap'"),
        (PLAIN.format("lambda m, s: m.velocity, parameters=(3,)"), "a tuple of Parameter"),
        (PLAIN.format("lambda m, s: m.velocity").replace('"N"', '"N/m^{p}"'), "unit of TERM"),
        (
            PLAIN.format("lambda m, s: 0, parameters=(Parameter('p', 0, 1, 0, '', '', 'log'),)"),
            "lower of parameter 'p' of TERM with log spacing must be a finite number > 0",
        ),
        (
            PLAIN.format("lambda m, s: 0, parameters=(Parameter('unit', 0, 1, 0, ''),)"),
            "named otherwise than id, coefficient, unit",
        ),
        (
            PLAIN.format("lambda m, s: 0, parameters=(Parameter('p', 2, 1, 0, ''),)"),
            "upper of parameter 'p' of TERM must be a finite number > 2",
        ),
        (DRAG + "VARIANTS = [{'exponent': 2}]", "parameter in VARIANTS must be one of power"),
        (DRAG + "VARIANTS = {'power': 2}", "VARIANTS must be a list of mappings"),
    ],
)
def test_what_is_wrong_in_a_file_is_said_in_one_line(file, text, message):
    with pytest.raises(InputError, match=message) as caught:
        load_term(file(text))
    assert "mine.py" in str(caught.value)
    assert not any(name.startswith("mine") for name in TERMS)


def test_what_is_no_file_is_said(tmp_path):
    with pytest.raises(InputError, match=r"nowhere\.py: effect must be a Python file, got no such"):
        load_term(tmp_path / "nowhere.py")
    with pytest.raises(InputError, match="got a folder"):
        load_term(tmp_path)


def test_a_force_that_fails_beyond_the_probe_still_names_the_file(file):
    text = "lambda m, s: (0.02**2 - m.displacement**2) ** 0.5"
    term = load_term(file(PLAIN.format(text)))
    with own_terms(term):
        model = ForceModel((FittedTerm("mine", 1.0),))
    with pytest.raises(InputError, match=r"mine\.py: column of mine must be finite throughout"):
        model.force(sine_motion(0.03, 1.0))


def test_a_file_is_read_again_when_it_has_changed(file):
    first = load_term(file(DRAG))
    second = load_term(file(DRAG.replace("odd-drag", "other-drag")))
    assert (first.id, second.id) == ("odd-drag", "other-drag")
    assert first.source.sha256 != second.source.sha256


def test_printing_in_the_file_does_not_reach_stdout(file, capsys):
    load_term(file("print('hello')\n" + DRAG))
    assert capsys.readouterr().out == ""


def model_of(path):
    with own_terms(load_term(path)):
        return ForceModel(
            (FittedTerm("inertia", 3.0), FittedTerm("odd-drag", 2.0, {"power": 1.5})), "mine"
        )


def test_a_model_outlives_the_block_and_its_document_needs_the_same_file(file):
    path = file(DRAG)
    model = model_of(path)
    motion = sine_motion(0.01, 2.0)
    drag = np.abs(motion.velocity) ** 1.5 * motion.displacement
    expected = 3.0 * motion.acceleration + 2.0 * drag
    np.testing.assert_allclose(model.force(motion), expected, rtol=1e-12)
    document = SegmentedModel((Band(None, None, model),), "speed").to_dict()
    assert document["bands"][0]["terms"][1]["source"] == load_term(path).source.to_dict()
    hashed = document["bands"][0]["terms"][1]["source"]["sha256"][:12]
    none = rf"m\.json: effect 'odd-drag' must be given with its file mine\.py .*{hashed}.*none"
    with pytest.raises(InputError, match=none):
        SegmentedModel.from_dict(document, where="m.json")
    with own_terms(load_term(path)):
        assert SegmentedModel.from_dict(document).bands[0].model == model
    changed = load_term(file(DRAG + "\n", "changed.py"))
    found = rf"sha256 {hashed}.*got .*changed\.py with sha256 {changed.source.sha256[:12]}"
    with own_terms(changed), pytest.raises(InputError, match=found):
        SegmentedModel.from_dict(document)
    with pytest.raises(InputError, match="catalogue's own term"):
        term = {**document["bands"][0]["terms"][1], "id": "inertia"}
        FittedTerm.from_dict(term)
    with pytest.raises(InputError, match="a file with its sha256"):
        FittedTerm.from_dict({"id": "odd-drag", "coefficient": 1.0, "source": "mine.py"})


def test_loading_a_model_never_runs_its_file(file):
    path = file(DRAG)
    document = model_of(path).to_dict()
    path.write_text("raise RuntimeError('it ran')")
    with pytest.raises(InputError, match="got none"):
        ForceModel.from_dict(document)


def test_terms_and_models_go_to_other_processes(file):
    model = model_of(file(DRAG))
    assert pickle.loads(pickle.dumps(model)) == model
    assert copy.deepcopy(model) == model
    motion = sine_motion(0.01, 2.0)
    expected = model.force(motion)
    with joblib.parallel_config(backend="loky"):
        found = joblib.Parallel(n_jobs=2)(joblib.delayed(model.force)(motion) for _ in range(2))
    for force in found:
        np.testing.assert_array_equal(force, expected)


def test_a_pickle_is_refused_where_the_file_has_changed(file):
    path = file(DRAG)
    stored = pickle.dumps(model_of(path))
    path.write_text(DRAG + "\n")
    with pytest.raises(InputError, match="the file of effect 'odd-drag' must be the one with"):
        pickle.loads(stored)


def test_a_change_of_the_output_is_guarded_too(file):
    with own_terms(load_term(file(GAIN))):
        model = ForceModel((FittedTerm("inertia", 3.0), FittedTerm("my-gain", 0.5)))
    motion = sine_motion(0.01, 2.0)
    np.testing.assert_allclose(model.force(motion), 4.5 * motion.acceleration)
    bad = GAIN.replace("force_of(motion)", "force_of(motion)[::2]")
    with pytest.raises(InputError, match=r"transform of my-gain .* got shape \(32,\)"):
        load_term(file(bad, "bad.py"))


def test_the_file_may_hold_dataclasses(file):
    head = "from __future__ import annotations\nfrom dataclasses import dataclass\n"
    body = "@dataclass(frozen=True)\nclass Pair:\n    a: int\n    b: int\n"
    assert load_term(file(head + body + DRAG)).id == "odd-drag"


def test_the_vocabulary_starts_without_any_file():
    code = "from models.terms import CATALOGUE, TERMS; print(CATALOGUE == tuple(sorted(TERMS)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "True"
