"""Malformed ``model.json`` files by seed."""

from __future__ import annotations

import copy
import json
import random

from models.constitutive import FittedTerm, ForceModel, ioim_laminar, sfoim
from models.device import Device
from models.terms import TERMS
from tests.calibration.malformed.values import mutate


def _whole() -> list[dict]:
    """Return valid documents: every term, two bands, a device."""
    device = Device.preset("device-12")
    laminar = ioim_laminar(device).to_dict()
    one = {
        "schema": "inerter.model/1", "version": "0.1", "seed": 0, "name": "laminar",
        "campaign": {"title": "x", "hash": "y"}, "convention": "paper",
        "bands": [{"lower": None, "upper": None, "coordinate": "speed", **laminar}],
        "device": device.to_dict(),
    }  # fmt: skip
    two = sfoim(device, (18.25, 0.48), (0.57, 1.89)).to_dict()
    every = []
    for term in TERMS.values():
        shape = {p.name: p.default for p in term.parameters if p.default}
        every.append(FittedTerm(term.id, 1.0, shape).to_dict())
    wide = copy.deepcopy(one)
    wide["bands"][0]["terms"] = every
    return [one, two, wide, ForceModel(()).to_dict() | {"bands": one["bands"]}]


def malformed_model(seed: int) -> bytes:
    """Return one file: a valid document changed in one to four places, or its bytes damaged."""
    rng = random.Random(seed)
    document = json.loads(json.dumps(rng.choice(_whole())))
    turn = rng.random()
    if turn < 0.85:
        for _ in range(rng.randrange(1, 5)):
            if document:
                mutate(document, rng)
        return json.dumps(document).encode("utf-8", "surrogatepass")
    text = bytearray(json.dumps(document).encode())
    if turn < 0.9:
        return b'{"bands":' + b"[" * rng.choice((500, 20000, 200000))
    if turn < 0.94:
        return bytes(text).replace(b"null", b"9" * rng.choice((400, 5000)), 1)
    for _ in range(rng.randrange(1, 6)):
        text[rng.randrange(len(text))] = rng.randrange(256)
    return bytes(text[: rng.randrange(len(text))] if rng.random() < 0.3 else text)
