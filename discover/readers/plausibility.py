"""Units that make no sense: a campaign's sizes held to common sense, the device and the rig."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from discover.readers.columns import QUANTITIES
from discover.readers.fastest_motion import fastest_motion
from discover.readers.units import SI_UNITS, to_si
from discover.record_checks import apparent_of
from discover.records import Finding, Record, RigLimits
from models.checks import InputError
from models.device import Device


@dataclass(frozen=True)
class Sizes:
    """What a campaign's records are like, the median over them, in SI."""

    amplitude: float
    """m, half the stroke."""
    frequency: float
    """Hz, of the fastest motion."""
    force: float
    """N, half the range."""
    step: float
    """s, the sampling interval."""
    inertance: float | None
    """kg, apparent, of records whose force is much of inertia; None where none is asked for."""


@dataclass(frozen=True)
class Slip:
    """A column read in another unit than its values are in."""

    quantity: str
    """Its column."""
    factor: float
    """What values as read have to be multiplied by."""


_SLIPS = (
    Slip("displacement", 1e-3),
    Slip("displacement", 1e-6),
    Slip("displacement", 1e3),
    Slip("time", 1e-3),
    Slip("time", 1e-6),
    Slip("time", 1e-9),
    Slip("time", 1e3),
    Slip("force", 1e3),
    Slip("force", 1e-3),
)
_USUAL = {
    "displacement": ("µm", "mm", "m"),
    "time": ("ns", "µs", "ms", "s"),
    "force": ("mN", "N", "kN", "MN"),
}
"""Units that such columns are in."""
# What tests in laboratories are like, of valves and seals as of earthquake dampers.
_AMPLITUDE = (1e-6, 2.0)  # m
_ASSUMED_AMPLITUDE = (1e-6, 0.3)  # m, where nobody wrote the unit
_SPEED = (1e-4, 340.0)  # m/s; sound is as fast
_FORCE = (1e-3, 2e7)  # N
_STEP = (1e-7, 0.3)  # s
_INERTANCE = 30.0  # times the device's or a part of it: a prefix is 1000, an order at most 10
_RIG = 3.0  # times what the rig can do
_MUCH_INERTIA = 0.3  # of the force


def implausible(
    records: Sequence[Record],
    device: Device | None,
    rig: RigLimits | None,
    *,
    units: Sequence[Mapping[str, str | None]] = (),
) -> list[Finding]:
    """Return a warning where the sizes of a whole campaign make no sense, with the likely unit.

    A campaign is held to what tests are like, to the device's inertance where the force is much
    of inertia, and to the rig's limits. Where one column read in another unit would mend all that
    is wrong, the warning says which.

    Parameters
    ----------
    records : sequence of Record
        Of the campaign.
    device : Device or None
        Whose inertance the records' apparent one is compared with.
    rig : RigLimits or None
        What the rig can do.
    units : sequence of mapping
        Of each record, the units by quantity as read; None where none is stated.
    """
    sizes = _sizes(records, inertial=device is not None)
    if sizes is None:
        return []
    assumed = {q for read in units for q, unit in read.items() if unit is None}
    wrong = list(_wrong(sizes, device, rig, assumed))
    if not wrong:
        return []
    mending = [s for s in _SLIPS if not list(_wrong(_mended(sizes, s), device, rig, assumed))]
    text = "all records: " if len(records) > 1 else ""
    text += "; ".join(wrong) + ": " + _advice(mending, units)
    alone = records[0].file if len(records) == 1 else None
    return [Finding("warning", text, alone, about="unit")]


def _advice(mending: Sequence[Slip], units: Sequence[Mapping[str, str | None]]) -> str:
    unstated = "is a unit wrong? Check the [units] and the headers"
    if not mending:
        return unstated
    asked = [_question(slip, units) for slip in _distinct(mending)]
    return ", or ".join(asked) + "? It would make sense"


def _question(slip: Slip, units: Sequence[Mapping[str, str | None]]) -> str:
    """Return what to ask: for the unit, where it is a usual one and was read alike throughout."""
    kind = QUANTITIES[slip.quantity]
    read = {u.get(slip.quantity) or SI_UNITS[kind] for u in units}
    if len(read) == 1:
        (written,) = read
        size = _size(written, kind) * slip.factor
        for meant in _USUAL[slip.quantity]:
            if math.isclose(size, _size(meant, kind)):
                return f"is {slip.quantity} in {meant} where {written} was read"
    large, times = ("large", 1.0 / slip.factor) if slip.factor < 1.0 else ("small", slip.factor)
    return f"are the values of {slip.quantity} {times:.0f} times too {large}"


