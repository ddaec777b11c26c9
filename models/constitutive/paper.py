"""The paper's four families of models (Eqs. 5, 6, 7, 11), from a device's geometry."""

from __future__ import annotations

from models.checks import InputError, number
from models.constitutive.model import FittedTerm, ForceModel
from models.constitutive.segmented import Band, SegmentedModel
from models.device import Device
from models.flow import critical_frequency


def _friction(device: Device, friction: float | None) -> float:
    value = device.coulomb_friction if friction is None else friction
    if value is None:
        raise InputError(
            "coulomb_friction", expected="given, by the device or the call", found="nothing"
        )
    return value


def ioim_laminar(device: Device, *, friction: float | None = None) -> ForceModel:
    """Return the laminar integer-order model: ``b a + c1 v|v| + c2 v + f0 sign v`` (Eq. 5).

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    friction : float, optional
        Coulomb friction f0, N; the device's own where left out.

    Returns
    -------
    ForceModel
        Coefficients in SI: kg, N s^2/m^2, N s/m and N.

    Raises
    ------
    InputError
        Where neither the device nor `friction` says how great the friction is.

    Examples
    --------
    >>> model = ioim_laminar(Device.preset("device-12"))
    >>> round(model.coefficient("inertia"), 2)
    370.38
    """
    c1, c2 = device.laminar_coefficients
    return ForceModel(
        (
            FittedTerm("inertia", device.inertance),
            FittedTerm("quadratic-damping", c1),
            FittedTerm("viscous-damping", c2),
            FittedTerm("coulomb-friction", _friction(device, friction)),
        ),
        "IOIM-laminar",
    )


def ioim_turbulent(device: Device, *, friction: float | None = None) -> ForceModel:
    """Return the turbulent model (Eq. 6).

    It is ``b a + c1 |v|^1.75 sign v + c2 v|v| + c3 v + f0 sign v``. Without a piston clearance
    the film term c3 is left out.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    friction : float, optional
        Coulomb friction f0, N; the device's own where left out.

    Returns
    -------
    ForceModel
        Coefficients in SI: kg, N s^1.75/m^1.75, N s^2/m^2, N s/m and N.

    Raises
    ------
    InputError
        Where neither the device nor `friction` says how great the friction is.

    Examples
    --------
    >>> model = ioim_turbulent(Device.preset("device-12"))
    >>> [term.id for term in model.terms][:2], model.terms[1].unit
    (['inertia', 'power-law-damping'], 'N (s/m)^1.75')
    """
    c1, c2, c3 = device.turbulent_coefficients
    film = () if c3 is None else (FittedTerm("viscous-damping", c3),)
    return ForceModel(
        (
            FittedTerm("inertia", device.inertance),
            FittedTerm("power-law-damping", c1, {"exponent": 1.75}),
            FittedTerm("quadratic-damping", c2),
            *film,
            FittedTerm("coulomb-friction", _friction(device, friction)),
        ),
        "IOIM-turbulent",
    )


def foim(device: Device, b0: float, order: float, *, friction: float | None = None) -> ForceModel:
    """Return the fractional model: b(1 + b0) D^order x + f0 sign v (Eq. 7).

    b and b0 enter only as their product with one: b comes from the device.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    b0 : float
        Above -1.
    order : float
        Of the derivative of displacement, from 0 to 2.
    friction : float, optional
        Coulomb friction f0, N; the device's own where left out.

    Returns
    -------
    ForceModel
        Coefficients in N s^order/m and N.

    Raises
    ------
    InputError
        For b0 or an order out of range, and without any friction.

    Examples
    --------
    >>> round(foim(Device.preset("device-12"), 0.57, 1.89).terms[0].coefficient, 1)
    581.5
    """
    number("b0", b0, above=-1.0)
    number("order", order, at_least=0.0, at_most=2.0)
    return ForceModel(
        (
            FittedTerm("fractional-derivative", device.inertance * (1.0 + b0), {"order": order}),
            FittedTerm("coulomb-friction", _friction(device, friction)),
        ),
        "FOIM",
    )


def sfoim(
    device: Device,
    below: tuple[float, float],
    above: tuple[float, float],
    *,
    dean: float = 100.0,
    convention: str = "paper",
    friction: float | None = None,
) -> SegmentedModel:
    """Return the segmented fractional model (Eq. 11): (b0, order) below and above a Dean number.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    below, above : tuple of float
        (b0, order) in the band of low and of high Dean numbers.
    dean : float
        Where the bands part, above zero.
    convention : str
        Of that Dean number: "paper" or "standard".
    friction : float, optional
        Coulomb friction f0, N; the device's own where left out.

    Returns
    -------
    SegmentedModel
        Two bands of the Dean number.

    Raises
    ------
    InputError
        As `foim`; for a Dean number that is not above zero, and an unknown convention.

    See Also
    --------
    models.flow.critical_frequency : where the boundary lies for an amplitude.

    Examples
    --------
    >>> model = sfoim(Device.preset("device-12"), (18.25, 0.48), (0.57, 1.89))
    >>> [(band.lower, band.upper) for band in model.bands]
    [(None, 100.0), (100.0, None)]
    """
    critical_frequency(device, 0.001, dean=dean, convention=convention)
    return SegmentedModel(
        (
            Band(None, dean, foim(device, *below, friction=friction)),
            Band(dean, None, foim(device, *above, friction=friction)),
        ),
        "dean",
        convention,
        device,
        "SFOIM",
    )
