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
from discover.data_check.nominal import TELLING, Structure, contains, structures
from discover.data_check.plan import Plan
from discover.data_check.result import ExpectedGap, Inseparable, Pair
from discover.words import odds

_SAME_FREQUENCY = 0.02  # of it: frequencies that differ less count as one


def expected_pairs(plan: Plan) -> tuple[Pair, ...]:
    """Return every two structures with the gaps that these tests are expected to open."""
    known = structures()
    forces = {s.name: s.force(plan) for s in known}

    def gap(truth: Structure, model: Structure) -> ExpectedGap:
        nats = model.gap_to(forces[truth.name], plan)
        if contains(model, truth):
            return ExpectedGap(truth.name, model.name, nats, "nested")
        word = "separable" if nats >= TELLING else "inseparable"
        return ExpectedGap(truth.name, model.name, nats, word)

    found = []
    for first, second in combinations(known, 2):
        gaps = (gap(first, second), gap(second, first))
        rank, columns = joint_rank((first, second), plan)
        # Of two nested structures only the larger one can be told, by what the smaller one lacks.
        separable = all(g.word != "inseparable" for g in gaps)
        found.append(Pair((first.name, second.name), gaps, rank, columns, separable))
    return tuple(found)


def inseparable_pairs(pairs: Sequence[Pair], plan: Plan) -> tuple[Inseparable, ...]:
    """Return those of the pairs that the tests can't tell apart at their noise, and why.

    Parameters
    ----------
    pairs : sequence of Pair
        From `expected_pairs`.
    plan : Plan
        The same.
    """
    return tuple(
        Inseparable(p.structures, p.nats, _why(p, plan)) for p in pairs if not p.separable
    )


def _why(pair: Pair, plan: Plan) -> str:
    first, second = pair.structures
    count = plan.records
    records = "the one record that may be fitted" if count == 1 else f"these {count} records"
    frequencies = plan.frequency
    shaped = {s.name for s in structures() if s.bounds is not None}
    if shaped & {first, second} and np.ptp(frequencies) < _SAME_FREQUENCY * frequencies.max():
        return (
            f"at a single frequency ({frequencies.mean():.3g} Hz) a fractional derivative is"
            f" exactly a mixture of velocity and acceleration: {first} and {second} need tests at"
            " several frequencies"
        )
    return (
        f"at their noise {records} would give the right one of {first} and {second} odds of only"
        f" {odds(pair.nats)}, and {odds(TELLING)} are needed to rule one out at 5 %"
    )
