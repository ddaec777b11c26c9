"""Force models as tables of numbers that the compiled loop reads, one row a device and band."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array, InputError
from models.constitutive import FittedTerm, ForceModel, SegmentedModel
from models.flow.dimensionless import dean_per_speed
from models.structure import Model

POWER, SMOOTH_FRICTION, ASYMMETRIC, END_STOP = 0, 1, 2, 3
INERTANCE, VISCOUS, STIFFNESS, CUBIC, OFFSET, FRICTION, STRIBECK, STRIBECK_SPEED = range(8)
BY_SPEED, BY_FREQUENCY = 0, 1

_COEFFICIENTS = {
    "inertia": INERTANCE,
    "viscous-damping": VISCOUS,
    "stiffness": STIFFNESS,
    "cubic-stiffness": CUBIC,
    "force-offset": OFFSET,
}
_NOT_STEPPED = {
    "cubic-stiffness": ("closure", "span"),
    "end-stop": ("loss", "damping_time", "dry_loss"),
}
_MEASURING_CHAIN = frozenset({"time-delay", "sensor-gain", "sensor-drift", "sensor-clipping"})
_WHOLE_ORDERS = {0.0: STIFFNESS, 1.0: VISCOUS, 2.0: INERTANCE}


@dataclass(frozen=True)
class FractionalTerm:
    """One fractional term of one band of one device."""

    device: int
    """Index of the device."""
    band: int
    """Row of the band in the tables."""
    coefficient: float
    """N s^order/m."""
    order: float
    """In (0, 2), not whole."""


@dataclass(frozen=True)
class Elements:
    """All devices' bands, stacked; device j owns rows first[j] to first[j + 1]."""

    first: NDArray[np.int64]
    """(q + 1,) first row of each device."""
    table: Array
    """(rows, 8) coefficients in the order of the constants of this file, SI."""
    curve_first: NDArray[np.int64]
    """(rows + 1,) first entry of each row in `curves`."""
    curves: Array
    """(entries, 4) forces that bend with speed, and end stops: code, coefficient, parameters."""
    edges: Array
    """(rows,) upper end of each band: m/s, or Hz; infinite for the last."""
    coordinate: NDArray[np.int64]
    """(q,) `BY_SPEED` or `BY_FREQUENCY`: what chooses the band."""
    fractional: tuple[FractionalTerm, ...]
    """Terms with memory."""
    left_out: tuple[str, ...]
    """Ids of effects of the measuring chain: they move nothing."""


def compile_elements(models: tuple[Model, ...]) -> Elements:
    """Return the tables for `models`, one device each.

    Raises
    ------
    InputError
        For a term that has no place in a simulation in time.
    """
    first, edges, coordinate = [0], [], []
    rows: list[Array] = []
    curves: list[tuple[float, float, float, float]] = []
    curve_first = [0]
    fractional: list[FractionalTerm] = []
    left_out: list[str] = []
    for device, model in enumerate(models):
        bands, uppers, kind = _bands(model)
        coordinate.append(kind)
        for band, upper in zip(bands, uppers, strict=True):
            row = np.zeros(8)
            row[STRIBECK_SPEED] = 1.0
            for fitted in band.terms:
                if fitted.id in _MEASURING_CHAIN:
                    left_out.append(fitted.id)
                    continue
                order = _place(fitted, row, curves)
                if order is not None:
                    fractional.append(FractionalTerm(device, len(rows), fitted.coefficient, order))
            rows.append(row)
            edges.append(upper)
            curve_first.append(len(curves))
        first.append(len(rows))
    return Elements(
        np.array(first, dtype=np.int64),
        np.array(rows).reshape(-1, 8),
        np.array(curve_first, dtype=np.int64),
        np.array(curves, dtype=np.float64).reshape(-1, 4),
        np.array(edges, dtype=np.float64),
        np.array(coordinate, dtype=np.int64),
        tuple(fractional),
        tuple(dict.fromkeys(left_out)),
    )


def _bands(model: Model) -> tuple[list[ForceModel], list[float], int]:
    if isinstance(model, ForceModel):
        return [model], [np.inf], BY_SPEED
    scale = _per_coordinate(model)
    uppers = [np.inf if b.upper is None else b.upper * scale for b in model.bands]
    uppers[-1] = np.inf
    kind = BY_FREQUENCY if model.coordinate == "frequency" else BY_SPEED
    return [b.model for b in model.bands], uppers, kind


def _per_coordinate(model: SegmentedModel) -> float:
    if model.coordinate != "dean":
        return 1.0
    if model.device is None:
        raise InputError(
            "device of a model segmented by Dean number", expected="given", found="nothing"
        )
    return 1.0 / dean_per_speed(model.device, convention=model.convention)


def _place(
    fitted: FittedTerm, row: Array, curves: list[tuple[float, float, float, float]]
) -> float | None:
    """Add a term to its row or curve; return the order of one with memory."""
    value, shape = fitted.coefficient, fitted.shape
    for name in _NOT_STEPPED.get(fitted.id, ()):
        if shape[name] > 0.0:
            raise InputError(
                f"{name} of {fitted.id} in a simulation in time",
                expected="0: its plain law (harmonic balance takes any)",
                found=f"{shape[name]:g}",
            )
    if fitted.id in _COEFFICIENTS:
        row[_COEFFICIENTS[fitted.id]] += value
    elif fitted.id == "fractional-derivative":
        order = shape["order"]
        if order not in _WHOLE_ORDERS:
            return order
        row[_WHOLE_ORDERS[order]] += value
    elif fitted.id == "quadratic-damping":
        curves.append((POWER, value, 2.0, 0.0))
    elif fitted.id == "power-law-damping":
        curves.append((POWER, value, shape["exponent"], 0.0))
    elif fitted.id == "asymmetric-damping":
        curves.append((ASYMMETRIC, value, shape["power"], shape["side"]))
    elif fitted.id == "end-stop":
        # An entry for each end; the gap's sign says which.
        for side in (1.0, -1.0):
            if side * shape["side"] >= 0.0:
                curves.append((END_STOP, value, side * shape["gap"], shape["exponent"]))
    elif fitted.id == "coulomb-friction":
        if shape["transition_speed"] > 0.0:
            sharpness = shape["sharpness"] or 1.0
            sign, share = (-1.0 if shape["form"] > 0.0 else 1.0), shape["other_share"]
            # The knee's sign says which curve.
            faster = (1.0 - share) * value
            curves.append((SMOOTH_FRICTION, faster, shape["transition_speed"], sign * sharpness))
            if shape["other_speed"] > 0.0:
                curves.append((SMOOTH_FRICTION, share * value, shape["other_speed"], sign))
            else:
                row[FRICTION] += share * value
        else:
            row[FRICTION] += value
    elif fitted.id == "stribeck-friction":
        if shape.get("form", 0.0) != 0.0 or shape.get("transition_speed", 0.0) != 0.0:
            raise InputError(
                "stribeck-friction", expected="of form 0 that jumps", found=f"{dict(shape)}"
            )
        if row[STRIBECK] != 0.0:
            raise InputError("stribeck-friction", expected="there once", found="a second one")
        row[STRIBECK], row[STRIBECK_SPEED] = value, shape["stribeck_velocity"]
    else:
        raise InputError(
            f"term {fitted.id!r}",
            expected="one that can be simulated in time",
            found="no rule for a step of it",
        )
    return None
