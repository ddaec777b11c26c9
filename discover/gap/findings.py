"""What a reader of a gap search's answer has to know: what was dropped, refused, or is in doubt."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.gap.accuracy import sample_misfit
from discover.gap.baseline import Baseline
from discover.gap.result import CLOSED, NamedEffect
from discover.gap.search import Search
from discover.gap.stages import Stage, seen_gap
from discover.naming.evidence import AGREES, FEW, UNKNOWN
from discover.naming.forces import model_force
from discover.naming.rows import RecordRows
from discover.naming.unit_rows import whole_model
from discover.records import Finding
from models.constitutive import ForceModel

_WORSE = 1.02  # of a gap that was not fitted, from which a round is said to raise it
_NOISY = 20.0  # percent of a record's force
_SINGLE = 0.01  # of a record's samples
_MOST = 0.5  # of what is left
_NOT_MET = 1.5  # times the noise, and what fitted records are off by
_FURTHER = 1.02  # of the fitted records' range
_OWN = (
    ("sensor-drift", "The force channel's zero", "zero the channel before each test"),
    ("time-delay", "The delay between the channels", "start both by one trigger, on one clock"),
)
_NOT_THE_LINES = 1.5  # times the noise, from which a gap is not what the tests' lines show


def findings_of(
    baseline: Baseline, found: Search, rounds: Sequence[NamedEffect], text: str, noise: float
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
    """
    result = [Finding("note", text)]
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
    if found.refitted is not found.baseline:
        gaps = seen_gap(baseline.rows, found.baseline), seen_gap(baseline.rows, found.refitted)
        result.append(
            Finding(
                "note",
                f"Refitting the model's own coefficients alone brings the gap from {gaps[0]:.3g} %"
                f" to {gaps[1]:.3g} %; the rounds start from there. --fixed holds them.",
            )
        )
    if found.rejected is not None:
        result.append(
            Finding(
                "warning",
                f"{found.rejected} would lower the misfit in terms of the records' noise, but not"
                " the gap in force, or that only of records that it is fitted to, and is not added:"
                " the noise differs much between records, or the model is wrong in more than one"
                " way.",
            )
        )
    for entry in found.rounds:
        for name in entry.dropped:
            result.append(
                Finding("note", f"{name}, named in an earlier round, was made superfluous by"
                        f" {entry.effect} and dropped.")
            )
    result += _doubts(baseline, rounds)
    result += _noisy(baseline.rows, found.final)
    result += _spikes(baseline.rows, found.final, noise)
    result += _not_met(baseline.rows, found.final, noise)
    ended = found.last.ranked[0]
    over = seen_gap(baseline.rows, found.final) / max(noise, 1e-300)
    by_shapes = found.last.tolerated > 0.0
    if ended[0] == AGREES and not found.rounds and not by_shapes and over > _NOT_THE_LINES:
        result.append(
            Finding(
                "warning",
                f"The gap is {over:.1f} times the noise beside the tests' own lines, yet nothing in"
                " them is wrong: a source that does not follow the motion (hum, a pump, drift)."
                " Look at the force's spectrum.",
            )
        )
    if ended[0] == AGREES and by_shapes:
        result.append(
            Finding(
                "note",
                "What is left is no more than noise and what the formulas of the added effects may"
                " differ from the real ones by: no further effect is sought in it.",
            )
        )
    if ended[0] == UNKNOWN:
        chance = "over 0.99" if ended[1] > 0.99 else f"{ended[1]:.2f}"
        result.append(
            Finding(
                "warning",
                "What is left is more than noise, and none of the effects that were tried explains"
                f" it (probability {chance} that it is none of them).",
            )
        )
    return tuple(result)


