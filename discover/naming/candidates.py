"""What is tried for each effect: a few shapes of each, scaled by what the campaign covers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from discover.naming.scales import COARSE, Scales
from models.motion import sine_motion
from models.terms import TERMS
from models.terms.trials import chosen_parameters, trial_shapes, trial_size

_TESTS = 32  # of a campaign, from which a gain may have changed
_FEW_TESTS = 4.0  # in which a gradual change is not told from a jump
_SOFT = 0.1  # of a play's gap, over which flanks of rubber are met
_MOST_OWN = 64  # tests, of which each may have its own value
_IN_BAND = 0.1  # rad of the fastest test, from which a filter's own time constant shows


@dataclass(frozen=True)
class Part:
    """One term of a variant."""

    id: str
    """Of the term."""
    shape: Mapping[str, float] = field(default_factory=dict)
    """Its shape."""
    probe: float = 1.0
    """Coefficient at which a change of input or output is tried."""


@dataclass(frozen=True)
class Variant:
    """One shape of an effect: one term or several of the same id, fitted together."""

    effect: str
    """Id."""
    parts: tuple[Part, ...]
    """At least one."""
    shapes: int
    """Number of shape parameters that were chosen."""


def _one(effect: str, shapes: int = 0, probe: float = 1.0, **shape: float) -> Variant:
    return Variant(effect, (Part(effect, shape, probe),), shapes)


def variants(effect: str, scales: Scales) -> list[Variant]:
    """Return the shapes that are tried for an effect.

    Raises
    ------
    KeyError
        For an effect that is not in the catalogue.
    """
    maker = _MAKERS.get(effect)
    return _spread(effect, scales) if maker is None else maker(scales)


def _spread(effect: str, scales: Scales) -> list[Variant]:
    """Return the shapes that a term's own parameters give."""
    term = TERMS[effect]
    sizes = {"displacement": scales.displacement, "speed": scales.speed, "force": scales.force}
    number, shapes = chosen_parameters(term), trial_shapes(term, sizes)
    if term.transform is None:
        return [Variant(effect, (Part(effect, s),), number) for s in shapes]
    frequency = scales.speed / scales.displacement / (2.0 * np.pi)
    motion = sine_motion(scales.displacement, frequency)
    carried = motion.acceleration * (2.0 * np.pi * frequency) ** -1 + motion.velocity
    force = carried * scales.force / float(np.abs(carried).max())
    return [
        Variant(effect, (Part(effect, s, trial_size(term, s, motion, force)),), number)
        for s in shapes
    ]


def _between_tests(effect: str, scales: Scales) -> list[Variant]:
    """Return an effect that grows from test to test, over the campaign or its first tests."""
    tests = scales.tests - 1.0
    shares = (1.0, 0.5, 0.25) if tests > _FEW_TESTS else ()
    return [_one(effect, 1, 1e-3, from_test=2.0, over=share * tests) for share in shares]


def _numbers(scales: Scales) -> tuple[float, ...]:
    """Return the numbers of tests of which each may have its own value; none where they are few."""
    several = _FEW_TESTS < len(scales.numbers) <= _MOST_OWN and 0 not in scales.numbers
    return tuple(float(n) for n in scales.numbers) if several else ()


def _each_its_own(sets: Sequence[Sequence[Part]]) -> list[Variant]:
    """Return what has a value of its own in every test: one term for each."""
    return [Variant(parts[0].id, tuple(parts), 0) for parts in sets if parts]


def _power(scales: Scales) -> list[Variant]:
    grid = [0.25, 0.35, 0.5, 0.65, 0.8, 1.2, 1.35, 1.5, 1.65, 1.75, 2.3, 2.6, 3.0]
    return [_one("power-law-damping", 1, exponent=p) for p in grid]


def _asymmetric(scales: Scales) -> list[Variant]:
    name = "asymmetric-damping"
    others = [
        _one(name, 2, power=power, side=side) for power in (0.5, 1.5, 2.0, 3.0)
        for side in (1.0, -1.0)
    ]
    return [_one(name, 0, power=1.0, side=0.0), *others]


