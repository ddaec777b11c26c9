"""What of a force no smooth response to the motion explains: the local polynomial method.

In a narrow range of lines a response that changes smoothly with frequency is a polynomial
(Pintelon, Schoukens, Vandersteen, Barbe, *Mech. Syst. Signal Process.* 24 (2010) 573-595).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.motion_fit.noise_spectrum import smooth_spectrum
from discover.motion_fit.observation import Lines
from models.checks import Array

_SPAN = 18  # lines at least over which a response is a polynomial
_SPANS = 500  # at most: of more lines each takes more
_DEGREE = 2  # of the polynomials
_AT_ONCE = 100_000  # lines whose windows are formed at a time
_NEXT = -0.5  # correlation of neighbouring lines of white noise, by the sine taper
_LEAST_KEPT = 0.1  # of a line's noise: less tells nothing
_SAME = 1e-11  # of the greatest square of a singular value: no column of its own


def lines_of(column: Array, taper: Array) -> Lines:
    """Return the lines of a column's spectrum under a taper, without that of its mean."""
    return np.asarray(np.fft.rfft((column - column.mean()) * taper)[1:])


def unexplained(
    force: Array, inputs: Sequence[Array], frequencies: Array, step: float
) -> tuple[Array, Array]:
    """Return the power (B,) of a force's lines that no smooth response to inputs explains.

    And the share of a line's noise that is kept in it. Around each few lines the responses are
    polynomials of the frequency, by lines weighed for the same noise.
    """
    taper = np.sin(np.pi * (np.arange(force.size) + 0.5) / force.size)
    taper *= np.sqrt(4.0 * step / force.size)
    target, driving = lines_of(force, taper), np.stack([lines_of(i, taper) for i in inputs])
    whole = smooth_spectrum(frequencies, np.abs(target) ** 2, frequencies[0], 0.5 / step)
    level = whole.at(frequencies)
    target, driving = target / np.sqrt(level), driving / np.sqrt(level)
    size = target.size
    span = span_of(size)
    hop = max(span // 3, 1)
    degree = min(_DEGREE, span // (2 * len(driving)) - 1)
    powers = np.linspace(-1.0, 1.0, span) ** np.arange(degree + 1)[:, None]
    middle = np.arange(0, size, hop)  # of a window the lines from here to the next
    left, kept = np.empty(size), np.empty(size)
    for some in np.array_split(middle, -(-middle.size * span // _AT_ONCE)):
        first = np.clip(some - hop, 0, size - span)
        at = first[:, None] + np.arange(span)
        columns = (driving[:, at][:, None] * powers[:, None]).reshape(-1, *at.shape)
        beside, share = _beside(target[at], columns.transpose(1, 2, 0))
        lines = np.arange(some[0], min(some[-1] + hop, size))
        own = (lines - some[0]) // hop, lines - first[(lines - some[0]) // hop]
        left[lines], kept[lines] = beside[own], share[own]
    return level * left, np.maximum(kept, _LEAST_KEPT)


def span_of(size: int) -> int:
    """Return over how many of so many lines a response is a polynomial."""
    return min(max(_SPAN, -(-size // _SPANS)), size)


def _beside(target: Lines, columns: Lines) -> tuple[Array, Array]:
    """Return the power (W, S) of lines in windows that columns (W, S, P) do not explain.

    And the share of a line's noise that is kept in it, where neighbouring lines are correlated.
    """
    sizes = np.linalg.norm(columns, axis=1, keepdims=True)
    columns = columns / np.where(sizes > 0.0, sizes, 1.0)
    values, turn = np.linalg.eigh(columns.conj().transpose(0, 2, 1) @ columns)
    there = values > _SAME * values[:, -1:]
    turn *= (there / np.sqrt(np.where(there, values, 1.0)))[:, None]
    basis = columns @ turn
    turned = basis.conj()
    left = target - (basis @ (turned.transpose(0, 2, 1) @ target[..., None]))[..., 0]
    kept = 1.0 - np.sum(np.abs(basis) ** 2, axis=2)
    # The noise of a line beside a projection P is that of (1 - P) C (1 - P): of C its diagonal and
    # what is next to it.
    next_to = np.sum((basis[:, :-1] * turned[:, 1:]).real, axis=2)
    across = turned[:, 1:].transpose(0, 2, 1) @ basis[:, :-1]
    both = np.sum(((basis @ across) * turned).real, axis=2)
    both[:, :-1] -= next_to
    both[:, 1:] -= next_to
    return np.abs(left) ** 2, kept + 2.0 * _NEXT * both
