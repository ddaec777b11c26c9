"""Baselines from the device: what they hold, and what the answer says of them."""

import json
from pathlib import Path

import numpy as np
import pytest

from discover.cli import main
from discover.gap import close_gap
from discover.readers import read_campaign
from discover.records import Campaign
from models.checks import InputError
from models.device import Device
from tests.discover.gap_data import record

TWELVE = Device.preset("device-12")
NAMELESS = Device(
    **{f: getattr(TWELVE, f) for f in (
        "rod_radius", "cylinder_radius", "channel_radius", "helix_radius", "helix_pitch", "turns",
        "fluid",
    )}
)  # fmt: skip
FLUID = """
[device]
rod_radius = "12 mm"
cylinder_radius = "28 mm"
channel_radius = "5 mm"
helix_radius = "100 mm"
helix_pitch = "12 mm"
turns = 14
[device.fluid]
density = "800 kg/m^3"
viscosity = "27 mPa*s"
"""
LOW = [(f, a) for f in (0.15, 0.25, 0.4) for a in (0.003, 0.005)]
HIGH = [(f, a) for f in (1.0, 2.0, 4.0) for a in (0.005, 0.01)]


def fractional(frequency, amplitude, coefficient, order, friction=300.0):
    """Return coefficient D^order x + friction, of x = A sin(w t), by the textbook formula."""
    omega = 2.0 * np.pi * frequency

    def law(t, x, v, a):
        phase = omega * t + 0.5 * np.pi * order
        return coefficient * amplitude * omega**order * np.sin(phase) + friction * np.tanh(
            v / (0.02 * amplitude * omega)
        )

    return law


def records(plan, coefficient, order, rng):
    return [record(f, a, fractional(f, a, coefficient, order), rng, noise=0.002) for f, a in plan]


def two_bands():
    rng = np.random.default_rng(5)
    both = [*records(LOW, 6000.0, 0.6, rng), *records(HIGH, 600.0, 1.8, rng)]
    return Campaign("two bands", tuple(both), NAMELESS)


def test_foim_of_any_device_is_fitted_first():
    rng = np.random.default_rng(3)
    data = Campaign("one band", tuple(records(HIGH, 600.0, 1.8, rng)), NAMELESS)
    found = close_gap(data, "foim", fixed=True)
    assert found.fitted
    first = found.baseline[0]
    assert first.id == "fractional-derivative"
    assert first.coefficient == pytest.approx(600.0, rel=0.02)
    assert first.shape["order"] == pytest.approx(1.8, abs=0.01)


def test_sfoim_of_any_device_is_fitted_band_by_band():
    found = close_gap(two_bands(), "sfoim")
    assert (found.fitted, found.fixed) == (True, True)
    below, above = found.given.bands
    assert below.upper == above.lower == 100.0
    for band, coefficient, order in ((below, 6000.0, 0.6), (above, 600.0, 1.8)):
        term = band.model.terms[0]
        assert term.shape["order"] == pytest.approx(order, abs=0.02)
        assert term.coefficient == pytest.approx(coefficient, rel=0.03)
    document = found.to_dict()["baseline"]
    assert [b["lower"] for b in document["bands"]] == [None, 100.0]
    assert document["convention"] == "paper"
    assert found.gap_percent < 2.0


def test_sfoim_needs_a_device_and_records_in_both_bands():
    data = two_bands()
    with pytest.raises(InputError, match="sfoim must be used with a device"):
        close_gap(Campaign("no device", data.records), "sfoim")
    with pytest.raises(InputError, match="both sides of De 100 for sfoim, got all above"):
        close_gap(Campaign("high", data.records[6:], NAMELESS), "sfoim")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Records of a device that is none of the paper's, without friction or clearance given."""
    where = tmp_path_factory.mktemp("campaigns") / "own-device"
    where.mkdir()
    text = 'title = "My device"\n' + FLUID
    for r in two_bands().records:
        columns = np.column_stack([r.time, 1e3 * r.displacement, r.force])
        header = "time [s],displacement [mm],force [N]"
        np.savetxt(where / r.file, columns, "%.9g", ",", header=header, comments="")
        text += f'[[records]]\nfile = "{r.file}"\n'
    (where / "campaign.toml").write_text(text)
    return where


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("model", "notes"),
    [
        ("ioim-turbulent", ["without Coulomb friction", "without its film term"]),
        ("foim", ["Fitted first, with b = 362.2 kg of the device: b0 = "]),
        ("sfoim", ["several bands: its coefficients are held", "and b0 = "]),
    ],
)
def test_the_answer_says_what_the_baseline_is(
    folder, tmp_path, monkeypatch, capsys, model, notes
):
    monkeypatch.chdir(tmp_path)
    only = ["--effects", "coulomb-friction,viscous-damping"]
    assert main(["gap", str(folder), "--model", model, *only, "--json", "-o", "out"]) == 0
    document = json.loads(capsys.readouterr().out)
    said = " ".join(f["text"] for f in document["findings"])
    for note in notes:
        assert note in said
    page = (tmp_path / "out" / "report.html").read_text()
    assert ("Dean number, paper convention, below 100" in page) == (model == "sfoim")


@pytest.mark.usefixtures("undrawn")
def test_presets_keep_the_papers_values_and_nothing_is_left_out(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    plan = ["--frequencies", "0.5,2,6", "--amplitudes", "5,10", "--noise", "0.5%"]
    made = ["synth", "made", "--device", "device-12", "--model", "sfoim", *plan]
    assert main(made) == 0
    capsys.readouterr()
    assert main(["gap", "made", "--model", "sfoim", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["verdict"] == "agrees"
    assert document["baseline"]["fitted"] is False
    orders = [b["terms"][0]["order"] for b in document["baseline"]["bands"]]
    assert orders == [0.48, 1.89]
    assert not any("without" in f["text"] for f in document["findings"])


@pytest.mark.sweep
def test_from_a_baseline_that_lacks_much_the_shipped_campaign_closes_with_what_is_there():
    """The asymmetry's shape is chosen before the quadratic damping is there, and again after."""
    records = read_campaign(Path(__file__).parents[2] / "data" / "hidden-effect")
    gap = close_gap(records, "fit:inertia,viscous-damping")
    assert gap.verdict == "closed"
    named = {r.effect for r in gap.rounds}
    assert named == {"coulomb-friction", "asymmetric-damping", "quadratic-damping"}
    terms = gap.model.bands[0].model.terms
    (asymmetry,) = (t for t in terms if t.id == "asymmetric-damping")
    assert asymmetry.shape == {"power": 1.0, "side": 0.0}
    assert asymmetry.coefficient == pytest.approx(900.0, rel=0.1)
