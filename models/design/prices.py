"""Which bound costs most, and which dimension buys most, at an optimum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import optimize

from models.checks import Array
from models.design.constraints import Bound, Problem
from models.design.search import gradient
from models.device import Device

_ACTIVE = 1e-5


@dataclass(frozen=True)
class ActiveBound:
    """A bound that holds the optimum where it is."""

    name: str
    """What it bounds."""
    limit: float
    """Its value, SI (for geometry: the wall)."""
    unit: str
    """Its unit."""
    kind: str
    """"at most", "at least", "equal" or "geometry"."""
    price: float
    """Percent of critical frequency for each percent by which the bound is tightened.

    At least zero but for an "equal" bound, where it counts for each percent of increase. For
    geometry: for each percent by which the bodies come closer than they may."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `active_bounds` in ``design.json``."""
        return {
            "name": self.name,
            "limit": self.limit,
            "unit": self.unit,
            "kind": self.kind,
            "price_percent_per_percent": self.price,
        }


def active_bounds(problem: Problem, y: Array) -> tuple[ActiveBound, ...]:
    """Return the active bounds with their shadow prices, dearest first.

    The prices are the multipliers of the Karush-Kuhn-Tucker conditions, solved by non-negative
    least squares: grad ln f + sum of price x grad ratio = 0.

    Parameters
    ----------
    problem : Problem
        What was solved.
    y : array, shape (6,)
        Its optimum.
    """
    slope, jacobian = gradient(problem, y)
    ratios = problem.ratios(y)
    lower, upper = np.array(problem.box()).T
    rows = [(bound, jacobian[k]) for k, bound in enumerate(problem.listed)
            if ratios[k] > 1.0 - _ACTIVE]
    unit = np.eye(y.size)
    # The box holds only the inertance; its other sides lie beyond the listed bounds.
    fixed = upper[5] == lower[5]
    columns = [row for _, row in rows]
    if fixed or y[5] - lower[5] < _ACTIVE:
        columns.append(-unit[5])
    if fixed:
        columns.append(unit[5])
    if not columns:
        return ()
    prices, _ = optimize.nnls(np.array(columns).T, -slope)
    found = [
        ActiveBound(b.name, b.limit, b.unit, b.kind, float(price) * _leverage(problem, y, b))
        for (b, _), price in zip(rows, prices, strict=False)
    ]
    rest = prices[len(rows):]
    if rest.size:
        target = problem.bounds.inertance
        kind = "equal" if fixed else "at least"
        found.append(ActiveBound("inertance", target, "kg", kind, float(rest[0] - rest[1:].sum())))
    return tuple(sorted(found, key=lambda b: -abs(b.price)))


def _leverage(problem: Problem, y: Array, bound: Bound) -> float:
    """Return |d ratio / d ln limit| of a bound: below one where transitions take a share."""
    if bound.field is None:
        return 1.0
    row = problem.listed.index(bound)
    up, down = (
        float(problem.moved(bound, factor).ratios(y)[row]) for factor in (1 + 1e-6, 1 - 1e-6)
    )
    return abs(up - down) / 2e-6


def elasticities(device: Device) -> dict[str, float]:
    """Return d ln f_low / d ln (dimension) by Eq. 16, all else kept: what buys most.

    Negative: enlarging the dimension lowers the critical frequency.

    Parameters
    ----------
    device : Device
        Geometry and fluid.

    Returns
    -------
    dict of str to float
        By name of the dimension.

    Examples
    --------
    >>> {k: round(v, 2) for k, v in elasticities(Device.preset("device-12")).items()}
    {'rod_radius': 0.45, 'cylinder_radius': -2.45, 'channel_radius': 0.5, 'helix_radius': 0.5,
    'helix_pitch': 0.0, 'turns': 0.0, 'kinematic_viscosity': 1.0, 'amplitude': -1.0}
    """
    outer, inner = device.cylinder_radius**2, device.rod_radius**2
    return {
        "rod_radius": 2.0 * inner / (outer - inner),
        "cylinder_radius": -2.0 * outer / (outer - inner),
        "channel_radius": 0.5,
        "helix_radius": 0.5,
        "helix_pitch": 0.0,
        "turns": 0.0,
        "kinematic_viscosity": 1.0,
        "amplitude": -1.0,
    }