def _coulomb(scales: Scales) -> list[Variant]:
    speeds = [0.0, *np.geomspace(0.002, 0.25, 7) * scales.speed]
    lengths = np.geomspace(1e-4, 0.02, 6) * scales.displacement
    jumps = [_one("coulomb-friction", 1, transition_speed=float(s)) for s in speeds]
    return jumps + [_one("coulomb-friction", 1, presliding=float(z)) for z in lengths]


def _fractional(scales: Scales) -> list[Variant]:
    grid = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9]
    return [_one("fractional-derivative", 1, order=a) for a in grid]


def _stribeck(scales: Scales) -> list[Variant]:
    bristles = [
        _one(
            "stribeck-friction", 2, stribeck_velocity=float(s), form=float(form),
            presliding=float(z),
        )
        for s in np.geomspace(0.01, 0.5, 5) * scales.speed
        for z in np.geomspace(3e-4, 0.05, 5) * scales.displacement
        for form in (0, 1, 2)
    ]
    return bristles + [
        _one(
            "stribeck-friction", 1, stribeck_velocity=float(s), form=float(form),
            transition_speed=scales.reversal,
        )
        for s in np.geomspace(0.004, 0.5, 9) * scales.speed
        for form in (0, 1, 2)
    ]


def _delay(scales: Scales) -> list[Variant]:
    made = ((0, 0.0), (1, 1.0), (1, 3.0))  # sampled later, or aligned from samples
    rates = (0.0, scales.sampling) if scales.sampling else (0.0,)
    probe = 0.02 / scales.omega
    sampled = [
        _one("time-delay", shapes + (rate > 0.0), probe, resampled=degree,
             sampling=rate)
        for rate in rates
        for shapes, degree in made
    ]
    filtered = [
        _one("time-delay", 1, probe, filter_order=order, digital=digital)
        for order in (1.0, 2.0, 4.0)
        for digital in ((0.0, 1.0) if probe < COARSE * scales.step else (0.0,))
    ]
    own = [[Part("time-delay", {"only": n}, probe) for n in _numbers(scales)]]
    return sampled + filtered + _each_its_own(own)


def _compliance(scales: Scales) -> list[Variant]:
    stiffest = scales.force / scales.displacement
    springs = np.geomspace(0.001, 0.3, 10) / stiffest
    plain = [
        _one("series-compliance", 1, probe=float(c), loss=loss, inside=inside)
        for c in springs
        for loss in (0.03, 0.25)
        for inside in (0.0, 1.0)
    ]
    loaded = [
        _one(
            "series-compliance", 2, probe=float(c), loss=0.1, inside=1.0,
            half_load=h * scales.force, load_share=share, side=side,
        )
        for c in springs[2::2]
        for h, share in ((0.1, 0.3), (0.1, 0.7), (0.5, 0.6), (2.0, 0.9), (0.3, -0.4))
        for side in (0.0, 1.0, -1.0)
    ]
    return plain + loaded


def _stop(scales: Scales) -> list[Variant]:
    gaps = [g * scales.displacement for g in (0.3, 0.45, 0.55, 0.65, 0.72, 0.78, 0.84, 0.89,
                                              0.93, 0.96)]
    springs = [
        _one("end-stop", 1, gap=gap, exponent=p, side=s)
        for gap in gaps
        for p in (1.0, 1.5, 2.0, 3.0)
        for s in (0.0, 1.0, -1.0)
    ]
    lossy = [
        {"loss": loss / scales.speed, "form": form, "exponent": p}
        for p in (1.0, 2.0)
        for loss, form in ((0.5, 0.0), (3.0, 0.0), (1.0, 1.0), (10.0, 1.0))
    ]
    times = (0.03, 0.1, 0.3)  # of the time in which the stroke is passed
    damped = [{"damping_time": t * scales.displacement / scales.speed} for t in times]
    dissipating = [
        _one("end-stop", 2, gap=gap, side=s, **{"exponent": 1.0, **more})
        for s, some in ((0.0, gaps), (1.0, gaps[::2]), (-1.0, gaps[::2]))
        for gap in some
        for more in (*lossy, *damped, {"dry_loss": 0.3})
    ]
    uneven = [
        Variant(
            "end-stop",
            (
                Part("end-stop", {"gap": up, "exponent": 1.0, "side": 1.0}),
                Part("end-stop", {"gap": down, "exponent": 1.0, "side": -1.0}),
            ),
            2,
        )
        for up in gaps[::2]
        for down in gaps[::2]
        if up != down
    ]
    return springs + dissipating + uneven


