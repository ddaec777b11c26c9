"""Hide an effect on the virtual rig, search for it, and count."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from joblib import Parallel, delayed

from discover.gap import close_gap, prepare_baseline
from discover.gap.result import Gap
from discover.motion_fit import observe
from discover.naming.contest import UNKNOWN
from discover.naming.fit import fit_model, free_parameters
from discover.records import Campaign, Record
from models.rig import (
    CATALOGUE,
    FORMS,
    Chain,
    Limits,
    Plan,
    RigPhysics,
    random_device,
    run,
    sine_plan,
)

BASELINE = ("inertia", "viscous-damping", "quadratic-damping", "coulomb-friction")
RECORDS = 12
ABSORBED = 10.0  # nats that a noise-free refit leaves, below which nothing can be found
_FREQUENCIES = (0.3, 0.7, 1.5, 3.0, 6.0, 10.0)
_AMPLITUDES = (0.003, 0.008, 0.02)


@dataclass(frozen=True)
class Outcome:
    """One campaign's answer."""

    hidden: str
    """"id:form", several joined by "+"; "" for nothing."""
    size: float
    """rms change of force over rms force."""
    seed: int
    """Of the device, the motion and the noise."""
    expected: tuple[str, ...]
    """Right answers for the first round: an id, "unknown" or "agrees"."""
    named: tuple[str, ...]
    """Effects round by round; what ended the search is last."""
    probability: float
    """Of the first."""
    alternatives: tuple[str, ...]
    """Stated beside the first."""
    ratio: float
    """Final held-out gap over the noise floor."""

    @property
    def right(self) -> bool:
        """True where the first answer is the expected one."""
        return self.named[0] in self.expected


def campaign(seed: int, hidden: dict[str, float], *, ideal: bool = False) -> Campaign:
    """Return a campaign of a random device on the rig."""
    rng = np.random.default_rng([7, seed])
    device = random_device(rng)
    points = list(
        sine_plan(device, frequencies=_FREQUENCIES, amplitudes=_AMPLITUDES, limits=Limits())
    )
    if len(points) > RECORDS:
        chosen = np.unique(np.linspace(0, len(points) - 1, RECORDS).astype(int))
        points = [points[i] for i in chosen]
    measured = run(
        device,
        Plan(tuple(points)),
        seed=seed,
        hidden=hidden,
        physics=RigPhysics.simple(),
        chain=Chain.ideal() if ideal else Chain(),
    )
    records = tuple(
        Record(
            r.file, r.time, r.force.copy(), r.displacement.copy(),
            frequency=r.frequency, amplitude=r.amplitude,
        )
        for r in measured
    )
    return Campaign(f"rig, seed {seed}", records)


def absorbed(seed: int, hidden: dict[str, float], terms: Sequence[str]) -> bool:
    """Tell whether a noise-free refit of the baseline leaves less than ten nats."""
    noisy, exact = (campaign(seed, hidden, ideal=ideal) for ideal in (False, True))
    text = "fit:" + ",".join(terms)
    whitened = prepare_baseline([observe(r) for r in noisy.records], text, fixed=False).rows
    clean = [observe(r) for r in exact.records]
    rows = [
        type(r)(r.observation, r.project(o.measured), r.project, r.informative)
        for r, o in zip(whitened, clean, strict=True)
        if o.measured.size == r.observation.measured.size
    ]
    if len(rows) < len(whitened):
        return False
    start = prepare_baseline([observe(r) for r in noisy.records], text, fixed=False).model
    fit = fit_model(rows, start, free_parameters(start))
    return 0.5 * fit.chi2 < ABSORBED


