"""Eigenvalues of structures with fractional terms: two ways that check each other.

Orders with a small common denominator q make T a matrix polynomial in w = s^(1/q): its roots with
|arg w| < pi/q are the eigenvalues on the principal sheet. Any orders at all are a nonlinear
eigenproblem: the argument principle counts the eigenvalues in the upper half plane, and Newton's
method on det T, deflated by those already found, goes on until the count is reached.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np
import scipy.linalg

from models.checks import Array, InputError, one_of
from models.linear.dynamic import Complex, dynamic_stiffness, structure_terms
from models.structure import Structure

Method = Literal["auto", "commensurate", "contour"]

_DENOMINATOR = 100
_MARGIN = 0.05  # rad beyond the upper half plane, so that no root lies on the contour


@dataclass(frozen=True)
class Modes:
    """Modes of free vibration, one a conjugate pair, by rising frequency.

    A fractional structure has, besides, a part that decays as a power of time; no mode shows it.
    """

    eigenvalues: Complex
    """(k,) rad/s, imaginary part not negative."""
    shapes: Complex
    """(k, n) largest entry one."""

    @property
    def damped_frequencies(self) -> Array:
        """(k,) rad/s: the imaginary parts."""
        return np.asarray(self.eigenvalues.imag)

    @property
    def frequencies(self) -> Array:
        """(k,) rad/s: the magnitudes."""
        return np.asarray(np.abs(self.eigenvalues))

    @property
    def damping_ratios(self) -> Array:
        """(k,) less the cosine of the eigenvalue's angle; negative where unstable."""
        return np.asarray(-self.eigenvalues.real / np.abs(self.eigenvalues))


def eigenvalues(structure: Structure, *, method: Method = "auto") -> Complex:
    """Return the eigenvalues on the principal sheet, conjugates included.

    Parameters
    ----------
    structure : Structure
        Devices of one band each; friction and nonlinear damping are passed over.
    method : str
        "commensurate" for orders with a common denominator up to 100, "contour" for any; "auto"
        takes the first where it applies.

    Returns
    -------
    ndarray of complex, shape (k,)
        rad/s, by rising imaginary part of the upper ones, each followed by its conjugate.

    Raises
    ------
    InputError
        Where "commensurate" is asked for and the orders have no such denominator.

    Examples
    --------
    >>> from models.structure import oscillator
    >>> eigenvalues(oscillator(1.0, 4.0)).round(9)
    array([0.+2.j, 0.-2.j])
    """
    upper = _upper(structure, method)
    pairs = [[s, s.conjugate()] if s.imag > 0.0 else [s] for s in upper]
    return np.array([s for pair in pairs for s in pair], dtype=np.complex128)


def modes(structure: Structure, *, method: Method = "auto") -> Modes:
    """Return eigenvalues of the upper half plane with frequencies, damping ratios and shapes.

    Parameters
    ----------
    structure : Structure
        Devices of one band each; friction and nonlinear damping are passed over.
    method : str
        As in `eigenvalues`.

    Returns
    -------
    Modes
        By rising damped frequency.

    Raises
    ------
    InputError
        As `eigenvalues`.

    Examples
    --------
    >>> from models.structure import oscillator
    >>> modes(oscillator(1.0, 4.0, damping=0.4)).damping_ratios.round(9)
    array([0.1])
    """
    values = _upper(structure, method)
    shapes = np.empty((values.size, structure.size), dtype=np.complex128)
    for k, s in enumerate(values):
        null = np.linalg.svd(dynamic_stiffness(structure, s))[2][-1].conj()
        shapes[k] = null / null[np.argmax(np.abs(null))]
    return Modes(values, shapes)


def _upper(structure: Structure, method: Method) -> Complex:
    one_of("method", method, ("auto", "commensurate", "contour"))
    terms = structure_terms(structure)
    denominator = _common_denominator([order for order, _ in terms])
    if method == "commensurate" and denominator is None:
        raise InputError(
            "orders",
            expected=f"rational with a common denominator up to {_DENOMINATOR}",
            found=", ".join(f"{order:g}" for order, _ in terms),
        )
    if denominator is not None and method != "contour":
        values = _by_polynomial(terms, denominator)
    else:
        values = _by_contour(terms)
    return values[np.lexsort((values.real, values.imag))]


def _scale(terms: list[tuple[float, Array]]) -> float:
    """Return a typical rate, rad/s, at which the outer terms balance."""
    sizes = [(order, float(np.linalg.norm(matrix, 2))) for order, matrix in terms]
    sizes = [(order, size) for order, size in sizes if size > 0.0]
    (high, top), (low, bottom) = sizes[0], sizes[-1]
    return (bottom / top) ** (1.0 / (high - low)) if high > low else 1.0


def _common_denominator(orders: list[float]) -> int | None:
    common = 1
    for order in orders:
        near = Fraction(order).limit_denominator(_DENOMINATOR)
        if abs(float(near) - order) > 1e-14:
            return None
        common = math.lcm(common, near.denominator)
    return common if common <= _DENOMINATOR else None