def _size(unit: str, kind: str) -> float:
    return float(to_si(np.ones(1), unit, kind)[0])


def _distinct(slips: Iterable[Slip]) -> list[Slip]:
    """Return the first slip of each column: the least that makes sense."""
    met: dict[str, Slip] = {}
    for slip in slips:
        met.setdefault(slip.quantity, slip)
    return list(met.values())


def _sizes(records: Sequence[Record], *, inertial: bool) -> Sizes | None:
    moving = [r for r in records if r.displacement is not None]
    if not moving:
        return None
    values = np.array([sizes_of(r) for r in moving])
    amplitude, frequency, force, step = np.median(values, axis=0)
    inertance = _apparent_inertance(moving) if inertial else None
    return Sizes(amplitude, frequency, force, step, inertance)


def sizes_of(record: Record) -> tuple[float, float, float, float]:
    """Return a record's amplitude, m, fastest motion, Hz, force, N, and step, s: asked once."""
    return record.once(_of_record)


def _of_record(record: Record) -> tuple[float, float, float, float]:
    x = np.zeros(1) if record.displacement is None else record.displacement
    fastest = fastest_motion(record.time, x)
    return 0.5 * float(np.ptp(x)), fastest, 0.5 * float(np.ptp(record.force)), record.step


def _apparent_inertance(records: Sequence[Record]) -> float | None:
    """Return the median over records in which inertia is much of the force; None without one."""
    masses = []
    for record in records:
        try:
            found = apparent_of(record)
        except InputError:  # what can't be classified is for the checks to say
            continue
        if found is not None and found.mass > 0.0 and found.mass_share > _MUCH_INERTIA:
            masses.append(found.mass)
    return float(np.median(masses)) if masses else None


def _mended(sizes: Sizes, slip: Slip) -> Sizes:
    """Return the sizes as they would be with a column in another unit."""
    columns = ("displacement", "time", "force")
    x, t, f = (slip.factor if slip.quantity == column else 1.0 for column in columns)
    return Sizes(
        sizes.amplitude * x,
        sizes.frequency / t,
        sizes.force * f,
        sizes.step * t,
        None if sizes.inertance is None else sizes.inertance * f * t**2 / x,
    )


def _wrong(
    sizes: Sizes, device: Device | None, rig: RigLimits | None, assumed: Collection[str]
) -> Iterator[str]:
    """Yield in words what makes no sense."""
    speed = 2.0 * math.pi * sizes.frequency * sizes.amplitude
    stroke = _ASSUMED_AMPLITUDE if "displacement" in assumed else _AMPLITUDE
    if not stroke[0] <= sizes.amplitude <= stroke[1]:
        yield f"the displacement's amplitude is {sizes.amplitude:.3g} m"
    if not _STEP[0] <= sizes.step <= _STEP[1]:
        yield f"the sampling interval is {sizes.step:.3g} s"
    if not _SPEED[0] <= speed <= _SPEED[1]:
        yield f"the motion is of {speed:.3g} m/s at {sizes.frequency:.3g} Hz"
    if not _FORCE[0] <= sizes.force <= _FORCE[1]:
        yield f"the force's amplitude is {sizes.force:.3g} N"
    if device is not None and sizes.inertance is not None:
        ratio = sizes.inertance / device.inertance
        if not 1.0 / _INERTANCE <= ratio <= _INERTANCE:
            yield (
                f"the apparent inertance is {sizes.inertance:.3g} kg, {ratio:.2g} times the"
                f" device's {device.inertance:.4g} kg"
            )
    if rig is not None:
        pairs = (
            ("displacement's amplitude", sizes.amplitude, rig.max_stroke, "m"),
            ("force's amplitude", sizes.force, rig.max_force, "N"),
        )
        for name, value, limit, unit in pairs:
            if limit is not None and value > _RIG * limit:
                yield f"the {name} is {value:.3g} {unit}, beyond the rig's {limit:.3g} {unit}"
