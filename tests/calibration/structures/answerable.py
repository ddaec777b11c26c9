"""Whether a campaign's records can tell what is asked of them; it is drawn again where not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tests.calibration.structures.devices import Redraw
from tests.calibration.structures.extras import OWN
from tests.calibration.structures.noise import Noise
from tests.calibration.structures.specimen import Specimen
from tests.calibration.structures.told import (
    Evidence,
    best_cuts,
    evidence,
    nearest_core,
    nearest_extra,
    pieces,
    without_boundary,
)

Array = np.ndarray

TOLD = 12.0
"""Nats by which the nearest rival has to miss what is asked for."""
BESIDE = 6.0
"""Nats that tell on which side of a boundary the records beside it lie."""
ABSENT = 20.0
"""Nats by which a device misses its records without its extra."""


def judged(
    name: str, kind: str, effect: str, specimen: Specimen, changes: Sequence[Array], noise: Noise,
    levels: Sequence[float], beside: Sequence[str],
) -> tuple[float, bool]:
    """Return nats against the nearest rival and whether the coordinate is told.

    Parameters
    ----------
    name, kind, effect : str
        The case's set, kind of device and hidden effect.
    specimen : Specimen
        The device.
    changes : sequence of array
        (N,) what effects change of each record's force, N.
    noise : Noise
        Its colour.
    levels : sequence of float
        Its rms in each record, N.
    beside : sequence of str
        Columns of what is hidden: a rival may have them too.

    Raises
    ------
    Redraw
        Where a rival is nearer than the set allows; thin data may tell nothing.
    """
    found = _evidence(specimen, None, noise, levels)
    cores = [law.core for law in specimen.bands.laws]
    members = members_of(specimen)
    if kind in ("three-bands", "gradual"):
        nats = np.inf
    else:
        nats = min(
            nearest_core(found, core, own, beside)
            for core, own in zip(cores, members, strict=True)
        )
    if name == "thin":
        return float(nats), True
    _least(nats, TOLD)
    told = True
    if specimen.bands.boundaries:
        more, told = _boundaries_told(found, specimen, beside, gradual=kind == "gradual")
        nats = min(nats, more)
        _least(nats, TOLD)
    if name == "one-extra":
        whole = _evidence(specimen, changes, noise, levels)
        _extra_told(whole, effect, members)
    return float(nats), told


def _least(nats: float, bar: float) -> None:
    if nats < bar:
        raise Redraw(f"a rival is {nats:.1f} nats away")


def _evidence(
    specimen: Specimen, changes: Sequence[Array] | None, noise: Noise, levels: Sequence[float]
) -> Evidence:
    fluids = [specimen.fluid(i) for i in range(len(specimen.runs))]
    directions = [specimen.friction.direction(r.motion) for r in specimen.runs]
    targets = fluids
    if changes is not None:
        targets = [f + c for f, c in zip(fluids, changes, strict=True)]
    return evidence(specimen.runs, targets, fluids, directions, noise, levels)


def members_of(specimen: Specimen) -> list[list[int]]:
    """Return the records of each band; by the greater weight where a boundary is gradual."""
    found: list[list[int]] = [[] for _ in specimen.bands.laws]
    for i in range(len(specimen.runs)):
        found[int(np.argmax(specimen.weights(i)))].append(i)
    return found


def _boundaries_told(
    found: Evidence, specimen: Specimen, beside: Sequence[str], *, gradual: bool
) -> tuple[float, bool]:
    bands = specimen.bands
    order = [int(i) for i in np.argsort(specimen.places(bands.coordinate))]
    sizes = [len(m) for m in members_of(specimen)]
    cuts = [int(c) for c in np.cumsum(sizes)[:-1]]
    other = "frequency" if bands.coordinate == "dean" else "dean"
    elsewhere = [int(i) for i in np.argsort(specimen.places(other))]
    least = best_cuts(found, order, len(cuts)) if gradual else pieces(found, order, cuts)
    nats = without_boundary(found, beside) - least
    _least(nats, TOLD)
    if not gradual:
        for k in range(len(cuts)):
            for side in (-1, 1):
                moved = [*cuts[:k], cuts[k] + side, *cuts[k + 1 :]]
                _least(pieces(found, order, moved) - least, BESIDE)
    if len(cuts) > 1:
        nats = min(nats, best_cuts(found, order, len(cuts) - 1) - least)
        _least(nats, TOLD)
    return nats, best_cuts(found, elsewhere, len(cuts)) - least >= TOLD


def _extra_told(found: Evidence, effect: str, members: Sequence[Sequence[int]]) -> None:
    """Redraw where any core explains a band without the extra, or with another in its place."""
    for own in members:
        part = Evidence(found.products[list(own)])
        if nearest_extra(part, OWN[effect]) >= ABSENT:
            return
    raise Redraw("the extra can't be told")
