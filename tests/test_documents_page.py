"""The documentation's page of documents leaves out no key of a document that a verb writes."""

import json
import re
import shutil
import sys
from pathlib import Path

import pytest

from discover.cli import main
from discover.data_check.result import AddedTest, Inseparable
from tests.discover.sample_gap import sample_gap_document
from tests.discover.sample_study import sample_document

DOCS = Path(__file__).parents[1] / "docs"


@pytest.fixture(scope="module")
def pages():
    """Return the module that writes the page, found where Sphinx finds it."""
    sys.path.insert(0, str(DOCS))
    try:
        import page_documents
    finally:
        sys.path.remove(str(DOCS))
    return page_documents


@pytest.fixture(scope="module")
def told(pages):
    """Return the keys on the page by document."""
    parts = re.split(r"^## (\w+)\.json$", pages.documents_page(), flags=re.M)[1:]
    return {
        name: set(re.findall(r"^\| `([^`]+)` \| \S", text, re.M))
        for name, text in zip(parts[::2], parts[1::2], strict=True)
    }


@pytest.fixture
def written(tmp_path, undrawn):
    """Return documents that verbs write of small campaigns, none of them the page's own."""
    home = tmp_path
    one, two = str(home / "one"), str(home / "two")
    plan = "--device device-12 --frequencies 0.5,2 --amplitudes 5,10 --held-out 1".split()
    hidden = str(DOCS.parent / "data" / "hidden-effect.json")
    assert main(["synth", one, *plan, "--model", "ioim-laminar"]) == 0
    assert main(["synth", two, *plan, "--model", hidden]) == 0
    shutil.copytree(one, home / "raw")
    (home / "raw" / "campaign.toml").unlink()
    (home / "raw" / "notes.csv").write_text("a,b\n1,2\n2,3\n")
    runs = {
        "study": ["discover", two],
        "gap": ["gap", two, "--model", "ioim-laminar"],
        "check": ["check", two],
        "simulation": ["simulate", "ioim-laminar", "foim", one],
        "comparison": ["compare", one, two],
        "init": ["init", str(home / "raw")],
        "batch": ["batch", one, two, "--model", "ioim-laminar", "--pooled"],
        "design": ["design", "--no-verify", "--amplitude", "8 mm"],
        "reproduction": ["reproduce"],
    }
    documents = {}
    for name, command in runs.items():
        assert main([*command, "-o", str(home / "out" / name)]) == 0
        file = home / "out" / name / f"{name}.json"
        documents[name] = json.loads(file.read_text(encoding="utf-8"))
    model = home / "out" / "study" / "model.json"
    return {**documents, "model": json.loads(model.read_text(encoding="utf-8"))}


def test_names_in_tables_break_after_dots_and_underscores_and_nowhere_else():
    sys.path.insert(0, str(DOCS))
    try:
        from keys import breakable
    finally:
        sys.path.remove(str(DOCS))
    ending = '<td><span class="pre">.csv</span></td>'
    assert breakable(ending) == ending
    code = '<code><span class="pre">a[].b_c</span></code>'
    assert breakable(f"<p>{code}</p><td>{code}</td>") == (
        f"<p>{code}</p><td>{code.replace('.b_', '.<wbr>b_<wbr>')}</td>"
    )


NAMES = (
    "study", "gap", "model", "check", "simulation", "comparison", "design", "reproduction", "init",
    "batch",
)  # fmt: skip


@pytest.mark.slow
def test_every_key_that_a_verb_writes_is_told(pages, told, written):
    left_out = {n: set(pages.document_keys(written[n])) - told[n] for n in NAMES}
    assert left_out == {n: set() for n in NAMES}


def test_a_row_is_understood_without_the_row_above_it(pages):
    meanings = re.findall(r"^\| `([^`]+)` \| (.*) \|$", pages.documents_page(), flags=re.M)
    leaning = {k: m for k, m in meanings if re.match(r"Likewise|Return |\S+\.$", m)}
    assert leaning == {}


def test_what_a_check_says_only_of_poor_plans_is_told(told):
    why = Inseparable(("FOIM", "IOIM-linear"), 0.1, "one frequency")
    test = AddedTest(1.0, 0.01, ("FOIM", "IOIM-linear"), 3.0)
    keys = {f"inseparable[].{k}" for k in why.to_dict()} | {
        f"added_test.{k}" for k in test.to_dict()
    }
    assert keys - told["check"] == set()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "document"), [("study", sample_document()), ("gap", sample_gap_document())]
)
def test_every_key_that_a_report_reads_is_told(pages, told, name, document):
    assert set(pages.document_keys(document)) - told[name] == set()
