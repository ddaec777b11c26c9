"""Dynamic stiffness of a structure with devices, and its transfer functions."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import Array, InputError, one_of
from models.constitutive import WHOLE_ORDERS, ForceModel
from models.structure import Model, Structure

Complex = NDArray[np.complex128]
Quantity = Literal["displacement", "velocity", "acceleration", "absolute-acceleration"]


def linear_terms(model: Model) -> tuple[tuple[float, float], ...]:
    """Return (coefficient, order) of the terms that are linear in the displacement.

    Friction and nonlinear damping have no place here: linearise them first, as with
    ``models.equivalents.harmonic_equivalents``; they are passed over.

    Parameters
    ----------
    model : ForceModel or SegmentedModel
        Of one band.

    Returns
    -------
    tuple of (float, float)
        Coefficients in N s^order/m, and orders.

    Raises
    ------
    InputError
        For a segmented model: its bands are different systems; pass the band's model.

    Examples
    --------
    >>> from models.constitutive import FittedTerm
    >>> linear_terms(ForceModel((FittedTerm("fractional-derivative", 3.0, {"order": 1.5}),)))
    ((3.0, 1.5),)
    """
    if not isinstance(model, ForceModel):
        raise InputError(
            "model for linear analysis",
            expected="of one band (take `model.at(coordinate)`)",
            found=f"{len(model.bands)} bands",
        )
    found = []
    for fitted in model.terms:
        order = fitted.shape.get("order", WHOLE_ORDERS.get(fitted.id))
        if order is not None and fitted.term.acts == "force":
            found.append((fitted.coefficient, order))
    return tuple(found)


def structure_terms(structure: Structure) -> list[tuple[float, Array]]:
    """Return (order, matrix) of every term: T(s) = sum of s^order times matrix."""
    terms = [
        (2.0, np.array(structure.mass)),
        (1.0, np.array(structure.damping)),
        (0.0, np.array(structure.stiffness)),
    ]
    for direction, mount in zip(structure.directions, structure.devices, strict=True):
        dyad = np.outer(direction, direction)
        for coefficient, order in linear_terms(mount.model):
            terms.append((order, coefficient * dyad))
    merged: dict[float, Array] = {}
    for order, matrix in terms:
        merged[order] = merged.get(order, 0.0) + matrix
    return sorted(merged.items(), key=lambda item: -item[0])


def dynamic_stiffness(structure: Structure, s: ArrayLike) -> Complex:
    """Return T(s) = M s^2 + C s + K + sum_j d_j d_j^T c_j s^(order_j), shape (..., n, n), N/m.

    Principal branch of the powers: cut along the negative real axis, T(conj s) = conj T(s).

    Parameters
    ----------
    structure : Structure
        Devices of one band each.
    s : array_like of complex, shape (...)
        rad/s; i omega for a steady state.

    Returns
    -------
    complex array, shape (..., n, n)
        N/m.

    Raises
    ------
    InputError
        For a segmented device.

    Examples
    --------
    >>> from models.structure import oscillator
    >>> dynamic_stiffness(oscillator(1.0, 4.0), 1j).real.tolist()
    [[3.0]]
    """
    points = np.asarray(s, dtype=np.complex128)
    total = np.zeros((*points.shape, structure.size, structure.size), dtype=np.complex128)
    for order, matrix in structure_terms(structure):
        total += np.power(points, order)[..., None, None] * matrix
    return total


def transfer_function(
    structure: Structure,
    omega: ArrayLike,
    *,
    acts: Literal["force", "base"] = "force",
    at: int = 0,
    output: int = 0,
    quantity: Quantity = "displacement",
) -> Complex:
    """Return the steady-state response of one degree of freedom per unit of load.

    Parameters
    ----------
    structure : Structure
        Devices of one band each; friction and nonlinear damping are passed over.
    omega : array_like, shape (...)
        rad/s, not negative.
    acts, at
        A force on degree of freedom `at`, N; or the base's acceleration, m/s^2.
    output : int
        Degree of freedom observed.
    quantity : str
        Under base motion relative to the base, but for "absolute-acceleration".

    Returns
    -------
    ndarray of complex, shape (...)
        m/N and so on; under base motion m/(m/s^2) and so on.

    Raises
    ------
    InputError
        For an unknown load or quantity, and a degree of freedom that is not there.

    Examples
    --------
    >>> from models.structure import oscillator
    >>> float(abs(transfer_function(oscillator(1.0, 4.0), 0.0)))
    0.25
    """
    one_of("acts", acts, ("force", "base"))
    one_of("quantity", quantity, Quantity.__args__)  # type: ignore[attr-defined]
    for name, index in (("at", at), ("output", output)):
        if not 0 <= index < structure.size:
            raise InputError(name, expected=f"in 0..{structure.size - 1}", found=f"{index}")
    w = np.asarray(omega, dtype=np.float64)
    load = -structure.mass.sum(axis=1) if acts == "base" else np.eye(structure.size)[at]
    loads = np.broadcast_to(load[:, None], (*w.shape, load.size, 1))
    moved = np.linalg.solve(dynamic_stiffness(structure, 1j * w), loads)
    x: Complex = np.asarray(moved[..., output, 0], dtype=np.complex128)
    if quantity == "displacement":
        return x
    if quantity == "velocity":
        return np.asarray(1j * w * x)
    relative = np.asarray(-(w**2) * x)
    carried = quantity == "absolute-acceleration" and acts == "base"
    return relative + 1.0 if carried else relative
