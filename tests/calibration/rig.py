"""The study on the virtual rig, where no structure is true: the truth is what predicts best.

In every band that the study states, models are fitted to the band's measured records by least
squares of their own, on closed forms with coefficients that are not negative, and predict the
exact force of new tests inside the band: fractional, and every subset of inertia and damping, each
with and without friction and elasticity. The best predictor's structure is the truth; so are those
that predict alike, which the choice of the new tests decides. "other" is what has no inertia, or
much stiffness; the terms that the study states are refitted, its order or exponent held, and take
part too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from joblib import Parallel, delayed
from scipy.optimize import minimize_scalar, nnls

from discover.records import Campaign, Record
from discover.study import run_study
from models.flow import dean_per_speed
from models.rig import Chain, Plan, RigPhysics, RigRecord, random_device, run, sine_point
from tests.calibration.plans import PLANS, drawn_points, new_points
from tests.calibration.rates import rate, reliability

ALIKE = 0.05
"""Relative difference of prediction errors up to which structures predict alike."""
UNSEEN = 1e-3
"""Of the force: errors closer than this are alike too; no load cell sees them."""
_HARMONICS = 5
_REVERSAL = 0.05  # of the speed amplitude: friction reverses over a range
_EXTRAS = (
    (), ("friction",), ("stiffness",), ("friction", "stiffness"), ("friction", "cubic"),
    ("friction", "-cubic"), ("friction", "stiffness", "-cubic"),
)
_TRANSITIONS = (0.0, 0.03, 0.1, 0.3)  # over the least speed amplitude
_PLAIN = ("inertia", "viscous", "quadratic", "turbulent")
_ELASTIC = ("stiffness", "cubic", "-cubic")
_SIDE = {"friction", "asymmetric", "offset", *_ELASTIC}
MINOR = 0.25
"""Share of the force up to which stiffness leaves a structure its name."""
_NAMES = {
    "inertia": "inertia", "viscous-damping": "viscous", "quadratic-damping": "quadratic",
    "power-law-damping": "turbulent", "fractional-derivative": "fractional",
    "coulomb-friction": "friction", "stiffness": "stiffness", "cubic-stiffness": "cubic",
    "asymmetric-damping": "asymmetric", "force-offset": "offset",
}


@dataclass(frozen=True)
class Outcome:
    """One band of one campaign."""

    seed: int
    physics: str
    plan: str
    records: int
    """In the band."""
    structure: str
    """Stated first."""
    probability: float
    """Stated of it."""
    truths: tuple[str, ...]
    """What predicts best; several where they predict alike."""
    listed: bool
    """Whether a truth is first or among the equivalents."""
    errors: dict[str, float]
    """Relative error of each on new tests."""

    @property
    def right(self) -> bool:
        """True where the stated structure predicts best, or as well as the best."""
        return self.structure in self.truths

    @property
    def best(self) -> bool:
        """True where no other structure predicts better by however little."""
        return self.structure in truths(self.errors, alike=False)


@dataclass(frozen=True)
class _Waves:
    """A sine test's motion from its own harmonics, away from reversals."""

    time: np.ndarray
    omega: float
    phasors: np.ndarray
    """(H,) of the displacement, from the fundamental on."""
    kept: np.ndarray
    """(N,) samples away from reversals."""

    def derivative(self, order: float) -> np.ndarray:
        """Return the derivative of an order at every sample, steady state."""
        w = self.omega * np.arange(1, self.phasors.size + 1)
        return np.real(self._turns @ ((1j * w) ** order * self.phasors))

    @cached_property
    def _turns(self) -> np.ndarray:
        w = self.omega * np.arange(1, self.phasors.size + 1)
        return np.exp(1j * np.outer(self.time, w))

    def column(self, name: str, transition: float) -> np.ndarray:
        """Return a term of unit coefficient at every sample; friction reverses over a speed.

        A minus before a name turns its sign; "power" is followed by its exponent.
        """
        if name.startswith("-"):
            return -self.column(name[1:], transition)
        if name == "inertia":
            return self.derivative(2.0)
        v = self.derivative(1.0)
        if name.startswith("power"):
            return np.sign(v) * np.abs(v) ** float(name[5:])
        return {
            "viscous": v,
            "quadratic": v * np.abs(v),
            "turbulent": np.sign(v) * np.abs(v) ** 1.75,
            "friction": np.sign(v) if transition == 0.0 else np.tanh(v / transition),
            "stiffness": self.derivative(0.0),
            "cubic": self.derivative(0.0) ** 3,
            "asymmetric": np.abs(v),
            "offset": np.ones_like(v),
        }[name]


