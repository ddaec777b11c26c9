"""From a campaign to what a study searches with: observe each record once, choose what may hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from discover.bands.found import Device
from discover.motion_fit import Observation, observe_all
from discover.records import Campaign, Finding, checked_campaign
from discover.rows import RecordRows, record_rows
from discover.study.options import StudyOptions
from models.checks import InputError
from models.cores import CORES, FRICTION, TELLING, Core, core_of, family_of
from models.terms import TERMS, find_term

_FEWEST = 4  # units, from which two bands are possible


@dataclass(frozen=True)
class Prepared:
    """A campaign ready for the search."""

    observations: tuple[Observation, ...]
    """Of all records, in the campaign's order."""
    rows: tuple[RecordRows, ...]
    """Of the records that may be fitted."""
    device: Device
    """What is searched with."""
    single: bool
    """True where one record, or too few, allow one band only."""


def prepare(campaign: Campaign, options: StudyOptions) -> Prepared:
    """Return the campaign's observations and rows, and what the search weighs.

    Raises
    ------
    InputError
        Where no record may be fitted, or a term can't be searched for in a study.
    """
    if not checked_campaign(campaign).fitted:
        raise InputError(
            "records", expected="at least one that is not held out", found="none",
            where=campaign.source,
        )
    observations = observe_all(campaign.records, options.jobs)
    rows = tuple(record_rows(o) for o in observations if not o.held_out)
    single = len(rows) == 1 or sum(len(r.windows) for r in rows) < _FEWEST
    cores, with_friction, extras = _choices(options)
    chosen = ("speed", "frequency") if options.coordinate is None else (
        "frequency" if options.coordinate == "frequency" else "speed",
    )
    device = Device(
        rows=rows,
        friction=TERMS[FRICTION],
        with_friction=with_friction,
        cores=cores,
        grids=_grids(options),
        extras=extras,
        coordinates=chosen,
        bands=1 if single else options.bands,
        seed=options.seed,
    )
    return Prepared(observations, rows, device, single)


def _choices(options: StudyOptions) -> tuple[tuple[Core, ...], bool, tuple[str, ...]]:
    """Return the structures, whether there may be friction, and what may join."""
    if options.terms is None:
        beside = {i for c in CORES for i in c.beside}
        extras = [i for i in sorted(TERMS) if i not in TELLING - beside and i != FRICTION]
        return CORES, True, tuple(extras)
    ids = [i for i in options.terms if i != FRICTION]
    for identifier in ids:
        term = find_term(identifier, where="--terms")
        if term.column is None or any(p.scaled_by and p.default for p in term.parameters):
            raise InputError(
                "term",
                expected="one whose force is linear in its coefficient; the missing-effect"
                " search handles the others",
                found=identifier,
                where="--terms",
            )
    name = core_of(options.terms)
    core = Core(name, family_of(ids), tuple(ids))
    return (core,), FRICTION in options.terms, ()


def _grids(options: StudyOptions) -> dict[str, tuple[float, ...]]:
    grids = {"order": options.orders, "exponent": options.exponents}
    return {name: tuple(values) for name, values in grids.items() if values}


def observation_findings(observations: Sequence[Observation]) -> tuple[Finding, ...]:
    """Return what observing found."""
    return tuple(
        Finding(
            "note",
            f"force and terms are compared up to {o.cutoff:.3g} Hz,"
            " where the displacement stands clear of its noise.",
            o.file,
        )
        for o in observations
        if o.cutoff is not None
    )
