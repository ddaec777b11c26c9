"""Records of the virtual rig in the place of the paper's experiments, which are not public."""

from __future__ import annotations

from discover.records import Record
from discover.reproduction import IDENTIFIED, StandIn
from models.rig import Chain, Plan, run, sine_point


def rig_stand_ins(*, noise: float, seed: int) -> list[StandIn]:
    """Return one record for each test that the paper identified a model from.

    Parameters
    ----------
    noise : float
        rms noise of the force over its rms.
    seed : int
        Makes them repeatable.

    Examples
    --------
    >>> [item.record.file for item in rig_stand_ins(noise=0.01, seed=0)]
    ['0.5hz-20mm.csv', '12hz-5mm.csv', '3hz-17.5mm.csv']
    """
    made = []
    for one in IDENTIFIED:
        condition = one.condition
        plan = Plan((sine_point(condition.frequency, condition.amplitude),))
        measured = run(condition.device, plan, seed=seed, chain=Chain(noise=noise))[0]
        record = Record(
            measured.file,
            measured.time,
            measured.force,
            measured.displacement,
            frequency=measured.frequency,
            amplitude=measured.amplitude,
        )
        made.append(StandIn(one, record))
    return made
