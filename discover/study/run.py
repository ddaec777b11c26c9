"""A study: from a campaign to bands, structures, boundary, Dean check and what is left open."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.dean import DeanCheck, check_dean
from discover.figure_data import StructureProbability, StudyFigureData
from discover.library.dictionary import DELAY, Dictionary
from discover.records import Campaign
from discover.regression.baselines import baseline_answers
from discover.regression.support import fitted_terms
from discover.segmentation import Boundary
from discover.selection.judge import Judgement
from discover.selection.materiality import relative_triangle
from discover.selection.structures import STRUCTURES, family_of
from discover.study.accuracy import Accuracy, noise_percent, pooled_percent, predict
from discover.study.bands import Bands, coordinate_values, find_bands
from discover.study.figures import record_curves
from discover.study.findings import study_findings
from discover.study.next import next_test
from discover.study.options import StudyOptions
from discover.study.preparation import Prepared, prepare
from discover.study.result import Nuisance, Study, StudyBand, StudyBoundary, TermEstimate
from models.constitutive import Band, ForceModel, SegmentedModel
from models.device import Device
from models.flow import dean_per_speed

OPEN = 0.05  # probability from which a structure can't be ruled out


def run_study(campaign: Campaign, options: StudyOptions | None = None) -> Study:
    """Return the study of a campaign.

    Parameters
    ----------
    campaign : Campaign
        As `discover.readers.read_campaign` returns it.
    options : StudyOptions, optional
        Choices; the defaults leave everything to the data.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        Where a record can't be used, or none may be fitted.
    """
    chosen = options or StudyOptions()
    device = campaign.device
    prepared = prepare(campaign, chosen)
    bands = find_bands(prepared, device, chosen)
    model = _model(bands, prepared.dictionary, device, chosen.convention)
    place = _places(prepared, bands, device, chosen.convention)
    accuracies = [
        predict(o, model.bands[b].model, prepared.delay + _delay(bands.judgements[b]))
        for o, b in zip(prepared.observations, place, strict=True)
    ]
    fitted = [a for a in accuracies if not a.observation.held_out]
    held = [a for a in accuracies if a.observation.held_out]
    study_bands = tuple(
        _band(b, bands, prepared, model, accuracies, place) for b in range(len(bands.judgements))
    )
    boundaries = tuple(
        _boundary(b, bands, device, chosen.convention, prepared, first=i == 0)
        for i, b in enumerate(bands.segmentation.boundaries)
    )
    check = _dean(bands, boundaries, device, chosen)
    nuisance = _nuisance(bands.judgements, prepared.delay)
    findings = study_findings(campaign, prepared, bands, study_bands, nuisance, chosen)
    return Study(
        title=campaign.title,
        content_hash=campaign.content_hash,
        seed=chosen.seed,
        coordinate=bands.coordinate,
        relative_error_percent=pooled_percent(fitted),
        held_out_relative_error_percent=pooled_percent(held) if held else None,
        identifiable=all(len(b.equivalents) < 2 for b in study_bands),
        findings=findings,
        bands=study_bands,
        nuisance=nuisance,
        boundaries=boundaries,
        dean_check=check,
        next_test=next_test(prepared, bands, study_bands, boundaries, check, campaign.rig),
        model=model,
        figure_data=_figures(bands, prepared, accuracies, place, device),
    )


def _delay(judgement: Judgement) -> float:
    ids = judgement.support.ids
    return float(judgement.fit.coefficients[ids.index(DELAY)]) if DELAY in ids else 0.0


def _edges(bands: Bands) -> list[float | None]:
    return [None, *(b.value for b in bands.segmentation.boundaries), None]


def _model(
    bands: Bands, dictionary: Dictionary, device: Device | None, convention: str
) -> SegmentedModel:
    edges = _edges(bands)
    parts = tuple(
        Band(edges[i], edges[i + 1], ForceModel(fitted_terms(j.fit, dictionary), j.structure))
        for i, j in enumerate(bands.judgements)
    )
    return SegmentedModel(parts, bands.coordinate, convention, device)


def _places(
    prepared: Prepared, bands: Bands, device: Device | None, convention: str
) -> list[int]:
    """Return the band of each record, by its coordinate."""
    edges = [b.value for b in bands.segmentation.boundaries]
    result = []
    for o in prepared.observations:
        value = o.frequency if bands.coordinate == "frequency" else o.speed
        if bands.coordinate == "dean" and device is not None:
            value *= dean_per_speed(device, convention=convention)
        result.append(int(np.searchsorted(edges, value)))
    return result


def _terms(judgement: Judgement, dictionary: Dictionary) -> tuple[TermEstimate, ...]:
    ids = judgement.support.ids
    terms = fitted_terms(judgement.fit, dictionary)
    positions = [i for i, identifier in enumerate(ids) if identifier != DELAY]
    spread = judgement.uncertainty
    result = []
    for term, position in zip(terms, positions, strict=True):
        shapes = {}
        if position < len(judgement.support.free):
            name = term.term.parameters[0].name
            low, high = spread.shape_intervals[position]
            shapes[name] = (float(low), float(high))
        low, high = spread.intervals[position]
        result.append(
            TermEstimate(
                term, float(spread.std_errors[position]), (float(low), float(high)), shapes
            )
        )
    return tuple(result)


def _nuisance(judgements: Sequence[Judgement], delay: float) -> tuple[Nuisance, ...]:
    """Return the sensor's artefacts: one delay for all, since the channels are the same."""
    result = []
    if delay or any(DELAY in j.support.ids for j in judgements):
        steps, weights = zip(*(_delay_step(j) for j in judgements), strict=True)
        weight = sum(weights)
        value = delay + sum(s * w for s, w in zip(steps, weights, strict=True)) / weight
        half = 2.0 / float(np.sqrt(weight))
        result.append(Nuisance(DELAY, value, (value - half, value + half), "s"))
    for judgement in judgements:
        if "force-offset" in judgement.support.ids:
            i = judgement.support.ids.index("force-offset")
            low, high = judgement.uncertainty.intervals[i]
            value = float(judgement.fit.coefficients[i])
            result.append(Nuisance("force-offset", value, (float(low), float(high)), "N"))
    return tuple(result)


