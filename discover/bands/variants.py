"""The structures as columns: every variant of every core, its shapes on a grid with slopes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from discover.posterior.space import Part, Space, parts_of, shape_grid, unit
from discover.posterior.structures import Choice, Variant, choice_of
from models.checks import Indices
from models.cores import Core
from models.terms import TERMS, Parameter

STEP = 0.1
"""Between neighbouring orders, or exponents: slopes bridge it."""

Grids = Mapping[str, tuple[float, ...]]
"""By name of a shape parameter, the values whose ends bound it."""


def bounds_of(core: Core, identifier: str, grids: Grids) -> tuple[float, float]:
    """Return the range of a term's first shape parameter in a core."""
    parameter = TERMS[identifier].parameters[0]
    low, high = core.within.get(identifier, (parameter.lower, parameter.upper))
    given = grids.get(parameter.name)
    if given:
        low, high = max(low, min(given)), min(high, max(given))
    return low, max(high, low)


def variants_of(
    space: Space, cores: Sequence[Core], grids: Grids
) -> tuple[Variant, ...]:
    """Return every variant of the cores, as parts of a space that takes their columns in."""
    known: dict[tuple[str, tuple[float, float]], list[Part]] = {}

    def parts(core: Core, identifier: str) -> list[Part]:
        parameters = TERMS[identifier].parameters
        shaped = bool(parameters) and parameters[0].fitted
        bounds = bounds_of(core, identifier, grids) if shaped else (0.0, 0.0)
        key = identifier, bounds
        if key not in known:
            if shaped:
                known[key] = _shaped(space, identifier, parameters[0], bounds)
            else:
                known[key] = parts_of(space, [(unit(TERMS[identifier], {}),)])
        return known[key]

    found = []
    for core in cores:
        for ids in core.variants:
            shapes = list(product(*(parts(core, i) for i in ids)))
            prior = -float(np.log(len(cores) * len(core.variants) * max(len(shapes), 1)))
            found += [Variant(core.name, s, prior) for s in shapes]
    return tuple(found)


def _shaped(
    space: Space,
    identifier: str,
    parameter: Parameter,
    bounds: tuple[float, float],
) -> list[Part]:
    term = TERMS[identifier]
    low, high = bounds
    if high - low < 1e-9:
        return parts_of(space, [(unit(term, {parameter.name: low}),)])
    values = list(shape_grid(bounds, STEP))
    step = (high - low) / len(values)
    found = parts_of(
        space, [(unit(term, {parameter.name: v}),) for v in values],
        [((parameter.name, step / float(np.sqrt(12.0))),)] * len(values),
    )  # fmt: skip
    return [
        replace(p, within=((v - 0.5 * step, v + 0.5 * step),))
        for p, v in zip(found, values, strict=True)
    ]


def as_choice(variants: Sequence[Variant]) -> tuple[Choice, Indices]:
    """Return variants side by side, by places among their own columns, and these columns (K,)."""
    whole = [p.columns for v in variants for p in v.parts]
    columns = np.unique(np.concatenate(whole)) if whole else np.zeros(0, dtype=int)
    own = [
        Variant(
            v.core,
            tuple(replace(p, columns=np.searchsorted(columns, p.columns)) for p in v.parts),
            v.log_prior,
        )
        for v in variants
    ]
    return choice_of(own, columns.size), columns
