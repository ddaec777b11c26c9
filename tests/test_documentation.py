"""README and docs: links lead somewhere, every block runs, output is what the program prints."""

import re
import shlex
import shutil
import subprocess
import tomllib
from glob import glob
from pathlib import Path

import matplotlib
import pytest

from discover.cli import main

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = sorted([ROOT / "README.md", ROOT / "data" / "README.md", *DOCS.glob("*.md")])
BUILT = "_generated/"
"""Pages that the program writes when the site is built."""

# Blocks that set a machine up, or need one that is not there: each with a word that it holds.
NOT_RUN = (
    "make ",  # would set up another environment
    "venv/bin/activate",
    "pip install",
    "dask",  # a scheduler and its workers; tests/discover/executor has its own
    "cluster",
    "from models.terms.term import",  # a file of the package, tested in tests/models/terms
)


def blocks(page):
    """Return the language and the text of a page's blocks, in order."""
    return re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)


def named(page):
    return page.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_of_a_page_lead_to_files_that_are_there(page):
    text = page.read_text(encoding="utf-8")
    targets = [t.split("#")[0] for t in re.findall(r"\]\(([^)\s]+)\)", text)]
    local = [t for t in targets if t and not t.startswith(("http:", "https:"))]
    kept = [t.replace(f"{BUILT}notebooks", "../notebooks") for t in local]
    there = [t for t in kept if (page.parent / t).exists()]
    written = [t for t in kept if t.startswith(BUILT) and t in BUILT_PAGES]
    assert sorted({*there, *written}) == sorted(set(kept))


BUILT_PAGES = [f"{BUILT}{name}.md" for name in ("commands", "constants", "terms", "documents")]


def test_every_page_stands_in_the_site_s_contents():
    listed = re.findall(r"^([\w-]+)$", (DOCS / "index.md").read_text(encoding="utf-8"), re.M)
    assert sorted(p.stem for p in DOCS.glob("*.md") if p.stem != "index") == sorted(listed)


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").split()) <= 900


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_verbs_and_options_that_a_page_names_are_the_program_s(page, capsys):
    for language, text in blocks(page):
        for line in text.splitlines() if language in ("sh", "console") else ():
            command = re.match(r"(?:\$ )?inerter ([a-z]+)(.*)", line.partition("#")[0])
            if command is None:
                continue
            verb, rest = command.groups()
            assert main([verb, "--help"]) == 0, line
            known = capsys.readouterr().out
            assert all(o in known for o in re.findall(r"--[a-z-]+", rest)), line


def same(printed, shown):
    """Tell whether a page shows what is printed; numbers differ in a last digit by machine."""
    (words, numbers), (shown_words, shown_numbers) = said(printed), said(shown)
    return words == shown_words and numbers == pytest.approx(shown_numbers, rel=0.02)


def said(text):
    """Return what lines say without their numbers, and these."""
    whole = " ".join(line for line in text.splitlines() if not line.startswith("$"))
    plain = re.sub(r"\S*/bin/inerter ", "inerter ", whole.replace("\u202f", " "))
    number = r"[−-]?\d+(?:\.\d+)?"
    found = [float(n.replace("−", "-")) for n in re.findall(number, plain)]
    return " ".join(re.sub(number, "#", plain).split()), found


@pytest.mark.slow
def test_the_readme_shows_what_the_program_prints(capsys, tmp_path, monkeypatch, undrawn):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    study, gap = re.findall(r"^```text\n(.*?)^```", text, re.M | re.S)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").symlink_to(ROOT / "data")
    monkeypatch.setattr("discover.cli.discover.shown_path", lambda _: "data/hidden-effect")
    assert main(["discover"]) == 0
    assert same(capsys.readouterr().out, study)
    assert main(["gap", "data/hidden-effect", "--model", "ioim-laminar"]) == 0
    assert same(capsys.readouterr().out, gap)


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    """Return a small campaign of a known device: what pages call the reader's own."""
    folder = tmp_path_factory.mktemp("own") / "records"
    options = "--model ioim-laminar --frequencies 0.5,2 --amplitudes 5,10 --held-out 1"
    assert main(["synth", str(folder), "--device", "device-12", *options.split()]) == 0
    return folder


def run_shell(text, capsys):
    """Run a block's commands; return for each that begins with a dollar what it printed."""
    shown = text.lstrip().startswith("$ ")
    for line in text.splitlines():
        if shown and not line.startswith("$ "):
            continue
        command = line.removeprefix("$ ").partition(" #")[0].strip()
        if not command or any(word in command for word in NOT_RUN):
            continue
        capsys.readouterr()
        if command.startswith("inerter "):
            words = [sorted(glob(w)) if "*" in w else [w] for w in shlex.split(command)[1:]]
            assert main(sum(words, [])) == 0, (command, capsys.readouterr().err)
            yield command, capsys.readouterr().out
        else:
            done = subprocess.run(command, shell=True, check=True, capture_output=True, text=True)
            yield command, done.stdout


def printed_below(text):
    """Return what a console block shows below each of its commands."""
    parts = re.split(r"^\$ (.*)\n", text, flags=re.M)[1:]
    return dict(zip(parts[::2], parts[1::2], strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=named)
def test_every_block_of_a_page_runs_and_prints_what_is_shown(
    page, records, tmp_path, monkeypatch, capsys, undrawn
):
    monkeypatch.chdir(tmp_path)
    matplotlib.use("svg")
    for name in (
        "my-records", "my-campaign", "fleet/a", "fleet/b", "lab/a", "lab/b", "other-records",
    ):  # fmt: skip
        if page.name != "tutorial.md":
            (tmp_path / name).parent.mkdir(exist_ok=True)
            shutil.copytree(records, tmp_path / name)
    if "inerter init my-records" in page.read_text(encoding="utf-8"):
        (tmp_path / "my-records" / "campaign.toml").unlink()
    (tmp_path / "more").mkdir()
    shutil.copy(next(records.glob("*.csv")), tmp_path / "more")
    (tmp_path / "data").symlink_to(ROOT / "data")
    names, before = {}, ""
    for language, text in blocks(page):
        if language == "python" and text.startswith('"""'):  # a file by its first words
            (tmp_path / text[3:].partition(":")[0]).write_text(text, encoding="utf-8")
        elif language == "python" and not any(word in text for word in NOT_RUN):
            capsys.readouterr()
            exec(compile(text, f"{page.name}", "exec"), names)
            before = capsys.readouterr().out
        elif language == "text" and before and page.name != "README.md":
            assert same(before, text)
            before = ""
        elif language in ("sh", "console"):
            shown = printed_below(text) if language == "console" else {}
            for command, output in run_shell(text, capsys):
                if command in shown:
                    assert same(output, shown[command]), (command, output)


def test_the_command_in_a_campaign_s_first_line_makes_it_again(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").mkdir()
    for name in ("segmented", "hidden-effect"):
        shipped = ROOT / "data" / name
        (tmp_path / "data" / f"{name}.json").write_bytes(
            shipped.with_suffix(".json").read_bytes()
        )
        first = (shipped / "campaign.toml").read_text(encoding="utf-8").splitlines()[0]
        assert main(shlex.split(first.partition("inerter ")[2])) == 0
        made = tmp_path / "data" / name
        tables = [
            tomllib.loads((f / "campaign.toml").read_text(encoding="utf-8"))
            for f in (shipped, made)
        ]
        assert tables[0] == tables[1]
        for record in tables[0]["records"]:
            file = record["file"]
            assert (made / file).read_text() == (shipped / file).read_text()
