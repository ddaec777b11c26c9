"""What a study found, in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.bands.boundaries import Boundary
from discover.bands.found import Found
from discover.record_checks import data_errors, differing_records, one_direction
from discover.records import Campaign, Finding
from discover.rows import record_rows
from discover.study.options import StudyOptions
from discover.study.prepare import Prepared, observation_findings
from discover.study.result import Nuisance, StudyBand
from discover.study.verdict import MOST_LEFT
from discover.words import (
    capitalize_first,
    listed,
    percent,
    quantity,
    short_name,
    significant,
    zero_possible,
)
from models.cores import CORES
from models.terms import TERMS
from models.terms.between_tests import is_alike

_NARROW = 1.3  # ratio of frequencies under which a band can't tell an order
_OTHER_COORDINATE = 5.0  # nats, by which frequency has to beat speed to be worth a word
_UNSURE = 0.95  # of what stands beside a structure, below which it is said


def study_findings(
    campaign: Campaign,
    prepared: Prepared,
    found: Found,
    bands: Sequence[StudyBand],
    nuisance: Sequence[Nuisance],
    ends: Sequence[Boundary],
    options: StudyOptions,
) -> tuple[Finding, ...]:
    """Return everything that a user should know, most important first."""
    result = _not_as_asked(campaign, bands, options)
    if prepared.single:
        count = len(campaign.fitted)
        reason = "one record" if count == 1 else f"{count} records"
        result.append(
            Finding(
                "note",
                f"One band only: {reason} can't show a boundary. It takes at least two tests"
                " on either side, at different frequencies.",
            )
        )
    for index, band in enumerate(bands):
        result += _about_band(index, band, len(bands))
        result += _about_frequencies(index, band, prepared)
    result += _about_extras(bands[0])
    if any(b.friction for b in bands):
        result += one_direction(campaign)
    for end in ends:
        if end.width is not None:
            result.append(
                Finding(
                    "note",
                    "The boundary is gradual: from a tenth to nine tenths of the upper band's model"
                    f" the coordinate rises by a factor of {np.exp(end.width):.2g}.",
                )
            )
    result += [_about_nuisance(n) for n in nuisance]
    if found.banded.coordinate == "frequency" and options.coordinate is None:
        result.append(
            Finding(
                "warning",
                "The bands line up by frequency and not by speed amplitude or Dean number, so they"
                " are given by frequency.",
            )
        )
    one_law = all(is_alike(t.shape) for j in found.joined for t in j.terms)
    if not (found.quiet and one_law):  # else one law for all explains all
        held = [record_rows(o) for o in prepared.observations if o.held_out]
        result += [d.finding for d in differing_records([*prepared.rows, *held])]
    observed = observation_findings(prepared.observations)
    return (*data_errors(campaign), *result, *campaign.findings, *observed)


def _about_band(index: int, band: StudyBand, count: int) -> list[Finding]:
    result = []
    name = f"Band {index + 1}" if count > 1 else "The records"
    if len(band.equivalents) > 1:
        names = listed((f"{s} ({100 * p:.0f} %)" for s, p in band.equivalents), last="from")
        result.append(Finding("warning", f"{name}: the data can't tell {names}."))
    low, high = band.remainder.interval
    if low > MOST_LEFT * band.noise_percent:
        result.append(
            Finding(
                "warning",
                f"{name}: beyond the noise {percent(band.remainder.percent)} of the force"
                f" ({significant(low, 3)} to {percent(high)}) is left that no term has, so what is"
                " stated is the best of these models, and not the whole. `inerter gap` says what"
                " helps most.",
            )
        )
    return result


def _about_frequencies(index: int, band: StudyBand, prepared: Prepared) -> list[Finding]:
    """Return what a band's frequencies can't tell of an order."""
    telling = {i for c in CORES if c.family == "fractional" for i in c.required}
    sines = {r.observation.kind for r in prepared.rows if r.file in band.records} == {"sine"}
    if sines and band.upper_hz < 1.001 * band.lower_hz:
        return [
            Finding(
                "warning",
                f"Band {index + 1} has a single frequency: there a fractional derivative is"
                " exactly a mixture of velocity and acceleration, and no order is evidence.",
            )
        ]
    if sines and band.upper_hz / band.lower_hz < _NARROW and telling & {
        t.fitted.id for t in band.terms
    }:
        return [
            Finding(
                "warning",
                f"Band {index + 1} spans only {band.lower_hz:.3g} to {band.upper_hz:.3g} Hz:"
                " the order rests on little.",
            )
        ]
    return []


def _about_extras(band: StudyBand) -> list[Finding]:
    """Return what may stand in the place of something that the device has besides."""
    result = []
    for extra in band.extras:
        name = extra.term.fitted.id
        if extra.probability < _UNSURE and extra.alternatives:
            others = listed(
                (f"{short_name(n)} ({100 * p:.0f} %)" for n, p in extra.alternatives), last="or"
            )
            result.append(
                Finding(
                    "warning",
                    f"{capitalize_first(short_name(name))} ({100 * extra.probability:.0f} %) may as"
                    f" well be {others}.",
                )
            )
    return result


def _not_as_asked(
    campaign: Campaign, bands: Sequence[StudyBand], options: StudyOptions
) -> list[Finding]:
    """Return what was asked for and could not be done."""
    result = []
    if options.coordinate == "dean" and campaign.device is None:
        result.append(
            Finding(
                "warning",
                "Bands by Dean number need the device's geometry ([device] in campaign.toml). They"
                " are by speed amplitude, to which it is proportional.",
            )
        )
    if options.bands is not None and len(bands) != options.bands:
        result.append(
            Finding(
                "warning",
                f"{options.bands} bands were asked for, {len(bands)} are given: every band takes"
                " at least 2 tests.",
            )
        )
    return result


def _about_nuisance(nuisance: Nuisance) -> Finding:
    term = TERMS[nuisance.id]
    size = quantity(nuisance.value, nuisance.unit, nuisance.interval)
    if zero_possible(nuisance.interval):
        size += ", which is not told from zero"
    return Finding(
        "note",
        f"{capitalize_first(short_name(nuisance.id))}, {size}, may belong to a measuring channel"
        f" and not to the device. It is in the model, as {term.summary}.",
    )