def _delay_step(judgement: Judgement) -> tuple[float, float]:
    """Return the delay (s) left beside a band's other terms, and its inverse variance."""
    triangle = judgement.engine.triangle
    ids = judgement.support.ids
    others = judgement.fit.weights[:, [i for i, name in enumerate(ids) if name != DELAY]]
    columns = triangle.columns @ others
    norms = np.linalg.norm(columns, axis=0)
    q, _ = np.linalg.qr(columns / np.where(norms > 0.0, norms, 1.0))
    both = np.column_stack([triangle.columns[:, -1], triangle.target])
    column, target = (both - q @ (q.T @ both)).T
    power = max(float(column @ column), 1e-300)
    return float(column @ target) / power, power


def _band(
    index: int,
    bands: Bands,
    prepared: Prepared,
    model: SegmentedModel,
    accuracies: Sequence[Accuracy],
    place: Sequence[int],
) -> StudyBand:
    judgement = bands.judgements[index]
    edges = _edges(bands)
    inside = [
        a
        for a, b in zip(accuracies, place, strict=True)
        if b == index and not a.observation.held_out
    ] or [a for a in accuracies if not a.observation.held_out]
    frequencies = [a.observation.frequency for a in inside]
    probability = judgement.probabilities[judgement.structure]
    others = sorted(
        ((s, p) for s, p in judgement.probabilities.items() if p >= OPEN),
        key=lambda item: -item[1],
    )
    return StudyBand(
        lower=edges[index],
        upper=edges[index + 1],
        lower_hz=min(frequencies),
        upper_hz=max(frequencies),
        records=tuple(a.observation.file for a in inside),
        family=family_of(judgement.support.ids),
        structure=judgement.structure,
        terms=_terms(judgement, prepared.dictionary),
        error_percent=_of_peak(inside),
        relative_error_percent=pooled_percent(inside),
        noise_percent=noise_percent(inside),
        probability=probability,
        equivalents=tuple(others),
    )


def _of_peak(accuracies: Sequence[Accuracy]) -> float:
    error = sum(a.error_power for a in accuracies)
    return 100.0 * float(np.sqrt(error / max(sum(a.peak**2 for a in accuracies), 1e-300)))


def _boundary(
    boundary: Boundary,
    bands: Bands,
    device: Device | None,
    convention: str,
    prepared: Prepared,
    *,
    first: bool,
) -> StudyBoundary:
    position = boundary.position
    order = bands.segmentation.order
    pair = [prepared.fitted[int(order[position + s])] for s in (-1, 0)]
    frequency = float(np.sqrt(pair[0].frequency * pair[1].frequency))
    change = bands.transition if first else None
    low, high = boundary.interval
    if change is not None:
        low, high = min(low, change.interval[0]), max(high, change.interval[1])
    scale = 1.0
    if bands.coordinate == "dean" and device is not None:
        scale = dean_per_speed(device, convention=convention)
    speed = None if bands.coordinate == "frequency" else boundary.value / scale
    dean, dean_interval = None, None
    if device is not None and speed is not None:
        per_speed = dean_per_speed(device, convention=convention)
        dean = speed * per_speed
        dean_interval = (low / scale * per_speed, high / scale * per_speed)
    return StudyBoundary(
        coordinate=boundary.value,
        bracket=boundary.bracket,
        interval=(low, high),
        speed=speed,
        frequency_hz=boundary.value if bands.coordinate == "frequency" else frequency,
        dean=dean,
        dean_interval=dean_interval,
        width=None if change is None else change.width,
    )


def _dean(
    bands: Bands,
    boundaries: Sequence[StudyBoundary],
    device: Device | None,
    options: StudyOptions,
) -> DeanCheck:
    place = None
    if boundaries:
        first = boundaries[0]
        if first.speed is not None:
            scale = first.coordinate / first.speed
            place = (first.speed, (first.interval[0] / scale, first.interval[1] / scale))
        elif bands.exponent is not None:
            low, high = bands.exponent.speed
            place = (float(np.sqrt(low * high)), (low, high))
    return check_dean(
        device,
        place,
        bands.exponent,
        convention=options.convention,
        criterion=options.criterion,
    )


def _figures(
    bands: Bands,
    prepared: Prepared,
    accuracies: Sequence[Accuracy],
    place: Sequence[int],
    device: Device | None,
) -> StudyFigureData:
    curves = tuple(
        record_curves(a, band=b, structure=bands.judgements[b].structure, device=device)
        for a, b in zip(accuracies, place, strict=True)
    )
    probabilities = tuple(
        StructureProbability(b, name, judgement.probabilities[name])
        for b, judgement in enumerate(bands.judgements)
        for name in STRUCTURES
    )
    baselines = tuple(
        answer
        for b, judgement in enumerate(bands.judgements)
        for answer in baseline_answers(
            relative_triangle(judgement.windows), prepared.dictionary, band=b
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


__all__ = ["coordinate_values", "run_study"]
