"""The curves of the paper's Figures 2 to 5 and 7 to 9, from its formulas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from discover.reproduction.error_measure import SAMPLES, deviation_percent
from discover.reproduction.paper import M1, M2, M3, Condition, Identified, integer_order_model
from models.checks import Array
from models.device import Device
from models.flow import dean, reynolds
from models.motion import sine_motion

ABSENT = "The measured curves are not public and are absent here."


@dataclass(frozen=True)
class Curve:
    """A curve with its name."""

    label: str
    """For the legend."""
    x: Array
    """(N,) s or Hz."""
    y: Array
    """(N,) N, or dimensionless."""


@dataclass(frozen=True)
class Panel:
    """One picture of a figure."""

    title: str
    """What it shows."""
    curves: tuple[Curve, ...]
    """At least one."""
    note: str = ""
    """What the curves add up to."""


@dataclass(frozen=True)
class PaperFigure:
    """A figure of the paper, redrawn."""

    number: int
    """The paper's number."""
    caption: str
    """What it shows and what is absent."""
    kind: str
    """"force" (over time), "numbers" (over frequency)."""
    panels: tuple[Panel, ...]
    """In the paper's order."""


def force_panel(condition: Condition, *identified: Identified) -> Panel:
    """Return fractional models and the integer-order model over one cycle of a sine test."""
    motion = sine_motion(condition.amplitude, condition.frequency, samples=SAMPLES)
    reference = integer_order_model(condition.device).force(motion)
    curves = [Curve("IOIM", motion.time, reference)]
    notes = []
    for one in identified:
        force = one.model().force(motion)
        curves.append(Curve(f"FOIM ({one.name})", motion.time, force))
        notes.append(f"{one.name}: e_d {deviation_percent(force, reference):.2f} %")
    return Panel(condition.label, tuple(curves), ", ".join(notes))


def numbers_panel(quantity: str) -> Panel:
    """Return the amplitude of "reynolds" or "dean" over frequency, paper's convention."""
    rule = {"reynolds": reynolds, "dean": dean}[quantity]
    frequency = np.geomspace(0.01, 5.0, 201)
    curves = []
    for name in ("device-12", "device-10"):
        for amplitude in (0.005, 0.01):
            speed = 2.0 * np.pi * frequency * amplitude
            label = f"[{name.removeprefix('device-')}], {1e3 * amplitude:g} mm"
            curves.append(Curve(label, frequency, rule(Device.preset(name), speed)))
    return Panel({"reynolds": "Re amplitude", "dean": "De amplitude"}[quantity], tuple(curves))


def paper_figures() -> tuple[PaperFigure, ...]:
    """Return every figure that formulas can redraw (1 and 6 are drawings of devices and flow)."""

    def on_12(frequency: float, amplitude: float) -> Condition:
        return Condition("device-12", frequency, amplitude)

    def on_10(frequency: float, amplitude: float) -> Condition:
        return Condition("device-10", frequency, amplitude)

    return (
        PaperFigure(
            2, f"Device [12] at the two records the models were identified from. {ABSENT}",
            "force", (force_panel(on_12(0.5, 0.02), M1), force_panel(on_12(12.0, 0.005), M2)),
        ),
        PaperFigure(
            3, "Device [12] at other frequencies, M2 against the integer-order model.", "force",
            tuple(force_panel(c, M2) for c in (on_12(3, 0.01), on_12(8, 0.005), on_12(15, 0.005))),
        ),
        PaperFigure(
            4, f"Device [10] at the record M3 was identified from. {ABSENT}", "force",
            (force_panel(on_10(3.0, 0.0175), M3),),
        ),
        PaperFigure(
            5, "Device [10] at other frequencies, M3 against the integer-order model.", "force",
            tuple(
                force_panel(c, M3) for c in (on_10(0.5, 0.015), on_10(8, 0.005), on_10(12, 0.005))
            ),
        ),
        PaperFigure(
            7, "Reynolds and Dean number amplitude over frequency, the paper's convention (the "
            "standard Re is half, the standard De 1/2.83 of it). The line is the criterion: "
            "Re = 2000, De = 100.",
            "numbers", (numbers_panel("reynolds"), numbers_panel("dean")),
        ),
        PaperFigure(
            8, "Device [12] below the critical frequency: the paper says that M1 is the closer.",
            "force", tuple(force_panel(on_12(f, 0.005), M1, M2) for f in (0.3, 0.5)),
        ),
        PaperFigure(
            9, "Device [12] above the critical frequency: the paper says that M2 is the closer.",
            "force", tuple(force_panel(on_12(f, 0.005), M1, M2) for f in (2.0, 5.0)),
        ),
    )
