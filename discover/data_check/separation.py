"""What a plan of tests can't tell apart: the expected gap between structures, before any fit.

Each structure is given a nominal force, in which its terms contribute equally and which is as large
as the measured one. The other structure is then fitted to that force: half the squared misfit over
the noise is the log-likelihood that the records would speak with if the first structure were true.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from discover.data_check.conditioning import joint_rank
from discover.data_check.nominal import TELLING, contains, gap_to, nominal_force, supports_of
from discover.data_check.result import ExpectedGap, Inseparable, Pair
from discover.library.dictionary import Dictionary
from discover.triangle import WindowRows, triangle_of

_SAME_FREQUENCY = 0.02


def expected_pairs(windows: Sequence[WindowRows], dictionary: Dictionary) -> tuple[Pair, ...]:
    """Return every two structures with the gaps that these tests are expected to open.

    Parameters
    ----------
    windows : sequence of WindowRows
        Of the records that may be fitted.
    dictionary : Dictionary
        Of their columns.
    """
    triangle = triangle_of(windows)
    supports = supports_of(dictionary)
    forces = {
        name: triangle.columns @ nominal_force(s, triangle, dictionary)
        for name, s in supports.items()
    }

    def gap(truth: str, model: str) -> ExpectedGap:
        nats = gap_to(forces[truth], supports[model], triangle, dictionary)
        if contains(supports[model], supports[truth]):
            return ExpectedGap(truth, model, nats, "nested")
        return ExpectedGap(truth, model, nats, "separable" if nats >= TELLING else "inseparable")

    found = []
    for first, second in combinations(supports, 2):
        gaps = (gap(first, second), gap(second, first))
        rank, columns = joint_rank((supports[first], supports[second]), triangle, dictionary)
        # Of two nested structures only the larger one can be told, by what the smaller one lacks.
        separable = all(g.word != "inseparable" for g in gaps)
        found.append(Pair((first, second), gaps, rank, columns, separable))
    return tuple(found)


def inseparable_pairs(
    pairs: Sequence[Pair], windows: Sequence[WindowRows]
) -> tuple[Inseparable, ...]:
    """Return those of the pairs that the tests can't tell apart at their noise, and why.

    Parameters
    ----------
    pairs : sequence of Pair
        From `expected_pairs`.
    windows : sequence of WindowRows
        Of the same records.
    """
    return tuple(
        Inseparable(p.structures, p.nats, _why(p, windows)) for p in pairs if not p.separable
    )


def _why(pair: Pair, windows: Sequence[WindowRows]) -> str:
    first, second = pair.structures
    count = len({w.record for w in windows})
    records = "the one record that may be fitted" if count == 1 else f"these {count} records"
    frequencies = np.array([w.frequency for w in windows])
    if "FOIM" in (first, second) and np.ptp(frequencies) < _SAME_FREQUENCY * frequencies.max():
        return (
            f"at a single frequency ({frequencies.mean():.3g} Hz) a fractional derivative is"
            f" exactly a mixture of velocity and acceleration: {first} and {second} need tests at"
            " several frequencies"
        )
    return (
        f"at their noise {records} would speak with only {pair.nats:.2g} nats for the right one of"
        f" {first} and {second}, and {TELLING:.1f} are needed to rule one out at 5 %"
    )
