"""Predicted forces against records from closed forms, through the library and the command."""

from __future__ import annotations

import csv
import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest

from discover.cli import main
from discover.records import Campaign, Record
from discover.simulate import simulate_forces
from models.checks import InputError
from models.constitutive import Band, FittedTerm, ForceModel, SegmentedModel
from models.device import Device

_SPEC = importlib.util.spec_from_file_location("exact", Path(__file__).with_name("exact.py"))
exact = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(exact)

OPTIONS = {"frequencies": (0.5, 2.0, 6.0), "amplitudes": (0.005, 0.02), "cycles": 5.0}


def foim_terms(product, order, friction):
    return ForceModel(
        (
            FittedTerm("fractional-derivative", product, {"order": order}),
            FittedTerm("coulomb-friction", friction),
        ),
        "true",
    )


def test_the_model_that_made_the_records_predicts_to_within_their_noise():
    campaign = exact.campaign(exact.fractional(581.5, 1.89, 400.0), noise=0.01, **OPTIONS)
    answer = simulate_forces(campaign, {"true": foim_terms(581.5, 1.89, 400.0)})
    for record in answer.to_dict()["models"][0]["records"]:
        assert record["relative_error_percent"] == pytest.approx(1.0, abs=0.03)
        assert 0.8 < record["noise_percent"] < 1.6  # of five cycles, an estimate
        assert 0.5 < record["error_percent"] < 1.1  # of the peak, which is 1 to 1.4 times the rms
    assert any("within the noise" in f.text for f in answer.findings)


def test_models_are_ranked_on_held_out_records():
    law = exact.fractional(581.5, 1.89, 400.0)
    campaign = exact.campaign(law, noise=0.01, held_out=(1, 4), **OPTIONS)
    models = {
        "worst": foim_terms(581.5, 1.7, 400.0),
        "true": foim_terms(581.5, 1.89, 400.0),
        "near": foim_terms(581.5, 1.88, 400.0),
    }
    answer = simulate_forces(campaign, models)
    assert [m.name for m in answer.ranked] == ["true", "near", "worst"]
    document = answer.to_dict()
    assert document["ranked_on"] == "held-out records"
    assert [m["rank"] for m in document["models"]] == [3, 1, 2]
    assert sum(r["held_out"] for r in document["models"][0]["records"]) == 2
    # A model that is right only where it was fitted loses to one that is right elsewhere.
    held_out_only = Campaign("t", tuple(r for r in campaign.records if r.held_out))
    worst = simulate_forces(held_out_only, models).models[0]
    pooled = answer.models[0].relative_percent(held_out=True)
    assert worst.relative_percent() == pytest.approx(pooled)


def test_a_ranking_without_held_out_records_says_so():
    campaign = exact.campaign(exact.fractional(581.5, 1.89, 400.0), noise=0.01, **OPTIONS)
    models = {"a": foim_terms(581.5, 1.7, 400.0), "b": foim_terms(581.5, 1.89, 400.0)}
    answer = simulate_forces(campaign, models)
    assert answer.to_dict()["ranked_on"] == "all records"
    assert any("No record is held out" in f.text for f in answer.findings)


def test_a_segmented_model_uses_the_band_of_each_record():
    low, high = (3000.0, 1.3, 200.0), (581.5, 1.89, 400.0)
    device = Device.preset("device-12")
    campaign = exact.campaign(
        exact.segmented(device, low, high), device=device, noise=0.01,
        frequencies=(0.1, 0.2, 0.8, 3.0), amplitudes=(0.005, 0.01), cycles=5.0,
    )  # fmt: skip
    bands = (Band(None, 100.0, foim_terms(*low)), Band(100.0, None, foim_terms(*high)))
    answer = simulate_forces(campaign, {"s": SegmentedModel(bands, "dean", "paper", device)})
    assert answer.models[0].relative_percent() == pytest.approx(1.0, abs=0.1)
    used = {r.accuracy.observation.file: r.bands for r in answer.models[0].records}
    # De = 100 lies at 0.664 Hz for 5 mm and at 0.332 Hz for 10 mm.
    assert used["0.2hz-5mm.csv"] == used["0.2hz-10mm.csv"] == (0,)
    assert used["0.8hz-5mm.csv"] == used["0.8hz-10mm.csv"] == (1,)
    with pytest.raises(InputError, match="device of a model segmented"):
        simulate_forces(campaign, {"s": SegmentedModel(bands, "dean", "paper")})


