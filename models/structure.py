"""Structures of a few degrees of freedom that carry devices: M a + C v + K x + devices = load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from models.checks import Array, InputError, finite_array, number
from models.constitutive import ForceModel, SegmentedModel

Model = ForceModel | SegmentedModel


@dataclass(frozen=True)
class Mount:
    """A device between two degrees of freedom; its motion is x[upper] - x[lower]."""

    model: Model
    """Force law of the device."""
    upper: int = 0
    """Index of the degree of freedom at one end."""
    lower: int | None = None
    """The other end; None for the ground (the moving base, under base acceleration)."""


@dataclass(frozen=True)
class Structure:
    """Masses, dampers and springs as matrices, with the devices mounted between them.

    Under base acceleration the coordinates are relative to the base.

    Examples
    --------
    >>> Structure([[2.0]], [[0.0]], [[8.0]]).undamped_frequencies
    array([2.])
    """

    mass: Array
    """(n, n) kg, symmetric, positive definite together with the devices' inertance."""
    damping: Array
    """(n, n) N s/m."""
    stiffness: Array
    """(n, n) N/m, symmetric."""
    devices: tuple[Mount, ...] = field(default=())
    """Devices between degrees of freedom, or to ground."""

    def __post_init__(self) -> None:
        """Check shapes and ends, and freeze copies of the matrices."""
        size = np.shape(self.mass)[0] if np.ndim(self.mass) == 2 else 0
        for name in ("mass", "damping", "stiffness"):
            matrix = finite_array(name, getattr(self, name), ndim=2).copy()
            if matrix.shape != (size, size):
                raise InputError(
                    name, expected=f"square, ({size}, {size})", found=f"shape {matrix.shape}"
                )
            if name != "damping" and not np.allclose(matrix, matrix.T, rtol=1e-12, atol=0.0):
                raise InputError(name, expected="symmetric", found="an asymmetric matrix")
            matrix.flags.writeable = False
            object.__setattr__(self, name, matrix)
        object.__setattr__(self, "devices", tuple(self.devices))
        for mount in self.devices:
            for end, index in (("upper", mount.upper), ("lower", mount.lower)):
                if index is not None and not 0 <= index < size:
                    raise InputError(
                        f"{end} end of a device", expected=f"in 0..{size - 1}", found=f"{index}"
                    )
            if mount.upper == mount.lower:
                raise InputError("ends of a device", expected="different", found=f"{mount.upper}")

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return int(self.mass.shape[0])

    @property
    def directions(self) -> Array:
        """(q, n): row j maps coordinates to the relative motion of device j."""
        rows = np.zeros((len(self.devices), self.size))
        for row, mount in zip(rows, self.devices, strict=True):
            row[mount.upper] += 1.0
            if mount.lower is not None:
                row[mount.lower] -= 1.0
        return rows

    @property
    def undamped_frequencies(self) -> Array:
        """(n,) rad/s of the structure without damping and devices, ascending."""
        values = np.linalg.eigvals(np.linalg.solve(self.mass, self.stiffness))
        return np.sort(np.sqrt(np.clip(values.real, 0.0, None)))


def oscillator(
    mass: float, stiffness: float, device: Model | None = None, *, damping: float = 0.0
) -> Structure:
    """Return one mass on a spring, a damper and a device to ground.

    Parameters
    ----------
    mass : float
        kg, above zero.
    stiffness : float
        N/m.
    device : ForceModel or SegmentedModel, optional
        Beside the spring.
    damping : float
        N s/m.

    Returns
    -------
    Structure
        Of one degree of freedom.

    Raises
    ------
    InputError
        For a mass that is not above zero, or a negative stiffness.

    Examples
    --------
    >>> oscillator(250.0, 20e3, damping=100.0).size
    1
    """
    number("mass", mass, above=0.0)
    number("stiffness", stiffness, at_least=0.0)
    number("damping", damping)
    devices = () if device is None else (Mount(device, 0, None),)
    return Structure(
        np.array([[mass]]), np.array([[damping]]), np.array([[stiffness]]), devices
    )


def chain(
    masses: ArrayLike,
    stiffnesses: ArrayLike,
    dampings: ArrayLike | None = None,
    devices: Sequence[Mount] = (),
) -> Structure:
    """Return masses in a row: spring and damper i hold mass i to mass i - 1, the first to ground.

    Parameters
    ----------
    masses : array_like, shape (n,)
        kg.
    stiffnesses, dampings : array_like, shape (n,)
        N/m and N s/m; no damping where left out.
    devices : sequence of Mount
        Devices between any two masses or to ground.

    Returns
    -------
    Structure
        Of n degrees of freedom.

    Raises
    ------
    InputError
        Where shapes differ, or a device's ends are not there.

    Examples
    --------
    >>> chain([1.0, 1.0], [2.0, 3.0]).stiffness
    array([[ 5., -3.],
           [-3.,  3.]])
    """
    m = finite_array("masses", masses, ndim=1)
    k = finite_array("stiffnesses", stiffnesses, ndim=1)
    c = np.zeros_like(m) if dampings is None else finite_array("dampings", dampings, ndim=1)
    for name, values in (("stiffnesses", k), ("dampings", c)):
        if values.shape != m.shape:
            raise InputError(name, expected=f"of shape {m.shape}", found=f"{values.shape}")
    return Structure(np.diag(m), _tridiagonal(c), _tridiagonal(k), tuple(devices))


def _tridiagonal(values: Array) -> Array:
    difference = np.eye(values.size) - np.eye(values.size, k=-1)
    return np.asarray(difference.T @ np.diag(values) @ difference)
