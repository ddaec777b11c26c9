"""What a reader of a gap search's answer has to know: what was dropped, refused, or is in doubt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.gap.baseline import Baseline
from discover.gap.result import NamedEffect
from discover.gap.search import Search, Stage
from discover.gap.verdict import CLOSED
from discover.posterior.local import judged
from discover.records import Finding
from discover.rows.held_out import NOT_MET, held_out_findings
from discover.words import capitalize_first, short_name, significant
from models.terms.between_tests import ONLY

_WORSE = 1.02  # of a gap that was not fitted, from which a round is said to raise it
_NOISY = 20.0  # percent of a record's force
_SINGLE = 0.01  # of a record's samples
_MOST = 0.5  # of what is left
_NOT_THE_LINES = 1.5  # times the noise, from which a gap is not what the tests' lines show


def findings_of(
    baseline: Baseline, found: Search, rounds: Sequence[NamedEffect], text: str, noise: float,
    verdict: str,
) -> tuple[Finding, ...]:
    """Return what a reader of a gap search's answer has to know.

    Parameters
    ----------
    baseline : Baseline
        Where the search began.
    found : Search
        The search.
    rounds : sequence of NamedEffect
        Its rounds as they are stated.
    text : str
        Where the baseline misses, in words.
    noise : float
        The records' noise floor, %.
    verdict : str
        What the search comes to.
    """
    return (
        Finding("note", text),
        *_about_start(baseline, found),
        *_wrong_signs(found.refitted),
        *_refused_or_dropped(found),
        *_doubts(rounds),
        *_noisy(found.final),
        *_spikes(found.final, noise),
        *_not_met(found.final),
        *_unexplained(found, noise, verdict),
    )


def _about_start(baseline: Baseline, found: Search) -> list[Finding]:
    """Return how the motion was made where it is not measured, and what refitting alone gives."""
    result = []
    for r in baseline.rows:
        if r.observation.phase_fitted:
            result.append(
                Finding(
                    "note",
                    "has no displacement: the motion is a pure sine of the labelled frequency and"
                    " amplitude, its phase fitted to the force.",
                    r.observation.file,
                )
            )
    gaps = found.given.gap, found.refitted.gap
    if not baseline.fixed and not baseline.fitted and gaps[1] < 0.98 * gaps[0]:
        result.append(
            Finding(
                "note",
                f"Refitting the model's own coefficients alone brings the gap from {gaps[0]:.3g} %"
                f" to {gaps[1]:.3g} %; the rounds start from there. `--fixed` holds them.",
            )
        )
    return result


def _refused_or_dropped(found: Search) -> list[Finding]:
    """Return which effects were refused, or dropped for a later one."""
    result = []
    if found.rejected is not None:
        result.append(
            Finding(
                "warning",
                f"{_named(found.rejected)} "
                "would make the fitted records more probable, but leaves no less of them,"
                " or those that were not fitted are not met better: it is not added.",
            )
        )
    for entry in found.rounds:
        for name in entry.dropped:
            result.append(
                Finding("note", f"{_named(name)},"
                        " named in an earlier round, was made superfluous by"
                        f" {short_name(entry.effect)} and dropped.")
            )
    return result


def _unexplained(found: Search, noise: float, verdict: str) -> list[Finding]:
    """Return what is left at the end that no effect of the list explains."""
    result = []
    over = found.final.gap / max(noise, 1e-300)
    if not found.rounds and found.final.assessed.quiet and over > _NOT_THE_LINES:
        result.append(
            Finding(
                "warning",
                f"The gap is {over:.1f} times the noise beside the tests' own lines, yet nothing in"
                " them is wrong: a source that does not follow the motion (hum, a pump, drift)."
                " Look at the force's spectrum.",
            )
        )
    if verdict not in ("agrees", "closed"):
        result.append(
            Finding(
                "warning",
                "What is left is more than noise, and no further effect of those that were tried"
                " helps more than a smooth remainder does.",
            )
        )
    return result


def _named(identifier: str) -> str:
    """Return a term's name as a sentence begins with it."""
    return capitalize_first(short_name(identifier))


def _wrong_signs(at: Stage) -> list[Finding]:
    """Return which of the model's coefficients the records would have below zero."""
    space, local = at.assessed.space, at.assessed.local
    beside = local.beside(space, at.assessed.curve)
    solved = judged(local, beside, at.assessed.place.sizes(space.own_unit)).solved
    deviation = np.sqrt(np.maximum(np.diagonal(solved.covariance), 0.0))
    result = []
    for i, n in enumerate(local.numbers):
        fitted = local.model.terms[n.term].fitted
        wrong = local.sign[i] * solved.mean[i] < -2.0 * deviation[i]
        if n.shape is None and local.sign[i] and wrong:
            stores = fitted.term.derivative == 2.0
            why = (
                "the device stores energy like a spring here: presliding, stiffness or a lag"
                if stores else "another term is missing that the records have in its place"
            )
            result.append(
                Finding(
                    "warning",
                    f"{_named(fitted.id)} "
                    f"would come out as {significant(solved.mean[i], 3)} {fitted.unit}, which it"
                    f" can't be, and is held at its limit: {why}.",
                )
            )
    return result


