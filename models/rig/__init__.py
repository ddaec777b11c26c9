"""The virtual test rig: records of a device from the physics of its flow, not from model terms.

It shares no code with the terms that discovery fits: the force comes from friction correlations,
the exact impedance of oscillating flow, seals that deflect and slide (or, in the simple physics,
reverse by a law drawn for the device), and oil that yields; `hidden` puts further effects in, in
forms of their own. Everything follows from a seed and the device.
"""

from models.rig.campaign import RigRecord, run
from models.rig.chain import Chain, measure
from models.rig.devices import random_device
from models.rig.effects import CATALOGUE, FORMS, OUTSIDE, Effect, find_effect
from models.rig.hiding import Hidden
from models.rig.physics import RigPhysics
from models.rig.plan import Limits, Plan, TestPoint, sine_plan, sine_point, transient_plan

__all__ = [
    "CATALOGUE",
    "FORMS",
    "OUTSIDE",
    "Chain",
    "Effect",
    "Hidden",
    "Limits",
    "Plan",
    "RigPhysics",
    "RigRecord",
    "TestPoint",
    "find_effect",
    "measure",
    "random_device",
    "run",
    "sine_plan",
    "sine_point",
    "transient_plan",
]
