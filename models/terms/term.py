"""What a term is: a shape of the motion with a coefficient, or a change of what is seen."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from models.checks import Array, InputError, number, shown
from models.motion import Motion
from models.terms.scales import Scales

Shape = Mapping[str, float]
ForceOf = Callable[[Motion], Array]
ScaledBy = Literal["", "displacement", "speed", "force"]
Follows = Literal["motion", "path", "time"]


@dataclass(frozen=True)
class Changed:
    """A force as an effect of input or output changes it: called like the force itself."""

    force_of: ForceOf
    """Before the effect."""
    transform: Callable[[ForceOf, Motion, float, Shape], Array]
    """Of the effect."""
    coefficient: float
    """Its size."""
    shape: Shape
    """Its shape parameters."""

    def __call__(self, motion: Motion) -> Array:
        """Return the changed force, (N,) N."""
        return self.transform(self.force_of, motion, self.coefficient, self.shape)


def unchanged(force_of: ForceOf) -> ForceOf:
    """Return a force before all effects that change it."""
    while isinstance(force_of, Changed):
        force_of = force_of.force_of
    return force_of


@dataclass(frozen=True)
class Parameter:
    """A shape parameter of a term, profiled out of every fit (it is not linear)."""

    name: str
    """Key in documents, as ``order`` or ``exponent``."""
    lower: float
    """Least sensible value, in units of `scaled_by`."""
    upper: float
    """Greatest sensible value, likewise."""
    default: float
    """Value where none is given, likewise."""
    unit: str
    """SI unit of the value in documents; "" where dimensionless."""
    scaled_by: ScaledBy = ""
    """The campaign's amplitude that the bounds are fractions of; "" where they are absolute."""
    spacing: Literal["linear", "log"] = "linear"
    """How trial values are spread."""
    fitted: bool = True
    """False for a choice (a side, a form, a test's number): no fit changes it."""


@dataclass(frozen=True)
class Start:
    """A shape that is tried first: one term, or several of the same id fitted together."""

    shapes: tuple[Shape, ...]
    """Of each, SI; parameters left out have their defaults."""
    probe: float = 1.0
    """Coefficient at which a change of input or output is tried."""

    @classmethod
    def one(cls, probe: float = 1.0, **shape: float) -> Start:
        """Return a single term's shape."""
        return cls((shape,), probe)


@dataclass(frozen=True)
class TermSource:
    """The file that a user's own term was read from."""

    path: Path
    """Where it was found."""
    sha256: str
    """Of the file's bytes."""

    def to_dict(self) -> dict[str, str]:
        """Return the file's name and hash, as models store them."""
        return {"file": self.path.name, "sha256": self.sha256}


@dataclass(frozen=True)
class Term:
    """One entry of the vocabulary: a model's term and, by the same name, a missing effect.

    A term that acts as a "force" adds ``coefficient * column(motion, shape)``. Others change the
    motion before the device sees it ("input"), or the force on its way to the record ("output"):
    they carry `transform` instead.
    """

    id: str
    """Name in commands and documents."""
    unit: str
    """SI unit of the coefficient; "{order}" and "{exponent}" are filled in."""
    summary: str
    """One line in plain words, with the formula."""
    column: Callable[[Motion, Shape], Array] | None = None
    """Force per unit coefficient, (N,); None for a term that is not an added force."""
    transform: Callable[[ForceOf, Motion, float, Shape], Array] | None = None
    """Force (N,) of the changed device, from the force of the unchanged one."""
    acts: Literal["force", "input", "output"] = "force"
    """Where in the chain it acts."""
    parameters: tuple[Parameter, ...] = ()
    """Shape parameters."""
    nonnegative: bool = False
    """True where a negative coefficient is unphysical."""
    mistaken_for: tuple[str, ...] = ()
    """Ids that data of little variety can't tell it from."""
    harmonic: bool = False
    """True where the column is linear in the displacement."""
    follows: Follows | Callable[[Shape], Follows] = "motion"
    """What a column is a function of: the motion at the moment; its path, so that a sine test
    shows the cycle that it settles into; or besides the time since the record began."""
    derivative: float | None = None
    """Order of the derivative of displacement that the column is; None for another column."""
    bounds: Callable[[Shape], tuple[float, float]] | None = None
    """What the coefficient lies between, by shape; None where only `nonnegative` bounds it."""
    of_channel: bool = False
    """True where it may belong to a measuring channel instead of the device."""
    needs: tuple[str, ...] = ()
    """Ids of terms without one of which it means nothing."""
    impacts: Callable[[Shape], bool] | None = None
    """Tells whether a shape has impacts, which a fit can't find from far; None: none has."""
    starts: Callable[[Scales], Sequence[Start]] | None = None
    """Shapes that are tried first in a campaign; None to spread the parameters."""
    common: float | None = None
    """Odds beforehand that records show it; None where it is one of many that may join."""
    curves: Callable[[Scales], Sequence[Shape]] | None = None
    """Shapes by whose columns measured ones differ from the formula's, the plainest first; of a
    term that needs another they are among that one's."""
    described: Callable[[Shape], str] | None = None
    """What a shape's choices (parameters that no fit changes) mean in words; "" where nothing
    needs saying. None: they are told by name."""
    departure: float = 0.0
    """Size of these differences over the coefficient, one standard deviation."""
    trials: tuple[Shape, ...] = ()
    """Shapes that are tried first, in units of `scaled_by`; empty to spread the parameters."""
    source: TermSource | None = None
    """File of a user's own term; None for those of the catalogue."""

    def remembers(self, shape: Shape) -> Follows:
        """Return what the column of a shape is a function of: see `follows`."""
        return self.follows(shape) if callable(self.follows) else self.follows

    def coefficient_bounds(self, shape: Shape) -> tuple[float, float]:
        """Return what the coefficient lies between."""
        if self.bounds is not None:
            return self.bounds(shape)
        return (0.0 if self.nonnegative else -math.inf), math.inf

    @property
    def simulated(self) -> bool:
        """True where the motion behind it has to be found in time: no column says what it does."""
        return self.acts == "input" or self.impacts is not None

    def has_impacts(self, shape: Shape) -> bool:
        """Tell whether a shape has impacts."""
        return self.impacts is not None and self.impacts(shape)

    def shape(self, given: Shape) -> dict[str, float]:
        """Return the parameters' values: those given, else the defaults that are absolute.

        Raises
        ------
        InputError
            For a name that the term does not have, or a scaled parameter without a value.
        """
        known = {p.name: p for p in self.parameters}
        for name in given:
            if name not in known:
                raise InputError(
                    f"parameter {name!r} of {self.id}",
                    expected="one of " + (", ".join(known) or "none"),
                    found=shown(name),
                )
        result = {}
        for name, parameter in known.items():
            if name in given:
                result[name] = number(f"{self.id}.{name}", given[name])
            elif parameter.scaled_by and parameter.default:
                raise InputError(f"{self.id}.{name}", expected="given", found="nothing")
            else:
                result[name] = parameter.default
        return result
