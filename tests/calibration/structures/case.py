"""One campaign of the study: what it is asked to be, what it is, and its truth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from discover.records import Campaign, Record
from tests.calibration.structures.answerable import judged, members_of
from tests.calibration.structures.devices import (
    Redraw,
    draw_bands,
    draw_geometry,
    draw_many,
)
from tests.calibration.structures.extras import OWN, Hidden, draw_size, hide
from tests.calibration.structures.friction import draw_friction, log_uniform
from tests.calibration.structures.motion import Motion
from tests.calibration.structures.noise import draw_noise
from tests.calibration.structures.outside import Unnamed, hide_unnamed
from tests.calibration.structures.plans import Run, draw_line, draw_plan, draw_points, sine_run
from tests.calibration.structures.specimen import Specimen

Array = np.ndarray
Generator = np.random.Generator

MATTERS, RUBS = 0.06, 0.05
"""Least share of force that a term, and friction, make in one record or another."""
OUTSIDE_SIZE = 0.05
EVEN_SIZE = (0.01, 0.04)
_ATTEMPTS = 400
_STREAM = {"structures": 1, "two-boundaries": 2, "one-extra": 3, "outside": 4, "thin": 5}


@dataclass(frozen=True)
class Truth:
    """What a campaign holds."""

    cores: tuple[str, ...]
    """From the lowest band up."""
    orders: tuple[float | None, ...]
    """Of the bands' fractional derivatives; None where there is none."""
    exponents: tuple[float | None, ...]
    """Of the bands' power laws, likewise."""
    inertances: tuple[float | None, ...]
    """kg, likewise."""
    coordinate: str
    """"dean" or "frequency"; "" with one band."""
    boundaries: tuple[float, ...]
    """In the coordinate's unit; Dean numbers in the paper's convention."""
    speeds: tuple[float, ...]
    """The same as speeds of the rod, m/s; empty where the coordinate is a frequency."""
    members: tuple[tuple[str, ...], ...]
    """Records of each band; of a gradual boundary on either side of its middle."""
    gradual: bool
    """True where the boundary is gradual."""
    coordinate_told: bool
    """True where the records tell the coordinate."""
    extra: str
    """Id of the hidden effect of the catalogue, or name of one outside; "" for none."""
    size: float
    """Its size: rms over records of its share of each record's force."""
    remainder: tuple[float, float]
    """Share of force that no term explains, by record and pooled; zeros for none."""
    noise_percent: float
    """100 x noise over force, pooled."""
    nats: float
    """By which the nearest rival misses."""
    friction: str
    """Law and parameters in words."""


@dataclass(frozen=True)
class Case:
    """What a campaign is asked to be; the campaign itself is made when it is looked at."""

    set: str
    """Of `sets.SETS`."""
    kind: str
    """Of device: one of `devices.KINDS`, "three-bands" or "gradual"."""
    friction: str
    """Law: one of `friction.LAWS`."""
    twist: str
    """Of the plan: one of `plans.TWISTS`."""
    effect: str
    """Id of the extra, name of what is outside, or ""."""
    seed: int
    """Of all draws."""
    place: int
    """Within the seed's cases."""

    @property
    def key(self) -> str:
        """What tells the case from others."""
        words = (self.set, self.kind, self.friction, self.twist, self.effect or "-")
        return f"{' '.join(words)} {self.seed}/{self.place}"

    @property
    def campaign(self) -> Campaign:
        """The records as the engine gets them."""
        return build(self)[0]

    @property
    def truth(self) -> Truth:
        """What they hold."""
        return build(self)[1]


@lru_cache(maxsize=2)
def build(case: Case) -> tuple[Campaign, Truth]:
    """Return the campaign of a case and its truth; drawn again until it can be told."""
    for attempt in range(_ATTEMPTS):
        key = [_STREAM[case.set], case.seed, case.place, attempt]
        rng = np.random.default_rng(key)
        try:
            return drawn(case, rng)
        except Redraw:
            continue
    raise RuntimeError(f"{case.key} can't be drawn")


def drawn(case: Case, rng: Generator) -> tuple[Campaign, Truth]:
    """Draw a campaign once.

    Raises
    ------
    Redraw
        Where what was drawn can't be built, or its records can't tell it.
    """
    specimen = draw_specimen(case, rng)
    runs = specimen.runs
    noise = draw_noise(rng)
    level = log_uniform(rng, 0.02, 0.1) if case.set == "thin" else log_uniform(rng, 0.01, 0.05)
    level *= np.exp(0.1 * rng.standard_normal(len(runs)))
    beside: tuple[str, ...] = ()
    changes: list[Array] = [np.zeros(r.motion.time.size) for r in runs]
    hidden: Hidden | Unnamed | None = None
    if case.set == "one-extra":
        hidden = hide(case.effect, draw_size(rng), specimen, rng)
        changes, beside = hidden.changes, OWN[case.effect]
    if case.set == "outside":
        hidden = hide_unnamed(case.effect, OUTSIDE_SIZE, specimen, rng)
        changes = hidden.changes
    if case.twist == "even":
        for identifier in ("force-offset", "asymmetric-damping"):
            even = hide(identifier, log_uniform(rng, *EVEN_SIZE), specimen, rng)
            changes = [c + e for c, e in zip(changes, even.changes, strict=True)]
            beside = (*beside, *OWN[identifier])
    forces = [specimen.force(i) + change for i, change in enumerate(changes)]
    levels = [
        float(part * np.sqrt(np.mean(f**2))) for part, f in zip(level, forces, strict=True)
    ]
    nats, told = judged(case.set, case.kind, case.effect, specimen, changes, noise, levels, beside)
    records, square = [], [0.0, 0.0]
    for run, force, size in zip(runs, forces, levels, strict=True):
        error = size * noise.draw(force.size, run.sampling, rng)
        records.append(record(run, force + error, rng))
        square[0] += float(error @ error)
        square[1] += float((force + error) @ (force + error))
    title = f"{case.set} {case.seed}/{case.place}"
    campaign = Campaign(title, tuple(records), device=specimen.device)
    percent = 100.0 * float(np.sqrt(square[0] / square[1]))
    return campaign, truth_of(specimen, hidden, percent, nats, told)


