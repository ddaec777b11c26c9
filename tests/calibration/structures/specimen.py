"""One device on the rig: its laws along the plan and its friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.device import Device
from tests.calibration.structures.devices import Bands, coordinates
from tests.calibration.structures.friction import Friction
from tests.calibration.structures.motion import Motion
from tests.calibration.structures.plans import Run

Array = np.ndarray


@dataclass(frozen=True)
class Specimen:
    """A device with its records' motions."""

    device: Device
    """Geometry and oil."""
    runs: tuple[Run, ...]
    """Its records."""
    bands: Bands
    """The fluid's laws."""
    friction: Friction
    """The seals."""

    def weights(self, i: int) -> Array:
        """Return the share of each law (B,) in a record."""
        coordinate = self.bands.coordinate or "frequency"
        return self.bands.weights(float(self.places(coordinate)[i]))

    def places(self, coordinate: str) -> Array:
        """Return the records' places (R,) along a coordinate."""
        return coordinates(self.device, self.runs, coordinate)

    def parts(self, i: int, motion: Motion) -> dict[str, Array]:
        """Return the fluid's forces by term along a motion in the state of a record (N,), N."""
        found: dict[str, Array] = {}
        for k, (law, weight) in enumerate(zip(self.bands.laws, self.weights(i), strict=True)):
            if weight > 0.0:
                found |= {f"{k} {n}": weight * f for n, f in law.parts(motion).items()}
        return found

    def fluid(self, i: int, motion: Motion | None = None) -> Array:
        """Return the fluid's force at the samples (N,), N."""
        return np.sum(list(self.parts(i, motion or self.runs[i].motion).values()), axis=0)

    def damping(self, i: int) -> Array:
        """Return what of the fluid's force resists speed at the samples (N,), N."""
        motion = self.runs[i].motion
        return np.sum(
            [
                w * law.damping(motion)
                for law, w in zip(self.bands.laws, self.weights(i), strict=True)
            ],
            axis=0,
        )

    def force(self, i: int, motion: Motion | None = None) -> Array:
        """Return the whole force at the samples (N,), N."""
        driven = motion or self.runs[i].motion
        return self.fluid(i, driven) + self.friction.force(driven, i)


def share(changes: Sequence[Array], forces: Sequence[Array]) -> float:
    """Return the size of changes of force: rms over records of each record's share."""
    return float(np.sqrt(np.mean([np.mean(c**2) / np.mean(f**2) for c, f in zip(
        changes, forces, strict=True)])))


def pooled(changes: Sequence[Array], forces: Sequence[Array]) -> float:
    """Return the size of changes of force pooled over all samples."""
    square = sum(float(c @ c) for c in changes)
    return float(np.sqrt(square / sum(float(f @ f) for f in forces)))
