"""Rows of a record that is no sine test: the lines of its windows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from discover.motion_fit import Lines, Observation, Window, real_rows
from discover.rows.record_rows import RecordRows
from models.checks import Array

_TOLERANCE = 3e-5  # of a record's force: no model is better
_MOST_HATS = 8  # functions of frequency that a smooth response is made of
_GROWS = 0.5  # power of the local force's power, with which that of what models miss grows
_UNSEEN = 1e-24  # of the greatest energy: a function of the remainder that no line shows
_PER_E_FOLD = 3.0  # levels of force that are told apart, for each factor e of frequency
_PRODUCTS = ((0, 0), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
"""Powers of displacement and velocity whose products stand for a static law."""


def band_rows(observation: Observation) -> RecordRows:
    """Return the rows of a sweep, a random record, an earthquake, a multisine or a trajectory."""
    windows = observation.windows
    power = sum(w.share * w.power for w in windows)
    scales = [
        np.tile(1.0 / np.sqrt(w.variance + _TOLERANCE**2 * power / w.omega.size), 2)
        for w in windows
    ]

    def of_motion(columns: Array) -> Array:
        parts = [real_rows(w.project(columns)) * s for w, s in zip(windows, scales, strict=True)]
        return np.concatenate(parts, axis=-1)

    lines = [real_rows(w.force) * s for w, s in zip(windows, scales, strict=True)]
    size = np.sqrt(power) * np.concatenate(scales)
    ends = np.cumsum([0, *(s.size for s in scales)])
    motion = replace(observation.motion, test=observation.test)
    return RecordRows(
        observation=observation,
        motion=motion,
        cycle=None,
        target=np.concatenate(lines),
        size=size,
        of_motion=of_motion,
        cycle_rows=None,
        remainder=_remainder(observation, of_motion, scales, power),
        loudness=np.stack([np.zeros_like(size), size * np.sqrt(_local(windows))]),
        windows=tuple(slice(int(a), int(b)) for a, b in zip(ends[:-1], ends[1:], strict=True)),
    )


def _remainder(
    observation: Observation, of_motion: object, scales: list[Array], power: float
) -> Array:
    """Return generic functions of the motion: a smooth response to speed, and a static law, (F, R).

    Each makes the record's own force; together they do, too.
    """
    motion, windows = observation.motion, observation.windows
    x = motion.displacement - motion.displacement.mean()
    v = motion.velocity
    x, v = (c / max(float(np.abs(c).max()), 1e-300) for c in (x, v))
    products = np.stack([x**i * v**j for i, j in _PRODUCTS])
    found = []
    responses = [w.project(v) for w in windows]
    hats = _hats(windows, responses)
    for w, s, lines, over in zip(windows, scales, responses, hats, strict=True):
        static = w.project(products)
        linear = np.concatenate([over * lines, 1j * over * lines])
        found.append((real_rows(np.concatenate([linear, static])), s, w.share))
    energy = sum(share * np.sum(rows**2, axis=1) for rows, _, share in found)
    shown = energy > _UNSEEN * energy.max()
    unit = np.where(shown, np.sqrt(power / energy.size / np.where(shown, energy, 1.0)), 0.0)
    return np.concatenate([rows * unit[:, None] * s for rows, s, _ in found], axis=1)


def _local(windows: tuple[Window, ...]) -> Array:
    """Return the share (R,) of a window's independent error that is in each row.

    What models miss is larger where the force is, but not as much: over ten measured machines its
    amplitude goes as the force's to a power from about 0 to about 1, 0.6 in the middle.
    """
    omega = np.concatenate([w.omega for w in windows])
    power = np.concatenate([np.abs(w.force) ** 2 for w in windows])
    lowest = omega[omega > 0.0].min()
    place = np.log(np.maximum(omega, lowest))
    count = max(int(np.ceil(_PER_E_FOLD * np.ptp(place))), 1)
    cell = np.minimum(((place - place.min()) / max(float(np.ptp(place)), 1e-9) * count).astype(int),
                      count - 1)
    number = np.maximum(np.bincount(cell, minlength=count), 1)
    level = np.bincount(cell, power, minlength=count) / number
    middle = place.min() + (np.arange(count) + 0.5) * float(np.ptp(place)) / count
    shown = level > 0.0
    found = []
    for w in windows:
        at = np.log(np.maximum(w.omega, lowest))
        own = np.exp(_GROWS * np.interp(at, middle[shown], np.log(level[shown])))
        found.append(np.tile(own / own.sum() / 2.0, 2))
    return np.concatenate(found)


def _hats(windows: tuple[Window, ...], responses: list[Lines]) -> list[Array]:
    """Return hat functions (H, L) of the logarithm of frequency, from where motion begins."""
    omega = np.concatenate([w.omega for w in windows])
    moving = np.concatenate([np.abs(r) ** 2 for r in responses])
    order = np.argsort(omega)
    total = np.cumsum(moving[order])
    first = omega[order][np.searchsorted(total, 0.02 * total[-1])]
    low, high = np.log(np.maximum([first, omega.max()], 1e-12))
    count = int(np.clip(np.ceil(high - low), 1, _MOST_HATS - 1)) + 1
    nodes = np.linspace(low, high, count)
    width = max((high - low) / (count - 1), 1e-6)
    result = []
    for w in windows:
        place = np.clip(np.log(np.maximum(w.omega, 1e-12)), low, high)
        result.append(np.maximum(1.0 - np.abs(place - nodes[:, None]) / width, 0.0))
    return result