def _backlash(scales: Scales) -> list[Variant]:
    return [
        _one(
            "backlash", 4 if soft else 3, gap=float(g * scales.displacement),
            contact=k * scales.omega, loss=loss, inside=0.0, softness=soft,
        )
        for g in np.geomspace(1e-4, 0.3, 11)
        for k, loss, soft in (
            *product((4.0, 12.0, 30.0), (0.15, 0.5), (0.0,)), (12.0, 0.5, _SOFT), (40.0, 0.5, _SOFT)
        )
    ]


def _cavitation(scales: Scales) -> list[Variant]:
    shares = np.linspace(0.1, 0.96, 12)
    return [
        _one("cavitation", 3, limit=float(c * scales.force), contact=k * scales.omega, loss=0.3,
             refill=refill, lag=lag / scales.omega, side=s)
        for c in shares
        for k, refill, lag in (
            (6.0, 0.0, 0.0), (25.0, 0.0, 0.0), (25.0, 1.0, 0.0), (25.0, 1.0, 0.1),
        )
        for s in (1.0, -1.0)
    ]


def _hysteresis(scales: Scales) -> list[Variant]:
    return [
        _one("hysteresis", 1, yield_displacement=float(r), form=float(form))
        for r in np.geomspace(0.02, 1.5, 10) * scales.displacement
        for form in (0, 1, 2)
    ]


def _along(scales: Scales) -> list[Variant]:
    name, speed = "position-dependent-friction", scales.reversal
    one, two, four = (Part(name, {"power": p, "transition_speed": speed}) for p in (1.0, 2.0, 4.0))
    sets = ((one,), (two,), (one, two), (two, four), (one, two, four))
    local = [
        _one(
            name, 2, power=0.0, form=form, place=place * scales.displacement,
            width=width * scales.displacement, transition_speed=speed,
        )
        for form in (0.0, 2.0)
        for place in (-0.5, 0.05, 0.5)
        for width in (0.15, 0.4)
    ]
    periodic = [
        _one(
            name, 2, power=0.0, form=3.0, place=phase * width, width=width, transition_speed=speed
        )
        for width in scales.displacement / np.arange(0.7, 4.0, 0.15)
        for phase in (1.0 / 12.0, 0.25, 5.0 / 12.0)  # the sign gives the others
    ]
    return [*(Variant(name, parts, 0) for parts in sets), *local, *periodic]


def _thermal(scales: Scales) -> list[Variant]:
    straight = [
        _one("thermal-drift", 1, warming_time=float(t), heating=heating)
        for t in (0.0, *np.geomspace(0.02, 1.0, 5) * scales.duration)
        for heating in (0.0, 1.0)
    ]
    most = 0.5 * scales.speed**2
    saturated = [
        _one("thermal-drift", 2, warming_time=float(t), heating=1.0, saturation=k / (most * whole))
        for t, whole in ((0.0, scales.duration), (0.3 * scales.duration, 1.0))
        for k in (2.0, 8.0, 30.0)
    ]
    seals = [
        _one("thermal-drift", 2, warming_time=float(t), power=0.0, transition_speed=scales.reversal)
        for t in (0.0, *np.geomspace(0.02, 1.0, 5) * scales.duration)
    ]
    between = _between_tests("thermal-drift", scales)
    between += [
        _one("thermal-drift", 2, **{**v.parts[0].shape, "power": 0.0,
                                    "transition_speed": scales.reversal})
        for v in between
    ]
    return straight + saturated + seals + between


def _drift(scales: Scales) -> list[Variant]:
    settling = [
        _one("sensor-drift", 1, settling_time=float(t))
        for t in (0.0, *np.geomspace(0.02, 1.0, 5) * scales.duration)
    ]
    powers = [Part("sensor-drift", {"settling_time": 0.0, "power": p}) for p in (1.0, 2.0, 3.0)]
    wandering = [Variant("sensor-drift", tuple(powers[:n]), 0) for n in (2, 3)]
    numbers = _numbers(scales)
    zeros = [Part("sensor-drift", {"over": 1.0, "only": n}) for n in numbers]
    slopes = [Part("sensor-drift", {"power": 1.0, "only": n}) for n in numbers]
    bends = [Part("sensor-drift", {"power": 2.0, "only": n}) for n in numbers]
    own = _each_its_own([zeros, zeros + slopes, zeros + slopes + bends])
    return settling + wandering + _between_tests("sensor-drift", scales) + own


