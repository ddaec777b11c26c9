"""Where each test stands in the plan, for pictures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.figure_data import PlanFigureData, PlannedTest
from discover.record_checks import RecordCheck
from discover.records import Campaign, Finding
from discover.rows import RecordRows
from models.flow import dean_per_speed

_GRAVE = ("error", "warning")


def plan_figure_data(
    campaign: Campaign,
    records: Sequence[RecordCheck],
    findings: Sequence[Finding],
    rows: Sequence[RecordRows],
) -> PlanFigureData:
    """Return every sine test, and every window of the other records, with noise and findings.

    Parameters
    ----------
    campaign : Campaign
        As read.
    records : sequence of RecordCheck
        In the campaign's order.
    findings : sequence of Finding
        Of the whole check.
    rows : sequence of RecordRows
        Of all records; none where no record may be fitted.
    """
    tests: list[PlannedTest] = []
    for index, record in enumerate(records):
        found = {f.level for f in findings if f.record == record.file}
        level = next((grave for grave in _GRAVE if grave in found), "")
        places = _places(index, record, rows)
        tests += [
            PlannedTest(
                file=record.file,
                kind=record.kind.kind,
                held_out=record.held_out,
                frequency=frequency,
                amplitude=amplitude,
                noise_percent=noise,
                level=level,
            )
            for frequency, amplitude, noise in places
        ]
    device = campaign.device
    scale = {
        convention: None if device is None else dean_per_speed(device, convention=convention)
        for convention in ("paper", "standard")
    }
    return PlanFigureData(tuple(tests), scale["paper"], scale["standard"])


def _places(
    index: int, record: RecordCheck, rows: Sequence[RecordRows]
) -> list[tuple[float, float, float | None]]:
    """Return frequency (Hz), amplitude (m) and noise (percent): of a sine test, else by window."""
    if record.frequency_hz and record.amplitude_m:
        return [(record.frequency_hz, record.amplitude_m, record.force_noise_percent)]
    if not rows:
        return []
    return [
        (w.frequency, w.amplitude, 100.0 * float(np.sqrt(w.noise_power / w.power)))
        for w in rows[index].observation.windows
        if w.frequency > 0.0 and w.amplitude > 0.0 and w.power > 0.0
    ]
