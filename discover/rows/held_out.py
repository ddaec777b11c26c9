"""Records that were not fitted and are met worse than those that were."""

from __future__ import annotations

from collections.abc import Sequence

from discover.motion_fit import Observation
from discover.records import Finding
from discover.rows.accuracy import Accuracy, noise_percent, pooled_percent

NOT_MET = 1.5
"""Times the noise, and what fitted records are off by: a record that is off by more is not met."""
_FURTHER = 1.02  # of the fitted records' range


def held_out_findings(seen: Sequence[Accuracy], unseen: Sequence[Accuracy]) -> list[Finding]:
    """Return a warning where records that are held out are met worse than the fitted ones.

    Parameters
    ----------
    seen, unseen : sequence of Accuracy
        Of the records that were fitted, and of those that are held out.
    """
    met = pooled_percent(seen) / max(noise_percent(seen), 1e-300)
    off = [
        a for a in unseen
        if a.noise_percent > 0.0
        and a.relative_percent > NOT_MET * max(met, 1.0) * a.noise_percent
    ]
    if not off:
        return []
    worst = max(off, key=lambda a: a.relative_percent / a.noise_percent)
    count, verb = f"{len(off)} of {len(unseen)} records", "is" if len(off) == 1 else "are"
    percent = f"{worst.relative_percent:.3g} % (noise {worst.noise_percent:.3g} %)"
    beyond = _beyond_fitted(worst.observation, [a.observation for a in seen])
    return [
        Finding(
            "warning",
            f"{count} that are held out {verb} met worse than the fitted ones, this one to"
            f" {percent}" + (f"; it goes beyond them in {beyond}" if beyond else "")
            + ". What only it shows is not searched for: drop its mark, or test there again.",
            worst.observation.file,
        )
    ]


def _beyond_fitted(own: Observation, others: Sequence[Observation]) -> str:
    """Return in what a record goes beyond the fitted ones, in words; "" where in nothing."""
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