def _gain(scales: Scales) -> list[Variant]:
    peaks = np.array(scales.peaks)
    between = np.sqrt(peaks[1:] * peaks[:-1])[peaks[1:] > 1.05 * peaks[:-1]]
    chosen = between[:: max(between.size // 16, 1)]
    uniform = [_one("sensor-gain", 0, 1e-3, threshold=0.0, side=1.0)]
    ranges = [
        _one("sensor-gain", 1, probe, threshold=float(t / np.sqrt(1.0 + probe)), side=1.0)
        for t in chosen for probe in (0.1, -0.1)  # as measured, peaks in the range have the gain
    ]
    one_way = [_one("sensor-gain", 1, 1e-3, side=1.0, one_way=1.0)]
    later = range(2, scales.tests + 1, max(scales.tests // _TESTS, 1))
    changed = [_one("sensor-gain", 1, 1e-3, side=1.0, from_test=float(test)) for test in later]
    settling = [
        _one("sensor-gain", 1, 1e-3, side=1.0, settling_time=float(t * scales.duration))
        for t in (0.03, 0.1, 0.3, 1.0, 10.0)
    ]
    filtered = [  # above the band only the product of gain and time constant shows
        _one("sensor-gain", int(t > _IN_BAND), 1e-3, side=1.0,
             filter_time=float(t / scales.omega), digital=digital)
        for t in np.geomspace(0.01, 1.0, 8)
        for digital in ((0.0, 1.0) if t / scales.omega < COARSE * scales.step else (0.0,))
    ]
    drooping = [
        _one("sensor-gain", 1, -1e-3, side=1.0, droop_time=float(t / scales.slowest))
        for t in np.geomspace(0.3, 12.0, 10)
        if scales.slowest > 0.0
    ]
    loaded = [
        _one("sensor-gain", 0, 1e-3, side=1.0, load=scales.force, load_power=p) for p in (1.0, 2.0)
    ]
    between = _between_tests("sensor-gain", scales)
    return uniform + ranges + one_way + filtered + drooping + loaded + changed + settling + between


def _clipping(scales: Scales) -> list[Variant]:
    shares = (0.3, 0.4, 0.5, 0.6, 0.7, 0.78, 0.85, 0.9, 0.95, 0.98)

    def rail(limit: float, soft: float, side: float) -> Part:
        force = float(limit * scales.force)
        return Part("sensor-clipping", {"limit": force, "softness": soft * force, "side": side})

    even = [
        Variant("sensor-clipping", (rail(c, soft, side),), 1)
        for c in shares
        for soft in (0.0, 0.05, 0.15)
        for side in (0.0, 1.0, -1.0)
    ]
    uneven = [
        Variant("sensor-clipping", (rail(up, 0.0, 1.0), rail(down, 0.0, -1.0)), 2)
        for up in shares
        for down in shares
        if up != down
    ]
    return even + uneven


def _cubic(scales: Scales) -> list[Variant]:
    closing = [
        _one("cubic-stiffness", 1, closure=float(c * scales.displacement))
        for c in (1.05, 1.2, 1.5, 2.5)
    ]
    levelling = [
        _one("cubic-stiffness", 1, span=float(s * scales.displacement))
        for s in (0.2, 0.5, 1.0, 2.5)
    ]
    return [_one("cubic-stiffness"), *closing, *levelling]


_MAKERS = {
    "asymmetric-damping": _asymmetric,
    "power-law-damping": _power,
    "coulomb-friction": _coulomb,
    "fractional-derivative": _fractional,
    "stribeck-friction": _stribeck,
    "time-delay": _delay,
    "series-compliance": _compliance,
    "end-stop": _stop,
    "backlash": _backlash,
    "cavitation": _cavitation,
    "hysteresis": _hysteresis,
    "position-dependent-friction": _along,
    "thermal-drift": _thermal,
    "sensor-drift": _drift,
    "sensor-gain": _gain,
    "sensor-clipping": _clipping,
    "cubic-stiffness": _cubic,
}
