"""The device behind a joint: a spring, and the mass and resistances that fit its other force.

What these leave of it and is a curve of speed, as that of a valve or of thinning oil, is behind
a spring too. The rest, as a memory's, moves with the driven end.
"""

from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self
from weakref import ReferenceType, ref

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.compiled import compiled
from models.motion import Motion
from models.terms.hysteresis import bristle_state
from models.terms.speed_curve import SpeedCurves, nodes_of
from models.terms.stepping import on_curve
from models.terms.term import ForceOf, unchanged

_RIDGE = 1e-12
_LEAST_CURVE = 1e-5  # of the force's root mean square, of what else is a curve of speed
_SLOW = 0.002  # of the greatest speed: dry friction reverses over no less in time stepping
_REVERSALS = _SLOW * 1.6 ** np.arange(11.0)  # ranges of reversal tried, of the greatest speed
_LENGTHS = 0.25 * 2.0 ** (-0.5 * np.arange(24.0))  # tried, over which it deflects, of half a stroke
_BEYOND = 2.0  # ranges of reversal, where dry friction has reversed
_MOST_KNOWN = 32  # devices of one motion that are kept
_SEEN = 8192  # samples of a motion at least, by which a device is told where there are more


class JointDevice(NamedTuple):
    """A device as a joint drives it."""

    mass: float
    """kg."""
    viscous: float
    """Resistance, N s/m."""
    quadratic: float
    """Resistance, N s^2/m^2."""
    dry: float
    """Resistance, N."""
    reversal: float
    """m/s, range of speed over which the dry one reverses."""
    length: float
    """m over which it deflects instead before it slides; 0 where it does not."""
    spring: float
    """N/m."""
    curve: Array
    """N at the nodes of speed (`speed_curve`) up to `top`: what else depends on speed; empty where
    nothing does."""
    top: float
    """m/s."""

    def force(self, motion: Motion, *, dry: bool = True) -> Array:
        """Return the force (N,) in a motion, N; with or without the dry resistance."""
        known = _Known.of(motion)
        slides = self.dry if dry and self.length == 0.0 else 0.0
        found = _driven(
            known.place, motion.velocity, motion.acceleration, self.mass, self.viscous,
            self.quadratic, slides, self.reversal, self.spring, self.curve, self.top,
        )  # fmt: skip
        if dry and self.length > 0.0:
            found = found + self.dry * bristle_state(motion, self.length)
        return np.asarray(found)

    def for_spring(self) -> Self:
        """Return the same with as much of it dry as there is just beyond where that reverses.

        Beside more, the curve would fall steeply there, which can't be stepped. One that deflects
        stays as it is.
        """
        if not self.curve.size or self.length > 0.0:
            return self
        nodes, middle = nodes_of(self.top), self.curve.size // 2
        turned = np.tanh(nodes / self.reversal)
        whole = self.curve + self.dry * turned
        beyond = min(int(np.searchsorted(nodes[middle:], _BEYOND * self.reversal)), middle)
        there = min(whole[middle + beyond], -whole[middle - beyond]) / turned[middle + beyond]
        dry = max(float(there), 0.0)
        return self._replace(dry=dry, curve=np.asarray(whole - dry * turned))


@compiled(cache=True, nogil=True)
def _driven(
    x: Array, v: Array, a: Array, mass: float, viscous: float, quadratic: float, dry: float,
    reversal: float, spring: float, curve: Array, top: float,
) -> Array:
    """Return the force (N,) of a device whose friction does not deflect."""
    found = np.empty(v.size)
    for i in range(v.size):
        found[i] = mass * a[i] + (viscous + quadratic * abs(v[i])) * v[i] + spring * x[i]
        if dry != 0.0:
            found[i] += dry * np.tanh(v[i] / reversal)
        if curve.size > 0:
            found[i] += on_curve(curve, top, v[i])[0]
    return found


_NONE = np.zeros(0)


