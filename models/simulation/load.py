"""What drives a structure: a force on one of its masses, or the acceleration of its base."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from models.checks import Array, InputError, finite_array, number


@dataclass(frozen=True)
class Load:
    """A scalar history and where it acts. Built by the functions of this file.

    Examples
    --------
    >>> import numpy as np
    >>> Load(lambda t: 3.0 * t, acts="force", at=1).vector(np.eye(2))
    array([0., 1.])
    """

    history: Callable[[Array], Array]
    """Maps times (N,) s to values (N,): N of a force, m/s^2 of a base acceleration."""
    acts: Literal["force", "base"] = "force"
    """A force on `at`, or the acceleration of the base."""
    at: int = 0
    """Degree of freedom that a force acts on."""

    def vector(self, mass: Array) -> Array:
        """Return the forces on the degrees of freedom per unit of the history, (n,).

        Parameters
        ----------
        mass : array, shape (n, n)
            kg.

        Raises
        ------
        InputError
            Where the structure has no such degree of freedom.
        """
        if self.acts == "base":
            return np.asarray(-mass.sum(axis=1))
        if not 0 <= self.at < mass.shape[0]:
            raise InputError(
                "degree of freedom of the load",
                expected=f"in 0..{mass.shape[0] - 1}",
                found=f"{self.at}",
            )
        result = np.zeros(mass.shape[0])
        result[self.at] = 1.0
        return result


def sine_load(
    amplitude: float,
    frequency: float,
    *,
    acts: Literal["force", "base"] = "force",
    at: int = 0,
    phase: float = 0.0,
) -> Load:
    """Return amplitude sin(2 pi f t + phase), in N or m/s^2; frequency in Hz, phase in rad.

    Parameters
    ----------
    amplitude : float
        N or m/s^2.
    frequency : float
        Hz, above zero.
    acts : str
        "force", N on a degree of freedom, or "base", m/s^2 of the base.
    at : int
        Degree of freedom that a force acts on.
    phase : float
        rad.

    Returns
    -------
    Load

    Raises
    ------
    InputError
        For a frequency that is not above zero.

    Examples
    --------
    >>> import numpy as np
    >>> sine_load(2.0, 0.25).history(np.array([0.0, 1.0])).round(12)
    array([0., 2.])
    """
    number("amplitude", amplitude)
    number("frequency", frequency, above=0.0)
    return Load(lambda t: amplitude * np.sin(2.0 * np.pi * frequency * t + phase), acts, at)


def sweep_load(
    amplitude: float,
    start: float,
    stop: float,
    duration: float,
    *,
    acts: Literal["force", "base"] = "force",
    at: int = 0,
) -> Load:
    """Return a sine whose frequency goes from start to stop (Hz) in equal ratios per second.

    Parameters
    ----------
    amplitude : float
        N or m/s^2.
    start, stop : float
        Hz, above zero.
    duration : float
        s, above zero.
    acts : str
        "force", N on a degree of freedom, or "base", m/s^2 of the base.
    at : int
        Degree of freedom that a force acts on.

    Returns
    -------
    Load

    Raises
    ------
    InputError
        For frequencies or a duration that are not above zero.

    Examples
    --------
    >>> import numpy as np
    >>> load = sweep_load(1.0, 1.0, 4.0, 10.0)
    >>> float(load.history(np.array([0.0]))[0])
    0.0
    """
    number("amplitude", amplitude)
    number("start", start, above=0.0)
    number("stop", stop, above=0.0)
    number("duration", duration, above=0.0)
    rate = np.log(stop / start) / duration
    if rate == 0.0:
        return sine_load(amplitude, start, acts=acts, at=at)
    scale = 2.0 * np.pi * start / rate
    return Load(lambda t: amplitude * np.sin(scale * np.expm1(rate * t)), acts, at)


def sampled_load(
    time: ArrayLike, values: ArrayLike, *, acts: Literal["force", "base"] = "force", at: int = 0
) -> Load:
    """Return a record or an earthquake trace, linear between its samples, zero outside.

    Parameters
    ----------
    time : array_like, shape (N,)
        s, rising.
    values : array_like, shape (N,)
        N or m/s^2.
    acts : str
        "force", N on a degree of freedom, or "base", m/s^2 of the base.
    at : int
        Degree of freedom that a force acts on.

    Returns
    -------
    Load

    Raises
    ------
    InputError
        Where shapes differ, a value is not finite, or time does not rise.

    Examples
    --------
    >>> import numpy as np
    >>> load = sampled_load([0.0, 1.0], [0.0, 10.0], acts="base")
    >>> load.history(np.array([0.5, 2.0])).tolist()
    [5.0, 0.0]
    """
    t = finite_array("time", time, ndim=1, min_size=2)
    y = finite_array("values", values, ndim=1, min_size=2)
    if y.shape != t.shape:
        raise InputError("values", expected=f"of shape {t.shape}", found=f"{y.shape}")
    if not (np.diff(t) > 0.0).all():
        raise InputError("time", expected="strictly increasing", found="steps back or repeats")
    return Load(lambda at_times: np.interp(at_times, t, y, left=0.0, right=0.0), acts, at)


def no_load() -> Load:
    """Return no load: free vibration.

    Returns
    -------
    Load
        Zero at all times.

    Examples
    --------
    >>> import numpy as np
    >>> no_load().history(np.array([0.0, 1.0])).tolist()
    [0.0, 0.0]
    """
    return Load(np.zeros_like)
