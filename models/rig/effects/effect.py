"""What a hidden effect is: a change of the force that the rig's load cell reports."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from models.checks import Array
from models.rig.bench import Bench, Scales

Values = Mapping[str, float]
Draw = Callable[[np.random.Generator, Scales], dict[str, float]]
Change = Callable[[Bench, Array, float, Values], Array]


def nothing_to_draw(rng: np.random.Generator, scales: Scales) -> dict[str, float]:
    """Return no parameters: for effects that only have a size."""
    return {}


@dataclass(frozen=True)
class Effect:
    """One physical form of one effect."""

    id: str
    """The catalogue's id, or "outside:" and a name where the catalogue has none."""
    form: str
    """Name of the physical form."""
    summary: str
    """The physics in one line, with the formula."""
    change: Change
    """(bench, force (M,), amount, parameters) -> change of the force (M,), N."""
    draw: Draw = nothing_to_draw
    """Draws the parameters that the size doesn't set, in proportion to the campaign's scales."""
    linear: bool = True
    """True where the change is proportional to the amount."""
    acts: Literal["force", "input", "output"] = "force"
    """Added at the piston, before the device, or behind it in the measuring chain."""
    start: Callable[[Scales], float] | None = None
    """First guess of the amount, where it is searched (not linear)."""
    unit: str = ""
    """SI unit of the amount."""
    at_seals: bool = False
    """True where the device's own seals rub: they reverse by their law at their half speed, which
    is parameter `reversal` whatever `draw` gives for it."""


def seal_direction(bench: Bench, values: Values) -> Array:
    """Return the device's seals' friction over its limit (M,), -1 to 1."""
    return bench.law.seal.reversal.share(bench.v / values["reversal"])
