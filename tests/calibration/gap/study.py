"""Search for what is hidden, and keep the answer beside the truth."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter

from joblib import Parallel, delayed

from discover.gap import close_gap, prepare_baseline
from discover.gap.result import Gap
from discover.motion_fit import observe_all
from models.checks import InputError
from models.constitutive import ForceModel
from tests.calibration.gap.case import Case, campaign
from tests.calibration.gap.truth import nats_left

BASELINE = ("inertia", "viscous-damping", "quadratic-damping", "coulomb-friction")
AGREES, UNKNOWN = "agrees", "unknown"
ABSORBED = 10.0  # nats that a noise-free refit leaves, below which nothing can be found
IMPOSSIBLE = "impossible"  # no amount gives the size on this device
FAILED = "failed"  # the search itself ended in an error


@dataclass(frozen=True)
class Outcome:
    """One campaign's answer."""

    case: Case
    """What was hidden."""
    fixed: bool
    """The baseline was held: what is hidden would be absorbed by a fitted one."""
    expected: tuple[str, ...]
    """Right answers for the first round: an id, "unknown" or "agrees"."""
    named: tuple[str, ...]
    """Effects round by round, without what ended the search where a round was made."""
    probability: float
    """Of the first."""
    alternatives: tuple[str, ...]
    """Stated beside the first."""
    ratio: float
    """Final held-out gap over the noise floor."""
    seconds: float
    """Of the search."""
    commit: str
    """Of the code that answered; "+" where it had uncommitted changes."""
    shape_adequate: bool | None = None
    """Whether the first effect's formula holds; None where none is added."""

    @property
    def right(self) -> bool:
        """True where the first answer is the expected one.

        Of what no entry explains, too, where the first effect is said to be only like it.
        """
        if UNKNOWN in self.expected and self.shape_adequate is False:
            return True
        return self.named[0] in self.expected

    @property
    def stated(self) -> bool:
        """True where a right answer is first or among the alternatives."""
        return self.right or bool(set(self.expected) & set(self.alternatives))

    @property
    def both(self) -> bool:
        """True where all that was hidden is named within the first three rounds."""
        return set(self.case.ids) <= set(self.named[:3])


def known_baseline(case: Case) -> ForceModel:
    """Return the whole baseline as fitted to the same device's clean campaign."""
    observed = observe_all(campaign(case, clean=True).records, 1)
    return prepare_baseline(observed, "fit:" + ",".join(BASELINE), fixed=False).whole


def baseline(case: Case) -> tuple[str | ForceModel, bool]:
    """Return a baseline that lacks what is hidden, and whether it absorbed something.

    Each hidden effect is tried alone against a fitted baseline; where one is absorbed (added
    inertance always), the device's known model is held instead.
    """
    lacking = [t for t in BASELINE if t == "inertia" or t not in case.ids]
    for name, identifier in zip(case.hidden, case.ids, strict=True):
        alone = Case(case.kind, (name,), case.size, case.seed)
        terms = [t for t in BASELINE if t == "inertia" or t != identifier]
        if nats_left(alone, terms) < ABSORBED:
            return known_baseline(case), True
    return "fit:" + ",".join(lacking), False


def outcome(case: Case, commit: str = "") -> Outcome:
    """Return what the search answers on one campaign."""
    began = perf_counter()
    try:
        measured = campaign(case)
        model, fixed = baseline(case)
    except InputError as error:
        if not str(error).startswith("size of"):
            raise
        return Outcome(case, False, (), (IMPOSSIBLE,), 0.0, (), 0.0, 0.0, commit)
    if not case.hidden or (fixed and len(case.hidden) == 1 and nats_left(case) < ABSORBED):
        expected: tuple[str, ...] = (AGREES,)
    else:
        expected = tuple(UNKNOWN if i == "outside" else i for i in case.ids)
    try:
        found = close_gap(measured, model, fixed=fixed)
    except Exception as error:  # a study of hours shall count a failure, not end with it
        named = (f"{FAILED}: {type(error).__name__}: {error}",)
        return Outcome(
            case, fixed, expected, named, 0.0, (), 0.0, perf_counter() - began, commit
        )
    return _outcome(found, case, fixed, expected, perf_counter() - began, commit)


def _outcome(
    found: Gap, case: Case, fixed: bool, expected: tuple[str, ...], seconds: float, commit: str
) -> Outcome:
    first = found.rounds[0] if found.rounds else None
    named = tuple(r.effect for r in found.rounds) or (found.last[0][0],)
    stated = found.last[1:] if first is None else first.alternatives
    held = found.final_held_out_gap_percent or found.final_gap_percent
    return Outcome(
        case, fixed, expected, named,
        float(found.last[0][1] if first is None else first.probability),
        tuple(e for e, _ in stated), float(held / found.noise_percent), seconds, commit,
        None if first is None else first.shape_adequate,
    )


def outcomes(
    wanted: Sequence[Case], *, jobs: int = 1, keep: Path | None = None, commit: str = ""
) -> list[Outcome]:
    """Return the outcome of every case; those in the file `keep` are not searched again
    unless the search failed.

    Each outcome is appended to `keep` as one line of JSON as soon as it is there.
    """
    kept = read_outcomes(keep) if keep is not None else []
    known = {o.case.key: o for o in kept if not o.named[0].startswith(FAILED)}
    left = [case for case in wanted if case.key not in known]
    searched = Parallel(n_jobs=jobs, return_as="generator_unordered")(
        delayed(outcome)(case, commit) for case in left
    )
    for one in searched:
        known[one.case.key] = one
        if keep is not None:
            keep.parent.mkdir(parents=True, exist_ok=True)
            with keep.open("a") as file:
                file.write(json.dumps(asdict(one)) + "\n")
    return [known[case.key] for case in wanted]


def read_outcomes(path: Path) -> list[Outcome]:
    """Return the outcomes in a file; a last line that was cut off is left out."""
    result = []
    for line in path.read_text().splitlines() if path.exists() else ():
        try:
            kept = json.loads(line)
        except json.JSONDecodeError:
            continue
        case = kept.pop("case")
        case["hidden"] = tuple(case["hidden"])
        for key in ("expected", "named", "alternatives"):
            kept[key] = tuple(kept[key])
        result.append(Outcome(Case(**case), **kept))
    return result