def sweep_record(law, *, noise=0.0):
    """A sine whose frequency rises from 0.5 to 4 Hz, in closed form with its derivatives."""
    t = np.arange(20_000) / 1000.0
    rate = np.log(8.0) / 20.0
    phase = 2.0 * np.pi * 0.5 / rate * np.expm1(rate * t)
    w = 2.0 * np.pi * 0.5 * np.exp(rate * t)
    x = 0.01 * np.sin(phase)
    v = 0.01 * w * np.cos(phase)
    a = 0.01 * (rate * w * np.cos(phase) - w**2 * np.sin(phase))
    return Record("sweep.csv", t, law(v, a), x)


def test_bands_change_along_a_sweep():
    record = sweep_record(lambda v, a: 100.0 * a + 50.0 * v)
    inner = ForceModel((FittedTerm("inertia", 100.0), FittedTerm("viscous-damping", 50.0)))
    same = SegmentedModel((Band(None, 1.5, inner), Band(1.5, None, inner)), "frequency")
    other = ForceModel((FittedTerm("inertia", 100.0), FittedTerm("viscous-damping", 500.0)))
    mixed = SegmentedModel((Band(None, 1.5, inner), Band(1.5, None, other)), "frequency")
    answer = simulate_forces(
        Campaign("sweep", (record,)), {"plain": inner, "same": same, "mixed": mixed}
    )
    plain, split, wrong = answer.models
    assert plain.relative_percent() < 0.5
    assert split.relative_percent() == pytest.approx(plain.relative_percent(), rel=1e-9)
    assert wrong.records[0].bands == (0, 1)
    early = wrong.records[0].accuracy
    gap = np.abs(early.model_force - plain.records[0].accuracy.model_force)
    assert gap[:2000].max() < 1e-3 * gap[-2000:].max()


def test_no_model_is_refused():
    with pytest.raises(InputError, match="models must be at least one"):
        simulate_forces(Campaign("t", ()), {})


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaigns") / "laminar"
    plan = ["--frequencies", "0.5,2", "--amplitudes", "10", "--held-out", "1"]
    arguments = ["--device", "device-12", "--model", "ioim-laminar", "--noise", "0.5%", *plan]
    assert main(["synth", str(folder), *arguments]) == 0
    return folder


def test_the_command_writes_the_document_and_a_table_a_record(folder, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["simulate", "foim", "ioim-laminar", str(folder), "-o", str(out)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("1. ioim-laminar: misses")
    assert lines[1].startswith("2. foim: misses")
    document = json.loads((out / "simulation.json").read_text())
    assert document["schema"] == "inerter.simulation/1"
    assert [m["name"] for m in document["models"]] == ["foim", "ioim-laminar"]
    files = [r["file"] for r in document["models"][0]["records"]]
    assert {p.name for p in out.glob("*.csv")} == set(files)
    with (out / files[0]).open() as table:
        rows = list(csv.DictReader(table))
    force = np.array([float(r["force [N]"]) for r in rows])
    model = np.array([float(r["ioim-laminar [N]"]) for r in rows])
    error = 100.0 * np.linalg.norm(force - model) / np.linalg.norm(force)
    stated = document["models"][1]["records"][0]["relative_error_percent"]
    assert error == pytest.approx(stated, rel=1e-3)


def test_the_command_prints_the_document_alone_with_json(folder, tmp_path, capsys):
    assert main(["simulate", "foim", str(folder), "--json", "-o", str(tmp_path / "o")]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["models"][0]["rank"] == 1
    assert err == ""


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["foim"], "models and then a campaign"),
        (["foim", "foim", "CAMPAIGN"], "foim twice"),
        (["nonsense", "CAMPAIGN"], "one of ioim-laminar"),
        (["foim", "no-such-folder"], "no-such-folder"),
    ],
)
def test_bad_input_is_one_line_and_exit_2(folder, tmp_path, capsys, arguments, said):
    given = [str(folder) if a == "CAMPAIGN" else a for a in arguments]
    assert main(["simulate", *given, "-o", str(tmp_path / "out")]) == 2
    err = capsys.readouterr().err
    assert len(err.splitlines()) == 1
    assert said in err