def outcome(hidden: dict[str, float], seed: int) -> Outcome:
    """Return what the search answers on one campaign."""
    ids = [name.split(":")[0] for name in hidden]
    catalogue = [i for i in ids if i in CATALOGUE]
    terms = tuple(t for t in BASELINE if t not in ids)
    found = close_gap(campaign(seed, hidden), "fit:" + ",".join(terms))
    if not hidden:
        expected: tuple[str, ...] = ("agrees",)
    elif not catalogue:
        expected = (UNKNOWN,)
    else:
        expected = tuple(catalogue)
        if len(ids) == 1 and absorbed(seed, hidden, terms):
            expected = ("agrees",)
    return _outcome(found, hidden, seed, expected)


def _outcome(
    found: Gap, hidden: dict[str, float], seed: int, expected: tuple[str, ...]
) -> Outcome:
    named = (*(r.effect for r in found.rounds), found.last[0][0])
    first = found.rounds[0] if found.rounds else None
    stated = found.last[1:] if first is None else first.alternatives
    held = found.final_held_out_gap_percent or found.final_gap_percent
    return Outcome(
        "+".join(hidden), max(hidden.values(), default=0.0), seed, expected, named,
        found.last[0][1] if first is None else first.probability,
        tuple(e for e, _ in stated), held / found.noise_percent,
    )


def cases(
    seeds: Iterable[int], sizes: Sequence[float], effects: Sequence[str] | None = None
) -> list[tuple[dict[str, float], int]]:
    """Return every effect, in a form that changes with the seed, at every size."""
    chosen = tuple(FORMS) if effects is None else effects
    result = []
    for seed in seeds:
        for effect in chosen:
            forms = list(FORMS[effect])
            for size in sizes:
                result.append(({f"{effect}:{forms[seed % len(forms)]}": size}, seed))
    return result


def outcomes(wanted: Sequence[tuple[dict[str, float], int]], jobs: int = 1) -> list[Outcome]:
    """Return the outcome of every case."""
    return list(Parallel(n_jobs=jobs)(delayed(outcome)(*case) for case in wanted))


def table(found: Sequence[Outcome]) -> str:
    """Return rates by size, wrong answers and the reliability of probabilities, in Markdown."""
    lines = ["| size | campaigns | named first | stated | held-out ≤ 1.3 × noise where right |",
             "|---|---|---|---|---|"]
    for size in sorted({o.size for o in found}, reverse=True):
        some = [o for o in found if o.size == size and "outside:" not in o.hidden]
        if not some:
            continue
        right = [o for o in some if o.right]
        stated = [o for o in some if o.right or set(o.expected) & set(o.alternatives)]
        closed = [o for o in right if o.ratio <= 1.3]
        lines.append(
            f"| {100.0 * size:g} % | {len(some)} | {_rate(len(right), len(some))} |"
            f" {_rate(len(stated), len(some))} | {_rate(len(closed), len(right))} |"
        )
    outside = [o for o in found if "outside:" in o.hidden]
    if outside:
        unknown = sum(o.right for o in outside)
        sure = sum(not o.right and o.probability > 0.9 for o in outside)
        lines.append(
            f"\nOutside the catalogue: unknown in {_rate(unknown, len(outside))}, a name above 0.9"
            f" in {_rate(sure, len(outside))}."
        )
    lines.append("\n| stated probability | campaigns | right |\n|---|---|---|")
    edges = (0.0, 0.3, 0.5, 0.7, 0.9, 0.99, 1.01)
    for low, high in zip(edges, edges[1:], strict=False):
        some = [o for o in found if low <= o.probability < high]
        if some:
            right_share = _rate(sum(o.right for o in some), len(some))
            lines.append(f"| {low:g} to {min(high, 1.0):g} | {len(some)} | {right_share} |")
    wrong = [
        f"- {o.hidden} {100.0 * o.size:g} %, seed {o.seed}: {o.named[0]} ({o.probability:.2f})"
        for o in found
        if not o.right
    ]
    return "\n".join([*lines, "\nWrong first answers:", *(wrong or ["none"])])


def _rate(right: int, asked: int) -> str:
    return f"{right} of {asked} ({100.0 * right / asked:.0f} %)" if asked else "–"
