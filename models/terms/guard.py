"""A user's function as it is called: every result checked, every failure with its line."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from models.checks import Array, InputError, finite_array
from models.motion import Motion, sampled_motion, sine_motion
from models.terms.term import ForceOf, Shape, Term
from models.terms.trials import trial_shapes

_SCALES = {"displacement": 0.01, "speed": 0.06, "force": 1000.0}
_SIZE = 1e-6


def failure(what: str, expected: str, error: BaseException, *, path: str) -> InputError:
    """Return an error of the user's own code as one of input, with the line in their file."""
    lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == path]
    where = f"{path}:{lines[-1]}" if lines else path
    text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return InputError(what, expected=expected, found=text, where=where)


@dataclass(frozen=True)
class _Guarded:
    """A function of a user's file."""

    id: str
    """Of the term."""
    path: str
    """Of the file."""
    function: Callable[..., Array]
    """The function itself."""

    def _call(self, name: str, motion: Motion, shape: Shape, *arguments: Any) -> Array:
        what = f"{name} of {self.id}"
        values = ", ".join(f"{k} = {v:.6g}" for k, v in shape.items())
        at = f"{self.path}, {values}" if values else self.path
        try:
            with np.errstate(all="ignore"):
                result = np.asarray(self.function(*arguments))
        except InputError:
            raise
        except Exception as error:
            raise failure(what, "a function of whole arrays", error, path=self.path) from None
        if result.shape != motion.displacement.shape:
            raise InputError(
                what, expected=f"one force a sample, shape {motion.displacement.shape}",
                found=f"shape {result.shape}", where=at,
            )  # fmt: skip
        if np.iscomplexobj(result):
            raise InputError(what, expected="real", found="complex numbers", where=at)
        return finite_array(what, result, where=at)


class GuardedColumn(_Guarded):
    """A user's column."""

    def __call__(self, motion: Motion, shape: Shape) -> Array:
        """Return the column, (N,)."""
        return self._call("column", motion, shape, motion, shape)


class GuardedTransform(_Guarded):
    """A user's change of input or output."""

    def __call__(
        self, force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape
    ) -> Array:
        """Return the changed force, (N,)."""
        return self._call("transform", motion, shape, force_of, motion, coefficient, shape)


def probe(term: Term, *, where: str) -> None:
    """Evaluate a guarded term on a steady sine and on a motion from rest, of different sizes.

    Raises
    ------
    InputError
        Where it fails, changes its input, or returns what is not one finite number a sample.
    """
    try:
        shapes = trial_shapes(term, _SCALES)
    except InputError as error:
        raise InputError(
            error.what, expected=error.expected, found=error.found, where=where
        ) from None
    time = np.arange(101) / 100.0
    from_rest = 0.01 * np.where(time > 0.2, np.sin(5.0 * (time - 0.2)) ** 3, 0.0)
    for motion in (sine_motion(0.01, 1.0, samples=64), sampled_motion(time, from_rest)):
        for array in (motion.time, motion.displacement, motion.velocity, motion.acceleration):
            array.flags.writeable = False
        for shape in map(MappingProxyType, shapes):
            if term.column is not None:
                term.column(motion, shape)
            if term.transform is not None:
                term.transform(_linear_device, motion, _SIZE, shape)


def _linear_device(motion: Motion) -> Array:
    return 100.0 * motion.acceleration + 500.0 * motion.velocity
