"""Sine tests that are too long to be held: their lines and sums, piece by piece."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from discover.motion_fit.clear_samples import moving
from discover.motion_fit.cycle_sums import cycle_sums
from discover.motion_fit.harmonic import RELATIVE_FLOOR, find_sine, velocity_phase
from discover.motion_fit.harmonic_lines import LineSums, lines_of
from discover.motion_fit.sine_found import SineFound
from discover.records import LongRecord, Piece, Record
from discover.sine_fit import LongFit, SineFit, fit_long_sine, moments
from models.checks import Array, InputError


def find_long_sine(
    record: Record, long: LongRecord, usable: slice, head: SineFit
) -> SineFound:
    """Return what the samples of a sine test that is read in pieces tell.

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
        As `find_sine`, and where the motion is not the same throughout.
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
    first_part, _ = find_sine(record, usable, fit.frequency, fit)
    count = first_part.force.size - 1
    fitted = LineSums(
        fit.frequency, count, middle=0.5 * (fit.first + float(fit.last[-1]))
    )

    def clear() -> Iterator[tuple[Array, Array]]:
        for piece in steady():
            kept = moving(moments(piece.time), fit.frequency, fit.coefficients)
            time, force = piece.time[kept], piece.force[kept]
            fitted.add(time, force)
            yield time, force

    ends = _clear(fit.last, fit)
    last = float(ends[-1] if ends.size else fit.last[-1])
    held = _clear(record.time[usable], fit)
    sums = cycle_sums(clear(), fit.frequency, float(held[0]), last)
    solution, left = fitted.solve()
    (lines,) = lines_of(solution[None], count)
    turn = np.exp(-1j * np.arange(count + 1) * velocity_phase(fit.coefficients))
    floor = RELATIVE_FLOOR**2 * float(np.sum(np.abs(lines) ** 2))
    span = float(held[-1] - held[0])
    return replace(
        first_part,
        force=lines * turn,
        variance=np.maximum(first_part.variance * span / (sums.last - sums.first), floor),
        rest=left / sums.samples,
        sums=sums,
        drift=float(solution[-1]),
    )


def _clear(time: Array, fit: LongFit) -> Array:
    """Return the times that lie clear of the reversals of motion."""
    return time[moving(moments(time), fit.frequency, fit.coefficients)]


def _from_sample(long: LongRecord, start: int) -> Iterator[Piece]:
    """Yield the pieces from a sample on."""
    begin = 0
    for piece in long.pieces():
        inside = slice(max(start - begin, 0), None)
        begin += piece.time.size
        if begin > start:
            yield Piece(piece.time[inside], piece.displacement[inside], piece.force[inside])
