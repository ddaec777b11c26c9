"""Check a campaign: its records one by one, the sense of its force, and what its plan can tell."""

from __future__ import annotations

from collections.abc import Sequence

from discover.data_check.added_test import added_test
from discover.data_check.conditioning import conditioning
from discover.data_check.figures import plan_figure_data
from discover.data_check.plan import plan_of
from discover.data_check.result import AddedTest, Conditioning, DataCheck, Inseparable, Pair
from discover.data_check.separation import expected_pairs, inseparable_pairs
from discover.data_check.sizes import size_findings
from discover.motion_fit import observe_all
from discover.record_checks import Differing, RecordCheck, check_records, differing_records
from discover.records import Campaign, Finding, checked_campaign
from discover.rows import RecordRows, record_rows
from discover.words import quantity

_LEVELS = ("error", "warning", "note")
_SAME = 0.05  # relative difference below which two amplitudes are one


def check_campaign(campaign: Campaign, *, seed: int = 0, jobs: int = 1) -> DataCheck:
    """Judge a campaign's data before anything is concluded from it.

    Parameters
    ----------
    campaign : Campaign
        As `discover.read_campaign` returns it.
    seed : int
        Kept in the document. Nothing in a check is random.
    jobs : int
        Processes that observe the records.

    Returns
    -------
    DataCheck
        Its ``to_dict()`` is ``check.json``: SI, noise in percent of the force.

    Raises
    ------
    InputError
        Where a record can't be used.

    Examples
    --------
    >>> import discover
    >>> check = discover.check_campaign(discover.read_campaign("data/hidden-effect"))
    >>> check.passed, [pair.structures for pair in check.inseparable]
    (True, [])
    """
    campaign = checked_campaign(campaign)
    observations = observe_all(campaign.records, jobs)
    judged = check_records(campaign, observations)
    rows: tuple[RecordRows, ...] = ()
    differing: tuple[Differing, ...] = ()
    structures: tuple[Conditioning, ...] = ()
    pairs: tuple[Pair, ...] = ()
    inseparable: tuple[Inseparable, ...] = ()
    sizes = size_findings(campaign, judged.records)
    doubted = any(f.about == "unit" for f in (*judged.findings, *sizes))
    more: AddedTest | None = None
    if campaign.fitted:
        rows = tuple(record_rows(o) for o in observations)
        differing = differing_records(rows)
        plan = plan_of([r for r in rows if not r.observation.held_out])
        structures = conditioning(plan)
        pairs = expected_pairs(plan)
        inseparable = inseparable_pairs(pairs, plan)
        more = None if doubted else added_test(pairs, plan, campaign.rig)
    found = [
        *judged.findings,
        *sizes,
        *(d.finding for d in differing),
        *_plan_findings(judged.records),
    ]
    findings = tuple(sorted(found, key=lambda f: _LEVELS.index(f.level)))
    return DataCheck(
        title=campaign.title,
        content_hash=campaign.content_hash,
        seed=seed,
        records=judged.records,
        findings=findings,
        differing=differing,
        structures=structures,
        pairs=pairs,
        inseparable=inseparable,
        added_test=more,
        figure_data=plan_figure_data(campaign, judged.records, findings, rows),
    )


def _plan_findings(records: Sequence[RecordCheck]) -> list[Finding]:
    fitted = [r for r in records if not r.held_out]
    amplitudes = _distinct([r.amplitude_m for r in fitted if r.amplitude_m])
    frequencies = _distinct([r.frequency_hz for r in fitted if r.frequency_hz])
    if not fitted or any(r.amplitude_m is None or r.frequency_hz is None for r in fitted):
        return []  # a sweep or a trajectory has more than one of each
    found = []
    if len(frequencies) == 1:
        found.append(
            Finding(
                "warning",
                f"all tests run at {frequencies[0]:.3g} Hz: neither an order nor a boundary can be"
                " found.",
            )
        )
    elif len(amplitudes) == 1:
        found.append(
            Finding(
                "warning",
                f"all tests run at {quantity(amplitudes[0], 'm')}: a boundary that follows the Dean"
                " number can't be told from one that is fixed in frequency.",
            )
        )
    return found


def _distinct(values: Sequence[float]) -> list[float]:
    """Return values that differ by more than a few percent, rising."""
    kept: list[float] = []
    for value in sorted(values):
        if not kept or value > (1.0 + _SAME) * kept[-1]:
            kept.append(value)
    return kept
