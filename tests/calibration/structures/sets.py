"""The study's sets: which cases each seed holds."""

from __future__ import annotations

from collections.abc import Iterable

from tests.calibration.structures.case import Case
from tests.calibration.structures.devices import CORES, KINDS
from tests.calibration.structures.extras import EXTRAS
from tests.calibration.structures.friction import LAWS, SMOOTH
from tests.calibration.structures.outside import OUTSIDE
from tests.calibration.structures.plans import TWISTS

SEEDS = {"structures": 5, "two-boundaries": 8, "one-extra": 5, "outside": 5, "thin": 6}
"""Number of seeds of each set's kept table."""
SETS = tuple(SEEDS)
_BEHIND = ("series-compliance", "backlash")
_SINES = ("plain", "harmonics", "short")


def cases(name: str, seeds: Iterable[int]) -> list[Case]:
    """Return the cases of a set.

    Parameters
    ----------
    name : str
        One of `SETS`. "structures" holds 50 cases a seed (five kinds x ten friction laws; over
        five seeds each pair meets each twist of the plan once), "two-boundaries" 8 (five with
        three bands, three with a gradual boundary), "one-extra" 35 (seven extras x five kinds),
        "outside" 45 (nine effects x five kinds), "thin" 40 (four kinds x ten laws).
    seeds : iterable of int
        Apart from other seeds in every draw.
    """
    makers = {
        "structures": _structures, "two-boundaries": _two_boundaries, "one-extra": _one_extra,
        "outside": _outside, "thin": _thin,
    }
    return [case for seed in seeds for case in makers[name](seed)]


def _structures(seed: int) -> list[Case]:
    found = []
    for k, kind in enumerate(KINDS):
        for n, law in enumerate(LAWS):
            twist = TWISTS[(k + 2 * n + seed) % len(TWISTS)]
            found.append(Case("structures", kind, law, twist, "", seed, len(found)))
    return found


def _two_boundaries(seed: int) -> list[Case]:
    found = []
    for n in range(8):
        kind = "three-bands" if n < 5 else "gradual"
        law = LAWS[(8 * seed + n) % len(LAWS)]
        twist = _SINES[(seed + n) % len(_SINES)]
        found.append(Case("two-boundaries", kind, law, twist, "", seed, n))
    return found


def _one_extra(seed: int) -> list[Case]:
    found = []
    for e, effect in enumerate(EXTRAS):
        laws = SMOOTH if effect in _BEHIND else LAWS
        for k, kind in enumerate(KINDS):
            law = laws[(3 * seed + 5 * e + k) % len(laws)]
            twist = "plain" if effect == "backlash" else _SINES[(seed + e + k) % len(_SINES)]
            found.append(Case("one-extra", kind, law, twist, effect, seed, len(found)))
    return found


def _outside(seed: int) -> list[Case]:
    found = []
    for e, effect in enumerate(OUTSIDE):
        for k, kind in enumerate(KINDS):
            law = LAWS[(3 * seed + 7 * e + k) % len(LAWS)]
            twist = _SINES[(seed + e + k) % len(_SINES)]
            found.append(Case("outside", kind, law, twist, effect, seed, len(found)))
    return found


def _thin(seed: int) -> list[Case]:
    found = []
    for kind in CORES:
        for law in LAWS:
            found.append(Case("thin", kind, law, "plain", "", seed, len(found)))
    return found
