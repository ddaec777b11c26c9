"""From a campaign to whitened rows: observe each record once, evaluate each column once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.library.dictionary import DELAY, PLAIN, Dictionary, standard_dictionary
from discover.motion_fit import Observation, observe_all
from discover.records import Campaign, Finding
from discover.regression.support import MOST_DELAY, Support, solve
from discover.selection.delay import delay_holds, further_delay, rich_delay
from discover.selection.materiality import relative_triangle
from discover.selection.structures import FRACTIONAL, POWER, candidate_supports
from discover.selection.variants import rich_weights, settle_variants
from discover.study.options import StudyOptions
from discover.triangle import WindowRows, rows_of
from models.checks import InputError
from models.terms import find_term

_REVERSAL_SCALE = 0.5
_TRANSITION_ROUNDS = 2
_TRANSITIONS = 7
_LEAST_TRANSITION = 0.1  # of the least transition speed of the standard dictionary
_DELAY_ROUNDS = 4
_NO_DELAY = 2e-6  # s
_ORDERS = (0.0, 2.0)
_EXPONENTS = (0.4, 3.0)


@dataclass(frozen=True)
class Prepared:
    """A campaign ready for the search."""

    observations: tuple[Observation, ...]
    """Of all records, in the campaign's order."""
    fitted: tuple[WindowRows, ...]
    """Windows of the records that may be fitted, one variant of each term."""
    held_out: tuple[WindowRows, ...]
    """Windows of the others."""
    dictionary: Dictionary
    """Of their columns."""
    supports: tuple[Support, ...]
    """What the search weighs."""
    delay: float
    """s: what the force channel was found to run late, taken out of the windows."""
    findings: tuple[Finding, ...]
    """What observing found."""


def _range(grid: tuple[float, ...] | None, default: tuple[float, float]) -> tuple[float, float]:
    if grid is None:
        return default
    if len(grid) == 1:
        return max(grid[0] - 1e-6, default[0]), grid[0] + 1e-6
    return min(grid), max(grid)


def prepare(campaign: Campaign, options: StudyOptions) -> Prepared:
    """Return the campaign's observations and rows.

    Raises
    ------
    InputError
        Where no record may be fitted, or a term can't be searched for in a study.
    """
    if not campaign.fitted:
        raise InputError(
            "records", expected="at least one that is not held out", found="none",
            where=campaign.source,
        )
    observations = observe_all(campaign.records, options.jobs)
    windows = [w for o in observations if not o.held_out for w in o.windows]
    terms = PLAIN if options.terms is None else _plain_terms(options.terms)
    delay = options.terms is None or DELAY in options.terms
    dictionary = standard_dictionary(
        np.array([w.speed for w in windows]),
        np.array([2.0 * np.pi * w.frequency for w in windows]),
        terms=terms,
        orders=_range(options.orders, _ORDERS),
        exponents=_range(options.exponents, _EXPONENTS),
        delay=delay,
    )
    fitted, delay_found = _without_delay(observations, dictionary)
    settled, small = settle_variants(fitted, dictionary)
    for _ in range(_TRANSITION_ROUNDS):
        closer = _closer(dictionary, small)
        if closer is None:
            break
        dictionary = closer
        fitted = _fitted_rows(observations, dictionary, delay_found)
        settled, small = settle_variants(fitted, dictionary)
    if small.has("coulomb-friction") and small.transition_speeds[0] > 0.0:
        small = small.with_reversal(_REVERSAL_SCALE * _friction(settled, small))
        settled = _fitted_rows(observations, small, delay_found)
    held = [
        w
        for i, o in enumerate(observations)
        if o.held_out
        for w in rows_of(o, small, i, delay=delay_found)
    ]
    if options.terms is None:
        supports = tuple(candidate_supports(small))
    else:
        free = tuple(t for t in options.terms if t in (FRACTIONAL, POWER))
        plain = tuple(t for t in options.terms if t not in free)
        supports = (Support(plain, free),)
    return Prepared(
        observations,
        tuple(settled),
        tuple(held),
        small,
        supports,
        delay_found,
        _findings(observations),
    )


