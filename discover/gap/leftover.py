"""What is left unexplained, described: symmetry, harmonics, growth, memory."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.gap.where import Place, misfit_at_samples, phase_means
from discover.rows import RecordRows, force_at_samples
from models.checks import Array
from models.constitutive import ForceModel

_FEWEST = 5  # sine tests from which growth and memory can be told
_SPAN = 1.5  # ratio that a plan has to cover for a power of it
_DEGREE = 5  # of the polynomial in displacement and velocity
_FUNCTION, _NO_FUNCTION = 0.85, 0.6  # shares explained by displacement and velocity alone
_MAJOR = 0.15  # of the energy, from which a harmonic is listed


def leftover_in_words(
    rows: Sequence[RecordRows], found: Sequence[Place], models: Sequence[ForceModel]
) -> str:
    """Return the shape of the misfit in sine tests where it stands above the noise.

    Parameters
    ----------
    rows : sequence of RecordRows
        All records.
    found : sequence of Place
        `where.places` of the same records.
    models : sequence of ForceModel
        What leaves the misfit in each.

    Returns
    -------
    str
        "" where no sine test shows it.
    """
    pairs = [
        (r, m)
        for r, p, m in zip(rows, found, models, strict=True)
        if p.significant and r.observation.kind == "sine"
    ]
    if not pairs:
        return ""
    shown = [r for r, _ in pairs]
    lines = [_lines(r, m) for r, m in pairs]
    energies = [_above_noise(r, own) for r, own in zip(shown, lines, strict=True)]
    parts = [_symmetry(energies), _phase(shown, lines), _growth(shown, energies)]
    return "; ".join(p for p in (*parts, _memory(pairs)) if p)


def _lines(rows: RecordRows, model: ForceModel) -> Array:
    """Return the misfit's lines (H,), N, less the mean; real parts are in phase with velocity."""
    window = rows.observation.windows[0]
    modelled = window.project(force_at_samples(rows.observation, model))
    return np.asarray((window.force - modelled)[1:])


def _above_noise(rows: RecordRows, lines: Array) -> Array:
    """Return the energy (H,) of each harmonic above the noise, N^2."""
    noise = 2.0 * rows.observation.windows[0].variance[1:]
    return np.asarray(np.maximum(np.abs(lines) ** 2 - noise, 0.0))


def _symmetry(energies: Sequence[Array]) -> str:
    size = max(e.size for e in energies)
    whole = sum(np.pad(e / max(e.sum(), 1e-300), (0, size - e.size)) for e in energies)
    share = np.asarray(whole) / max(float(np.sum(whole)), 1e-300)
    odd = float(share[::2].sum())
    named = ", ".join(str(k + 1) for k in np.flatnonzero(share > _MAJOR))
    turned = "odd" if odd > 0.8 else "even" if odd < 0.2 else "neither odd nor even"
    harmonics = f", mostly in harmonic {named}" if named else ""
    return f"it is {turned} when the motion is turned round{harmonics}"


def _phase(rows: Sequence[RecordRows], lines: Sequence[Array]) -> str:
    first = np.array([own[0] for own in lines])
    power = np.abs(first) ** 2 / np.array([r.observation.windows[0].power for r in rows])
    along = float(power @ np.cos(np.angle(first)) ** 2 / max(power.sum(), 1e-300))
    if along > 0.8:
        return "its fundamental resists or drives the motion (in phase with velocity)"
    if along < 0.2:
        return "its fundamental stores energy (in phase with displacement)"
    return ""


def _growth(rows: Sequence[RecordRows], energies: Sequence[Array]) -> str:
    """Return how the misfit's size grows with frequency and amplitude: powers, ± two deviations."""
    if len(rows) < _FEWEST:
        return ""
    size = 0.5 * np.log(np.array([max(float(e.sum()), 1e-300) for e in energies]))
    plan = {
        "frequency": np.log([r.observation.windows[0].frequency for r in rows]),
        "amplitude": np.log([r.observation.windows[0].amplitude for r in rows]),
    }
    plan = {name: v for name, v in plan.items() if np.ptp(v) > np.log(_SPAN)}
    design = np.column_stack([np.ones(len(rows)), *plan.values()])
    if not plan or np.linalg.matrix_rank(design) < design.shape[1]:
        return ""
    solution, _, _, _ = np.linalg.lstsq(design, size, rcond=None)
    left = size - design @ solution
    spread = float(left @ left) / max(len(rows) - design.shape[1], 1)
    errors = np.sqrt(spread * np.diagonal(np.linalg.inv(design.T @ design)))
    powers = " and ".join(
        f"{name}^({p:.1f} ± {2.0 * e:.1f})"
        for name, p, e in zip(plan, solution[1:], errors[1:], strict=True)
    )
    return f"its size grows as {powers}"


def _memory(pairs: Sequence[tuple[RecordRows, ForceModel]]) -> str:
    """Return whether one function of displacement and velocity makes it in all tests."""
    rows = [r for r, _ in pairs]
    if len(rows) < _FEWEST:
        return ""
    top = max(r.observation.windows[0].amplitude for r in rows)
    pace = max(r.observation.windows[0].speed for r in rows)
    blocks, targets = [], []
    powers = [(i, j) for i in range(_DEGREE + 1) for j in range(_DEGREE + 1 - i)]
    for r, model in pairs:
        o = r.observation
        x, v, mean = (
            phase_means(o, c)[0]
            for c in (
                o.at_samples(o.motion.displacement),
                o.at_samples(o.motion.velocity),
                misfit_at_samples(r, model),
            )
        )
        level = max(float(np.sqrt(np.mean(mean**2))), 1e-300)
        blocks.append(np.stack([(x / top) ** i * (v / pace) ** j for i, j in powers]) / level)
        targets.append(mean / level)
    design, target = np.concatenate(blocks, axis=1).T, np.concatenate(targets)
    solution = np.linalg.lstsq(design, target, rcond=1e-9)[0]
    share = 1.0 - float(np.sum((target - design @ solution) ** 2) / (target @ target))
    if share > _FUNCTION:
        return (
            f"one smooth function of displacement and velocity makes {100.0 * share:.0f} % of it"
            " in all tests, without memory"
        )
    if share < _NO_FUNCTION:
        return (
            f"no smooth function of displacement and velocity makes more than"
            f" {100.0 * share:.0f} % of it: it jumps, remembers, or follows acceleration or time"
        )
    return ""
