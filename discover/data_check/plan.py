"""The rows that a plan of tests promises: of every sine test those of a sine, and of nothing else.

A drive's harmonics, a few thousandths of the motion, would formally tell an order at a single
frequency. They are not part of the plan, and at that size a rig's own flaws are as large, so what a
plan can tell is judged without them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.library.dictionary import Dictionary
from discover.motion_fit import Observation
from discover.next_test import sine_rows
from discover.triangle import WindowRows


def plan_rows(
    windows: Sequence[WindowRows], observations: Sequence[Observation], dictionary: Dictionary
) -> tuple[WindowRows, ...]:
    """Return the windows with those of sine tests as a motion without harmonics would give them.

    Parameters
    ----------
    windows : sequence of WindowRows
        As measured.
    observations : sequence of Observation
        Of the campaign's records.
    dictionary : Dictionary
        Of the windows' columns.

    Returns
    -------
    tuple of WindowRows
        With the measured noise. The force column has its measured size, but not the phase that
        would go with the columns.
    """
    return tuple(
        _sine(w, dictionary) if observations[w.record].kind == "sine" else w for w in windows
    )


def _sine(window: WindowRows, dictionary: Dictionary) -> WindowRows:
    lines = window.variance.size
    rows = sine_rows(window.frequency, window.amplitude, dictionary, lines=lines)
    by_line = rows.reshape(2, lines, -1).swapaxes(0, 1)  # of each, real and imaginary part
    force = window.matrix[:, -1]
    return replace(
        window,
        matrix=np.column_stack([by_line.reshape(2 * lines, -1), force]),
        block=np.repeat(np.arange(lines), 2),
    )
