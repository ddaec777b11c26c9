"""Delay of the force channel, found before the search so that the search need only refine it.

Skew between channels turns inertance into damping and damping into inertance at every frequency.
As a column, the force's slope in time stands for it only while frequency times delay is small; so
the force's lines are shifted by what a rich model finds, and the rest is found again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.library.dictionary import DELAY, Dictionary
from discover.regression.support import ProfiledFit, Support, solve
from discover.selection.discrepancy import neighbours
from discover.selection.evidence import score
from discover.selection.materiality import noise_energy, relative_triangle
from discover.selection.structures import named_supports
from discover.selection.variants import rich_weights
from discover.triangle import WindowRows, triangle_of

_HARMONICS = 5  # higher ones turn too far for a slope
_CLEAR = 10.0  # nats
_WORTH = 20.0  # rise of the log likelihood ratio from which a delay is corrected


def rich_delay(windows: Sequence[WindowRows], dictionary: Dictionary) -> float:
    """Return the force channel's delay beside a rich model, s; 0 where it does not matter.

    It matters where it explains significantly much, and more than the rich model leaves above the
    noise: an effect that no term here is may look like a delay too.
    """
    if not dictionary.has(DELAY):
        return 0.0
    low = [_low_harmonics(w) for w in windows]
    triangle = relative_triangle(low)
    weights = rich_weights(dictionary)
    with_delay, misfit = solve(triangle.columns @ weights, triangle.target)
    _, without = solve(triangle.columns @ weights[:, :-1], triangle.target)
    noise, deviation = noise_energy(low)
    gain = without - misfit
    informative = 8.0 * len(windows)
    ratio = informative * float(np.log(max(without, 1e-300) / max(misfit, 1e-300)))
    if ratio < _WORTH or gain < max(misfit - noise - 3.0 * deviation, 0.0):
        return 0.0
    return float(with_delay[-1])


def further_delay(windows: Sequence[WindowRows], dictionary: Dictionary) -> float:
    """Return what is left of a delay that is nearly taken out, s, from all lines by their noise."""
    triangle = triangle_of(windows)
    weights = rich_weights(dictionary)
    coefficients, _ = solve(triangle.columns @ weights, triangle.target)
    return float(coefficients[-1])


def delay_holds(
    windows: Sequence[WindowRows], shifted: Sequence[WindowRows], dictionary: Dictionary
) -> bool:
    """Return whether taking a delay out helps the structures themselves, and not just a rich model.

    Memory of the flow turns the force's phase as a delay does. So the best structure of all tests
    must gain clearly by the shift, and the best ones of neighbouring tests must not lose.
    """
    supports = named_supports(dictionary, ())
    whole = _best(shifted, dictionary, supports) - _best(windows, dictionary, supports)
    if whole < _CLEAR:
        return False
    local = [
        _best([shifted[i] for i in group], dictionary, supports)
        - _best([windows[i] for i in group], dictionary, supports)
        for group in neighbours(np.array([w.speed for w in windows]))
    ]
    return float(np.sum(local)) > 0.0


def _best(
    windows: Sequence[WindowRows], dictionary: Dictionary, supports: Sequence[Support]
) -> float:
    return score(ProfiledFit(triangle_of(windows), dictionary), supports)[0].log_evidence


def _low_harmonics(window: WindowRows) -> WindowRows:
    if window.count.size <= _HARMONICS + 2:
        return window
    kept = window.block <= _HARMONICS
    return replace(
        window,
        matrix=window.matrix[kept],
        block=window.block[kept],
        count=window.count[: _HARMONICS + 1],
        variance=window.variance[: _HARMONICS + 1],
        discrepancy=window.discrepancy[: _HARMONICS + 1],
    )
