"""Series compliance: a mount, a joint or the oil yields, so the device moves less than the ends."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.motion import Motion
from models.terms.term import ForceOf, Parameter, Shape, Term

Response = Callable[[Array], NDArray[np.complex128]]


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force through a spring of compliance c: F/(1 + c Z), line by line.

    Z = -b omega^2 + i omega d is the device's dynamic stiffness, b and d as fit its own force
    best; friction passes the same filter. Exact where the device is linear.
    """
    force = force_of(motion)
    columns = np.stack([motion.acceleration, motion.velocity], axis=1)
    (inertance, damping), *_ = np.linalg.lstsq(columns, force - force.mean(), rcond=None)

    def response(omega: Array) -> NDArray[np.complex128]:
        own = -abs(inertance) * omega**2 + 1j * omega * abs(damping)
        loss = 1.0 + 1j * shape["loss"]
        return np.asarray(1.0 / (1.0 + coefficient * own / loss))

    return through(force, motion, response)


def through(force: Array, motion: Motion, response: Response) -> Array:
    """Return `force` filtered by a frequency response; the samples may have gaps."""
    step = motion.step
    uniform = motion.time[0] + step * np.arange(motion.time.size)
    even = force if motion.periodic else np.interp(uniform, motion.time, force)
    pad = 0 if motion.periodic else even.size // 8
    wide = np.pad(even, pad, mode="reflect") if pad else even
    lines = np.fft.rfft(wide) * response(2.0 * np.pi * np.fft.rfftfreq(wide.size, step))
    back = np.fft.irfft(lines, n=wide.size)[pad : pad + even.size]
    return back if motion.periodic else np.asarray(np.interp(motion.time, uniform, back))


TERM = Term(
    "series-compliance",
    "m/N",
    "a spring of this compliance in series: the device sees x - c F",
    transform=transform,
    acts="input",
    parameters=(Parameter("loss", 0.0, 0.5, 0.05, ""),),
    nonnegative=True,
    mistaken_for=("inertia", "time-delay", "fractional-derivative"),
)
