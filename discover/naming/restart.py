"""Other starts for what a joint does: its impacts make chi-square a landscape of many hollows."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from discover.naming.columns import without_span
from discover.naming.fit import ModelFit, fit_model, free_parameters, misfits, telling
from discover.naming.forces import model_force
from discover.naming.rows import RecordRows
from discover.naming.scales import Scales, scales_of
from discover.naming.scattered import unexplained
from discover.naming.unit_rows import UnitRows, whole_model
from models.constitutive import FittedTerm, ForceModel

_FACTORS = {  # of a joint's shape
    "contact": (0.4, 1.0, 2.5), "gap": (0.7, 0.85, 1.0, 1.2),
    "limit": (0.6, 0.75, 0.87, 0.95, 1.0, 1.05, 1.15),
}
_LOSSES: tuple[float, ...] = (0.1, 0.5)
_LAGS = (0.03, 0.06, 0.12)  # of a valve, over the greatest angular frequency
_VALVES = (0.0, 0.25, 1.0)  # its resistance, of the limit over the greatest speed
_SPRINGS = (0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0)  # factors of a compliance
_LOADS = (  # half load over the greatest force, and the share of compliance that load takes
    (0.15, 0.3), (0.15, 0.7), (0.5, 0.3), (0.5, 0.7), (2.0, 0.9), (0.1, -0.2), (0.4, -0.5),
)
_SPRING_LOSS = 0.05
_TRIED = 8  # records
_FIRST_LEG = 2  # of them, that choose
_SECOND_LEG = 16  # starts for the others
_FIRST = 3  # that are begun
_FIRST_STEPS = 3
_AGAIN = 12
_ENOUGH = 0.003
_TURNS = 3  # of starts around the best so far,
_MUCH = 0.5  # as long as chi-square falls to this share
_RANGE_STEPS = 8
_SETTLED = 0.9  # of chi-square, to which another turn has to bring it
_BY_FAR = 0.7  # of the misfit without the joint
_GOOD = 1.5  # of chi-square a row, up to which no other start is sought


def restarted(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    *,
    instead_of: ModelFit | None = None,
    besides: Sequence[FittedTerm] = (),
) -> ModelFit:
    """Return the best of the fit and fits from other shapes of the joint that is its last term.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        Where the first start led; returned as it is where it leaves little.
    instead_of : ModelFit, optional
        Without the joint. Where no start is better by far, none is followed.
    besides : sequence of FittedTerm
        Other joints to start from.
    """
    for _ in range(_TURNS):
        if fit.chi2 < _GOOD * fit.residual.size:
            break
        before, fit = fit.chi2, _best_start(rows, fit, instead_of, besides)
        if fit.chi2 > _MUCH * before:
            break
    return fit


def best_range(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    """Return the fit with the amplifier's range that explains most; the last term is its gain.

    Which records' peaks are in the range is a choice, that steps of a fit can't make.
    """
    for _ in range(_TURNS):
        before, fit = fit.chi2, _best_range(rows, fit)
        if fit.chi2 > _SETTLED * before:
            break
    return fit


def _best_range(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    *rest, gain = fit.model.terms
    if gain.shape["threshold"] == 0.0:
        return fit
    model = ForceModel(tuple(rest), fit.model.name)
    peaks = np.sort([
        np.abs(model_force(r.observation, whole_model(r, model))).max() for r in rows
    ])
    units = UnitRows()
    before = units.of_model(rows, model)
    others = [i for i, p in enumerate(fit.parameters) if p.term < len(rest)]
    left = np.concatenate([r.target for r in rows]) - before
    left = without_span(left[None], fit.tangents[others])[0]
    best, most = None, 0.0
    for threshold in np.sqrt(peaks[1:] * peaks[:-1]):
        term = FittedTerm(gain.id, gain.coefficient, {**gain.shape, "threshold": threshold})
        other = ForceModel((*rest, term), fit.model.name)
        column = units.of_model(rows, other) - before
        column = without_span(column[None], fit.tangents[others])[0]
        explained = float(column @ left) ** 2 / max(float(column @ column), 1e-300)
        if explained > most:
            best, most = other, explained
    if best is None:
        return fit
    trial = fit_model(rows, best, free_parameters(best), iterations=_RANGE_STEPS, units=units)
    return trial if trial.chi2 < fit.chi2 else fit


def _best_start(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    instead_of: ModelFit | None,
    besides: Sequence[FittedTerm],
) -> ModelFit:
    """Return the best of the fit and fits from a few starts, of what added forces can't explain."""
    *rest, joint = fit.model.terms
    units = UnitRows()
    chosen = telling(rows, fit if instead_of is None else instead_of, _TRIED)
    seen = [rows[i] for i in chosen]
    seeds = [ForceModel((*rest, _whole(seed)), fit.model.name) for seed in (joint, *besides)]
    around = _ranked(seen[:_FIRST_LEG], seeds, units)[0][1].terms[-1] if besides else joint
    others = (*besides, *_others(around, scales_of([r.observation for r in rows])))
    models = [ForceModel((*rest, other), fit.model.name) for other in others]
    without = None if instead_of is None else misfits(rows, instead_of)[chosen]
    if len(models) > _SECOND_LEG:
        starts = _ranked(seen[:_FIRST_LEG], models, units)
        if without is not None and starts[0][0] > _BY_FAR * float(np.sum(without[:_FIRST_LEG])):
            return fit
        models = [m for _, m in starts[:_SECOND_LEG]]
    starts = _ranked(seen, models, units)
    if without is not None and starts and starts[0][0] > _BY_FAR * float(np.sum(without)):
        return fit
    begun = [
        fit_model(
            seen, model, free_parameters(model), iterations=_FIRST_STEPS, units=units,
            exact=False,
        )
        for _, model in starts[:_FIRST]
    ]
    best = min(begun, key=lambda f: f.chi2, default=fit)
    again = fit_model(
        rows, best.model, free_parameters(best.model), iterations=_AGAIN, enough=_ENOUGH,
        units=units,
    )
    return again if again.chi2 < fit.chi2 else fit


