"""A study: from a campaign to bands, structures, boundary, Dean check and what is left open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from discover.bands.boundaries import Boundary, boundaries_of, line_evidence
from discover.bands.extras import without
from discover.bands.found import Found
from discover.bands.told import told
from discover.bands.ways import found
from discover.dean import AmplitudeExponent, DeanCheck, amplitude_exponent, check_dean
from discover.figure_data import StructureProbability, StudyFigureData
from discover.motion_fit import Observation
from discover.records import Campaign
from discover.rows import Accuracy, accuracy, pooled_percent, record_rows, with_own_values
from discover.rows.held_out import held_out_findings
from discover.study.bands import core_probabilities, study_bands
from discover.study.baselines import baseline_answers
from discover.study.estimate import Estimates, estimated
from discover.study.figures import record_curves
from discover.study.findings import study_findings
from discover.study.next import next_test
from discover.study.options import StudyOptions
from discover.study.prepare import Prepared, prepare
from discover.study.result import Nuisance, Study, StudyBand, StudyBoundary
from models.checks import Array
from models.constitutive import Band, ForceModel, SegmentedModel
from models.cores import CORES
from models.device import Device
from models.flow import dean_per_speed
from models.terms.between_tests import ONLY


def run_study(campaign: Campaign, options: StudyOptions | None = None) -> Study:
    """Return the study of a campaign.

    Parameters
    ----------
    campaign : Campaign
        As `discover.read_campaign` returns it.
    options : StudyOptions, optional
        Choices; the defaults leave everything to the data.

    Returns
    -------
    Study
        Coefficients are SI, in each term's unit. Its ``to_dict()`` is ``study.json``.

    Raises
    ------
    InputError
        Where a record can't be used, or none may be fitted.

    Examples
    --------
    >>> import discover
    >>> campaign = discover.read_campaign("data/hidden-effect")
    >>> options = discover.StudyOptions(terms=("inertia", "viscous-damping", "coulomb-friction"))
    >>> study = discover.run_study(campaign, options)
    >>> [band.structure for band in study.bands]
    ['IOIM-linear']
    """
    chosen = options or StudyOptions()
    with threadpool_limits(1):  # its matrices are small: more threads take longer
        prepared = prepare(campaign, chosen)
        return _study(campaign, chosen, prepared, *_answered(prepared))


def _answered(prepared: Prepared) -> tuple[Found, Estimates]:
    """Return the answer and its numbers, without what they do not tell from nothing.

    Beside friction's whole curve a term may be told that is not beside the few that are stated.
    """
    answer = told(found(prepared.device))
    while True:
        estimates = estimated(prepared, answer)
        ids = estimates.untold
        doubtful = [j for j in answer.joined if j.id in ids]
        if not doubtful:
            return answer, estimates
        answer = told(without(answer, doubtful[-1]))


def _study(
    campaign: Campaign,
    chosen: StudyOptions,
    prepared: Prepared,
    answer: Found,
    estimates: Estimates,
) -> Study:
    device = campaign.device
    coordinate, scale = _coordinate(answer, device, chosen)
    ends = boundaries_of(answer)
    edges = [None, *(scale * e.value for e in ends), None]
    place = [_band_of(o, ends, answer.banded.coordinate) for o in prepared.observations]
    accuracies = [
        accuracy(o, estimates.models[b]) for o, b in zip(prepared.observations, place, strict=True)
    ]
    bands = study_bands(prepared, answer, estimates, accuracies, place, edges)
    boundaries = tuple(
        _boundary(e, b, answer, device, chosen.convention, scale) for b, e in enumerate(ends)
    )
    exponent = _exponent(answer) if boundaries else None
    check = _dean(boundaries, exponent, device, chosen)
    nuisance = _nuisance(bands)
    fitted = [a for a in accuracies if not a.observation.held_out]
    held = [a for a in accuracies if a.observation.held_out]
    findings = study_findings(campaign, prepared, answer, bands, nuisance, ends, chosen)
    with_own = _with_own_values(
        [(o, estimates.models[b]) for o, b in zip(prepared.observations, place, strict=True)
         if o.held_out]
    )  # fmt: skip
    if with_own is None:  # else it is known why others are met worse
        findings = (*findings, *held_out_findings(fitted, held))
    model = SegmentedModel(
        tuple(
            Band(edges[b], edges[b + 1], m) for b, m in enumerate(_named(estimates, bands))
        ),
        coordinate, chosen.convention, device,
    )  # fmt: skip
    return Study(
        title=campaign.title,
        content_hash=campaign.content_hash,
        seed=chosen.seed,
        coordinate=coordinate,
        relative_error_percent=pooled_percent(fitted),
        held_out_relative_error_percent=pooled_percent(held) if held else None,
        held_out_with_own_values_percent=with_own,
        identifiable=all(len(b.equivalents) < 2 for b in bands),
        findings=findings,
        bands=bands,
        nuisance=nuisance,
        boundaries=boundaries,
        dean_check=check,
        next_test=None if any(f.about == "unit" for f in findings) else next_test(
            prepared, answer, estimates, bands, boundaries, check, campaign.rig
        ),
        model=model,
        draw=partial(_figures, prepared, answer, bands, accuracies, place, device),
    )


def _with_own_values(held: Sequence[tuple[Observation, ForceModel]]) -> float | None:
    """Return the error of records that were held out where what tests have of their own is theirs.

    None where no term is of one test only.
    """
    if not any(t.shape.get(ONLY.name, 0.0) > 0.0 for _, model in held for t in model.terms):
        return None
    return pooled_percent(
        [accuracy(o, with_own_values(model, record_rows(o))) for o, model in held]
    )


def _named(estimates: Estimates, bands: Sequence[StudyBand]) -> list[ForceModel]:
    return [replace(m, name=b.structure) for m, b in zip(estimates.models, bands, strict=True)]


def _coordinate(
    answer: Found, device: Device | None, options: StudyOptions
) -> tuple[str, float]:
    """Return the coordinate that bands are stated in, and what the search's is times."""
    if answer.banded.coordinate == "frequency" or options.coordinate == "frequency":
        return "frequency", 1.0
    if device is None or options.coordinate == "speed":
        return "speed", 1.0
    return "dean", dean_per_speed(device, convention=options.convention)