def _by_polynomial(terms: list[tuple[float, Array]], q: int) -> Complex:
    """Roots of the matrix polynomial in (s/scale)^(1/q), from its companion pencil."""
    scale = _scale(terms)
    size = terms[0][1].shape[0]
    degree = 2 * q
    blocks = np.zeros((degree + 1, size, size))
    for order, matrix in terms:
        blocks[round(order * q)] += scale**order * matrix
    blocks /= np.abs(blocks).max()
    while degree > 1 and not blocks[degree].any():
        degree -= 1
    left, right = np.zeros((2, degree * size, degree * size))
    left[:-size, size:] = np.eye((degree - 1) * size)
    for k in range(degree):
        left[-size:, k * size : (k + 1) * size] = -blocks[k]
    right[:-size, :-size] = np.eye((degree - 1) * size)
    right[-size:, -size:] = blocks[degree]
    alpha, beta = scipy.linalg.eig(left, right, right=False, homogeneous_eigvals=True)
    finite = np.abs(beta) > 1e-12 * np.abs(alpha)
    w = alpha[finite] / beta[finite]
    angle = np.angle(w)
    # Real negative s (whole orders) sit at the edge of the principal sheet.
    w = w[(angle > -1e-10) & (angle <= np.pi / q + 1e-10) & (np.abs(w) > 0.0)]
    s = scale * np.exp(q * np.log(w))
    s.imag[np.abs(s.imag) < 1e-9 * np.abs(s)] = 0.0
    return np.asarray(s)


def _by_contour(terms: list[tuple[float, Array]]) -> Complex:
    """Zeros of det T in the upper half plane, in z = log s, counted first."""
    scale = _scale(terms)
    scaled = [(order, scale**order * matrix) for order, matrix in terms]
    largest = max(float(np.abs(m).max()) for _, m in scaled)
    scaled = [(order, m / largest) for order, m in scaled]
    low, high = _reach(scaled)
    corners = [
        complex(low, -_MARGIN), complex(high, -_MARGIN),
        complex(high, math.pi + _MARGIN), complex(low, math.pi + _MARGIN),
    ]  # fmt: skip
    turns = sum(
        _phase_gain(scaled, a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    )
    count = round(turns / (2.0 * math.pi))
    found: list[complex] = []
    for start in _starts(low, high):
        if len(found) == count:
            break
        z = _newton(scaled, start, found)
        inside = z is not None and low < z.real < high and -_MARGIN < z.imag < math.pi + _MARGIN
        if z is not None and inside:
            found.append(z)
    if len(found) < count:
        raise InputError(
            "eigenvalues", expected=f"{count} by the argument principle", found=f"{len(found)}"
        )
    s = scale * np.exp(np.array(found, dtype=np.complex128))
    angles = np.array([z.imag for z in found])
    s = s[(angles > -1e-12) & (angles <= math.pi + 1e-12)]
    s.imag[np.abs(s.imag) < 1e-12 * np.abs(s)] = 0.0
    return np.asarray(s)


def _reach(scaled: list[tuple[float, Array]]) -> tuple[float, float]:
    """Return bounds of log|s|, from where one term outweighs all the others."""

    def outweighs(index: int, z: float) -> bool:
        parts = [math.exp(order * z) * m for order, m in scaled]
        smallest = float(np.linalg.svd(parts[index], compute_uv=False)[-1])
        others = sum(float(np.linalg.norm(p, 2)) for i, p in enumerate(parts) if i != index)
        return smallest > others

    low, high = -1.0, 1.0
    while high < 30.0 and not outweighs(0, high):
        high += 0.5
    while low > -30.0 and not outweighs(len(scaled) - 1, low):
        low -= 0.5
    return low - 0.1, high + 0.1


def _matrix(scaled: list[tuple[float, Array]], z: complex) -> tuple[Complex, Complex]:
    value = np.zeros(scaled[0][1].shape, dtype=np.complex128)
    slope = np.zeros_like(value)
    for order, matrix in scaled:
        power = np.exp(order * z)
        value += power * matrix
        slope += order * power * matrix
    return value, slope


def _phase_gain(scaled: list[tuple[float, Array]], a: complex, b: complex) -> float:
    """Return the change of arg det T from a to b, in steps of less than half a radian."""

    def sign(z: complex) -> complex:
        return complex(np.linalg.slogdet(_matrix(scaled, z)[0])[0])

    total = 0.0
    pending = [(t, t + 1 / 32) for t in np.arange(31, -1, -1) / 32]
    at, value = 0.0, sign(a)
    while pending:
        start, stop = pending.pop()
        middle = 0.5 * (start + stop)
        ahead = sign(a + stop * (b - a))
        between = sign(a + middle * (b - a))
        first = float(np.angle(between / value))
        second = float(np.angle(ahead / between))
        if max(abs(first), abs(second)) > 0.5 and stop - start > 1e-9:
            pending += [(middle, stop), (start, middle)]
            continue
        total += first + second
        at, value = stop, ahead
    return total if at == 1.0 else math.nan


def _starts(low: float, high: float) -> list[complex]:
    angles = np.array([0.52, 0.6, 0.75, 0.9, 0.99, 0.3, 0.1]) * math.pi
    radii = np.linspace(low, high, 4 * math.ceil(high - low) + 1)
    middle_out = radii[np.argsort(np.abs(radii), kind="stable")]
    return [complex(r, a) for r in middle_out for a in angles]


def _newton(scaled: list[tuple[float, Array]], z: complex, found: list[complex]) -> complex | None:
    """Return a zero of det T that is not among `found`, or None where none is reached."""
    for _ in range(60):
        value, slope = _matrix(scaled, z)
        try:
            rate = complex(np.trace(np.linalg.solve(value, slope)))
        except np.linalg.LinAlgError:
            return z
        rate -= sum(1.0 / (z - other) for other in found if z != other)
        if rate == 0.0:
            return None
        move = -1.0 / rate
        if abs(move) > 0.5:
            move *= 0.5 / abs(move)
        z += move
        if abs(move) < 4e-16 * max(1.0, abs(z)):
            return z
        if abs(z.real) > 40.0 or abs(z.imag) > 2.0 * math.pi:
            return None
    return z if abs(move) < 1e-12 else None
