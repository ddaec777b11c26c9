"""How far a force channel's zero wanders from test to test.

The noise of a record's mean can't be seen beside it: noise that rises towards low frequency
(1/f, slow drift of a load cell) has most of its power below the lowest gap between harmonics. The
means of several tests show it by their scatter about what a constant offset and the one-sided
terms explain, and the mean of each test is weighted accordingly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.library.dictionary import Dictionary
from discover.regression.support import solve
from discover.triangle import WindowRows

_WITH_MEAN = ("force-offset", "asymmetric-damping", "stiffness")


def with_zero_drift(
    windows: Sequence[WindowRows], dictionary: Dictionary
) -> list[WindowRows]:
    """Return the windows with the variance of sine tests' means raised to what their scatter shows.

    Parameters
    ----------
    windows : sequence of WindowRows
        Those that are not of sine tests stay as they are; so do all where fewer than two means
        are left over the terms that can explain a mean.
    dictionary : Dictionary
        Of their columns.

    Returns
    -------
    list of WindowRows
        The drift's power is taken in proportion to each record's noise.
    """
    sine = [i for i, w in enumerate(windows) if w.count[0] == 1.0]
    present = [dictionary.index(i) for i in _WITH_MEAN if dictionary.has(i)]
    freedom = len(sine) - len(present)
    if freedom < 2:
        return list(windows)
    rows = np.array([windows[i].matrix[windows[i].block == 0][0] for i in sine])
    variance = np.array([windows[i].variance[0] for i in sine])
    level = np.array([windows[i].noise_power for i in sine]) + variance
    scaled = rows / np.sqrt(level)[:, None]
    _, scatter = solve(scaled[:, present], scaled[:, -1])
    drift = max(scatter / freedom - float(np.mean(variance / level)), 0.0)
    result = list(windows)
    for i, power in zip(sine, level, strict=True):
        raised = windows[i].variance.copy()
        raised[0] += drift * power
        result[i] = replace(windows[i], variance=raised)
    return result