def _waves(time: np.ndarray, displacement: np.ndarray, frequency: float) -> _Waves:
    omega = 2.0 * np.pi * frequency
    angles = omega * np.outer(time, np.arange(1, _HARMONICS + 1))
    design = np.column_stack([np.ones(time.size), np.cos(angles), np.sin(angles)])
    found = np.linalg.lstsq(design, displacement, rcond=None)[0][1:]
    phasors = found[:_HARMONICS] - 1j * found[_HARMONICS:]
    whole = _Waves(time, omega, phasors, np.ones(time.size, dtype=bool))
    v = whole.derivative(1.0)
    return _Waves(time, omega, phasors, np.abs(v) > _REVERSAL * np.abs(v).max())


class _Tests:
    """Tests and the forces that they are to explain, relative to each one's rms."""

    def __init__(
        self, waves: Sequence[_Waves], forces: Sequence[np.ndarray], transition: float
    ) -> None:
        self.waves = waves
        self.weights = [
            1.0 / (np.sqrt(np.mean(f**2)) * np.sqrt(np.sum(w.kept)))
            for w, f in zip(waves, forces, strict=True)
        ]
        self.target = self._stack(forces)
        self._transition = transition
        self._known: dict[str, np.ndarray] = {}

    def _stack(self, values: Sequence[np.ndarray]) -> np.ndarray:
        return np.concatenate(
            [v[w.kept] * s for v, w, s in zip(values, self.waves, self.weights, strict=True)]
        )

    def columns(self, names: Sequence[str], order: float) -> np.ndarray:
        for n in set(names) - set(self._known) - {"fractional"}:
            self._known[n] = self._stack([w.column(n, self._transition) for w in self.waves])
        return np.stack(
            [
                self._stack([w.derivative(order) for w in self.waves])
                if n == "fractional"
                else self._known[n]
                for n in names
            ],
            axis=1,
        )

    def error(self, force: np.ndarray) -> float:
        """Return the relative error of a stacked force, root mean square over tests."""
        return float(np.sqrt(np.sum((self.target - force) ** 2) / len(self.waves)))


def _candidates() -> list[tuple[str, ...]]:
    """Return every model of the contest: a core, with or without friction and elasticity."""
    cores: list[tuple[str, ...]] = [("fractional",)]
    for size in range(len(_PLAIN) + 1):
        cores += combinations(_PLAIN, size)
    return [(*core, *extra) for core in cores for extra in _EXTRAS if core or extra]


def name_of(names: Sequence[str], elastic: float) -> str:
    """Return the structure of a model, given the share of stiffness in its force."""
    core = {n for n in names if n.lstrip("-") not in _SIDE}
    if elastic > MINOR:
        return "other"
    if core == {"fractional"}:
        return "FOIM"
    powers = [float(n[5:]) for n in core if n.startswith("power")]
    if "inertia" not in core or "fractional" in core or any(not 1.5 <= p <= 2.0 for p in powers):
        return "other"
    if powers:
        return "IOIM-turbulent"
    if "turbulent" in core:
        return "IOIM-turbulent"
    return "IOIM-laminar" if "quadratic" in core else "IOIM-linear"


def _solve(
    tests: _Tests, names: Sequence[str], order: float
) -> tuple[np.ndarray, float, float]:
    """Return coefficients that are not negative, the misfit, and the share of stiffness."""
    columns = tests.columns(names, order)
    small = np.linalg.qr(np.column_stack([columns, tests.target]), mode="r")
    scale = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    found, misfit = nnls(small[:, :-1] / scale, small[:, -1])
    elastic = max([f for f, n in zip(found, names, strict=True) if n in _ELASTIC], default=0.0)
    return found / scale, float(misfit), float(elastic / np.linalg.norm(tests.target))


def _best_order(tests: _Tests, names: Sequence[str]) -> float:
    grid = np.linspace(0.0, 2.0, 21)
    misfits = [_solve(tests, names, order)[1] for order in grid]
    best = int(np.argmin(misfits))
    around = grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)]
    return float(
        minimize_scalar(
            lambda order: _solve(tests, names, order)[1], bounds=around, method="bounded"
        ).x
    )


def predictions(
    fitted: _Tests, new: _Tests, also: Sequence[tuple[tuple[str, ...], float]] = ()
) -> list[tuple[str, float]]:
    """Return each model's structure and relative error on new tests.

    Parameters
    ----------
    fitted, new : _Tests
        What each is fitted to, and what it is to predict.
    also : sequence of tuple
        Further models: terms and order.

    Returns
    -------
    list of tuple
        A model with a coefficient at zero is left out: the one without that term is there.
    """
    result = []
    models: list[tuple[tuple[str, ...], float | None]] = [(n, None) for n in _candidates()]
    for names, order in [*models, *also]:
        if order is None:
            order = _best_order(fitted, names) if "fractional" in names else 1.0
        found, _, elastic = _solve(fitted, names, order)
        if np.all(found > 0.0):
            error = new.error(new.columns(names, order) @ found)
            result.append((name_of(names, elastic), error))
    return result


def truths(errors: dict[str, float], *, alike: bool = True) -> tuple[str, ...]:
    """Return the structures that predict best, from each one's least relative error.

    With `alike`, those that predict as well as the best are among them.
    """
    least = min(errors.values())
    near = max(least * (1.0 + ALIKE), least + UNSEEN) if alike else least
    return tuple(sorted(name for name, e in errors.items() if e <= near))