@dataclass(frozen=True)
class _Resistances:
    """What a device's force is made of: inertia, resistances, and one of T frictions."""

    columns: Array
    """(3 + T, N) those of acceleration, velocity and its square, then of the frictions."""
    scale: Array
    """(3 + T,) their sizes."""
    solving: Array
    """(T, 16, 4, 4) what makes coefficients of some of the first three and a friction from their
    products with a force; each of the 16 sets of them, zeros for the others."""

    @classmethod
    def of(cls, plain: Array, dry: Array) -> Self:
        """Return those of columns (3, N) that all have and of frictions (T, N)."""
        columns = np.concatenate([plain, dry])
        scale = np.sqrt(np.einsum("ij,ij->i", columns, columns))
        scale = np.where(scale > 0.0, scale, 1.0)
        gram = columns @ columns.T / np.outer(scale, scale)
        solving = np.zeros((len(dry), 16, 4, 4))
        at = _picked(len(dry))
        whole = gram[at[:, :, None], at[:, None]] + _RIDGE * np.eye(4)
        for some in range(1, 16):
            own = np.array([i for i in range(4) if some >> i & 1])
            inverse = np.linalg.inv(whole[:, own[:, None], own])
            solving[:, some, own[:, None], own] = inverse
        return cls(columns, scale, solving)

    def fitted(self, force: Array) -> tuple[Array, int]:
        """Return the coefficients (4,) that fit a force (N,) best, and the place of the friction.

        None is negative: the best of the sets of columns that need no negative one.
        """
        found, best = _not_negative(self.columns @ force / self.scale, self.solving)
        return found / self.scale[[0, 1, 2, 3 + best]], best


@compiled(cache=True, nogil=True)
def _not_negative(side: Array, solving: Array) -> tuple[Array, int]:
    """Return what `_Resistances.fitted` does, over columns of size one."""
    most, best, result = -1.0, 0, np.zeros(4)
    own, found = side[:4].copy(), np.zeros(4)
    for k in range(solving.shape[0]):
        own[3] = side[3 + k]
        for some in range(solving.shape[1]):
            gained, least = 0.0, 0.0
            for i in range(4):
                found[i] = 0.0
                for j in range(4):
                    found[i] += solving[k, some, i, j] * own[j]
                gained += found[i] * own[i]
                least = min(least, found[i])
            if least == 0.0 and gained > most:
                most, best = gained, k
                result[:] = found
    return result, best


def _picked(frictions: int) -> NDArray[np.intp]:
    """Return the places (T, 4) of what all devices have and of each friction."""
    return np.array([[0, 1, 2, 3 + k] for k in range(frictions)])


@dataclass(frozen=True)
class _Deflecting:
    """A spring and, one at a time, T frictions that deflect."""

    place: Array
    """(N,) m."""
    states: Array
    """(T, N) of the frictions."""
    own: Array
    """(T,) their squares."""
    across: Array
    """(T,) their products with the place."""
    determinant: Array
    """(T,) of the products of a friction and the spring."""

    @classmethod
    def of(cls, place: Array, states: Array) -> Self:
        """Return those of a place (N,) and of frictions' states (T, N)."""
        own, across = np.einsum("tn,tn->t", states, states), states @ place
        return cls(place, states, own, across, own * (place @ place) - across**2)

    def stiffness(self, lost: Array, alone: float) -> float:
        """Return the spring's stiffness, N/m, with the friction that fits a force (N,) best.

        That `alone` where no friction beside it fits better.
        """
        sought = lost - lost.mean()
        side, other = self.states @ sought, float(self.place @ sought)
        spring = self.place @ self.place
        friction = (spring * side - self.across * other) / self.determinant
        stiffness = (self.own * other - self.across * side) / self.determinant
        gained = np.where(friction > 0.0, friction * side + stiffness * other, -np.inf)
        best = int(gained.argmax())
        return float(stiffness[best]) if gained[best] > alone * other else alone


@dataclass
class _Known:
    """What was found out on a motion, which keeps it: one device is tried behind many joints."""

    place: Array
    """(N,) m, displacement about its mean."""
    devices: dict[tuple[int, bool, bool], tuple[ReferenceType[Array], JointDevice]] = field(
        default_factory=dict
    )
    """By the force's identity, whether it came without a model, whether friction may deflect."""
    resistances: dict[bool, _Resistances] = field(default_factory=dict)
    """By whether friction may deflect."""
    deflecting: _Deflecting | None = None
    """None where it was not asked for."""
    curves: SpeedCurves | None = None
    """None where they were not asked for."""
    still: Motion | None = None
    """The same speeds without displacement; None likewise, or where the motion is long."""

    @classmethod
    def of(cls, motion: Motion) -> Self:
        """Return what is known on a motion."""
        known: Self | None = motion.kept.get(__name__)
        if known is None:
            x = motion.displacement
            known = motion.kept.setdefault(__name__, cls(np.ascontiguousarray(x - x.mean())))
        return known


