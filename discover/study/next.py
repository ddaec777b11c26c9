"""What a study proposes to do next: settle a structure, or the boundary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.bands.found import Found
from discover.dean import DeanCheck
from discover.next_test import NextTest, Rival, admissible_tests, propose
from discover.posterior.local import fitted, judged, local_of
from discover.records import RigLimits
from discover.study.bands import core_probabilities
from discover.study.estimate import Estimates
from discover.study.prepare import Prepared
from discover.study.result import StudyBand, StudyBoundary
from models.checks import Array

_DEAN = ("a boundary at fixed Dean number", "a boundary at fixed frequency")
_HALVED = float(np.log(2.0))  # nats gained: a test in the middle halves the bracket
_NARROW = 0.05  # of the coordinate's logarithm, that no bracket needs to be narrower than


def next_test(
    prepared: Prepared,
    found: Found,
    estimates: Estimates,
    bands: Sequence[StudyBand],
    boundaries: Sequence[StudyBoundary],
    check: DeanCheck,
    limits: RigLimits | None,
) -> NextTest | None:
    """Return the test that would tell most, None where nothing is open.

    First comes a band whose structure is open, the least certain first; then whether the boundary
    follows the Dean number; then a boundary whose bracket can be halved.
    """
    units = found.search.space.sheet.units
    tested = (
        np.array([u.frequency for u in units]), np.array([u.amplitude for u in units])
    )
    open_bands = sorted(
        (b for b in range(len(bands)) if len(bands[b].equivalents) > 1),
        key=lambda b: bands[b].probability,
    )
    for b in open_bands:
        test = _between_structures(prepared, found, estimates, b, tested, limits)
        if test is not None:
            return test
    if not boundaries:
        return None
    if check.verdict == "undetermined":
        return _other_amplitude(tested, boundaries[0], limits)
    return _halving(tested, bands, boundaries)


def _between_structures(
    prepared: Prepared,
    found: Found,
    estimates: Estimates,
    band: int,
    tested: tuple[Array, Array],
    limits: RigLimits | None,
) -> NextTest | None:
    """Return the test that best tells a band's two leading structures apart."""
    chances = core_probabilities(found, band)
    names = sorted(chances, key=lambda name: -chances[name])[:2]
    rivals = [_rival(found, estimates, band, name, chances[name]) for name in names]
    frequencies, amplitudes = admissible_tests(*tested, limits)
    banded = found.banded
    if banded.bands > 1:
        value = frequencies if banded.coordinate == "frequency" else (
            2.0 * np.pi * frequencies * amplitudes
        )
        low = banded.brackets[band - 1][0] if band else 0.0
        high = banded.brackets[band][1] if band < banded.bands - 1 else np.inf
        inside = (value > low) & (value < high)
        frequencies, amplitudes = frequencies[inside], amplitudes[inside]
    return propose(
        rivals, frequencies, amplitudes, noise=_line_noise(prepared),
        max_force=None if limits is None else limits.max_force,
    )


def _line_noise(prepared: Prepared) -> float:
    """Return a line's standard deviation over its record's rms force, the median of records."""
    levels = [
        float(np.sqrt(np.median(w.variance) / max(w.power, 1e-300)))
        for r in prepared.rows
        for w in r.observation.windows
    ]
    return float(np.median(levels))


def _rival(
    found: Found, estimates: Estimates, band: int, name: str, chance: float
) -> Rival:
    """Return a structure in a band, fitted beside the other bands' own."""
    banded = found.banded
    best = max(
        (v for v in range(len(found.variants)) if found.variants[v].core == name),
        key=lambda v: float(banded.by_variant[band, v]),
    )
    variants = list(banded.variants)
    variants[band] = best
    model = replace(found, banded=replace(banded, variants=tuple(variants))).model
    assessor = estimates.assessor
    sizes = banded.place.sizes(assessor.space.own_unit)
    curve = assessor.curve_of(model)
    begun = local_of(assessor.space, assessor.evaluator, model)
    local = fitted(assessor.space, assessor.evaluator, begun, sizes, curve)
    solved = judged(local, local.beside(assessor.space, curve), sizes).solved
    inside = [
        i for i, n in enumerate(local.numbers)
        if _in_band(local.model.terms[n.term].share, banded.shares[band])
    ]
    unit = int(banded.shares[band].argmax())
    return Rival(
        name, chance, local.model, unit, tuple(local.numbers[i] for i in inside),
        solved.covariance[np.ix_(inside, inside)],
    )


def _in_band(share: tuple[float, ...] | None, own: Array) -> bool:
    return share is None or bool(np.any(np.array(share) * own > 0.0))


def _other_amplitude(
    tested: tuple[Array, Array], boundary: StudyBoundary, limits: RigLimits | None
) -> NextTest | None:
    """Return a test at the boundary's frequency, at the amplitude furthest from those tested."""
    known = tested[1]
    frequencies, amplitudes = admissible_tests(*tested, limits)
    wider = np.unique(np.concatenate([amplitudes, known.min() / np.array([2.0, 4.0])]))
    distance = [float(np.min(np.abs(np.log(a / known)))) for a in wider]
    amplitude = float(wider[int(np.argmax(distance))])
    if max(distance) < _HALVED / 2.0 or not frequencies.size:
        return None
    return NextTest(boundary.frequency_hz, amplitude, _DEAN, max(distance))


def _halving(
    tested: tuple[Array, Array], bands: Sequence[StudyBand], boundaries: Sequence[StudyBoundary]
) -> NextTest | None:
    """Return the test in the middle of the widest bracket between two bands."""
    widths = [float(np.log(b.bracket[1] / b.bracket[0])) for b in boundaries]
    index = int(np.argmax(widths))
    boundary = boundaries[index]
    if widths[index] < _NARROW:
        return None
    amplitude = float(np.median(tested[1]))
    frequency = boundary.frequency_hz
    if boundary.speed is not None:
        frequency = boundary.speed / (2.0 * np.pi * amplitude)
    names = [b.structure for b in bands[index : index + 2]]
    return NextTest(float(frequency), amplitude, (names[0], names[1]), _HALVED)


