"""A term is named only if it explains more than the model leaves unexplained.

Where the misfit is far above the noise, what remains is an effect that no term here is, and a
further term that takes a small part of it has likely taken something else's name. So a term's own
gain (misfit energy without it less with it) must exceed the energy that remains above the noise.
The same holds for a shape: an order or exponent is named only if it explains more, over the
nearest plain terms, than remains. Where noise is the limit nothing remains, and the rule never
bites: evidence alone decides.

The energies are relative to each record's force, so that quiet records count as loud ones do.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, Support, SupportFit
from discover.triangle import Triangle, WindowRows, reduce_rows

_PLAIN_KIN = {
    "fractional-derivative": ("inertia", "viscous-damping", "stiffness"),
    "power-law-damping": ("coulomb-friction", "viscous-damping", "quadratic-damping"),
}
NEGLIGIBLE = 1e-3
"""Share of the force below which, in every record, a change is not seen."""
_RELATIVE_UNIT = 0.01  # a row's error over the force, as weighed against prior knowledge
_AT_BOUND = 1e-3  # of the range: a shape this near its end is not identified


def record_power(windows: Sequence[WindowRows]) -> dict[int, float]:
    """Return the mean square of each record's force over its windows."""
    power: dict[int, float] = {}
    share: dict[int, float] = {}
    for w in windows:
        power[w.record] = power.get(w.record, 0.0) + w.share * w.power
        share[w.record] = share.get(w.record, 0.0) + w.share
    return {r: max(power[r] / share[r], 1e-300) for r in power}


def relative_triangle(windows: Sequence[WindowRows]) -> Triangle:
    """Return the triangle with every record's rows over its force's root mean square."""
    power = record_power(windows)
    matrix = np.concatenate([w.matrix * np.sqrt(w.share / power[w.record]) for w in windows])
    rows = int(sum(w.count.sum() for w in windows))
    return Triangle(reduce_rows(matrix), rows, 0.0, unit=_RELATIVE_UNIT)


def noise_energy(windows: Sequence[WindowRows]) -> tuple[float, float]:
    """Return the expected misfit energy of noise in the relative triangle, and its deviation."""
    power = record_power(windows)
    scales = np.concatenate([w.variance * w.share / power[w.record] for w in windows])
    counts = np.concatenate([w.count for w in windows])
    return float(counts @ scales), float(np.sqrt(2.0 * counts @ scales**2))


class Worth:
    """Tells whether a term changes any record's force by enough to be worth a name."""

    def __init__(self, windows: Sequence[WindowRows], fits: Sequence[SupportFit]) -> None:
        self._rows = [w.matrix[:, :-1] / np.sqrt(max(w.power, 1e-300)) for w in windows]
        self._fits = {_key(f.support): f for f in fits if f.valid}

    def all_terms(self, fit: SupportFit) -> bool:
        """Return whether leaving out any one term, all else refitted, shows in some record.

        A term whose absence changes the model's force by less than a thousandth everywhere is
        not seen by any load cell, nor by a fitted curve of friction.
        """
        for identifier in fit.support.ids:
            less = self._fits.get(_key(without(fit.support, identifier)))
            if less is None:
                continue
            change = fit.combined - less.combined
            if max(float(np.linalg.norm(r @ change)) for r in self._rows) < NEGLIGIBLE:
                return False
        return True


def _key(support: Support) -> tuple[frozenset[object], ...]:
    return frozenset(support.plain), frozenset(support.free), frozenset(support.fixed)


class Materiality:
    """Judges supports by what each of their terms explains on its own."""

    def __init__(self, windows: Sequence[WindowRows], dictionary: Dictionary) -> None:
        self._engine = ProfiledFit(relative_triangle(windows), dictionary)
        noise, deviation = noise_energy(windows)
        self._noise = noise + 3.0 * deviation
        self._misfit: dict[tuple[frozenset[object], ...], float] = {}

    def misfit(self, support: Support) -> float:
        """Return the relative misfit energy of a support, fitted in this metric."""
        key = _key(support)
        if key not in self._misfit:
            self._misfit[key] = self._engine.fit(support).chi2
        return self._misfit[key]

    def unexplained(self, support: Support) -> float:
        """Return the misfit energy above the noise."""
        return max(self.misfit(support) - self._noise, 0.0)

    def weakest(self, support: Support) -> tuple[str, float]:
        """Return the term that explains least, and its gain over what remains unexplained."""
        left = max(self.unexplained(support), 1e-30)
        own = self.misfit(support)
        gains = [(i, (self.misfit(without(support, i)) - own) / left) for i in support.ids]
        gains += [
            (i, (self.misfit(replaced(support, i, plain)) - own) / left)
            for i in support.free
            for plain in _PLAIN_KIN[i]
            if self._engine.dictionary.has(plain)
        ]
        return min(gains, key=lambda g: g[1], default=("", np.inf))

    def holds(self, support: Support) -> bool:
        """Return whether every term, and every shape, explains more than remains unexplained."""
        if self.unexplained(support) == 0.0:
            return True
        fit = self._engine.fit(support)
        for identifier, value in zip(support.free, fit.shapes, strict=False):
            found = self._engine.dictionary.family(identifier)
            if found is not None:
                margin = _AT_BOUND * (found[0].upper - found[0].lower)
                if not found[0].lower + margin < value < found[0].upper - margin:
                    return False
        return self.weakest(support)[1] >= 1.0


def replaced(support: Support, identifier: str, plain: str) -> Support:
    """Return the support with a free family replaced by a plain term."""
    rest = without(support, identifier)
    if plain in rest.plain:
        return rest
    return Support((*rest.plain, plain), rest.free, rest.fixed)


def without(support: Support, identifier: str) -> Support:
    """Return the support less one term."""
    return Support(
        tuple(i for i in support.plain if i != identifier),
        tuple(i for i in support.free if i != identifier),
        tuple((i, v) for i, v in support.fixed if i != identifier),
    )
