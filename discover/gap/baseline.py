"""The model that is held against the data: given, or terms whose coefficients are fitted first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.gap.fractional import FOIM_TERMS, FRACTIONAL, fitted_sfoim
from discover.gap.reversing import reversing_as_sampled
from discover.motion_fit import Observation
from discover.naming.fit import ModelFit, fit_model, free_parameters
from discover.naming.rows import RecordRows, record_rows
from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel, SegmentedModel
from models.device import Device
from models.flow import dean_per_speed
from models.terms import find_term

FIT = "fit:"
_TRANSITIONS = (0.002, 0.01, 0.05, 0.2)
_ORDERS = (0.3, 0.7, 1.3, 1.7)
_EXPONENTS = (1.75,)


@dataclass(frozen=True)
class Baseline:
    """A model as the search starts from it."""

    rows: tuple[RecordRows, ...]
    """Of all records, with the terms that are held in each."""
    model: ForceModel
    """Terms that are fitted together with each effect; none where all are held."""
    whole: SegmentedModel | ForceModel
    """The model as it was given, or fitted."""
    fitted: bool
    """True where its coefficients were fitted first."""
    fixed: bool
    """True where they are held."""
    added: tuple[str, ...] = ()
    """Ids of its last terms, where an earlier search added them."""

    @property
    def fitted_rows(self) -> tuple[RecordRows, ...]:
        """Rows of the records that are not held out."""
        return tuple(r for r in self.rows if not r.observation.held_out)

    @property
    def terms(self) -> tuple[FittedTerm, ...]:
        """All terms, of all bands."""
        if isinstance(self.whole, ForceModel):
            return self.whole.terms
        return tuple(t for band in self.whole.bands for t in band.model.terms)


def term_ids(text: str, *, where: str = "--model") -> tuple[str, ...]:
    """Return the ids of ``fit:TERM,TERM,...``, or of ``foim`` and ``sfoim``.

    Raises
    ------
    InputError
        For an id that is not in the vocabulary, one given twice, or none.

    Examples
    --------
    >>> term_ids("fit:inertia,viscous-damping")
    ('inertia', 'viscous-damping')
    """
    if text in FRACTIONAL:
        return FOIM_TERMS
    ids = tuple(part.strip() for part in text.removeprefix(FIT).split(",") if part.strip())
    if not ids:
        raise InputError("model", expected="fit:TERM,TERM,...", found=repr(text), where=where)
    for name in ids:
        term = find_term(name, where=where)
        if ids.count(name) > 1:
            raise InputError("terms", expected="each once", found=f"{name} twice", where=where)
        scaled = any(
            p.scaled_by in ("displacement", "force") and p.default for p in term.parameters
        )
        if term.column is None or scaled:
            raise InputError(
                "term of a baseline", expected="an added force of the motion now", found=name,
                where=where,
            )
    return ids


def fit_terms(rows: Sequence[RecordRows], ids: Sequence[str]) -> ModelFit:
    """Return the terms fitted to records, the best of a few first guesses of their shapes."""
    speed = max(float(np.abs(r.observation.motion.velocity).max()) for r in rows)
    starts: list[dict[str, dict[str, float]]] = [{}]
    for name, key, grid in (
        ("coulomb-friction", "transition_speed", [s * speed for s in _TRANSITIONS]),
        ("fractional-derivative", "order", list(_ORDERS)),
        ("power-law-damping", "exponent", list(_EXPONENTS)),
        ("stribeck-friction", "stribeck_velocity", [0.05 * speed]),
    ):
        if name in ids:
            starts = [{**s, name: {key: float(value)}} for s in starts for value in grid]
    best: ModelFit | None = None
    for start in starts:
        model = ForceModel(tuple(FittedTerm(i, 1.0, start.get(i, {})) for i in ids))
        linear = [p for p in free_parameters(model) if p.shape is None]
        found = fit_model(rows, model, linear, iterations=1)
        if best is None or found.chi2 < best.chi2:
            best = found
    if best is None:
        raise InputError("terms", expected="at least one", found="none")
    return reversing_as_sampled(rows, fit_model(rows, best.model, free_parameters(best.model)))


def prepare_baseline(
    observations: Sequence[Observation],
    model: str | ForceModel | SegmentedModel,
    *,
    fixed: bool,
    device: Device | None = None,
) -> Baseline:
    """Return the baseline on its records.

    Parameters
    ----------
    observations : sequence of Observation
        Of all records.
    model : str, ForceModel or SegmentedModel
        ``fit:TERM,...``, ``foim`` or ``sfoim`` is fitted to the records that are not held out; a
        model is taken as it is, and refitted with each effect unless it has several bands or is
        held.
    fixed : bool
        Hold the baseline's coefficients.
    device : Device, optional
        Where ``sfoim`` parts its bands.

    Raises
    ------
    InputError
        For terms that are not in the vocabulary.
    """
    fitted_first = model == "sfoim"
    if model == "sfoim":
        model = fitted_sfoim(
            observations, device, along=_coordinate,
            fit=lambda rows: fit_terms(rows, FOIM_TERMS).model,
        )  # fmt: skip
    if isinstance(model, str):
        rows = [record_rows(o) for o in observations]
        fitted = fit_terms([r for r in rows if not r.observation.held_out], term_ids(model)).model
        if not fixed:
            return Baseline(tuple(rows), fitted, fitted, fitted=True, fixed=False)
        held = tuple(record_rows(o, held=fitted.terms) for o in observations)
        return Baseline(held, ForceModel(()), fitted, fitted=True, fixed=True)
    added = model.added if isinstance(model, SegmentedModel) else ()
    if isinstance(model, SegmentedModel) and len(model.bands) == 1:
        model = ForceModel(model.bands[0].model.terms, model.name)
    if isinstance(model, ForceModel):
        terms = model.terms if fixed else ()
        rows = [record_rows(o, held=terms) for o in observations]
        free = ForceModel(()) if fixed else model
        return Baseline(tuple(rows), free, model, fitted=False, fixed=fixed, added=added)
    rows = [record_rows(o, held=model.at(_coordinate(o, model)).terms) for o in observations]
    free = ForceModel(())
    return Baseline(tuple(rows), free, model, fitted=fitted_first, fixed=True, added=added)


def _coordinate(observation: Observation, model: SegmentedModel) -> float:
    if model.coordinate == "frequency":
        return observation.frequency
    if model.coordinate == "speed":
        return observation.speed
    if model.device is None:
        raise InputError("device", expected="given for bands of the Dean number", found="none")
    return observation.speed * dean_per_speed(model.device, convention=model.convention)