def _own(band) -> list[tuple[tuple[str, ...], float]]:
    """Return a band's own terms, with its order or exponent."""
    names, order = [], 1.0
    for term in (t.fitted for t in band.terms if t.fitted.id in _NAMES):
        name = _NAMES[term.id]
        if "exponent" in term.shape:
            name = f"power{term.shape['exponent']}"
        order = term.shape.get("order", order)
        names.append(f"-{name}" if term.coefficient < 0.0 else name)
    return [(tuple(names), order)] if names else []


def _waves_of(record: RigRecord) -> _Waves:
    return _waves(record.time, record.true_displacement, record.frequency)


def judge_campaign(seed: int) -> list[Outcome]:
    """Return the outcome of every band that the study of one campaign states."""
    rng = np.random.default_rng([41, seed])
    device = random_device(rng)
    kind = "simple" if seed % 2 == 0 else "full"
    physics = RigPhysics.simple() if kind == "simple" else RigPhysics()
    plan = str(rng.choice(PLANS, p=[0.45, 0.25, 0.1, 0.2]))
    points: list[tuple[float, float]] = []
    while len(points) < (4 if plan in ("single", "one amplitude") else 8):
        points = drawn_points(rng, plan, device)
    chain = Chain(noise=rng.uniform(0.01, 0.05), low_frequency=rng.uniform(0.0, 0.9))
    measured = run(
        device, Plan(tuple(sine_point(*p) for p in points)), seed=seed, physics=physics,
        chain=chain,
    )
    records = tuple(
        Record(f"{i:02d}.csv", r.time, r.force.copy(), r.displacement.copy(),
               frequency=r.frequency, amplitude=r.amplitude)
        for i, r in enumerate(measured)
    )
    study = run_study(Campaign(f"rig, seed {seed}", records, device=device))
    scale = dean_per_speed(device, convention="paper")
    result = []
    for band in study.bands:

        def inside(frequency: float, amplitude: float, band=band) -> bool:
            value = frequency
            if study.coordinate != "frequency":
                value = 2.0 * np.pi * frequency * amplitude
                value *= scale if study.coordinate == "dean" else 1.0
            return (band.lower or 0.0) <= value <= (band.upper or np.inf)

        numbers = [int(name.split(".")[0]) for name in band.records]
        fresh = new_points(rng, [points[i] for i in numbers], device, inside)
        if not fresh:
            continue
        new = run(
            device, Plan(tuple(sine_point(*p) for p in fresh)), seed=seed + 1_000_000,
            physics=physics, chain=Chain.ideal(),
        )
        waves, forces = [_waves_of(measured[i]) for i in numbers], [
            measured[i].force for i in numbers
        ]
        slowest = min(2.0 * np.pi * points[i][0] * points[i][1] for i in numbers)
        made = [_Tests(waves, forces, share * slowest) for share in _TRANSITIONS]
        misfits = [_solve(t, (*_PLAIN, "friction", "stiffness"), 1.0)[1] for t in made]
        best = int(np.argmin(misfits))
        fitted = made[best]
        fresh = _Tests(
            [_waves_of(r) for r in new], [r.true_force for r in new], _TRANSITIONS[best] * slowest
        )
        errors = predictions(fitted, fresh, _own(band))
        least = {n: min(e for m, e in errors if m == n) for n, _ in errors}
        found = truths(least)
        stated = {s for s, _ in band.equivalents} | {band.structure}
        result.append(
            Outcome(
                seed, kind, plan, len(numbers), band.structure, band.probability, found,
                bool(stated & set(found)), least,
            )
        )
    return result


def outcomes(seeds, jobs: int = 1) -> list[Outcome]:
    """Return the outcomes of campaigns, over processes."""
    found = Parallel(n_jobs=jobs)(delayed(judge_campaign)(s) for s in seeds)
    return [o for campaign in found for o in campaign]


def table(found: Sequence[Outcome]) -> str:
    """Return how often the stated structure predicts best, in Markdown."""
    lines = [
        "| physics | plan | bands | first predicts best or alike | share (95 %) |"
        " first or an equivalent does | share (95 %) | first is the very best |",
        "|---|---|---|---|---|---|---|---|",
    ]
    groups = [(p, q) for p in ("simple", "full") for q in (*PLANS, "all")]
    for physics, plan in groups:
        some = [o for o in found if o.physics == physics and plan in (o.plan, "all")]
        if some:
            right, listed = (sum(v) for v in ((o.right for o in some), (o.listed for o in some)))
            lines.append(f"| {physics} | {plan} | {len(some)} | {rate(right, len(some))}"
                         f" {rate(listed, len(some))} {sum(o.best for o in some)} |")
    return "\n".join(
        [*lines, "", reliability([(o.probability, o.right) for o in found])]
    )
