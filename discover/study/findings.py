"""What a study found, in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.record_checks import data_errors
from discover.records import Campaign, Finding
from discover.segmentation import MIN_WINDOWS
from discover.selection.judge import Judgement
from discover.selection.structures import FRACTIONAL
from discover.study.bands import Bands
from discover.study.options import StudyOptions
from discover.study.preparation import Prepared
from discover.study.result import Nuisance, StudyBand

_DAMPING = ("viscous-damping", "quadratic-damping", "power-law-damping")
_NEAR = 3.0  # nats within which another form of the damping is as good
_NARROW = 1.3  # ratio of frequencies under which a band can't tell an order


def study_findings(
    campaign: Campaign,
    prepared: Prepared,
    bands: Bands,
    study_bands: Sequence[StudyBand],
    nuisance: Sequence[Nuisance],
    options: StudyOptions,
) -> tuple[Finding, ...]:
    """Return everything that a user should know, most important first."""
    result = _not_as_asked(campaign, study_bands, options)
    if bands.single:
        count = len(campaign.fitted)
        reason = "one record" if count == 1 else f"{count} records"
        result.append(
            Finding(
                "note",
                f"One band only: {reason} can't show a boundary. It takes at least two tests"
                " on either side, at different frequencies.",
            )
        )
    for index, (band, judgement) in enumerate(zip(study_bands, bands.judgements, strict=True)):
        result += _about_band(index, band)
        frequencies = {round(float(np.log(w.frequency)), 3) for w in judgement.windows}
        kinds = {prepared.observations[w.record].kind for w in judgement.windows}
        if kinds == {"sine"} and len(frequencies) == 1:
            result.append(
                Finding(
                    "warning",
                    f"Band {index + 1} has a single frequency: there a fractional derivative is"
                    " exactly a mixture of velocity and acceleration, and no order is evidence.",
                )
            )
        elif band.upper_hz / band.lower_hz < _NARROW and FRACTIONAL in judgement.support.ids:
            result.append(
                Finding(
                    "warning",
                    f"Band {index + 1} spans only {band.lower_hz:.3g} to {band.upper_hz:.3g} Hz:"
                    " the order rests on little.",
                )
            )
    for index, judgement in enumerate(bands.judgements):
        result += _other_forms(index, judgement)
    if bands.transition is not None:
        result.append(
            Finding(
                "note",
                "The boundary is gradual: from a tenth to nine tenths of the upper band's model the"
                f" {bands.coordinate} rises by a factor of {np.exp(bands.transition.width):.2g}.",
            )
        )
    for n in nuisance:
        result.append(_about_nuisance(n))
    if bands.frequency_advantage > 5.0 and bands.coordinate == "frequency":
        result.append(
            Finding(
                "warning",
                "The bands line up by frequency and not by speed amplitude or Dean number (better"
                f" by {bands.frequency_advantage:.0f} nats), so they are given by frequency.",
            )
        )
    return (*data_errors(campaign), *result, *campaign.findings, *prepared.findings)


def _about_band(index: int, band: StudyBand) -> list[Finding]:
    result = []
    if len(band.equivalents) > 1:
        names = ", ".join(f"{s} ({100 * p:.0f} %)" for s, p in band.equivalents)
        result.append(
            Finding("warning", f"Band {index + 1}: the data can't tell apart {names}.")
        )
    left = band.relative_error_percent**2 - band.noise_percent**2
    if left > 0.0 and band.relative_error_percent > 2.0 * band.noise_percent:
        result.append(
            Finding(
                "warning",
                f"Band {index + 1}: the model misses {band.relative_error_percent:.2g} % of the"
                f" force where the noise is {band.noise_percent:.2g} %: there is an effect that it"
                " does not have. `inerter gap` searches for it.",
            )
        )
    return result


def _other_forms(index: int, judgement: Judgement) -> list[Finding]:
    """Return what other damping terms the same structure may have."""
    scored = [s for s in judgement.contest.scored if s.structure == judgement.structure]
    best = scored[0]
    forms: list[str] = []
    for other in scored[1:]:
        if best.log_evidence - other.log_evidence > _NEAR:
            break
        damping = [i for i in other.fit.support.ids if i in _DAMPING]
        if set(damping) != {i for i in best.fit.support.ids if i in _DAMPING}:
            shape = f" (exponent {other.fit.shapes[0]:.3g})" if other.fit.shapes else ""
            text = " + ".join(damping) + shape
            forms += [text] if text not in forms else []
    if not forms:
        return []
    own = " + ".join(i for i in best.fit.support.ids if i in _DAMPING)
    if not own:
        return [
            Finding(
                "warning",
                f"Band {index + 1}: at this noise {'; '.join(forms[:3])} beside these terms can't"
                " be ruled out.",
            )
        ]
    return [
        Finding(
            "warning",
            f"Band {index + 1}: at this noise {own} can't be told from {'; '.join(forms[:3])}."
            " Their sum is known well, each coefficient alone is not.",
        )
    ]


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
                f" at least {MIN_WINDOWS} tests.",
            )
        )
    return result


def _about_nuisance(nuisance: Nuisance) -> Finding:
    if nuisance.id == "time-delay":
        text = (
            f"The force channel runs {1e3 * nuisance.value:.3g} ms behind the displacement"
            f" ({1e3 * nuisance.interval[0]:.3g} to {1e3 * nuisance.interval[1]:.3g} ms);"
            " coefficients and errors stated here are corrected for it. model.json is the device"
            " without it: `gap --model` and `simulate` meet the records' delay anew."
        )
    else:
        text = (
            f"The force has an offset of {nuisance.value:.3g} N"
            f" ({nuisance.interval[0]:.3g} to {nuisance.interval[1]:.3g} N)."
        )
    return Finding("note", text)
