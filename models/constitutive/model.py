"""A model of force: a sum of terms with coefficients."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import Array, InputError, number, shown, stored_number
from models.fractional import harmonic_factors
from models.motion import Motion
from models.terms import TERMS, Shape, Term, find_term, own_terms
from models.terms.own import same_file
from models.terms.term import Changed, ForceOf, Parameter

_ROUNDED = 1e-6  # of a bound: stored values are rounded

WHOLE_ORDERS = {"stiffness": 0.0, "viscous-damping": 1.0, "inertia": 2.0}
"""Of the derivative of displacement that a term is."""
_FIRST_POWER = re.compile(r"\(([^()]*)\)\^1(?![\d.])|\^1(?![\d.])")
_NO_POWER = re.compile(r"(?: ?\([^()]*\)|[ /]\w+)\^0(?![\d.])")


@dataclass(frozen=True)
class FittedTerm:
    """A term with its coefficient and shape.

    Examples
    --------
    >>> FittedTerm("thermal-drift", 3.0).unit, FittedTerm("thermal-drift", 3.0, {"power": 0.0}).unit
    ('N s/m', 'N')
    >>> FittedTerm("fractional-derivative", 580.0, {"order": 1.89}).unit
    'N s^1.89/m'
    >>> FittedTerm("coulomb-friction", 400.0, {"transition_speed": 0.001, "presliding": 0.0})
    FittedTerm('coulomb-friction', 400.0, {'transition_speed': 0.001})
    """

    id: str
    """Id in the vocabulary."""
    coefficient: float
    """In `unit`."""
    shape: Mapping[str, float] = field(default_factory=dict)
    """Shape parameters, SI."""
    term: Term = field(init=False, repr=False, compare=False)
    """The entry of the vocabulary."""

    def __post_init__(self) -> None:
        """Look the term up; check the names and values; fill in defaults."""
        object.__setattr__(self, "term", find_term(self.id))
        shape = self.term.shape(self.shape)
        object.__setattr__(self, "shape", MappingProxyType(shape))
        number(f"coefficient of {self.id}", self.coefficient)

    def __repr__(self) -> str:
        """Return what makes it again, without what is at its default: a friction has eight."""
        defaults = {
            p.name: p.default for p in self.term.parameters if not p.scaled_by or p.default == 0.0
        }
        shape = {n: v for n, v in self.shape.items() if defaults.get(n) != v}
        values = (self.id, self.coefficient, *([shape] if shape else []))
        return f"FittedTerm({', '.join(map(repr, values))})"

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by value (a mapping proxy can't be pickled)."""
        values = (self.id, self.coefficient, dict(self.shape))
        if self.term.source is None:
            return FittedTerm, values
        return _own_fitted_term, (self.term, *values)

    @property
    def unit(self) -> str:
        """SI unit of the coefficient."""
        text = self.term.unit.format(**{k: f"{v:.4g}" for k, v in self.shape.items()})
        return _FIRST_POWER.sub(r"\1", _NO_POWER.sub("", text))

    @property
    def told_shape(self) -> dict[str, float]:
        """Shape parameters that are not at their defaults, SI."""
        defaults = {p.name: p.default for p in self.term.parameters if not p.scaled_by}
        return {n: v for n, v in self.shape.items() if defaults.get(n) != v}

    def to_dict(self) -> dict[str, Any]:
        """Return id, coefficient, unit and shape parameters, flat as in documents.

        A user's own term comes with its file's name and hash.
        """
        result = {"id": self.id, "coefficient": self.coefficient, "unit": self.unit, **self.shape}
        source = self.term.source
        return result if source is None else {**result, "source": source.to_dict()}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], *, where: str = "") -> FittedTerm:
        """Read what `to_dict` wrote; further keys (intervals) are passed over.

        Raises
        ------
        InputError
            For what is no term, and for a user's own that is not in the vocabulary from the same
            file: wrap the call in `models.terms.own_terms`.
        """
        if not isinstance(data, Mapping):
            raise InputError("a term", expected="a table", found=shown(data), where=where)
        for key in ("id", "coefficient"):
            if key not in data:
                raise InputError(f"key {key!r} of a term", expected="given", where=where)
        identifier = data["id"]
        if not isinstance(identifier, str):
            raise InputError("id of a term", expected="text", found=shown(identifier), where=where)
        _check_source(identifier, data.get("source"), where)
        parameters = find_term(identifier, where=where).parameters
        shape = {p.name: _stored(p, data[p.name], identifier, where)
                 for p in parameters if p.name in data}  # fmt: skip
        size = stored_number(f"coefficient of {identifier}", data["coefficient"], where=where)
        try:
            return cls(identifier, size, shape)
        except InputError as error:  # a parameter that is not given
            raise InputError(
                error.what, expected=error.expected, found=error.found, where=where
            ) from None


def _stored(parameter: Parameter, value: Any, identifier: str, where: str) -> float:
    """Return a shape parameter of a document, within its bounds where those are absolute."""
    name = f"{identifier}.{parameter.name}"
    result = stored_number(name, value, where=where)
    lower, upper = parameter.lower, parameter.upper
    if parameter.scaled_by:  # bounds in units of a campaign: only the sign is known
        lower, upper = (0.0 if lower > 0.0 else -np.inf), np.inf
    slack = _ROUNDED * max(abs(lower), abs(upper), 1.0) if np.isfinite(upper) else 0.0
    if result != parameter.default and not lower - slack <= result <= upper + slack:
        expected = f"from {lower:g} to {upper:g}"
        raise InputError(name, expected=expected, found=f"{result:g}", where=where)
    return result


