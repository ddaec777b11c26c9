import json
import os
import signal
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pandas
import pytest

from discover.cli import main
from models.constitutive import SegmentedModel

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Four exact laminar records with little noise, one of them held out."""
    folder = tmp_path_factory.mktemp("campaigns") / "laminar"
    plan = ["--frequencies", "0.5,1,2,4", "--amplitudes", "10", "--held-out", "1"]
    arguments = ["--device", "device-12", "--model", "ioim-laminar", "--noise", "0.5%", *plan]
    assert main(["synth", str(folder), *arguments]) == 0
    return folder


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_discover_prints_the_answer_and_what_is_next_and_writes_the_folder(campaign, here, capsys):
    assert main(["discover", str(campaign)]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    lines = out.splitlines()
    names = [line.split(":")[0] for line in lines]
    lasting = [n for n in names if n not in ("Beside it", "Friction")]
    assert lasting == [
        "Verdict", "Values", "Accuracy", "Left over", "Certainty", "Dean check", "Next test",
        "Next", "Report",
    ]
    folder = here / "inerter-out" / "discover-laminar"
    headline = json.loads((folder / "study.json").read_text())["headline"]
    assert lines[0] == f"Verdict: {headline}."
    assert headline in (folder / "report.html").read_text().replace("\u202f", " ")
    assert lines[-1] == "Report: " + str(Path("inerter-out", "discover-laminar", "report.html"))
    written = {p.name for p in folder.iterdir()} - {".inerter-files"}
    assert written == {
        "study.json", "model.json", "report.html", "figures", "coefficients.csv", "records.csv"
    }
    terms = pandas.read_csv(folder / "coefficients.csv")
    assert terms.lower.le(terms.coefficient).all()
    assert terms.upper.ge(terms.coefficient).all()
    records = pandas.read_csv(folder / "records.csv")
    assert list(records.frequency) == pytest.approx([0.5, 1.0, 2.0, 4.0], rel=1e-3)
    assert records.held_out.sum() == 1
    assert all(p.suffix == ".svg" for p in (folder / "figures").iterdir())


@pytest.mark.usefixtures("undrawn")
def test_json_is_the_document_and_nothing_else(campaign, here, capsys):
    assert main(["discover", str(campaign), "--json", "-o", "out", "--seed", "3"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert out == (here / "out" / "study.json").read_text()
    document = json.loads(out)
    assert (document["schema"], document["seed"]) == ("inerter.study/1", 3)
    assert "inerter discover" in (here / "out" / "report.html").read_text()


@pytest.mark.usefixtures("undrawn")
def test_the_written_model_is_the_device_that_made_the_records(campaign, here):
    assert main(["discover", str(campaign), "-o", "out"]) == 0
    model = SegmentedModel.from_dict(json.loads((here / "out" / "model.json").read_text()))
    assert len(model.bands) == 1
    assert model.bands[0].model.coefficient("inertia") == pytest.approx(370.38, rel=0.01)


@pytest.mark.usefixtures("undrawn")
def test_only_the_terms_asked_for_are_kept(campaign, here, capsys):
    terms = "inertia,viscous-damping,force-offset"
    assert main(["discover", str(campaign), "--terms", terms, "--json", "--bands", "1"]) == 0
    (band,) = json.loads(capsys.readouterr().out)["bands"]
    assert {t["id"] for t in band["terms"]} == set(terms.split(","))


def test_an_unknown_term_is_named_with_those_that_there_are(campaign, here, capsys):
    assert main(["discover", str(campaign), "--terms", "inertia,drag"]) == 2
    assert "'drag'" in (err := capsys.readouterr().err)
    assert "viscous-damping" in err
    assert main(["discover", str(campaign), "--terms", "inertia,viscous-dampin"]) == 2
    assert "got 'viscous-dampin' (did you mean 'viscous-damping'?)" in capsys.readouterr().err
    assert not (here / "inerter-out").exists()


@pytest.mark.usefixtures("undrawn")
def test_check_passes_good_records_and_writes_its_document(campaign, here, capsys):
    assert main(["check", str(campaign), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    stored = json.loads((here / "inerter-out" / "check-laminar" / "check.json").read_text())
    assert stored == document
    assert [r["kind"] for r in document["records"]] == ["sine"] * 4
    found = [r["frequency_hz"] for r in document["records"]]
    assert found == pytest.approx([0.5, 1.0, 2.0, 4.0], rel=1e-3)
    noise = [r["force_noise_percent"] for r in document["records"]]
    assert np.mean(noise) == pytest.approx(0.5, rel=0.15)


def test_check_writes_its_report_and_pictures_and_says_what_comes_next(campaign, here, capsys):
    assert main(["check", str(campaign)]) == 0
    lines = capsys.readouterr().out.splitlines()
    folder = Path("inerter-out", "check-laminar")
    assert lines[-1] == f"Report: {folder / 'report.html'}"
    assert any(line.startswith("Next: ") and "inerter discover" in line for line in lines)
    written = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}
    assert written - {".inerter-files"} == {
        "check.json",
        "report.html",
        "figures/plan.svg",
        "figures/separation.svg",
    }
    plan = (folder / "figures" / "plan.svg").read_text()
    assert "Frequency (Hz)" in plan
    assert "Displacement amplitude (mm)" in plan
    document = json.loads((folder / "check.json").read_text())
    assert [s["name"] for s in document["structures"]] == [
        "FOIM",
        "IOIM-linear",
        "IOIM-laminar",
        "IOIM-turbulent",
    ]
    assert len(document["pairs"]) == 6


@pytest.mark.usefixtures("undrawn")
def test_check_without_a_campaign_takes_the_shipped_one_as_discover_does(
    campaign, here, capsys, monkeypatch
):
    monkeypatch.setattr("discover.cli.check.shipped_campaign", lambda: campaign)
    assert main(["check"]) == 0
    assert f"`inerter discover {campaign}`" in capsys.readouterr().out
    assert (here / "inerter-out" / "check-laminar" / "check.json").is_file()


@pytest.mark.usefixtures("undrawn")
def test_a_spring_alone_is_ordinary_data(here, capsys):
    phase = np.arange(600) / 10.0
    rows = np.column_stack([phase / 10.0, 0.01 * np.sin(phase), 2000.0 * np.sin(phase)])
    header = "time [s],displacement [m],force [N]"
    np.savetxt("spring.csv", rows, delimiter=",", header=header, comments="", fmt="%.9g")
    Path("campaign.toml").write_text('[[records]]\nfile = "spring.csv"\n')
    for verb in (["check"], ["discover"], ["gap", "--model", "fit:stiffness"]):
        assert main([verb[0], ".", *verb[1:], "-o", verb[0]]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert "\nFriction:" not in out.replace("\nFriction: not told from zero", "")
    study = json.loads((here / "discover" / "study.json").read_text())
    assert study["relative_error_percent"] < 0.01
    (band,) = study["bands"]
    friction = [t["interval"] for t in band["terms"] if t["id"].endswith("-friction")]
    assert all(low == 0.0 and high < 1.0 for low, high in friction)  # of 2,000 N
    assert "fractional-derivative" not in {t["id"] for t in band["terms"]}
    differs = (band.get("friction") or {"differs_by_record": 0.0})["differs_by_record"]
    assert differs < 1.0


@pytest.mark.usefixtures("undrawn")
def test_check_fails_where_the_force_has_the_wrong_sign(campaign, here, capsys):
    turned = here / "turned"
    turned.mkdir()
    for path in campaign.iterdir():
        text = path.read_text()
        if path.suffix == ".csv":
            head, *rows = text.splitlines()
            parts = [row.rsplit(",", 1) for row in rows]
            text = "\n".join([head, *(f"{a},{-float(f)!r}" for a, f in parts)]) + "\n"
        (turned / path.name).write_text(text)
    assert main(["check", str(turned)]) == 1
    out, err = capsys.readouterr()
    assert err == ""
    assert "Error: " in out
    assert out.splitlines()[-2] == "Check: failed."


@pytest.mark.parametrize("verb", ["check", "discover"])
def test_a_campaign_that_is_not_there_is_bad_input(verb, here, capsys):
    assert main([verb, "nowhere"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert "nowhere" in err
    assert err.count("\n") == 1


def test_a_record_that_is_not_what_its_label_says_is_bad_input(campaign, here, capsys):
    wrong = here / "wrong"
    wrong.mkdir()
    for path in campaign.iterdir():
        text = path.read_text().replace('frequency = "2 Hz"', 'frequency = "3 Hz"')
        (wrong / path.name).write_text(text)
    assert main(["discover", str(wrong)]) == 2
    err = capsys.readouterr().err
    assert "2hz-10mm.csv" in err
    assert "frequency" in err
    assert "Traceback" not in err


def test_results_never_go_into_a_folder_with_other_things(campaign, here, capsys):
    assert main(["check", str(campaign), "-o", str(campaign)]) == 2
    assert "earlier results" in capsys.readouterr().err
    assert tomllib.loads((campaign / "campaign.toml").read_text())["title"]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT for another process")
def test_ctrl_c_exits_130_without_a_traceback_and_leaves_no_results(here):
    process = subprocess.Popen(
        [sys.executable, "-m", "discover", "discover", "-o", "out"],
        cwd=here,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # a shell's background job ignores it, and so would what it starts
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    time.sleep(3.0)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert out == ""
    assert err == "inerter: interrupted\n"
    assert process.returncode == 130
    assert list(here.iterdir()) == []


@pytest.mark.usefixtures("undrawn")
def test_gap_with_another_model_leaves_the_first_answer_in_its_folder(campaign, here, capsys):
    for model in ("ioim-laminar", "fit:inertia,quadratic-damping,coulomb-friction"):
        arguments = ["--model", model, "--effects", "viscous-damping"]
        assert main(["gap", str(campaign), *arguments]) == 0
    assert capsys.readouterr().err == ""
    folders = {p.name for p in (here / "inerter-out").iterdir() if p.is_dir()}
    assert folders >= {
        "gap-laminar-ioim-laminar",
        "gap-laminar-fit-inertia-quadratic-damping-coulomb-friction",
    }
