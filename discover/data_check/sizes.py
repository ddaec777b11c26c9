"""Records whose displacement or force is of another size than all others: mostly a wrong unit."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence

import numpy as np

from discover.record_checks import RecordCheck, force_deviation
from discover.records import Campaign, Finding, Record

FACTOR = 100.0
"""Times the median of the others, or a part of it, from which a size is odd: plans of sine tests
span 30 in amplitude, and a unit's prefix is 1000."""
_THOUSAND = 3.0  # factor within which a ratio is taken for a thousand, or for a thousandth


def size_findings(campaign: Campaign, checks: Sequence[RecordCheck]) -> list[Finding]:
    """Return a warning for every record whose displacement or force is out of all proportion.

    A displacement is judged by its amplitude (√2 times the root mean square of a record that is
    no sine test), force by its root mean square about its mean. Since inertia alone makes it grow
    with the frequency's square, sine tests have to be odd by the force over their speed and over
    their acceleration as well. Where both are small and the motion is no sine, the device stood
    still.

    Parameters
    ----------
    campaign : Campaign
        As read.
    checks : sequence of RecordCheck
        Of its records, in order.
    """
    if len(campaign.records) < 2:
        return []
    amplitudes = [_amplitude(r, c) for r, c in zip(campaign.records, checks, strict=True)]
    forces: list[float | None] = [force_deviation(r) for r in campaign.records]
    omegas = [None if c.frequency_hz is None else 2.0 * math.pi * c.frequency_hz for c in checks]
    per_motion = [
        [
            None if f is None or not a or not w else f / (a * w**power)
            for f, a, w in zip(forces, amplitudes, omegas, strict=True)
        ]
        for power in (1, 2)
    ]
    found = []
    for index, record in enumerate(campaign.records):
        if checks[index].frequency_hz is None and _is_still(amplitudes, forces, index):
            text = (
                f"the device does not move in it, {1e3 * (amplitudes[index] or 0.0):.2g} mm, and"
                " its force is as small beside that of the others: leave it out"
            )
            found.append(Finding("warning", text, record.file))
            continue
        own, other = amplitudes[index], _others(amplitudes, index)
        if own and other and _out_of_proportion(own / other):
            sizes = f"is {1e3 * own:.3g} mm", f"{1e3 * other:.3g} mm"
            text = "its displacement amplitude " + _compared(*sizes, own / other, unit="m")
            found.append(Finding("warning", text, record.file, about="unit"))
        own, other = forces[index], _others(forces, index)
        if own and other and _force_out_of_proportion(per_motion, index, ratio=own / other):
            sizes = f"is {own:.3g} N root mean square", f"{other:.3g} N"
            text = "its force " + _compared(*sizes, own / other, unit="N")
            found.append(Finding("warning", text, record.file, about="unit"))
    return found


def _amplitude(record: Record, check: RecordCheck) -> float | None:
    if check.amplitude_m is not None:
        return check.amplitude_m
    if record.displacement is None:
        return None
    return math.sqrt(2.0) * float(np.std(record.displacement))


def _is_still(
    amplitudes: Sequence[float | None], forces: Sequence[float | None], index: int
) -> bool:
    """Return whether both displacement and force are far smaller than those of the others."""
    for values in (amplitudes, forces):
        own, other = values[index], _others(values, index)
        if own is None or (own and (not other or own / other > 1.0 / FACTOR)):
            return False
    return True


def _others(values: Sequence[float | None], index: int) -> float | None:
    """Return the median of the values but one; None where there is no other, or no own one.

    Of two in the middle the one nearer to the own value counts: of three records only that with
    the wrong unit is odd.
    """
    own = values[index]
    known = [v for i, v in enumerate(values) if i != index and v]
    if not own or not known:
        return None
    middle = statistics.median_low(known), statistics.median_high(known)
    return min(middle, key=lambda value: abs(math.log(own / value)))


def _out_of_proportion(ratio: float) -> bool:
    return not 1.0 / FACTOR <= ratio <= FACTOR


def _force_out_of_proportion(
    per_motion: Sequence[Sequence[float | None]], index: int, *, ratio: float
) -> bool:
    """Return whether `ratio` is odd, and force over speed and acceleration, if known, as it is."""
    if not _out_of_proportion(ratio):
        return False
    for values in per_motion:
        own, other = values[index], _others(values, index)
        if not own or not other:
            continue
        if not _out_of_proportion(own / other) or (own > other) != (ratio > 1.0):
            return False
    return True


def _compared(own: str, other: str, ratio: float, *, unit: str) -> str:
    times = f"{ratio:.3g} times" if ratio > 1.0 else f"1/{1.0 / ratio:.3g} of"
    text = f"{own}, {times} that of the others (median {other}): is its unit right?"
    return text + _guess(ratio, unit)


def _guess(ratio: float, unit: str) -> str:
    """Return which prefix may have been missed, where the ratio is near a thousand.

    Examples
    --------
    >>> _guess(1050.0, "m"), _guess(0.9e-3, "N"), _guess(1e5, "m")
    (' mm read as m?', ' kN read as N?', '')
    """
    large, small = {"m": ("mm read as m", "m read as mm"), "N": ("N read as kN", "kN read as N")}[
        unit
    ]
    for guess, expected in ((large, 1e3), (small, 1e-3)):
        if expected / _THOUSAND <= ratio <= expected * _THOUSAND:
            return f" {guess}?"
    return ""
