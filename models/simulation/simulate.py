"""The public entry: a structure with devices, its load, a step; the motion with its error."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from models.checks import Array, InputError, finite_array, number
from models.simulation.elements import compile_elements
from models.simulation.load import Load, no_load
from models.simulation.response import ErrorEstimate, PeriodicPast, Response
from models.simulation.run import Run, run
from models.structure import Structure


def simulate(
    structure: Structure,
    load: Load | None = None,
    *,
    step: float,
    duration: float,
    displacement: ArrayLike = 0.0,
    velocity: ArrayLike = 0.0,
    past: PeriodicPast | None = None,
    keep_every: int = 1,
    estimate_error: bool = True,
    richardson: bool = False,
    kernel_error: float = 1e-10,
) -> Response:
    """Return the motion of `structure` under `load` from a given state, or out of a steady state.

    Second order in time where the solution is smooth, from the first step on, fractional terms
    included; friction sticks exactly. Fractional derivatives are Caputo's from t = 0, or
    Weyl's after a periodic past. The time is linear, and the memory constant, in the number of
    steps, beyond the output.

    Parameters
    ----------
    structure : Structure
        Masses with the devices in between.
    load : Load, optional
        Force or base acceleration; free vibration where left out.
    step : float
        s; shortened a little where `duration` is not a whole number of steps.
    duration : float
        s.
    displacement, velocity : array_like, scalar or shape (n,)
        State at t = 0, m and m/s.
    past : PeriodicPast, optional
        Steady state before t = 0; it gives the state and the memory.
    keep_every : int
        Keep every n-th step only.
    estimate_error : bool
        Repeat at half the step and state the error: three times the work.
    richardson : bool
        Return the extrapolation of the two instead, for smooth problems: about fourth order. The
        error that is stated is then that of the finer of the two runs, hence an upper estimate.
    kernel_error : float
        Relative error of the fractional memory's kernel.

    Returns
    -------
    Response
        Displacement, velocity, acceleration (n, N) and the devices' forces, SI.

    Raises
    ------
    InputError
        For terms that can't be simulated, or values out of range.

    Examples
    --------
    >>> from models.structure import oscillator
    >>> free = simulate(oscillator(1.0, 1.0), step=0.01, duration=6.0, displacement=1.0)
    >>> bool(abs(free.displacement[-1, 0] - math.cos(6.0)) < 3e-5)
    True
    """
    steps = _step_count(step, duration, keep_every)
    exact_step = duration / steps
    elements = compile_elements(tuple(m.model for m in structure.devices))
    x0, v0 = _start(displacement, velocity, past, structure.size)

    def at(parts: int) -> Run:
        return run(
            structure,
            elements,
            load or no_load(),
            step=exact_step / parts,
            steps=steps * parts,
            every=keep_every * parts,
            displacement=x0,
            velocity=v0,
            past=past,
            kernel_error=kernel_error,
        )

    coarse = at(1)
    if not np.isfinite(coarse.displacement[-1]).all():
        raise InputError("step", expected="short enough for the motion to stay finite",
                         found=f"{exact_step:g} s")  # fmt: skip
    result, error = coarse, None
    if estimate_error or richardson:
        fine = at(2)
        # A second-order error falls to a quarter: 4/3 of the difference is that of the coarse run.
        error = _error(coarse, fine, 1.0 / 3.0 if richardson else 4.0 / 3.0)
        if richardson:
            result = _extrapolated(coarse, fine)
    return Response(
        time=result.time,
        displacement=result.displacement,
        velocity=result.velocity,
        device_force=result.device_force,
        step=exact_step,
        operator="caputo" if past is None else "weyl",
        energy=result.energy,
        error=error,
        extrapolated=richardson,
        switches=result.switches,
        left_out=elements.left_out,
    )


def _step_count(step: float, duration: float, keep_every: int) -> int:
    """Return how many steps of at most `step` the duration takes."""
    number("step", step, above=0.0)
    number("duration", duration, at_least=step)
    if keep_every < 1:
        raise InputError("keep_every", expected=">= 1", found=f"{keep_every}")
    return math.ceil(duration / step - 1e-9)


def _state(name: str, values: ArrayLike, size: int) -> Array:
    given = finite_array(name, values)
    if given.ndim > 1 or given.size not in (1, size):
        raise InputError(name, expected=f"a number or ({size},)", found=f"shape {given.shape}")
    return np.array(np.broadcast_to(given, (size,)))


def _start(
    displacement: ArrayLike, velocity: ArrayLike, past: PeriodicPast | None, size: int
) -> tuple[Array, Array]:
    """Return displacement and velocity (n,) at t = 0, m and m/s: as given, or the past's end."""
    if past is None:
        return _state("displacement", displacement, size), _state("velocity", velocity, size)
    if past.coefficients.shape[1] != size:
        raise InputError(
            "coefficients of the past",
            expected=f"for {size} degrees of freedom",
            found=f"{past.coefficients.shape[1]}",
        )
    return past.displacement(0.0)[0], past.velocity(0.0)[0]


def _extrapolated(coarse: Run, fine: Run) -> Run:
    """Return a run without the second-order part of the error, from one at half the step too."""

    def each(at_step: Array, at_half: Array) -> Array:
        return (4.0 * at_half - at_step) / 3.0

    return Run(
        coarse.time,
        each(coarse.displacement, fine.displacement),
        each(coarse.velocity, fine.velocity),
        each(coarse.device_force, fine.device_force),
        fine.energy,
        fine.switches,
    )


def _error(coarse: Run, fine: Run, factor: float) -> ErrorEstimate:
    gap = factor * np.abs(fine.displacement - coarse.displacement).max(axis=0)
    rate = factor * np.abs(fine.velocity - coarse.velocity).max(axis=0)
    scale = float(np.abs(fine.displacement).max())
    return ErrorEstimate(gap, rate, float(gap.max()) / scale if scale > 0.0 else 0.0)