def _band_of(observation: Observation, ends: Sequence[Boundary], coordinate: str) -> int:
    """Return the band of a record, by the search's coordinate."""
    value = observation.frequency if coordinate == "frequency" else observation.speed
    return int(np.searchsorted([e.value for e in ends], value))


def _nuisance(bands: Sequence[StudyBand]) -> tuple[Nuisance, ...]:
    """Return what sensors do to the force: the channels are the same in all bands."""
    return tuple(
        Nuisance(
            e.term.fitted.id, e.term.fitted.coefficient, e.term.interval, e.term.fitted.unit
        )
        for e in bands[0].extras
        if e.term.fitted.term.of_channel
    )


def _boundary(
    end: Boundary,
    lower: int,
    answer: Found,
    device: Device | None,
    convention: str,
    scale: float,
) -> StudyBoundary:
    banded = answer.banded
    units = answer.search.space.sheet.units
    values = answer.search.coordinates[banded.coordinate]
    below = [u for u, s in zip(range(len(units)), banded.shares[lower], strict=True) if s > 0.5]
    above = [u for u, s in zip(range(len(units)), banded.shares[lower + 1], strict=True) if s > 0.5]
    pair = max(below, key=lambda u: values[u]), min(above, key=lambda u: values[u])
    frequency = float(np.sqrt(units[pair[0]].frequency * units[pair[1]].frequency))
    by_frequency = banded.coordinate == "frequency"
    speed = None if by_frequency else end.value
    dean, dean_interval = None, None
    if device is not None and not by_frequency:
        per_speed = dean_per_speed(device, convention=convention)
        dean = end.value * per_speed
        dean_interval = (end.interval[0] * per_speed, end.interval[1] * per_speed)
    return StudyBoundary(
        coordinate=scale * end.value,
        bracket=(scale * end.bracket[0], scale * end.bracket[1]),
        interval=(scale * end.interval[0], scale * end.interval[1]),
        speed=speed,
        frequency_hz=end.value if by_frequency else frequency,
        dean=dean,
        dean_interval=dean_interval,
        width=end.width,
    )


def _exponent(answer: Found) -> AmplitudeExponent | None:
    """Return how the lowest boundary follows the amplitude."""
    banded, units = answer.banded, answer.search.space.sheet.units
    inside = np.flatnonzero(banded.shares[0] + banded.shares[1] > 0.0)
    frequency = np.array([units[u].frequency for u in inside])
    amplitude = np.array([units[u].amplitude for u in inside])

    def evidence(upper: NDArray[np.bool_]) -> Array:
        whole = np.zeros((len(upper), len(units)), dtype=bool)
        whole[:, inside] = upper
        return line_evidence(answer, whole)

    return amplitude_exponent(frequency, amplitude, evidence)


def _dean(
    boundaries: Sequence[StudyBoundary],
    exponent: AmplitudeExponent | None,
    device: Device | None,
    options: StudyOptions,
) -> DeanCheck:
    place = None
    if boundaries:
        first = boundaries[0]
        if first.speed is not None:
            scale = first.coordinate / first.speed
            place = (first.speed, (first.interval[0] / scale, first.interval[1] / scale))
        elif exponent is not None:
            low, high = exponent.speed
            place = (float(np.sqrt(low * high)), (low, high))
    return check_dean(
        device,
        place,
        exponent,
        convention=options.convention,
        criterion=options.criterion,
    )


def _figures(
    prepared: Prepared,
    answer: Found,
    bands: Sequence[StudyBand],
    accuracies: Sequence[Accuracy],
    place: Sequence[int],
    device: Device | None,
) -> StudyFigureData:
    curves = tuple(
        record_curves(a, band=b, structure=bands[b].structure, device=device)
        for a, b in zip(accuracies, place, strict=True)
    )
    probabilities = tuple(
        StructureProbability(b, core.name, core_probabilities(answer, b).get(core.name, 0.0))
        for b in range(len(bands))
        for core in CORES
    )
    baselines = tuple(
        one
        for b, band in enumerate(bands)
        for one in baseline_answers(
            [r for r in prepared.rows if r.file in band.records],
            [t.fitted for t in band.terms if t.fitted.id == prepared.device.friction.id],
            band=b,
        )
    )
    scale = {
        c: None if device is None else dean_per_speed(device, convention=c)
        for c in ("paper", "standard")
    }
    return StudyFigureData(
        records=curves,
        baselines=baselines,
        probabilities=probabilities,
        dean_per_speed_paper=scale["paper"],
        dean_per_speed_standard=scale["standard"],
    )
