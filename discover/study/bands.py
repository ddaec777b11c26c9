"""The bands of a study as its document states them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import logsumexp

from discover.bands.found import Found, Joined
from discover.posterior.reversal import Reversal
from discover.rows import (
    Accuracy,
    RecordRows,
    force_rows,
    noise_percent,
    pooled_percent,
    unexplained,
)
from discover.study.estimate import Estimates
from discover.study.prepare import Prepared
from discover.study.result import Extra, FrictionCurve, StudyBand, TermEstimate
from models.cores import family_of

OPEN = 0.05  # probability from which a structure can't be ruled out
_STATED = 0.02  # of an extra's alternatives


def study_bands(
    prepared: Prepared,
    found: Found,
    estimates: Estimates,
    accuracies: Sequence[Accuracy],
    place: Sequence[int],
    edges: Sequence[float | None],
) -> tuple[StudyBand, ...]:
    """Return the bands in rising coordinate.

    Parameters
    ----------
    prepared : Prepared
        The campaign.
    found : Found
        The search's answer.
    estimates : Estimates
        In numbers.
    accuracies : sequence of Accuracy
        Of all records.
    place : sequence of int
        Band of each.
    edges : sequence of float or None
        Ends of the bands in the coordinate, one more than bands.
    """
    return tuple(
        _band(b, prepared, found, estimates, accuracies, place, (edges[b], edges[b + 1]))
        for b in range(found.banded.bands)
    )


def core_probabilities(found: Found, band: int) -> dict[str, float]:
    """Return the probability of each structure in a band, the others held."""
    values: dict[str, list[float]] = {}
    for variant, value in zip(found.variants, found.banded.by_variant[band], strict=True):
        values.setdefault(variant.core, []).append(float(value))
    total = {core: float(logsumexp(v)) for core, v in values.items()}
    whole = float(logsumexp(list(total.values())))
    return {core: float(np.exp(v - whole)) for core, v in total.items()}


def _band(
    band: int,
    prepared: Prepared,
    found: Found,
    estimates: Estimates,
    accuracies: Sequence[Accuracy],
    place: Sequence[int],
    ends: tuple[float | None, float | None],
) -> StudyBand:
    inside = [
        a for a, b in zip(accuracies, place, strict=True)
        if b == band and not a.observation.held_out
    ] or [a for a in accuracies if not a.observation.held_out]
    spans = [a.observation.span for a in inside]
    chances = core_probabilities(found, band)
    ranked = sorted(chances.items(), key=lambda item: -item[1])
    structure = found.variants[found.banded.variants[band]].core
    terms = estimates.terms[band]
    files = {a.observation.file for a in inside}
    model = estimates.models[band]
    rows: list[RecordRows] = [r for r in prepared.rows if r.file in files]
    return StudyBand(
        lower=ends[0],
        upper=ends[1],
        lower_hz=min(low for low, _ in spans),
        upper_hz=max(high for _, high in spans),
        records=tuple(a.observation.file for a in inside),
        family=family_of([t.fitted.id for t in terms]),
        structure=ranked[0][0] if chances[structure] < ranked[0][1] else structure,
        terms=terms,
        error_percent=_of_peak(inside),
        relative_error_percent=pooled_percent(inside),
        noise_percent=noise_percent(inside),
        probability=ranked[0][1],
        equivalents=tuple((s, p) for s, p in ranked if p >= OPEN),
        extras=tuple(
            _extra(j, t) for j in found.joined for t in terms if t.fitted.id == j.id
        ),
        remainder=unexplained(rows, [force_rows(r, model) for r in rows]),
        friction=_friction(estimates.reversal),
    )


def _of_peak(accuracies: Sequence[Accuracy]) -> float:
    error = sum(a.error_power for a in accuracies)
    return 100.0 * float(np.sqrt(error / max(sum(a.peak**2 for a in accuracies), 1e-300)))


def _extra(joined: Joined, term: TermEstimate) -> Extra:
    chances = joined.step.probabilities
    others = tuple(
        (name, p) for name, p in sorted(chances.items(), key=lambda item: -item[1])
        if name and name != joined.id and p >= _STATED
    )
    return Extra(term, chances[joined.id], others)


_MANNER = {"path": "presliding_displacement", "motion": "transition_speed"}


def _friction(reversal: Reversal | None) -> FrictionCurve | None:
    if reversal is None:
        return None
    key = _MANNER[reversal.follows] if reversal.size > 0.0 else ""
    low, high = reversal.interval
    if not key:
        text = "reverses at once"
    elif key == "presliding_displacement":
        text = f"deflects over {1e3 * reversal.size:.3g} mm before it slides ({1e3 * low:.3g} to" \
            f" {1e3 * high:.3g} mm)"
    else:
        text = f"reverses over {1e3 * reversal.size:.3g} mm/s ({1e3 * low:.3g} to" \
            f" {1e3 * high:.3g} mm/s)"
    return FrictionCurve(
        text, key, reversal.size, reversal.interval, reversal.sure, reversal.differs
    )
