import re
import tomllib

import numpy as np
import pytest

from discover.cli import main
from models.device import Device
from models.rig.seal import draw_seal

SHORT = ["--frequencies", "0.5,2", "--amplitudes", "5"]


def synth(folder, *arguments, device="device-12"):
    return main(["synth", str(folder), "--device", device, *SHORT, *arguments])


def columns(folder, name):
    return np.loadtxt(folder / name, delimiter=",", skiprows=1).T


def test_campaign_states_device_limits_and_records(tmp_path, capsys):
    assert synth(tmp_path / "rig", "--held-out", "1", "--title", 'A "quoted" title') == 0
    assert capsys.readouterr().out == (
        f"2 records in {tmp_path / 'rig'}; next: inerter check {tmp_path / 'rig'}\n"
    )
    table = tomllib.loads((tmp_path / "rig" / "campaign.toml").read_text())
    assert table["title"] == 'A "quoted" title'
    assert table["device"] == {"preset": "device-12"}
    assert table["rig"]["max_stroke"] == "25 mm"
    assert [r["frequency"] for r in table["records"]] == ["0.5 Hz", "2 Hz"]
    assert sum(r.get("held_out", False) for r in table["records"]) == 1
    for record in table["records"]:
        header = (tmp_path / "rig" / record["file"]).read_text().split("\n", 1)[0]
        assert header == "time [s],displacement [mm],force [kN]"


def test_the_same_seed_gives_the_same_bytes_and_another_does_not(tmp_path):
    for name, seed in (("a", "1"), ("b", "1"), ("c", "2")):
        synth(tmp_path / name, "--seed", seed)
    a, b, c = ((tmp_path / n / "2hz-5mm.csv").read_bytes() for n in "abc")
    assert a == b != c


def test_exact_laminar_records_satisfy_the_equation_of_motion(tmp_path):
    synth(tmp_path / "exact", "--model", "ioim-laminar", "--noise", "0")
    time, x, force = columns(tmp_path / "exact", "2hz-5mm.csv")
    device, omega = Device.preset("device-12"), 4.0 * np.pi
    v = 5e-3 * omega * np.cos(omega * time)
    a = -5e-3 * omega**2 * np.sin(omega * time)
    s1, s2 = np.pi * (0.028**2 - 0.012**2), np.pi * 0.005**2
    c1 = 0.75 * 800.0 * s1**3 / s2**2
    expected = 370.38 * a + c1 * v * np.abs(v) + 400.0 * np.sign(v)
    expected += device.laminar_coefficients.c2 * v
    inside = np.abs(v) > 1e-6  # sign(v) at v = 0 is a matter of round-off
    assert np.allclose(1e-3 * x, 5e-3 * np.sin(omega * time), atol=1e-12)
    error = 1e3 * force[inside] - expected[inside]
    assert np.max(np.abs(error)) < 1e-4 * np.max(np.abs(expected))


def test_noise_has_the_size_asked_for(tmp_path):
    synth(tmp_path / "quiet", "--model", "foim", "--noise", "0")
    synth(tmp_path / "loud", "--model", "foim", "--noise", "3%")
    quiet, loud = (columns(tmp_path / n, "0.5hz-5mm.csv")[2] for n in ("quiet", "loud"))
    assert np.std(loud - quiet) / np.sqrt(np.mean(quiet**2)) == pytest.approx(0.03, rel=0.1)


def test_sfoim_changes_its_order_across_the_boundary(tmp_path):
    arguments = ["--model", "sfoim", "--noise", "0", "--frequencies", "0.2,2"]
    synth(tmp_path / "sfoim", *arguments)
    phases = []
    for name, frequency in (("0.2hz-5mm.csv", 0.2), ("2hz-5mm.csv", 2.0)):
        time, _, force = columns(tmp_path / "sfoim", name)
        omega = 2.0 * np.pi * frequency
        force = 1e3 * force - 400.0 * np.sign(np.cos(omega * time))
        line = np.sum(force * np.exp(-1j * omega * time)) * 1j
        phases.append(np.angle(line) / (np.pi / 2.0))
    assert phases == pytest.approx([0.48, 1.89], abs=5e-3)


def test_a_hidden_effect_changes_the_force_by_its_size_and_is_told(tmp_path, capsys):
    synth(tmp_path / "plain", "--noise", "0")
    synth(tmp_path / "hidden", "--noise", "0", "--hide", "stiffness=10%")
    change, total, stroke = 0.0, 0.0, 0.0
    for name in ("0.5hz-5mm.csv", "2hz-5mm.csv"):
        plain, hidden = (columns(tmp_path / n, name)[2] for n in ("plain", "hidden"))
        change += np.sum((hidden - plain) ** 2)
        total += np.sum(plain**2)
        stroke += np.sum(columns(tmp_path / "plain", name)[1] ** 2)
    assert np.sqrt(change / total) == pytest.approx(0.10, rel=0.02)
    told = re.search(r"Hidden: stiffness:spring, (\S+) N/m", capsys.readouterr().out)
    assert told[0] in (tmp_path / "hidden" / "campaign.toml").read_text()
    assert float(told[1]) == pytest.approx(1e6 * np.sqrt(change / stroke), rel=0.02)  # kN, mm


def test_effects_at_the_seals_say_how_those_reverse(tmp_path, capsys):
    synth(tmp_path / "hidden", "--noise", "0", "--hide", "stribeck-friction=10%")
    told = capsys.readouterr().out
    seal = draw_seal(Device.preset("device-12"))
    assert f"reversal {seal.half_speed:.4g}" in told
    assert f"seals that reverse by: {seal.reversal.name}" in told


def test_a_folder_with_anything_in_it_is_refused(tmp_path, capsys):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("keep")
    assert synth(tmp_path / "mine") == 2
    assert "new or empty folder, got one that holds notes.txt" in capsys.readouterr().err
    assert [p.name for p in (tmp_path / "mine").iterdir()] == ["notes.txt"]


def test_a_model_and_a_hidden_effect_exclude_each_other(tmp_path, capsys):
    assert synth(tmp_path / "x", "--model", "foim", "--hide", "stiffness=3%") == 2
    assert "--hide must be used with the rig" in capsys.readouterr().err