def device_of(
    force: Array, motion: Motion, force_of: ForceOf | None = None, *, deflects: bool = False
) -> JointDevice:
    """Return the device that fits a force best.

    None of its numbers but the spring's stiffness is negative; all are zero for a force that is
    not finite.

    Parameters
    ----------
    force : ndarray, shape (N,)
        The device's force, N.
    motion : Motion
        That it belongs to.
    force_of : callable, optional
        The device: what is lost without displacement is its spring's. At one frequency nothing
        else tells a spring from a mass.
    deflects : bool
        Whether dry friction may deflect before it slides.
    """
    here, key = _Known.of(motion), (id(force), force_of is None, deflects)
    devices = here.devices
    known = devices.get(key)
    if known is not None and known[0]() is force:
        return known[1]
    stiffness = 0.0 if force_of is None else _stiffness(force, motion, force_of, deflects=deflects)
    found = _device(force - stiffness * here.place, motion, deflects=deflects)
    found = found._replace(spring=stiffness)
    if len(devices) >= _MOST_KNOWN:
        devices.pop(list(devices)[0], None)  # threads may be here too
    devices[key] = ref(force), found
    return found


def at_rest(motion: Motion) -> Motion:
    """Return a motion of the same speeds that goes nowhere; the same one again where asked again.

    What a force loses in it is its springs'.
    """
    known = _Known.of(motion)
    if known.still is not None:
        return known.still
    still = replace(motion, displacement=np.zeros_like(motion.displacement))
    if still.displacement.size <= _SEEN:
        known.still = still
    return still


def _stiffness(force: Array, motion: Motion, force_of: ForceOf, *, deflects: bool) -> float:
    """Return the stiffness of what is lost without displacement, N/m.

    Friction that deflects is lost too: of both that is the spring which fits best beside it.
    """
    place, added = _Known.of(motion).place, unchanged(force_of)
    whole = force if added is force_of else added(motion)
    lost = whole - added(at_rest(motion))
    slope = float(lost @ place) / max(float(place @ place), 1e-300)
    if deflects and slope != 0.0 and np.isfinite(slope):
        slope = _deflecting_of(motion).stiffness(lost[_seen(motion)], slope)
    return slope if np.isfinite(slope) else 0.0


def _device(force: Array, motion: Motion, *, deflects: bool) -> JointDevice:
    """Return the device without a spring."""
    top = float(np.abs(motion.velocity).max())
    if not np.all(np.isfinite(force)) or top == 0.0:
        return JointDevice(0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, _NONE, 1.0)
    sought = force[_seen(motion)]
    sought = sought - sought.mean()
    resistances = _resistances_of(motion, deflects=deflects)
    found, best = resistances.fitted(sought)
    mass, viscous, quadratic, dry = (float(c) for c in found)
    speeds = _REVERSALS * top
    reversal, length = float(speeds[min(best, speeds.size - 1)]), 0.0
    if best >= speeds.size:
        length = float(_lengths_of(motion)[best - speeds.size])
    device = JointDevice(mass, viscous, quadratic, dry, reversal, length, 0.0, _NONE, top)
    left = sought - found @ resistances.columns[[0, 1, 2, 3 + best]]
    curve = _curves_of(motion).fitted(left)
    least = _LEAST_CURVE * float(np.sqrt(np.mean(sought**2)))
    return device._replace(curve=curve) if np.abs(curve).max() > least else device


def _resistances_of(motion: Motion, *, deflects: bool) -> _Resistances:
    """Return what devices on a motion are made of, evaluated once."""
    known = _Known.of(motion).resistances
    if deflects not in known:
        top, seen = float(np.abs(motion.velocity).max()), _seen(motion)
        v, a = motion.velocity[seen], motion.acceleration[seen]
        plain = np.stack([a, v, v * np.abs(v)])
        dry = np.tanh(v / (_REVERSALS[:, None] * top))
        if deflects:
            states = [bristle_state(motion, length)[seen] for length in _lengths_of(motion)]
            dry = np.concatenate([dry, states])
        known[deflects] = _Resistances.of(plain, dry)
    return known[deflects]


def _deflecting_of(motion: Motion) -> _Deflecting:
    """Return what tells a spring from friction that deflects in a motion, evaluated once."""
    known = _Known.of(motion)
    if known.deflecting is None:
        states = _resistances_of(motion, deflects=True).columns[3 + _REVERSALS.size :]
        known.deflecting = _Deflecting.of(known.place[_seen(motion)], states)
    return known.deflecting


def _lengths_of(motion: Motion) -> Array:
    """Return the lengths over which friction may deflect in a motion, m."""
    return np.asarray(_LENGTHS * 0.5 * np.ptp(motion.displacement))


def _curves_of(motion: Motion) -> SpeedCurves:
    """Return what fits curves of speed on a motion, made once."""
    known = _Known.of(motion)
    if known.curves is None:
        known.curves = SpeedCurves.of(motion.velocity[_seen(motion)])
    return known.curves


def _seen(motion: Motion) -> slice:
    """Return the samples by which a device is told: all of a cycle, every so many of a long run."""
    return slice(None, None, max(motion.velocity.size // _SEEN, 1))
