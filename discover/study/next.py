"""What a study proposes to do next: settle a structure, or the boundary."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.dean import DeanCheck
from discover.next_test import NextTest, admissible_tests, propose
from discover.records import RigLimits
from discover.study.bands import Bands
from discover.study.preparation import Prepared
from discover.study.result import StudyBand, StudyBoundary

_DEAN = ("a boundary at fixed Dean number", "a boundary at fixed frequency")
_HALVED = float(np.log(2.0))


def next_test(
    prepared: Prepared,
    bands: Bands,
    study_bands: Sequence[StudyBand],
    boundaries: Sequence[StudyBoundary],
    check: DeanCheck,
    limits: RigLimits | None,
) -> NextTest | None:
    """Return the test that would tell most, None where nothing is open.

    First comes a band whose structure is open, the least certain first; then whether the boundary
    follows the Dean number; then a boundary whose bracket can be halved.
    """
    per_speed = _per_speed(bands, boundaries)
    open_bands = sorted(
        (b for b in range(len(study_bands)) if len(study_bands[b].equivalents) > 1),
        key=lambda b: study_bands[b].probability,
    )
    for b in open_bands:
        band = study_bands[b]
        inside = (band.lower or 0.0, np.inf if band.upper is None else band.upper)
        found = propose(
            bands.judgements[b],
            prepared.dictionary,
            limits,
            inside=inside if len(study_bands) > 1 else (0.0, np.inf),
            per_speed=per_speed,
        )
        if found is not None:
            return found
    if not boundaries:
        return None
    if check.verdict == "undetermined":
        return _other_amplitude(prepared, boundaries[0], limits)
    return _halving(prepared, bands, boundaries)


def _per_speed(bands: Bands, boundaries: Sequence[StudyBoundary]) -> float | None:
    if bands.coordinate == "frequency":
        return None
    if bands.coordinate == "speed" or not boundaries or boundaries[0].speed is None:
        return 1.0
    return boundaries[0].coordinate / boundaries[0].speed


def _other_amplitude(
    prepared: Prepared, boundary: StudyBoundary, limits: RigLimits | None
) -> NextTest | None:
    """Return a test at the boundary's frequency, at the amplitude furthest from those tested."""
    tested = np.array([w.amplitude for w in prepared.fitted])
    frequencies, amplitudes = admissible_tests(prepared.fitted, limits)
    wider = np.unique(np.concatenate([amplitudes, tested.min() / np.array([2.0, 4.0])]))
    distance = [float(np.min(np.abs(np.log(a / tested)))) for a in wider]
    amplitude = float(wider[int(np.argmax(distance))])
    if max(distance) < _HALVED / 2.0 or not frequencies.size:
        return None
    return NextTest(boundary.frequency_hz, amplitude, _DEAN, max(distance))


def _halving(
    prepared: Prepared, bands: Bands, boundaries: Sequence[StudyBoundary]
) -> NextTest | None:
    """Return the test in the middle of the widest bracket between two bands."""
    widths = [float(np.log(b.bracket[1] / b.bracket[0])) for b in boundaries]
    index = int(np.argmax(widths))
    boundary = boundaries[index]
    if widths[index] < 0.05:
        return None
    amplitude = float(np.median([w.amplitude for w in prepared.fitted]))
    frequency = boundary.frequency_hz
    if boundary.speed is not None:
        frequency = boundary.speed / (2.0 * np.pi * amplitude)
    names = tuple(j.structure for j in bands.judgements[index : index + 2])
    return NextTest(float(frequency), amplitude, (names[0], names[1]), _HALVED)
