import json
import os
import re
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

import discover
from discover._version import __version__

ROOT = Path(__file__).parents[1]


def run(*command, cwd):
    """Run a command as a user would: nothing of this checkout on the path."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    return subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_one_version_everywhere():
    assert f"\nversion: {__version__}\n" in (ROOT / "CITATION.cff").read_text()
    assert re.search(
        rf"^## \[({re.escape(__version__)}|Unreleased)\]",
        (ROOT / "CHANGELOG.md").read_text(),
        re.MULTILINE,
    )


def test_readme_names_only_targets_that_the_makefile_has():
    makefile = (ROOT / "Makefile").read_text()
    targets = set(re.findall(r"^([a-z]+):", makefile, re.MULTILINE))
    named = set(re.findall(r"(?:^|`)make ([a-z]+)", (ROOT / "README.md").read_text(), re.M))
    assert {"study", "test"} <= named <= targets


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    done = run(
        sys.executable,
        "-m",
        "build",
        "--wheel",
        "--no-isolation",
        "--outdir",
        folder,
        ROOT,
        cwd=folder,
    )
    assert done.returncode == 0, done.stderr
    return next(folder.glob("*.whl"))


@pytest.mark.slow
def test_wheel_holds_the_packages_the_templates_and_the_campaign(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {"discover/report/templates/study.html", "discover/report/templates/style.css"} <= names
    for campaign in ("segmented", "hidden-effect", "device-12-rig"):
        shipped = {p.name for p in (ROOT / "data" / campaign).iterdir()}
        within = f"discover/_data/{campaign}/"
        assert {n.removeprefix(within) for n in names if n.startswith(within)} == shipped
    assert {"discover/py.typed", "models/py.typed"} <= names
    tops = {n.split("/")[0] for n in names}
    assert tops == {"models", "discover", f"inerter_discovery-{__version__}.dist-info"}


@pytest.mark.sweep
def test_wheel_in_a_fresh_environment_studies_the_shipped_campaign(wheel, tmp_path):
    venv.create(tmp_path / "fresh", with_pip=True)
    programs = tmp_path / "fresh" / ("Scripts" if os.name == "nt" else "bin")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    installed = run(programs / "python", "-m", "pip", "install", "--quiet", wheel, cwd=elsewhere)
    assert installed.returncode == 0, installed.stderr

    done = run(programs / "inerter", "discover", "--seed", "0", cwd=elsewhere)
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert lines[0].startswith("Verdict: two bands of Dean number")
    results = elsewhere / "inerter-out" / "discover-segmented"
    assert lines[-1] == f"Report: {(results / 'report.html').relative_to(elsewhere)}"
    document = json.loads((results / "study.json").read_text())
    assert document["schema"] == "inerter.study/1"
    assert document["bands"]
    assert (results / "report.html").read_text().startswith("<!DOCTYPE html>")
    assert {p.name for p in (results / "figures").iterdir()} >= {"map.svg", "errors-1.svg"}
    assert json.loads((results / "model.json").read_text())["bands"]


def test_the_library_gives_what_it_names():
    assert all(callable(getattr(discover, n)) for n in discover.__all__ if n != "__version__")
    assert discover.__version__ == __version__
    with pytest.raises(AttributeError, match="no attribute 'read_campain'"):
        discover.read_campain  # noqa: B018 - looking it up is the test
