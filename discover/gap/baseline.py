"""The model that is held against the data: given, or terms whose coefficients are fitted first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

from discover.gap.fractional import FOIM_TERMS, FRACTIONAL, fitted_sfoim
from discover.motion_fit import Observation
from discover.posterior.assess import Assessed, Assessor
from discover.posterior.local import judged, local_of
from discover.posterior.model import Composite, Evaluator, Placed
from discover.posterior.reversal import with_few_curves
from discover.posterior.setup import space_of
from discover.rows import RecordRows, record_rows
from models.checks import InputError
from models.constitutive import Band, FittedTerm, ForceModel, SegmentedModel
from models.cores import FRICTION
from models.device import Device
from models.flow import dean_per_speed
from models.terms import TERMS, Scales, find_term

FIT = "fit:"
_STARTS = 4  # shapes of each term, from which a fit begins


@dataclass(frozen=True)
class Baseline:
    """A model as the search starts from it."""

    rows: tuple[RecordRows, ...]
    """Of all records."""
    assessor: Assessor
    """Of those that are fitted."""
    composite: Composite
    """Its terms in the records that are fitted."""
    whole: SegmentedModel | ForceModel
    """The model as it was given, or fitted."""
    fitted: bool
    """True where its coefficients were fitted first."""
    fixed: bool
    """True where they are held."""
    added: tuple[str, ...] = ()
    """Ids of its last terms, where an earlier search added them."""

    @property
    def terms(self) -> tuple[FittedTerm, ...]:
        """All terms, of all bands."""
        if isinstance(self.whole, ForceModel):
            return self.whole.terms
        return tuple(t for band in self.whole.bands for t in band.model.terms)

    @property
    def banded(self) -> bool:
        """True where it has several bands: then its coefficients are held."""
        return isinstance(self.whole, SegmentedModel) and len(self.whole.bands) > 1

    def given(self) -> list[ForceModel]:
        """Return the model as it was given, in every record."""
        if isinstance(self.whole, ForceModel):
            return [self.whole] * len(self.rows)
        whole = self.whole
        return [whole.at(coordinate_of(r.observation, whole)) for r in self.rows]

    def with_terms(self, terms: Sequence[FittedTerm]) -> list[ForceModel]:
        """Return the model in every record: the baseline's own terms as they are, and others.

        Parameters
        ----------
        terms : sequence of FittedTerm
            All that is not held; where nothing is, the whole model.
        """
        if not self.fixed and not self.banded:
            return [ForceModel(tuple(terms))] * len(self.rows)
        return [ForceModel((*m.terms, *terms), m.name) for m in self.given()]


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
                "term of a baseline",
                expected="one that only adds a force and has no size of its own to fit (the search"
                " adds the others)", found=name,
                where=where,
            )
    return ids


def assessor_of(rows: Sequence[RecordRows], seed: int = 0) -> Assessor:
    """Return what assesses models of records, whose friction reverses over a speed."""
    space, curve = space_of(rows, TERMS[FRICTION])
    return Assessor(space, Evaluator(space.sheet, space.scales), curve, named=False, seed=seed)


def fit_terms(assessor: Assessor, ids: Sequence[str]) -> Assessed:
    """Return terms fitted to records, from the best of a few shapes of each."""
    space = assessor.space
    starts = [_shapes(i, space.scales) for i in ids]
    best, most = None, float("-inf")
    for shapes in product(*starts):
        terms = tuple(
            FittedTerm(i, 1.0, dict(shape)) for i, shape in zip(ids, shapes, strict=True)
        )
        model = Composite.of(ForceModel(terms))
        local = local_of(space, assessor.evaluator, model)
        sizes = space.start.sizes(space.own_unit)
        beside = local.beside(space, assessor.curve_of(model))
        value = judged(local, beside, sizes).value
        if value > most:
            best, most = model, value
    if best is None:
        raise InputError("terms", expected="at least one", found="none")
    return assessor.assess(best, space.start)


def in_few_curves(
    assessor: Assessor, found: Assessed, best: Assessed
) -> tuple[Composite, tuple[FittedTerm, ...]]:
    """Return a model's numbers beside few curves of friction, and its terms with these."""
    reversal, model = with_few_curves(assessor, found, best)
    terms: list[FittedTerm] = []
    for placed in model.terms:
        whole = reversal is not None and placed.fitted.id == reversal.name
        own = reversal.terms if whole and reversal is not None else (placed.fitted,)
        terms += [] if placed.held else own
    return model, tuple(terms)


