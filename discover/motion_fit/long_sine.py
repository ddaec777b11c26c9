"""Sine tests that are too long to be held: their lines and sums, piece by piece."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from discover.motion_fit.cycle_sums import cycle_sums
from discover.motion_fit.harmonic import RELATIVE_FLOOR, moving, observe_sine, velocity_phase
from discover.motion_fit.harmonic_lines import LineSums, lines_of
from discover.motion_fit.observation import Observation
from discover.records import LongRecord, Piece, Record
from discover.sine_fit import SineFit, fit_long_sine, moments
from models.checks import Array, InputError


def observe_long_sine(
    record: Record, long: LongRecord, usable: slice, head: SineFit
) -> Observation:
    """Return the observation of a sine test that is read in pieces.

    Frequency, motion, lines and sums are of all samples from the first steady one on. The noise's
    spectrum, and what is shown, are of the samples in memory.

    Parameters
    ----------
    record : Record
        The first samples.
    long : LongRecord
        All of them.
    usable : slice
        Steady part of the first samples, whose start is that of the record.
    head : SineFit
        Of the displacement there.

    Raises
    ------
    InputError
        As `observe_sine`, and where the motion is not the same throughout.
    """
    if record.displacement is None:
        raise InputError("displacement", expected="given", found="none", where=record.file)
    start = usable.start or 0

    def steady() -> Iterator[Piece]:
        return _from_sample(long, start)

    fit = fit_long_sine(
        lambda: ((p.time, p.displacement) for p in steady()), long.samples - start, head,
        record.time[usable], record.displacement[usable], where=record.file,
    )  # fmt: skip
    first_part = observe_sine(record, usable, fit.frequency, fit)
    (window,) = first_part.windows

    count = window.omega.size - 1
    fitted = LineSums(
        fit.frequency, count, middle=0.5 * (fit.first + float(fit.last[-1]))
    )

    def clear() -> Iterator[tuple[Array, Array]]:
        for piece in steady():
            kept = moving(moments(piece.time), fit.frequency, fit.coefficients)
            time, force = piece.time[kept], piece.force[kept]
            fitted.add(time, force)
            yield time, force

    ends = fit.last[moving(moments(fit.last), fit.frequency, fit.coefficients)]
    last = float(ends[-1] if ends.size else fit.last[-1])
    sums = cycle_sums(clear(), fit.frequency, float(first_part.time[0]), last)
    solution, left = fitted.solve()
    (lines,) = lines_of(solution[None], count)
    turn = np.exp(-1j * np.arange(count + 1) * velocity_phase(fit.coefficients))
    held = float(first_part.time[-1] - first_part.time[0])
    floor = RELATIVE_FLOOR**2 * float(np.sum(np.abs(lines) ** 2))
    window = replace(
        window,
        force=lines * turn,
        variance=np.maximum(window.variance * held / (sums.last - sums.first), floor),
        rest=left / sums.samples,
    )
    return replace(first_part, windows=(window,), sums=sums, drift=float(solution[-1]))


def _from_sample(long: LongRecord, start: int) -> Iterator[Piece]:
    """Yield the pieces from a sample on."""
    begin = 0
    for piece in long.pieces():
        inside = slice(max(start - begin, 0), None)
        begin += piece.time.size
        if begin > start:
            yield Piece(piece.time[inside], piece.displacement[inside], piece.force[inside])