def _doubts(baseline: Baseline, rounds: Sequence[NamedEffect]) -> list[Finding]:
    """Return what speaks against relying on a round, though its effect lowers the misfit."""
    result = []
    for entry in rounds:
        if entry.parameters.get("only"):
            continue  # it is said apart what values of every test's own tell
        raised = _raised(entry)
        if raised is not None:
            result.append(Finding("warning", raised))
        if entry.interval[0] < 0.0 < entry.interval[1]:
            result.append(
                Finding(
                    "warning",
                    f"{entry.effect} is needed, but its coefficient is not told from zero: terms"
                    " beside it, or its own shape, make up for another one.",
                )
            )
    fitted = sum(not r.observation.held_out for r in baseline.rows)
    if rounds and fitted < FEW:
        result.append(
            Finding(
                "warning",
                f"Fewer than {FEW} records were fitted: a wrong shape can't be told from a second"
                " small effect, and the nearest entry is named.",
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
            f"{entry.effect} lowers the gap of records that count alike from {entry.alike[0]:.3g} %"
            f" to {entry.alike[1]:.3g} %, but raises the pooled one from {entry.gap[0]:.3g} % to"
            f" {entry.gap[1]:.3g} %{f' (of records not fitted {others})' if others else ''}:"
            " records of little force gain what those of much lose, as where more than one effect"
            " is missing."
        )
    if others:
        return (
            f"{entry.effect} lowers the fitted records' misfit in terms of their noise, but raises"
            f" the gap of those that are not fitted {others}."
        )
    return None


def _noisy(rows: Sequence[RecordRows], at: Stage) -> list[Finding]:
    """Return what can't be judged because the force does not repeat."""
    levels = [
        m.noise_percent
        for r, m in zip(rows, at.misfits, strict=True)
        if not r.observation.held_out
    ]
    count = sum(level > _NOISY for level in levels)
    if not count:
        return []
    return [
        Finding(
            "warning",
            f"In {count} of {len(levels)} records more than {_NOISY:g} % of the force counts as"
            f" noise (up to {max(levels):.0f} %): it does not repeat from cycle to cycle. What"
            " rattles, chatters or slips at random is in it, and is not judged here. Look at the"
            " raw force, and sample faster.",
        )
    ]


def _spikes(rows: Sequence[RecordRows], at: Stage, noise: float) -> list[Finding]:
    """Return that most of what is left is in single samples, where it is."""
    if seen_gap(rows, at) <= CLOSED * noise:
        return []
    sines = [r for r in rows if not r.observation.held_out and r.observation.kind == "sine"]
    left = [
        sample_misfit(r.observation, model_force(r.observation, whole_model(r, at.fit.model))) ** 2
        for r in sines
    ]
    if not left:
        return []
    most = sum(float(np.sort(s)[-max(1, round(_SINGLE * s.size)) :].sum()) for s in left)
    share = most / max(sum(float(s.sum()) for s in left), 1e-300)
    if share < _MOST:
        return []
    slowest = min(1.0 / r.observation.motion.step for r in sines)
    return [
        Finding(
            "warning",
            f"{100.0 * share:.0f} % of what is left is in {100.0 * _SINGLE:g} % of each record's"
            " samples: impacts or steps that last no longer than a sample. No model can be judged"
            f" by them; sample faster (the slowest record has {slowest:.3g} Hz).",
        )
    ]


def _not_met(rows: Sequence[RecordRows], at: Stage, noise: float) -> list[Finding]:
    """Return which records that were not fitted are met worse than those that were."""
    of_each = _of_every_test(at.fit.model)
    if of_each:
        return of_each
    marked = [r for r in rows if r.observation.held_out]
    seen = [r for r in rows if not r.observation.held_out]
    met = seen_gap(rows, at) / max(noise, 1e-300)
    off = []
    for r, m, own in zip(marked or rows, at.unseen, at.misfits, strict=False):
        usual = met * m.noise_percent if marked else own.percent
        if m.noise_percent > 0.0 and m.percent > _NOT_MET * max(usual, m.noise_percent):
            off.append((m.percent / m.noise_percent, r, m))
    if not off:
        return []
    _, worst, m = max(off, key=lambda o: o[0])
    count, verb = f"{len(off)} of {len(at.unseen)} records", "is" if len(off) == 1 else "are"
    if not marked:
        return [
            Finding(
                "warning",
                f"{count} {verb} predicted worse when left out than when fitted, this one to"
                f" {m.percent:.3g} % (noise {m.noise_percent:.3g} %): what the model says there is"
                " known from it alone. Test near it again.",
                worst.observation.file,
            )
        ]
    beyond = _beyond_fitted(worst, seen)
    return [
        Finding(
            "warning",
            f"{count} that are held out {verb} met worse than the fitted ones, this one to"
            f" {m.percent:.3g} % (noise {m.noise_percent:.3g} %)"
            + (f"; it goes beyond them in {beyond}" if beyond else "")
            + ". What only it shows is not searched for: drop its mark, or test there again.",
            worst.observation.file,
        )
    ]


def _of_every_test(model: ForceModel) -> list[Finding]:
    """Return what is another one in every test, and so is not known of others."""
    result = []
    for effect, what, remedy in _OWN:
        terms = [t for t in model.terms if t.id == effect and t.shape["only"] > 0.0]
        terms = [t for t in terms if t.shape.get("over", 1.0) > 0.0]  # of a drift the zeros
        if terms:
            values = [t.coefficient for t in terms]
            result.append(
                Finding(
                    "warning",
                    f"{what} is another one in every test (from {min(values):.3g} to"
                    f" {max(values):.3g} {terms[0].unit}). No model predicts it, and records that"
                    f" were not fitted are met with the others' mean: {remedy}.",
                )
            )
    return result


def _beyond_fitted(unseen: RecordRows, seen: Sequence[RecordRows]) -> str:
    """Return in what a record goes beyond the fitted ones, in words; "" where in nothing."""
    own = unseen.observation
    others = [r.observation for r in seen]
    parts = []
    for name, unit, value, known in (
        ("amplitude", "mm", 1e3 * own.amplitude, [1e3 * o.amplitude for o in others]),
        ("frequency", "Hz", own.frequency, [o.frequency for o in others]),
        ("speed", "m/s", own.speed, [o.speed for o in others]),
    ):
        if value > _FURTHER * max(known):
            parts.append(f"{name} ({value:.3g} {unit}, they up to {max(known):.3g})")
        elif _FURTHER * value < min(known):
            parts.append(f"{name} ({value:.3g} {unit}, they from {min(known):.3g})")
    return " and ".join(parts)