def _doubts(rounds: Sequence[NamedEffect]) -> list[Finding]:
    """Return what speaks against relying on a round, though its effect lowers the misfit."""
    result = []
    for entry in rounds:
        if entry.parameters.get(ONLY.name):
            continue  # it is said apart what values of every test's own tell
        raised = _raised(entry)
        if raised is not None:
            result.append(Finding("warning", raised))
        if entry.interval[0] < 0.0 < entry.interval[1]:
            result.append(
                Finding(
                    "warning",
                    f"{_named(entry.effect)} "
                    "is needed, but its coefficient is not told from zero: terms"
                    " beside it, or its own shape, make up for another one.",
                )
            )
        if not entry.shape_adequate:
            result.append(
                Finding(
                    "note",
                    f"{_named(entry.effect)} "
                    f"explains {entry.share_percent:.0f} % of the misfit, but its"
                    " formula leaves more than noise: it is what helps most, not the whole.",
                )
            )
    return result


def _raised(entry: NamedEffect) -> str | None:
    """Return which gap a round raises, None where it raises none."""
    others = ""
    before, after = entry.unseen
    if before is not None and after is not None and after > _WORSE * before:
        others = f"from {before:.3g} % to {after:.3g} %"
    if entry.gap[1] > _WORSE * entry.gap[0]:
        return (
            f"{_named(entry.effect)} "
            f"lowers the gap of records that count alike from {entry.alike[0]:.3g} %"
            f" to {entry.alike[1]:.3g} %, but raises the pooled one from {entry.gap[0]:.3g} % to"
            f" {entry.gap[1]:.3g} %{f' (of records not fitted {others})' if others else ''}:"
            " records of little force gain what those of much lose, as where more than one effect"
            " is missing."
        )
    if others:
        return (
            f"{_named(entry.effect)} "
            "lowers the fitted records' misfit in terms of their noise, but raises"
            f" the gap of those that are not fitted {others}."
        )
    return None


def _noisy(at: Stage) -> list[Finding]:
    """Return what can't be judged because the force does not repeat."""
    levels = [a.noise_percent for a in at.seen]
    count = sum(level > _NOISY for level in levels)
    if not count:
        return []
    return [
        Finding(
            "warning",
            f"In {count} of {len(levels)} records more than {_NOISY:g} % of the force counts as"
            f" noise (up to {max(levels):.0f} %): it does not repeat where the motion does. What"
            " rattles, chatters or slips at random is in it, and is not judged here. Look at the"
            " raw force, and sample faster.",
        )
    ]


def _spikes(at: Stage, noise: float) -> list[Finding]:
    """Return that most of what is left is in single samples, where it is."""
    if at.gap <= CLOSED * noise:
        return []
    sines = [a for a in at.seen if a.observation.kind == "sine"]
    left = [(a.observation.measured - a.model_force) ** 2 for a in sines]
    if not left:
        return []
    most = sum(float(np.sort(s)[-max(1, round(_SINGLE * s.size)) :].sum()) for s in left)
    share = most / max(sum(float(s.sum()) for s in left), 1e-300)
    if share < _MOST:
        return []
    slowest = min(1.0 / a.observation.motion.step for a in sines)
    return [
        Finding(
            "warning",
            f"{100.0 * share:.0f} % of what is left is in {100.0 * _SINGLE:g} % of each record's"
            " samples: impacts or steps that last no longer than a sample. No model can be judged"
            f" by them; sample faster (the slowest record has {slowest:.3g} Hz).",
        )
    ]


def _not_met(at: Stage) -> list[Finding]:
    """Return which records that were not fitted are met worse than those that were."""
    of_each = _of_every_test(at)
    if of_each:
        return of_each
    if any(a.observation.held_out for a in at.unseen):
        return held_out_findings(at.seen, at.unseen)
    fitted = {a.observation.file: a.relative_percent for a in at.accuracies}
    off = [
        a for a in at.unseen
        if a.noise_percent > 0.0
        and a.relative_percent > NOT_MET * max(fitted[a.observation.file], a.noise_percent)
    ]
    if not off:
        return []
    worst = max(off, key=lambda a: a.relative_percent / a.noise_percent)
    count, verb = f"{len(off)} of {len(at.unseen)} records", "is" if len(off) == 1 else "are"
    percent = f"{worst.relative_percent:.3g} % (noise {worst.noise_percent:.3g} %)"
    return [
        Finding(
            "warning",
            f"{count} {verb} predicted worse when left out than when fitted, this one to"
            f" {percent}: what the model says there is known from it alone. Test near it"
            " again.",
            worst.observation.file,
        )
    ]


def _of_every_test(at: Stage) -> list[Finding]:
    """Return what is another one in every test, and so is not known of others."""
    result = []
    own: dict[str, list[float]] = {}
    for t in at.terms:
        if t.shape.get(ONLY.name, 0.0) > 0.0:
            own.setdefault(t.id, []).append(t.coefficient)
    for name, values in own.items():
        result.append(
            Finding(
                "warning",
                f"{_named(name)} is another one in every test (from {significant(min(values), 3)}"
                f" to {significant(max(values), 3)}). No model predicts it, and records that were"
                " not fitted are met with the others' mean: find what sets it, and hold that"
                " still.",
            )
        )
    return result
