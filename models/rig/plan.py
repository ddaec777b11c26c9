"""What is tested: points of frequency and amplitude within the limits of a test rig."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.constants import g as GRAVITY

from models.checks import InputError, number, one_of
from models.device import Device
from models.flow import channel_force, channel_impedance

KINDS = ("sine", "sweep", "random")
_SAMPLING = (200.0, 500.0, 1000.0, 2000.0, 5000.0, 10000.0)
_SAMPLES_A_CYCLE = 100.0


@dataclass(frozen=True)
class TestPoint:
    """One record to be taken.

    Examples
    --------
    >>> TestPoint(0.5, 0.02, cycles=6, sampling=200.0).duration
    12.0
    """

    __test__ = False  # not a test case, whatever pytest thinks of the name

    frequency: float
    """Hz; the lower end of the band for a sweep or random motion."""
    amplitude: float
    """m; of a sweep at its lower end; of random motion the peak."""
    cycles: float = 8.0
    """Number of cycles of `frequency`, whole or not: with it the duration."""
    sampling: float = 1000.0
    """Sampling frequency, Hz."""
    kind: str = "sine"
    """"sine", "sweep" or "random" (their displacement falls as the root of frequency)."""
    upper: float | None = None
    """Upper end of the band, Hz; only for a sweep or random motion."""
    held_out: bool = False
    """Never fitted, only predicted."""

    def __post_init__(self) -> None:
        """Refuse what can't be run or sampled."""
        number("frequency", self.frequency, above=0.0, where="test point")
        number("amplitude", self.amplitude, above=0.0, where="test point")
        number("cycles", self.cycles, at_least=1.0, where="test point")
        one_of("kind", self.kind, KINDS, where="test point")
        if (self.kind == "sine") != (self.upper is None):
            raise InputError(
                "upper",
                expected="given for a sweep or random motion, and only there",
                found=f"{self.upper} for {self.kind}",
                where="test point",
            )
        if self.upper is not None:
            number("upper", self.upper, above=self.frequency, where="test point")
        number("sampling", self.sampling, at_least=8.0 * self.top, where="test point")

    @property
    def top(self) -> float:
        """Highest frequency of the motion, Hz."""
        return self.frequency if self.upper is None else self.upper

    @property
    def duration(self) -> float:
        """Length of the record, s."""
        return self.cycles / self.frequency

    @property
    def file(self) -> str:
        """A file name that says what the record is."""
        stroke = f"{self.amplitude * 1e3:g}mm"
        if self.upper is None:
            return f"{self.frequency:g}hz-{stroke}.csv"
        return f"{self.kind}-{self.frequency:g}-{self.upper:g}hz-{stroke}.csv"


@dataclass(frozen=True)
class Limits:
    """What the rig can do."""

    stroke: float = 0.025
    """m, amplitude."""
    speed: float = 0.5
    """m/s."""
    acceleration: float = 5.0 * GRAVITY
    """m/s^2."""
    force: float = 25e3
    """N."""

    def allows(self, device: Device, point: TestPoint) -> bool:
        """Tell whether a sine test at `point` stays within the limits.

        The force is estimated as inertia and wall layer in quadrature with steady friction, plus
        dry friction.
        """
        omega = 2.0 * math.pi * point.frequency
        speed = omega * point.amplitude
        acceleration = omega * speed
        drag = float(channel_force(device, speed))
        drag += device.laminar_coefficients.c1 * speed**2
        wall = complex(channel_impedance(device, omega, part="wall")) * speed
        force = abs(1j * device.inertance * acceleration + wall + drag)
        force += device.coulomb_friction or 0.0
        return (
            point.amplitude <= self.stroke
            and speed <= self.speed
            and acceleration <= self.acceleration
            and force <= self.force
        )


@dataclass(frozen=True)
class Plan:
    """The test points of a campaign, in the order in which they are run."""

    points: tuple[TestPoint, ...]
    """At least one."""

    def __post_init__(self) -> None:
        """Refuse an empty plan and records that would share a file."""
        if not self.points:
            raise InputError("plan", expected="at least one test point", found="none")
        files = [p.file for p in self.points]
        for file in files:
            if files.count(file) > 1:
                raise InputError("plan", expected="different test points", found=f"{file} twice")

    def __len__(self) -> int:
        return len(self.points)

    def __iter__(self) -> Iterator[TestPoint]:
        return iter(self.points)


def sine_point(frequency: float, amplitude: float, *, held_out: bool = False) -> TestPoint:
    """Return a sine test with usual numbers of cycles and samples.

    Parameters
    ----------
    frequency : float
        Hz.
    amplitude : float
        m.
    held_out : bool
        Never fitted, only predicted.

    Returns
    -------
    TestPoint

    Examples
    --------
    >>> sine_point(0.1, 0.005).cycles, sine_point(15.0, 0.005).sampling
    (5, 2000.0)
    """
    number("frequency", frequency, above=0.0)
    cycles = int(np.clip(round(8.0 * frequency**0.4), 5, 20))
    wanted = _SAMPLES_A_CYCLE * frequency
    sampling = next((s for s in _SAMPLING if s >= wanted), wanted)
    return TestPoint(frequency, amplitude, cycles, sampling, held_out=held_out)


def sine_plan(
    device: Device,
    *,
    frequencies: Sequence[float] | None = None,
    amplitudes: Sequence[float] = (0.005, 0.01, 0.02),
    limits: Limits | None = None,
    held_out: int = 0,
) -> Plan:
    """Return sine tests at every frequency and amplitude that the rig's limits allow.

    Parameters
    ----------
    device : Device
        What is tested: its force counts against the limits.
    frequencies : sequence of float, optional
        Hz; twelve from 0.1 to 15 Hz where not given.
    amplitudes : sequence of float
        m.
    limits : Limits, optional
        The rig's.
    held_out : int
        How many of the points are marked as held out, spread over the plan.

    Returns
    -------
    Plan

    Examples
    --------
    >>> plan = sine_plan(Device.preset("device-12"))
    >>> len(plan), max(p.frequency for p in plan if p.amplitude == 0.02)
    (31, 3.8)
    """
    chosen = (
        [float(f"{f:.2g}") for f in np.geomspace(0.1, 15.0, 12)]
        if frequencies is None
        else [float(f) for f in frequencies]
    )
    bounds = Limits() if limits is None else limits
    points = [
        point
        for amplitude in amplitudes
        for frequency in chosen
        if bounds.allows(device, point := sine_point(frequency, float(amplitude)))
    ]
    number("held_out", held_out, at_least=0, at_most=max(len(points) - 1, 0), where="plan")
    if held_out:
        marked = np.linspace(0, len(points) - 1, held_out + 2)[1:-1].round().astype(int)
        points = [replace(p, held_out=i in marked) for i, p in enumerate(points)]
    return Plan(tuple(points))


def transient_plan(
    *,
    amplitude: float = 0.01,
    band: tuple[float, float] = (0.1, 8.0),
    duration: float = 40.0,
    sampling: float = 1000.0,
) -> Plan:
    """Return a sweep and a random motion over one band, the random one held out.

    Examples
    --------
    >>> [p.file for p in transient_plan()]
    ['sweep-0.1-8hz-10mm.csv', 'random-0.1-8hz-10mm.csv']
    """
    lower, upper = band
    cycles = number("duration", duration, above=0.0) * lower
    sweep = TestPoint(lower, amplitude, cycles, sampling, kind="sweep", upper=upper)
    return Plan((sweep, replace(sweep, kind="random", held_out=True)))
