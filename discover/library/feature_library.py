"""The vocabulary of terms as a pysindy feature library."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Self, get_args

import numpy as np
from pysindy.feature_library.base import BaseFeatureLibrary, x_sequence_or_item
from pysindy.utils import AxesArray, comprehend_axes
from sklearn.base import clone
from sklearn.utils.validation import check_is_fitted

from discover.library.column import PLAIN, Column
from discover.library.transition import fitted_transition
from models.checks import Array, InputError, finite_array, number, one_of
from models.motion import Motion, SampledKind, sampled_motion
from models.terms import find_term

DEFAULT_TERMS = (*PLAIN, "coulomb-friction")
"""Terms without a shape that has to be given."""
_FRACTIONAL, _POWER = "fractional-derivative", "power-law-damping"
_FRICTION = "coulomb-friction"
_FEWEST = 8  # samples a trajectory needs

Namer = Callable[[str, str, str, Mapping[str, float]], str]


def _coulomb(x: str, v: str, a: str, shape: Mapping[str, float]) -> str:
    transition = shape.get("transition_speed", 0.0)
    return f"tanh({v}/{transition:.4g})" if transition else f"sign({v})"


def _asymmetric(x: str, v: str, a: str, shape: Mapping[str, float]) -> str:
    power = shape.get("power", 1.0)
    side = {1.0: f" ({v}>0)", -1.0: f" ({v}<0)"}.get(shape.get("side", 0.0), "")
    return (f"|{v}|" if power == 1.0 else f"|{v}|^{power:.4g}") + side


_NAMES: dict[str, Namer] = {
    "inertia": lambda x, v, a, shape: a,
    "viscous-damping": lambda x, v, a, shape: v,
    "quadratic-damping": lambda x, v, a, shape: f"{v}|{v}|",
    "asymmetric-damping": _asymmetric,
    "stiffness": lambda x, v, a, shape: x,
    "cubic-stiffness": lambda x, v, a, shape: f"{x}^3",
    "force-offset": lambda x, v, a, shape: "1",
    "coulomb-friction": _coulomb,
    _FRACTIONAL: lambda x, v, a, shape: f"D^{shape['order']:.4g} {x}",
    _POWER: lambda x, v, a, shape: f"|{v}|^{shape['exponent']:.4g} sign({v})",
}


class InerterLibrary(BaseFeatureLibrary):  # type: ignore[misc]
    """Terms of a measured motion as features, for ``SINDy.fit(X, t, x_dot=force)``.

    The force is a static map of the motion's terms, so ``x_dot`` is the measured force, (N, 1),
    and must be given. Input columns are displacement in m and, where measured, velocity in m/s
    and acceleration in m/s^2; what is not measured is differentiated. Fractional derivatives are
    always of the displacement.

    Parameters
    ----------
    dt : float or sequence of float
        Sampling interval, s; one for all trajectories, or one for each.
    terms : sequence of str or Column
        Ids of the vocabulary; a `Column` carries a term's shape.
    orders : sequence of float
        Orders of the fractional derivatives, 0 to 2; evaluated together.
    exponents : sequence of float
        Exponents of power-law damping, above 0.
    kind : str
        Operator: "caputo" (from rest), "riemann-liouville", "grunwald-letnikov", or "weyl" (whole
        periods of a steady state).
    transition_speed : float
        Speed over which dry friction reverses, m/s: it is then tanh(v/v_t) in place of sign(v).
        0 for a jump. Measured friction never jumps, and the corners of a jump bend the other
        coefficients; `with_fitted_transition` finds the speed.

    Attributes
    ----------
    n_features_in_ : int
        Number of input columns, 1 to 3.
    n_output_features_ : int
        Number of terms.

    Notes
    -----
    Records with noise should pass ``discover.motion_fit`` first: derivatives amplify it.

    Examples
    --------
    >>> import pysindy as ps
    >>> from discover.regression import BestSubset
    >>> t = np.arange(400) / 400
    >>> x = 0.01 * np.sin(2 * np.pi * t) + 0.004 * np.cos(6 * np.pi * t)
    >>> library = InerterLibrary(dt=1 / 400, orders=(0.5, 1.5), kind="weyl")
    >>> force = library.fit_transform(x[:, None]) @ np.eye(10)[[0, 8]].T @ [[100.0], [20.0]]
    >>> model = ps.SINDy(feature_library=library, optimizer=BestSubset(max_terms=3))
    >>> model = model.fit(x[:, None], t=t, x_dot=force, feature_names=["x"])
    >>> model.print(lhs=["F"])
    F =  100.000 x'' +  20.000 D^0.5 x

    Friction that reverses over a speed, which is fitted:

    >>> v = 2 * np.pi * (0.01 * np.cos(2 * np.pi * t) - 0.012 * np.sin(6 * np.pi * t))
    >>> force = (2500.0 * v + 400.0 * np.tanh(v / 0.01))[:, None]
    >>> terms = ("viscous-damping", "coulomb-friction")
    >>> library = InerterLibrary(1 / 400, terms=terms, kind="weyl")
    >>> library = library.with_fitted_transition(x[:, None], force)
    >>> round(library.transition_speed, 4)
    0.01
    >>> model = ps.SINDy(feature_library=library, optimizer=BestSubset(max_terms=2))
    >>> model.fit(x[:, None], t=t, x_dot=force, feature_names=["x"]).print(lhs=["F"], precision=0)
    F =  2500 x' +  400 tanh(x'/0.01)
    """

    def __init__(
        self,
        dt: float | Sequence[float] = 1.0,
        *,
        terms: Sequence[str | Column] = DEFAULT_TERMS,
        orders: Sequence[float] = (),
        exponents: Sequence[float] = (),
        kind: SampledKind = "caputo",
        transition_speed: float = 0.0,
    ) -> None:
        self.dt = dt
        self.terms = terms
        self.orders = orders
        self.exponents = exponents
        self.kind = kind
        self.transition_speed = transition_speed

    @property
    def columns(self) -> tuple[Column, ...]:
        """The features: terms first, then orders, then exponents.

        Raises
        ------
        InputError
            For a term that is unknown, lacks its shape or is no force that adds, for an order
            outside [0, 2], an exponent that is not positive, or a feature that stands twice.
        """
        where = "InerterLibrary"
        if isinstance(self.terms, str):
            raise InputError("terms", expected="a sequence of ids", found=self.terms, where=where)
        slow = number("transition_speed", self.transition_speed, at_least=0.0, where=where)
        friction = Column(_FRICTION, (("transition_speed", slow),))
        chosen = [_checked_column(friction if t == _FRICTION else t) for t in self.terms]
        for order in np.atleast_1d(finite_array("orders", self.orders, min_size=0, where=where)):
            value = number("order", order, at_least=0.0, at_most=2.0, where=where)
            chosen.append(Column(_FRACTIONAL, (("order", value),)))
        powers = finite_array("exponents", self.exponents, min_size=0, where=where)
        for exponent in np.atleast_1d(powers):
            value = number("exponent", exponent, above=0.0, where=where)
            chosen.append(Column(_POWER, (("exponent", value),)))
        if not chosen:
            raise InputError("terms, orders, exponents", expected="not all empty", where=where)
        for column in chosen:
            if chosen.count(column) > 1:
                raise InputError("features", expected="distinct", found=f"{column}", where=where)
        return tuple(chosen)

    @property
    def nonnegative(self) -> tuple[int, ...]:
        """Positions of the features whose coefficient can't be negative."""
        return tuple(i for i, c in enumerate(self.columns) if find_term(c.id).nonnegative)

    @property
    def exclusive(self) -> tuple[tuple[int, ...], ...]:
        """Positions of the variants of one term (orders, exponents): one of each is enough."""
        variants: dict[str, list[int]] = {}
        for position, column in enumerate(self.columns):
            variants.setdefault(column.id, []).append(position)
        return tuple(tuple(v) for v in variants.values() if len(v) > 1)

    @x_sequence_or_item  # type: ignore[untyped-decorator]
    def fit(self, x_full: Sequence[Array], y: Any = None) -> Self:
        """Check the parameters and the input's shape.

        Parameters
        ----------
        x_full : array_like, shape (N, C), or list of them
            Displacement, velocity, acceleration; C from 1 to 3.
        y : None
            Not used.

        Returns
        -------
        InerterLibrary
        """
        one_of("kind", self.kind, get_args(SampledKind), where="InerterLibrary")
        self._steps(len(x_full))
        self.n_output_features_ = len(self.columns)
        inputs = {_checked_input(x).shape[1] for x in x_full}
        if len(inputs) > 1:
            raise InputError("trajectories", expected="of equally many columns", found=f"{inputs}")
        self.n_features_in_ = inputs.pop()
        return self

    @x_sequence_or_item  # type: ignore[untyped-decorator]
    def transform(self, x_full: Sequence[Array]) -> list[Any]:
        """Return the features of each trajectory.

        Parameters
        ----------
        x_full : array_like, shape (N, C), or list of them
            As in `fit`.

        Returns
        -------
        ndarray, shape (N, ``n_output_features_``), or list of them
            In SI units of the terms.
        """
        check_is_fitted(self)
        result = []
        for x, dt in zip(x_full, self._steps(len(x_full)), strict=True):
            values = _checked_input(x)
            if values.shape[1] != self.n_features_in_:
                raise InputError(
                    "X",
                    expected=f"of {self.n_features_in_} columns, as fitted",
                    found=f"{values.shape[1]}",
                    where="InerterLibrary",
                )
            features = self._features(values, dt)
            result.append(AxesArray(features, comprehend_axes(features)))
        return result

    def with_fitted_transition(
        self, x: Array | Sequence[Array], force: Array | Sequence[Array]
    ) -> InerterLibrary:
        """Return this library with the transition speed that fits measured force best.

        All its features are fitted beside the friction, so that none takes over what another has.

        Parameters
        ----------
        x : array_like, shape (N, C), or list of them
            As in `fit`.
        force : array_like, shape (N,) or (N, 1), or list of them
            Measured force, N.

        Returns
        -------
        InerterLibrary
            A new one.

        Raises
        ------
        InputError
            Where "coulomb-friction" is not among its terms, or shapes do not agree.
        """
        where = "InerterLibrary"
        if _FRICTION not in self.terms:
            raise InputError(
                "terms", expected=f"with {_FRICTION}", found=f"{self.terms}", where=where
            )
        motions = [np.asarray(m) for m in (x if isinstance(x, list | tuple) else [x])]
        forces = [
            finite_array("force", f, where=where).reshape(-1)
            for f in (force if isinstance(force, list | tuple) else [force])
        ]
        if [len(m) for m in motions] != [len(f) for f in forces]:
            raise InputError(
                "force", expected=f"of lengths {[len(m) for m in motions]}",
                found=f"{[len(f) for f in forces]}", where=where,
            )  # fmt: skip
        speeds = [f[:, 0] for f in self._features_of(motions, ("viscous-damping",), (), ())]
        rest = tuple(t for t in self.terms if t != _FRICTION)
        others = [np.empty((len(m), 0)) for m in motions]
        if rest or len(self.orders) or len(self.exponents):
            others = self._features_of(motions, rest, self.orders, self.exponents)
        found = fitted_transition(speeds, others, np.concatenate(forces))
        result: InerterLibrary = clone(self).set_params(transition_speed=found)
        return result

    def _features_of(
        self, motions: list[Array], terms: Sequence[str | Column], orders: Sequence[float],
        exponents: Sequence[float],
    ) -> list[Array]:
        """Return some of the features of each trajectory."""
        library = clone(self).set_params(terms=terms, orders=orders, exponents=exponents)
        return [np.asarray(f) for f in library.fit(motions).transform(motions)]

    def get_feature_names(self, input_features: Sequence[str] | None = None) -> list[str]:
        """Return a readable name of each feature.

        Parameters
        ----------
        input_features : sequence of str, optional
            Names of displacement and, where measured, velocity and acceleration; "x0", ...
            where absent. A derivative that is not measured is primed.

        Returns
        -------
        list of str
        """
        check_is_fitted(self)
        count = self.n_features_in_
        names = [f"x{i}" for i in range(count)] if input_features is None else list(input_features)
        if len(names) != count:
            raise InputError("input_features", expected=f"{count} names", found=f"{names}")
        x = names[0]
        v = names[1] if count > 1 else f"{x}'"
        a = names[2] if count > 2 else f"{x}''"
        return [_name(column, x, v, a) for column in self.columns]

    def calc_trajectory(self, diff_method: Any, x: Any, t: Any) -> Any:
        """Refuse a fit without the force.

        Raises
        ------
        InputError
            Always: pysindy would take the motion's own derivative for what is to be explained.
        """
        raise InputError("x_dot", expected="the measured force, (N, 1)", found="None")

    def _steps(self, trajectories: int) -> list[float]:
        where = "InerterLibrary"
        if np.ndim(self.dt) == 0:
            return [number("dt", self.dt, above=0.0, where=where)] * trajectories
        steps = [number("dt", dt, above=0.0, where=where) for dt in np.asarray(self.dt)]
        if len(steps) != trajectories:
            raise InputError(
                "dt", expected=f"one for each of {trajectories} trajectories",
                found=f"{len(steps)}", where=where,
            )
        return steps

    def _features(self, values: Array, dt: float) -> Array:
        columns = self.columns
        motion = sampled_motion(dt * np.arange(len(values)), values[:, 0], kind=self.kind)
        if values.shape[1] > 1:
            motion = replace(motion, velocity=values[:, 1])
        if values.shape[1] > 2:
            motion = replace(motion, acceleration=values[:, 2])
        result = np.empty((len(values), len(columns)))
        shaped = [i for i, c in enumerate(columns) if c.id == _FRACTIONAL]
        if shaped:
            orders = [dict(columns[i].shape)["order"] for i in shaped]
            result[:, shaped] = motion.fractional(orders).T
        for i, column in enumerate(columns):
            if column.id != _FRACTIONAL:
                result[:, i] = _column_values(column, motion)
        return result