def _predicting(assessor: Assessor, found: Assessed) -> ForceModel:
    """Return a model at the numbers that predict best, friction by few curves."""
    return ForceModel(in_few_curves(assessor, found, found.predicting)[1])


def _shapes(identifier: str, scales: Scales) -> list[dict[str, float]]:
    """Return shapes of a term to start from, of which a fit may change every parameter."""
    term = TERMS[identifier]
    if not term.parameters or term.starts is None:
        return [{}]
    found = [
        dict(s.shapes[0]) for s in term.starts(scales)
        if len(s.shapes) == 1 and term.remembers(term.shape(s.shapes[0])) == "motion"
    ]
    if not found:
        return [{}]
    step = max(len(found) // _STARTS, 1)
    return found[step // 2 :: step] or found[:1]


def _check_model(given: object) -> None:
    if isinstance(given, str | ForceModel | SegmentedModel):
        return
    near = f": `{type(given).__name__.lower()}.model` is one" if hasattr(given, "model") else ""
    raise InputError(
        "model", expected="'fit:TERM,...', a model's name or file, or a model" + near,
        found=type(given).__name__,
    )  # fmt: skip


def prepare_baseline(
    observations: Sequence[Observation],
    model: str | ForceModel | SegmentedModel,
    *,
    fixed: bool,
    device: Device | None = None,
    seed: int = 0,
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
    seed : int
        Of what is drawn.

    Raises
    ------
    InputError
        For terms that are not in the vocabulary, or where it is no model.
    """
    _check_model(model)
    rows = tuple(record_rows(o) for o in observations)
    free_rows = [r for r in rows if not r.observation.held_out]
    first = model == "sfoim"
    if model == "sfoim":
        model = fitted_sfoim(rows, device, along=coordinate_of, fit=_fitted)
    assessor = assessor_of(free_rows, seed)
    if isinstance(model, str):
        found = fit_terms(assessor, term_ids(model))
        whole = _predicting(assessor, found)
        composite = Composite.of(whole, held=True) if fixed else found.model
        return Baseline(rows, assessor, composite, whole, fitted=True, fixed=fixed)
    added = model.added if isinstance(model, SegmentedModel) else ()
    if isinstance(model, SegmentedModel) and len(model.bands) == 1:
        model = ForceModel(model.bands[0].model.terms, model.name)
    if isinstance(model, ForceModel):
        composite = Composite.of(model, held=fixed)
        return Baseline(
            rows, assessor, composite, model, fitted=False, fixed=fixed, added=added
        )
    composite = _by_bands(assessor, free_rows, model)
    return Baseline(rows, assessor, composite, model, fitted=first, fixed=True, added=added)


def _fitted(rows: Sequence[RecordRows]) -> ForceModel:
    assessor = assessor_of(rows)
    found = fit_terms(assessor, FOIM_TERMS)
    return _predicting(assessor, found)


def _by_bands(
    assessor: Assessor, rows: Sequence[RecordRows], model: SegmentedModel
) -> Composite:
    """Return a model by bands, held, each band's terms in its records."""
    bands = [model.at(coordinate_of(r.observation, model)) for r in rows]
    units = assessor.space.sheet.units
    placed = []
    for band in model.bands:
        share = tuple(float(bands[u.record] is band.model) for u in units)
        placed += [Placed(t, share, held=True) for t in band.model.terms]
    return Composite(tuple(placed))


def coordinate_of(observation: Observation, model: SegmentedModel) -> float:
    """Return where a record lies along a model's bands."""
    if model.coordinate == "frequency":
        return observation.frequency
    if model.coordinate == "speed":
        return observation.speed
    if model.device is None:
        raise InputError("device", expected="given for bands of the Dean number", found="none")
    return observation.speed * dean_per_speed(model.device, convention=model.convention)


def added_to(whole: SegmentedModel, terms: Sequence[FittedTerm]) -> SegmentedModel:
    """Return a model by bands with the same terms added in each."""
    bands = tuple(
        Band(b.lower, b.upper, ForceModel((*b.model.terms, *terms), b.model.name))
        for b in whole.bands
    )
    return replace(whole, bands=bands, added=(*whole.added, *(t.id for t in terms)))


__all__ = ["FIT", "Baseline", "added_to", "prepare_baseline", "term_ids"]
