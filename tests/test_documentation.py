"""README and docs: links lead somewhere, commands exist, output is what the program prints."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest

from discover.cli import main

ROOT = Path(__file__).parents[1]
PAGES = sorted([ROOT / "README.md", ROOT / "data" / "README.md", *(ROOT / "docs").glob("*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_links_of_a_page_lead_to_files_that_are_there(page):
    text = page.read_text(encoding="utf-8")
    targets = [t.split("#")[0] for t in re.findall(r"\]\(([^)\s]+)\)", text)]
    local = [t for t in targets if t and not t.startswith(("http:", "https:"))]
    assert [t for t in local if not (page.parent / t).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_verbs_and_options_that_a_page_names_are_the_program_s(page, capsys):
    blocks = re.findall(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)
    lines = [line for block in blocks for line in block.splitlines()]
    for line in lines:
        command = re.match(r"inerter ([a-z]+)(.*)", line.partition("#")[0])
        if command is None:
            continue
        verb, rest = command.groups()
        assert main([verb, "--help"]) == 0, line
        known = capsys.readouterr().out
        assert all(o in known for o in re.findall(r"--[a-z-]+", rest)), line


def said(text):
    """Return what lines say without their numbers, which differ in the last digit by machine."""
    whole = " ".join(line for line in text.splitlines() if not line.startswith("$"))
    plain = whole.replace("\u202f", " ").replace(".venv/bin/", "")
    words = re.sub(r"[\d.−]+", "#", plain)
    return " ".join(words.split())


@pytest.mark.slow
def test_the_readme_shows_what_the_program_prints(capsys, tmp_path, monkeypatch):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    study, gap = re.findall(r"^```text\n(.*?)^```", text, re.M | re.S)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").symlink_to(ROOT / "data")
    monkeypatch.setattr("discover.cli.discover.shown_path", lambda _: "data/hidden-effect")
    assert main(["discover"]) == 0
    assert said(capsys.readouterr().out) == said(study)
    assert main(["gap", "data/hidden-effect", "--model", "ioim-laminar"]) == 0
    assert said(capsys.readouterr().out) == said(gap)


@pytest.mark.slow
def test_the_readme_s_lines_of_python_run(tmp_path, monkeypatch):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my-records").symlink_to(ROOT / "data" / "segmented")
    names = {}
    exec(block, names)
    assert names["gap"].verdict == "agrees"
    assert (tmp_path / "study.json").is_file()


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