def _own_fitted_term(term: Term, identifier: str, coefficient: float, shape: Shape) -> FittedTerm:
    """Return a fitted term of a user's own in a process that may not know it."""
    with own_terms(term):
        return FittedTerm(identifier, coefficient, shape)


def _check_source(identifier: str, source: Any, where: str) -> None:
    """Check that a term stored with a file is known from that file."""
    if source is None:
        return
    if not isinstance(source, Mapping) or not isinstance(source.get("sha256"), str):
        raise InputError(
            f"source of {identifier!r}", expected="a file with its sha256", found=shown(source),
            where=where,
        )  # fmt: skip
    if identifier not in TERMS:
        raise InputError(
            f"effect {identifier!r}",
            expected=f"given with its file {source.get('file', '')}"
            f" (sha256 {source['sha256'][:12]}…, --effect-file)",
            found="none", where=where,
        )  # fmt: skip
    same_file(TERMS[identifier], source["sha256"], where=where)


@dataclass(frozen=True)
class ForceModel:
    """Force as a sum of terms of the motion, seen through input and output effects.

    Examples
    --------
    >>> from models.motion import sine_motion
    >>> model = ForceModel((FittedTerm("inertia", 100.0),), name="mass")
    >>> float(model.force(sine_motion(0.01, 1.0)).max().round(3))
    39.478
    """

    terms: tuple[FittedTerm, ...]
    """Terms in any order; output effects are applied in the order given, last outermost."""
    name: str = ""
    """For legends and tables."""

    def force(self, motion: Motion) -> Array:
        """Return the force for `motion`, (N,) N.

        Parameters
        ----------
        motion : Motion
            N samples; `models.motion` makes them.
        """
        return self.changed(self.added, motion)

    def added(self, motion: Motion) -> Array:
        """Return the sum of the terms that add a force for `motion`, (N,) N.

        Parameters
        ----------
        motion : Motion
            N samples.
        """
        total = np.zeros_like(motion.displacement)
        for fitted in self.terms:
            column = fitted.term.column
            if fitted.term.acts == "force" and column is not None:
                total += fitted.coefficient * column(motion, fitted.shape)
        return total

    def changed(self, added: ForceOf, motion: Motion) -> Array:
        """Return what the input and output effects make of an added force, (N,) N.

        Parameters
        ----------
        added : callable
            Maps a motion to a force, (N,) N.
        motion : Motion
            N samples.
        """
        whole = added
        for fitted in self.chain:
            transform = fitted.term.transform
            if transform is not None:
                whole = Changed(whole, transform, fitted.coefficient, fitted.shape)
        return whole(motion)

    @property
    def chain(self) -> tuple[FittedTerm, ...]:
        """Return the terms that change an added force, in the order in which they do."""
        return tuple(t for act in ("input", "output") for t in self.terms if t.term.acts == act)

    def dynamic_stiffness(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """Return F/X of the terms that are linear in displacement, N/m, at `omega` in rad/s.

        Friction and nonlinear damping have no transfer function; they are left out, and
        `nonlinear_terms` names them.

        Parameters
        ----------
        omega : array_like, any shape
            Angular frequency, rad/s.

        Returns
        -------
        complex array, shape of `omega`
        """
        w = np.asarray(omega, dtype=np.float64)
        total = np.zeros(w.shape, dtype=np.complex128)
        for fitted in self.terms:
            order = fitted.shape.get("order", WHOLE_ORDERS.get(fitted.id))
            if order is not None:
                factor = harmonic_factors(np.array([order]), np.ravel(w))[0]
                total += fitted.coefficient * factor.reshape(w.shape)
        return total

    @property
    def nonlinear_terms(self) -> tuple[str, ...]:
        """Ids of the terms that `dynamic_stiffness` leaves out."""
        return tuple(t.id for t in self.terms if not t.term.harmonic)

    def coefficient(self, identifier: str) -> float:
        """Return the coefficient of the first term called `identifier`, 0 where there is none.

        Parameters
        ----------
        identifier : str
            As in the vocabulary: "inertia".
        """
        return next((t.coefficient for t in self.terms if t.id == identifier), 0.0)

    def to_dict(self) -> dict[str, Any]:
        """Return name and terms."""
        return {"name": self.name, "terms": [t.to_dict() for t in self.terms]}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], *, where: str = "") -> ForceModel:
        """Read what `to_dict` wrote.

        Parameters
        ----------
        data : mapping
            ``terms``, and ``name`` where it has one.
        where : str
            What an error names as the place.

        Raises
        ------
        InputError
            For what is no such mapping.
        """
        if not isinstance(data.get("terms"), list | tuple):
            found = shown(data.get("terms"))
            raise InputError("terms", expected="a list", found=found, where=where)
        terms = tuple(FittedTerm.from_dict(t, where=where) for t in data["terms"])
        return cls(terms, stored_text(data, "name", where))


def stored_text(data: Mapping[str, Any], key: str, where: str, default: str = "") -> str:
    """Return a text of a document."""
    value = data.get(key, default)
    if not isinstance(value, str):
        raise InputError(key, expected="text", found=shown(value), where=where)
    return value