def _fitted_rows(
    observations: tuple[Observation, ...], dictionary: Dictionary, delay: float
) -> list[WindowRows]:
    return [
        w
        for i, o in enumerate(observations)
        if not o.held_out
        for w in rows_of(o, dictionary, i, delay=delay)
    ]


def _friction(windows: Sequence[WindowRows], dictionary: Dictionary) -> float:
    """Return Coulomb friction beside a rich model, N; at least a thousandth of the force."""
    triangle = relative_triangle(windows)
    weights = rich_weights(dictionary)
    coefficients, _ = solve(triangle.columns @ weights, triangle.target)
    found = abs(float(coefficients[dictionary.index("coulomb-friction")]))
    return max(found, 1e-3 * float(np.sqrt(np.median([w.power for w in windows]))))


def _without_delay(
    observations: tuple[Observation, ...], dictionary: Dictionary
) -> tuple[list[WindowRows], float]:
    """Return the fitted rows with the force channel's delay taken out, and the delay, s."""
    start = _fitted_rows(observations, dictionary, 0.0)
    delay = rich_delay(start, dictionary)
    if abs(delay) < _NO_DELAY or abs(delay) > MOST_DELAY:
        return start, 0.0
    rows = _fitted_rows(observations, dictionary, delay)
    for _ in range(_DELAY_ROUNDS):
        step = further_delay(rows, dictionary)
        if abs(step) < _NO_DELAY or abs(delay + step) > MOST_DELAY:
            break
        delay += step
        rows = _fitted_rows(observations, dictionary, delay)
    return (rows, delay) if delay_holds(start, rows, dictionary) else (start, 0.0)


def _closer(dictionary: Dictionary, settled: Dictionary) -> Dictionary | None:
    """Return the dictionary with transition speeds between the best one's neighbours.

    Where friction jumps, a jump and speeds below the least are tried once.
    """
    if not settled.has("coulomb-friction"):
        return None
    speeds = dictionary.transition_speeds
    if settled.transition_speeds[0] == 0.0:
        if speeds.size < 2 or speeds.size == _TRANSITIONS + 1:
            return None
        least = float(speeds[1])
        faster = np.geomspace(_LEAST_TRANSITION * least, least, _TRANSITIONS)
        return dictionary.with_transitions(np.r_[0.0, faster])
    best = int(np.searchsorted(speeds, settled.transition_speeds[0]))
    low = speeds[best - 1] if best > 0 and speeds[best - 1] > 0.0 else 0.5 * speeds[best]
    high = speeds[best + 1] if best + 1 < speeds.size else 2.0 * speeds[best]
    return dictionary.with_transitions(np.geomspace(low, high, _TRANSITIONS))


def _plain_terms(terms: tuple[str, ...]) -> tuple[str, ...]:
    result = []
    for identifier in terms:
        term = find_term(identifier, where="--terms")
        if identifier in (FRACTIONAL, POWER, DELAY, "coulomb-friction"):
            continue
        if term.column is None or any(p.scaled_by for p in term.parameters):
            raise InputError(
                "term",
                expected="one whose force is linear in its coefficient; the missing-effect"
                " search handles the others",
                found=identifier,
                where="--terms",
            )
        result.append(identifier)
    return tuple(result)


def _findings(observations: tuple[Observation, ...]) -> tuple[Finding, ...]:
    result = []
    for o in observations:
        if o.cutoff is not None:
            result.append(
                Finding(
                    "note",
                    f"is a {o.kind} record; force and terms are compared up to {o.cutoff:.3g} Hz,"
                    " where the displacement stands clear of its noise.",
                    o.file,
                )
            )
    return tuple(result)