def _whole(joint: FittedTerm) -> FittedTerm:
    """Return a joint with all of what it changes; a spring as it is."""
    return joint if joint.id == "series-compliance" else FittedTerm(joint.id, 1.0, joint.shape)


def _ranked(
    rows: Sequence[RecordRows], models: Sequence[ForceModel], units: UnitRows
) -> list[tuple[float, ForceModel]]:
    """Return models with what of their misfits their own added forces leave, least first."""
    left = unexplained(rows, models[0].terms, units) if models else None
    found = [(left(model), model) for model in models] if left else []
    return sorted(found, key=lambda s: s[0])


def _others(joint: FittedTerm, scales: Scales) -> list[FittedTerm]:
    """Return joints around one, in a campaign of these scales; none for other effects."""
    if joint.id == "series-compliance":
        return _springs(joint, scales)
    if not joint.shape.get("contact", 0.0):
        return []
    names = [n for n in _FACTORS if n in joint.shape]
    losses, choices = _LOSSES, [dict[str, float]()]
    if joint.id == "cavitation":
        losses = (joint.shape["loss"],)
        resistance = joint.shape["limit"] / scales.speed
        choices += [
            {"refill": 1.0, "lag": lag / scales.omega, "valve": share * resistance}
            for lag, share in product(_LAGS, _VALVES)
        ]
    found = []
    scaled = product(*(_FACTORS[n] for n in names))
    for factors, loss, choice in product(scaled, losses, choices):
        shape = {n: joint.shape[n] * f for n, f in zip(names, factors, strict=True)}
        found.append(FittedTerm(joint.id, 1.0, {**joint.shape, **shape, "loss": loss, **choice}))
    return found


def _springs(spring: FittedTerm, scales: Scales) -> list[FittedTerm]:
    """Return springs around one: as stiff on its other sides, and others that load changes."""
    own = spring.shape["side"]
    sides = [s for s in (0.0, 1.0, -1.0) if s != own and spring.shape["half_load"] > 0.0]
    turned = [
        FittedTerm(spring.id, spring.coefficient, {**spring.shape, "side": side}) for side in sides
    ]
    return turned + [
        FittedTerm(
            spring.id, spring.coefficient * factor,
            {
                **spring.shape, "half_load": load * scales.force, "load_share": share,
                "side": side, "loss": _SPRING_LOSS,
            },
        )
        for factor in _SPRINGS
        for side in dict.fromkeys((0.0, own))
        for load, share in _LOADS
    ]
