"""The candidate columns of a study, evaluated once for each record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.library.family import Family
from models.checks import Array
from models.motion import Motion
from models.terms import find_term

DELAY = "time-delay"
PLAIN = (
    "inertia",
    "viscous-damping",
    "quadratic-damping",
    "stiffness",
    "cubic-stiffness",
    "force-offset",
    "asymmetric-damping",
)
_TRANSITIONS = 9
_ORDER_NODES = 17
_EXPONENT_NODES = 17
_EXPONENTS = (0.4, 3.0)
_REVERSAL = (0.25, 0.5, 2.0, 4.0, 8.0, 16.0)  # with these, measured curves fit to a thousandth
_NO_MEAN = 1e-12  # least order: the limit of order zero from above, which a mean does not enter


@dataclass(frozen=True)
class Column:
    """One fixed column: a term with its shape."""

    id: str
    """The term."""
    shape: tuple[tuple[str, float], ...] = ()
    """Shape parameters, SI."""


@dataclass(frozen=True)
class Dictionary:
    """Fixed columns, families with a continuous shape, and the delay of the force channel."""

    columns: tuple[Column, ...]
    """Fixed columns, first in the matrix."""
    families: tuple[Family, ...]
    """Families, next; each takes as many columns as it has nodes."""
    delay: bool = True
    """Whether the last column is the force's slope in time, which a channel delay leaves."""
    reversal: tuple[Column, ...] = ()
    """Friction at other transition speeds, less friction at the fitted one: how the true curve of
    reversal may differ from the fitted curve. Marginalised in every fit, never selected."""
    reversal_scale: float = 1.0
    """N: standard deviation of their coefficients beforehand."""

    @property
    def size(self) -> int:
        """Number of columns."""
        return self._reversal_start + len(self.reversal) + int(self.delay)

    @property
    def _reversal_start(self) -> int:
        return len(self.columns) + sum(f.count for f in self.families)

    @property
    def reversal_positions(self) -> slice:
        """Positions of the reversal columns, before the delay's."""
        return slice(self._reversal_start, self._reversal_start + len(self.reversal))

    def index(self, identifier: str) -> int:
        """Return the position of the first fixed column of a term (or of the delay)."""
        if identifier == DELAY and self.delay:
            return self.size - 1
        return next(i for i, c in enumerate(self.columns) if c.id == identifier)

    def has(self, identifier: str) -> bool:
        """Return whether a term has a fixed column here (or is the delay)."""
        return (identifier == DELAY and self.delay) or any(
            c.id == identifier for c in self.columns
        )

    def family(self, identifier: str) -> tuple[Family, slice] | None:
        """Return a family and the positions of its nodes' columns."""
        start = len(self.columns)
        for family in self.families:
            if family.id == identifier:
                return family, slice(start, start + family.count)
            start += family.count
        return None

    def evaluate(self, motion: Motion) -> Array:
        """Return the columns that are functions of the motion, (K, N)."""
        blocks = []
        for column in self.columns:
            function = find_term(column.id).column
            if function is not None:
                blocks.append(function(motion, dict(column.shape))[None])
        for family in self.families:
            scale = family.reference ** -family.nodes
            if family.parameter == "order":
                values = motion.fractional(np.maximum(family.nodes, _NO_MEAN))
            else:
                speed = np.abs(motion.velocity)
                values = np.sign(motion.velocity) * speed ** family.nodes[:, None]
            blocks.append(values * scale[:, None])
        if self.reversal:
            function = find_term("coulomb-friction").column
            if function is not None:
                own = function(motion, dict(self.columns[self.index("coulomb-friction")].shape))
                blocks.append(
                    np.stack([function(motion, dict(c.shape)) - own for c in self.reversal])
                )
        return np.concatenate(blocks)

    @property
    def transition_speeds(self) -> Array:
        """Transition speeds of the friction columns, rising; (V,) m/s."""
        return np.array(
            [dict(c.shape)["transition_speed"] for c in self.columns if c.id == "coulomb-friction"]
        )

    def with_transitions(self, speeds: Sequence[float] | Array) -> Dictionary:
        """Return the dictionary with friction at these transition speeds instead."""
        others = [c for c in self.columns if c.id != "coulomb-friction"]
        columns = (*others, *(friction_column(v) for v in speeds))
        return replace(self, columns=columns)

    def with_reversal(self, scale: float) -> Dictionary:
        """Return the dictionary with room for another curve of reversal.

        Parameters
        ----------
        scale : float
            Standard deviation of each coefficient beforehand, N; half the friction is a good one.
        """
        speed = float(self.transition_speeds[0])
        columns = tuple(friction_column(speed * step) for step in _REVERSAL)
        return replace(self, reversal=columns, reversal_scale=scale)

    def restricted(self, columns: Sequence[Column]) -> tuple[Dictionary, list[int]]:
        """Return the dictionary with only these fixed columns, and the positions that it keeps."""
        kept = [i for i, c in enumerate(self.columns) if c in columns]
        rest = list(range(len(self.columns), self.size))
        small = replace(self, columns=tuple(self.columns[i] for i in kept))
        return small, kept + rest


def friction_column(transition_speed: float) -> Column:
    """Return Coulomb friction that reverses over a transition speed, m/s; 0 for a jump."""
    return Column("coulomb-friction", (("transition_speed", float(transition_speed)),))


def standard_dictionary(
    speeds: Array,
    omegas: Array,
    *,
    terms: Sequence[str] = PLAIN,
    orders: tuple[float, float] = (0.0, 2.0),
    exponents: tuple[float, float] = _EXPONENTS,
    delay: bool = True,
) -> Dictionary:
    """Return the dictionary for records of these speed amplitudes and frequencies.

    Parameters
    ----------
    speeds : ndarray, shape (R,)
        Speed amplitude of each record, m/s.
    omegas : ndarray, shape (R,)
        Angular frequency of each record, rad/s.
    terms : sequence of str
        Ids of the fixed columns wanted besides friction.
    orders, exponents : tuple of float
        Range of the fractional order and of the velocity exponent.
    delay : bool
        Whether a delay of the force channel is a candidate.

    Returns
    -------
    Dictionary
        Friction stands in it once with a jump and at nine transition speeds.
    """
    plain = [Column(t) for t in terms]
    low, high = 0.05 * float(np.min(speeds)), 0.3 * float(np.median(speeds))
    transitions = [0.0, *np.geomspace(low, max(high, 4.0 * low), _TRANSITIONS)]
    friction = [friction_column(v) for v in transitions]
    reference = float(np.exp(np.mean(np.log(omegas))))
    families = (
        Family("fractional-derivative", "order", *orders, _ORDER_NODES, reference),
        Family(
            "power-law-damping", "exponent", *exponents, _EXPONENT_NODES, float(np.max(speeds))
        ),
    )
    return Dictionary((*plain, *friction), families, delay)