def draw_specimen(case: Case, rng: Generator) -> Specimen:
    """Draw a device, its plan and its friction, each term of which matters somewhere."""
    device = draw_geometry(rng)
    runs = _runs(case, rng)
    coordinate = "dean" if (case.place + case.seed) % 2 else "frequency"
    if case.kind in ("three-bands", "gradual"):
        count, width = (3, 0.0) if case.kind == "three-bands" else (2, rng.uniform(0.15, 0.45))
        bands = draw_many(count, coordinate, device, runs, rng, width=width)
    else:
        lowest = 1.05 if case.effect == "backlash" else 0.4
        bands = draw_bands(case.kind, coordinate, device, runs, rng, lowest=lowest)
    motions = [r.motion for r in runs]
    bare = Specimen(device, tuple(runs), bands, draw_friction("jump", 0.0, motions, rng))
    sizes = [float(np.sqrt(np.mean(bare.fluid(i) ** 2))) for i in range(len(runs))]
    limit = float(np.median(sizes)) * log_uniform(rng, 0.06, 0.6)
    friction = draw_friction(case.friction, limit, motions, rng)
    specimen = Specimen(device, tuple(runs), bands, friction)
    _every_term_matters(specimen)
    return specimen


def _runs(case: Case, rng: Generator) -> list[Run]:
    if case.set == "thin":
        points = draw_line(int(rng.integers(3, 9)), rng)
        return [sine_run(f, a, i, case.twist, rng) for i, (f, a) in enumerate(points)]
    if case.effect == "backlash":
        points = draw_points(int(rng.integers(25, 33)), rng, lowest=(0.3, 0.5), highest=8.0)
        return [sine_run(f, a, i, "brief", rng) for i, (f, a) in enumerate(points)]
    many = case.kind in ("three-bands", "gradual")
    return draw_plan(case.twist, (34, 40) if many else (25, 40), rng)


def _every_term_matters(specimen: Specimen) -> None:
    greatest: dict[str, float] = {}
    for i, run in enumerate(specimen.runs):
        total = float(np.std(specimen.force(i)))
        parts = specimen.parts(i, run.motion)
        parts["friction"] = specimen.friction.force(run.motion, i)
        for name, part in parts.items():
            greatest[name] = max(greatest.get(name, 0.0), float(np.std(part)) / total)
    for name, most in greatest.items():
        if most < (RUBS if name == "friction" else MATTERS):
            raise Redraw(f"{name} never matters")


def record(run: Run, force: Array, rng: Generator) -> Record:
    """Return a record as measured; the displacement has a little white noise of its own."""
    motion: Motion = run.motion
    fine = log_uniform(rng, 0.3e-4, 2e-4) * motion.stroke
    shown = motion.x + fine * rng.standard_normal(force.size)
    time = np.arange(force.size) / run.sampling
    sine = run.amplitude is not None
    return Record(
        run.file, time, force, shown, frequency=run.frequency if sine else None,
        amplitude=run.amplitude,
    )


def truth_of(
    specimen: Specimen, hidden: Hidden | Unnamed | None, percent: float, nats: float, told: bool
) -> Truth:
    """Return the truth of a campaign."""
    bands, friction = specimen.bands, specimen.friction
    files = [r.file for r in specimen.runs]
    fractional = [law.core == "FOIM" for law in bands.laws]
    per_speed = _dean_per_speed(specimen) if bands.coordinate == "dean" else 0.0
    values = " ".join(f"{k} {v:.3g}" for k, v in friction.values.items())
    return Truth(
        cores=tuple(law.core for law in bands.laws),
        orders=tuple(
            w.order if f else None for w, f in zip(bands.laws, fractional, strict=True)
        ),
        exponents=tuple(w.exponent if w.power else None for w in bands.laws),
        inertances=tuple(
            None if f else w.inertance for w, f in zip(bands.laws, fractional, strict=True)
        ),
        coordinate=bands.coordinate,
        boundaries=bands.boundaries,
        speeds=tuple(b / per_speed for b in bands.boundaries) if per_speed else (),
        members=tuple(tuple(files[i] for i in own) for own in members_of(specimen)),
        gradual=bands.width > 0.0,
        coordinate_told=told,
        extra=hidden.id if hidden else "",
        size=hidden.size if hidden else 0.0,
        remainder=(hidden.size, hidden.pooled) if isinstance(hidden, Unnamed) else (0.0, 0.0),
        noise_percent=percent,
        nats=nats,
        friction=f"{friction.law} {friction.shape} {friction.size:.4g} N {values}",
    )


def _dean_per_speed(specimen: Specimen) -> float:
    place = specimen.places("dean")[0]
    return float(place / specimen.runs[0].motion.top_speed)
