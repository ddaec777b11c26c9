"""Two effects at once: the best pair of one with every other, along straight lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from discover.naming.candidates import Variant
from discover.naming.evidence import Entry, Evidence
from discover.naming.forces import coefficient_bounds
from models.checks import Array
from models.terms import TERMS

_PRIOR = -6.0
_NEARLY = 0.9  # of the correlation of two shapes of an effect, from which they are alike
_DOUBT = 0.17  # nats a row: two shapes explain more by chance


def unlikely(informative: float) -> float:
    """Return the log of how much less likely two effects are than one, by informative rows."""
    return _PRIOR - _DOUBT * informative


def pairs_with(
    lead: Entry,
    singles: Mapping[str, Entry],
    chosen: Sequence[Variant],
    spans: Sequence[slice],
    freed: Array,
    start: tuple[Array, float],
    evidence: Evidence,
    informative: float,
) -> list[Entry]:
    """Return the best pair of `lead` with every other effect; `start` is misfit and chi-square.

    The first is the stronger: of added forces that which explains more alone in its shape of the
    pair or one that is nearly the same. What else an effect may be, and how large, only its best
    entry in `singles` knows.
    """
    target, chi2 = start
    index = next(i for i, v in enumerate(chosen) if v is lead.variants[0])
    own = freed[spans[index]]
    norm = np.linalg.norm(own, axis=1)
    basis = np.linalg.qr((own / norm[:, None]).T)[0].T
    rest = target - basis.T @ (basis @ target)
    others = freed - (freed @ basis.T) @ basis
    power = np.sum(others**2, axis=1)
    along = others @ rest
    sizes = along / np.maximum(power, 1e-300)
    apart = power > 1e-4 * np.sum(freed**2, axis=1)
    gain = np.where(apart, along**2 / np.maximum(power, 1e-300), 0.0)
    best: dict[str, tuple[float, int]] = {}
    for i, v in enumerate(chosen):
        if v.effect == lead.effects[0] or len(v.parts) > 1:
            continue
        k = spans[i].start
        if not _possible(v, sizes[k]):
            continue
        if v.effect not in best or gain[k] > best[v.effect][0]:
            best[v.effect] = (float(gain[k]), i)
    explained = float(np.sum((basis @ target) ** 2))
    after = chi2 - explained
    unit = freed / np.maximum(np.linalg.norm(freed, axis=1), 1e-300)[:, None]
    alone = (unit @ target) ** 2

    shapes_of: dict[str, list[int]] = {}
    for v, span in zip(chosen, spans, strict=True):
        if len(v.parts) == 1:
            shapes_of.setdefault(v.effect, []).append(span.start)

    def nearly(i: int) -> float:
        """Return what a shape explains alone, or one of the effect's that is nearly the same."""
        k, same = spans[i].start, shapes_of.get(chosen[i].effect, [])
        near = np.abs(unit[same] @ unit[k]) > _NEARLY
        return float(np.max(alone[same], where=near, initial=alone[k]))

    found = []
    for name, (drop, i) in best.items():
        v = chosen[i]
        both = np.concatenate([own, freed[spans[i]]])
        solution = np.linalg.lstsq(both.T, target, rcond=1e-10)[0]
        if not _possible(lead.variants[0], solution[0]):
            continue
        spent = lead.variants[0].shapes + len(own) + 1 + v.shapes
        value = evidence(after - drop, spent) + unlikely(informative)
        names = (lead.effects[0], name)
        shapes = (lead.variants[0], v)
        parts = (tuple(solution[: len(own)]), (float(solution[-1]),))
        if all(TERMS[e].acts == "force" for e in names):
            stronger = nearly(i) > max(explained, nearly(index))
        else:
            other = singles.get(name)
            stronger = other is not None and other.log_evidence > lead.log_evidence
        if stronger:
            names, shapes, parts = names[::-1], shapes[::-1], parts[::-1]
        found.append(Entry(names, shapes, parts, after - drop, value))
    return found


def _possible(variant: Variant, value: float) -> bool:
    """Tell whether an effect can have this coefficient."""
    part = variant.parts[0]
    low, high = coefficient_bounds(part.shape)
    return low <= value <= high and not (TERMS[part.id].nonnegative and value <= 0.0)