def _column_values(column: Column, motion: Motion) -> Array:
    function = find_term(column.id).column
    if function is None:
        raise InputError("term", expected="a force that adds", found=column.id)
    return function(motion, dict(column.shape))


def _checked_column(given: str | Column) -> Column:
    column = Column(given) if isinstance(given, str) else given
    if not isinstance(column, Column):
        raise InputError("term", expected="an id or a Column", found=repr(given))
    term = find_term(column.id, where="terms")
    if term.column is None:
        raise InputError(
            "term", expected="a force with a coefficient", found=column.id, where="terms"
        )
    given_shape = dict(column.shape)
    if isinstance(given, str) and column.id in (_FRACTIONAL, _POWER):
        name = term.parameters[0].name
        raise InputError(f"{name}s", expected=f"given for {column.id}", found="a bare id")
    return Column(column.id, tuple(sorted(term.shape(given_shape).items())))


def _checked_input(x: Array) -> Array:
    values = finite_array("X", np.asarray(x), where="InerterLibrary")
    if values.ndim == 1:
        values = values[:, None]
    if values.ndim != 2 or not 1 <= values.shape[1] <= 3:
        raise InputError(
            "X",
            expected="(N, 1) displacement, or with velocity and acceleration (N, 2) or (N, 3)",
            found=f"shape {values.shape}",
            where="InerterLibrary",
        )
    if len(values) < _FEWEST:
        raise InputError("X", expected=f"at least {_FEWEST} samples long", found=f"{len(values)}")
    return values


def _name(column: Column, x: str, v: str, a: str) -> str:
    shape = dict(column.shape)
    if column.id in _NAMES:
        return _NAMES[column.id](x, v, a, shape)
    usual = {p.name: p.default for p in find_term(column.id).parameters if not p.scaled_by}
    usual |= {p.name: 0.0 for p in find_term(column.id).parameters if p.default == 0.0}
    told = {k: value for k, value in shape.items() if usual.get(k) != value}
    values = ", ".join(f"{k}={value:.4g}" for k, value in told.items())
    return f"{column.id}[{values}]({x})" if values else f"{column.id}({x})"
