"""A stored model that is not one is refused in one line; what was stored is read back."""

from __future__ import annotations

import copy
import json
import math

import pytest

from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel, SegmentedModel, ioim_laminar, sfoim
from models.device import Device
from models.terms import TERMS

DEVICE = Device.preset("device-12")
TWO = sfoim(DEVICE, (18.25, 0.48), (0.57, 1.89)).to_dict()
LAMINAR = {
    "schema": "inerter.model/1",
    "bands": [{"lower": None, "coordinate": "speed", **ioim_laminar(DEVICE).to_dict()}],
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(TERMS))
def test_every_term_is_read_back_at_the_ends_of_its_shape(name: str) -> None:
    term = TERMS[name]
    for end in ("lower", "upper"):
        shape = {p.name: getattr(p, end) for p in term.parameters}
        stored = json.loads(json.dumps(FittedTerm(name, 1.5, shape).to_dict()))
        assert dict(FittedTerm.from_dict(stored).shape) == shape


def test_a_segmented_model_is_read_back() -> None:
    stored = json.loads(json.dumps(TWO))
    assert SegmentedModel.from_dict(stored).to_dict() == TWO


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("schema",), "inerter.model/99", r"schema must be 'inerter.model/1', got 'inerter.model/"),
        (("schema",), "inerter.study/1", r"schema must be 'inerter.model/1', got 'inerter.study/1"),
        (("bands",), {}, "bands must be a list of bands, got {}"),
        (("bands",), "x", "bands must be a list of bands, got 'x'"),
        (("bands",), [], "bands must be a list of bands"),
        (("bands", 0), 3, "a band must be a table, got 3"),
        (("bands", 0, "lower"), math.nan, "lower must be a finite number"),
        (("bands", 0, "lower"), "1", "lower must be a number, got '1'"),
        (("bands", 0, "upper"), True, "upper must be a number, got True"),
        (("bands", 0, "coordinate"), "x", "coordinate must be one of dean, speed, frequency"),
        (("bands", 0, "coordinate"), 7, "coordinate must be text, got 7"),
        (("bands", 0, "terms"), "inertia", "terms must be a list, got 'inertia'"),
        (("bands", 0, "terms", 0), [], r"a term must be a table, got \[\]"),
        (("bands", 0, "terms", 0, "id"), ["inertia"], "id of a term must be text"),
        (("bands", 0, "terms", 0, "id"), "inertai", "did you mean 'inertia'"),
        (("bands", 0, "terms", 0, "coefficient"), True, "coefficient of inertia must be a number"),
        (("bands", 0, "terms", 0, "coefficient"), None, "coefficient of inertia must be a number"),
        (("bands", 0, "terms", 0, "coefficient"), 1e300, "coefficient of inertia must be a finite"),
        (("bands", 0, "terms", 0, "coefficient"), 10**400, "coefficient of inertia must be a fin"),
        (("bands", 0, "terms", 0), {"id": "time-delay", "coefficient": 1e-3, "filter_order": -3},
         "time-delay.filter_order must be from 0 to 4, got -3"),
        (("bands", 0, "terms", 0), {"id": "coulomb-friction", "coefficient": 1, "form": "x"},
         "coulomb-friction.form must be a number, got 'x'"),
        (("bands", 0, "terms", 0), {"id": "end-stop", "coefficient": 1.0},
         "m.json: end-stop.gap must be given"),
        (("bands", 0, "terms", 0), {"id": "end-stop", "coefficient": 1.0, "gap": -1.0},
         "end-stop.gap must be from 0 to inf, got -1"),
        (("convention",), "x", "convention must be one of paper, standard, got 'x'"),
        (("name",), 5, "name must be text, got 5"),
        (("device",), "device-12", "device must be a table, got 'device-12'"),
        (("device",), {"preset": 12}, "preset must be text, got 12"),
        (("device",), {"preset": "device-12", "turns": True}, "turns must be a number, got True"),
        (("device",), {"preset": "device-12", "fluid": {"density": "800"}}, "density must be a"),
        (("added",), "inertia", "added must be a list of ids"),
        (("added",), [["inertia"]], "added must be a list of ids"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(path: tuple, value: object, message: str) -> None:
    stored = copy.deepcopy(LAMINAR)
    holder = stored
    for key in path[:-1]:
        holder = holder[key]
    holder[path[-1]] = value
    with pytest.raises(InputError, match=message) as caught:
        SegmentedModel.from_dict(stored, where="m.json")
    assert str(caught.value).startswith("m.json")
    assert "\n" not in str(caught.value)


def test_bands_rise() -> None:
    stored = json.loads(json.dumps(TWO))
    stored["bands"].reverse()
    with pytest.raises(InputError, match="bands must be in rising order, got one up to None"):
        SegmentedModel.from_dict(stored)
    stored = json.loads(json.dumps(TWO))
    stored["bands"][1]["lower"], stored["bands"][1]["upper"] = 300.0, 200.0
    with pytest.raises(InputError, match="band must be with lower below upper, got 300 to 200"):
        SegmentedModel.from_dict(stored)
    stored = json.loads(json.dumps(TWO))
    stored["bands"][1]["coordinate"] = "speed"
    with pytest.raises(
        InputError, match="coordinate must be one for all bands, got dean and speed"
    ):
        SegmentedModel.from_dict(stored)


def test_a_force_model_of_no_terms_is_read_back() -> None:
    assert ForceModel.from_dict(ForceModel(()).to_dict()) == ForceModel(())
