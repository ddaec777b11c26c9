"""Harmonic balance against long simulations, closed forms, and its own convergence."""

from __future__ import annotations

import numpy as np
import pytest

from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel, sfoim
from models.device import Device
from models.harmonic_balance import (
    Branch,
    SineDrive,
    SteadyState,
    frequency_response,
    steady_state,
    unstable_exponents,
)
from models.simulation import PeriodicPast, simulate, sine_load
from models.structure import Mount, Structure, chain, oscillator

CYCLE = 2.0 * np.pi


def law(*terms: tuple[str, float] | tuple[str, float, dict[str, float]]) -> ForceModel:
    return ForceModel(tuple(FittedTerm(*t) for t in terms))


def seeded_case(seed: int) -> tuple[Structure, SineDrive]:
    """A hardening oscillator with memory, drag, and in every second case friction, that folds."""
    rng = np.random.default_rng(seed)
    terms = [
        FittedTerm("cubic-stiffness", rng.uniform(0.4, 0.8)),
        FittedTerm(
            "fractional-derivative", rng.uniform(0.04, 0.08), {"order": rng.uniform(0.4, 1.8)}
        ),
        FittedTerm("quadratic-damping", rng.uniform(0.0, 0.02)),
        FittedTerm("power-law-damping", rng.uniform(0.0, 0.02), {"exponent": 1.75}),
    ]
    if seed % 2:
        terms.append(FittedTerm("coulomb-friction", rng.uniform(0.01, 0.05)))
    return oscillator(1.0, 1.0, ForceModel(tuple(terms))), SineDrive(rng.uniform(0.4, 0.6))


def agreement(state: SteadyState, *, cycles: int = 40) -> tuple[float, float]:
    """Return errors of amplitude and waveform after many simulated cycles, relative."""
    period = 1.0 / state.frequency
    load = sine_load(state.drive.amplitude, state.frequency, acts=state.drive.acts)
    response = simulate(
        state.structure, load, step=period / 2000, duration=cycles * period,
        past=PeriodicPast(state.coefficients, state.frequency), estimate_error=False,
    )  # fmt: skip
    last = response.displacement[-2001:]
    time = response.time[-2001:]
    scale = state.amplitude.max()
    size = np.abs(np.ptp(last, axis=0) / 2.0 - state.amplitude).max() / scale
    shape = np.abs(last - state.displacement(time)).max() / scale
    return float(size), float(shape)


def stable_states(branch: Branch, frequency: float) -> list[SteadyState]:
    """Return the stable steady states at a frequency, one for each passage of the branch."""
    found = []
    f = branch.frequency
    for i in range(f.size - 1):
        if (f[i] - frequency) * (f[i + 1] - frequency) < 0.0:
            near = branch.points[i if abs(f[i] - frequency) < abs(f[i + 1] - frequency) else i + 1]
            state = steady_state(
                near.structure, near.drive, frequency, harmonics=near.coefficients.shape[0] - 1,
                guess=near,
            )  # fmt: skip
            if unstable_exponents(state) == 0:
                found.append(state)
    return found


@pytest.mark.parametrize("seed", [0, 1, 2, 4, 9])
def test_agrees_with_long_simulations_on_both_sides_of_each_fold(seed: int) -> None:
    structure, drive = seeded_case(seed)
    branch = frequency_response(
        structure, drive, (0.12, 0.6), harmonics=96 if seed % 2 else 24, step=0.06, stability=False
    )
    assert branch.complete
    assert len(branch.folds) == 2
    upper, lower = branch.folds
    assert upper.frequency > lower.frequency
    checked = 0
    for fold, inside in ((upper, 0.98), (lower, 1.02)):
        for frequency, expected in (
            (inside * fold.frequency, 2), (fold.frequency / inside, 1)
        ):  # fmt: skip
            states = stable_states(branch, frequency)
            assert len(states) == expected
            for state in states:
                size, shape = agreement(state)
                assert size <= 1e-4
                assert shape <= 1e-4
                checked += 1
    assert checked == 6


def test_between_the_folds_the_middle_state_is_left() -> None:
    structure, drive = seeded_case(2)
    branch = frequency_response(structure, drive, (0.12, 0.6), harmonics=10, step=0.03)
    assert branch.stable is not None
    first, second = (fold.after for fold in branch.folds)
    assert branch.stable[:first].all()
    assert not branch.stable[first + 1 : second].any()
    assert branch.stable[second + 1 :].all()
    middle = branch.points[(first + second) // 2]
    size, _ = agreement(middle, cycles=150)
    assert size > 0.05


def test_linear_response_is_the_dynamic_stiffness() -> None:
    for order in (0.3, 1.0, 1.6):
        structure = oscillator(2.0, 5.0, law(("fractional-derivative", 0.7, {"order": order})))
        for frequency in (0.05, 0.25, 0.7):
            s = 1j * CYCLE * frequency
            exact = -3j / (2.0 * s**2 + 5.0 + 0.7 * s**order)
            state = steady_state(structure, SineDrive(3.0), frequency, harmonics=3)
            assert state.coefficients[1, 0] == pytest.approx(exact, rel=1e-12)
            assert np.abs(state.coefficients[2:]).max() < 1e-12


def test_undamped_duffing_backbone() -> None:
    # Free vibration x'' + x + k x^3 = 0: the frequency by the complete elliptic integral.
    from scipy.special import ellipk

    k, amplitude = 1.0, 1.0
    m = k * amplitude**2 / (2.0 * (1.0 + k * amplitude**2))
    free = np.sqrt(1.0 + k * amplitude**2) * np.pi / (2.0 * ellipk(m))
    structure = oscillator(1.0, 1.0, law(("cubic-stiffness", k)), damping=1e-3)
    branch = frequency_response(
        structure, SineDrive(1e-3 * free * amplitude), (0.15, free / CYCLE * 1.2), harmonics=8,
        stability=False,
    )  # fmt: skip
    top = branch.folds[0]
    assert top.amplitude[0] == pytest.approx(amplitude, rel=2e-2)
    m = k * top.amplitude[0] ** 2 / (2.0 * (1.0 + k * top.amplitude[0] ** 2))
    backbone = np.sqrt(1.0 + k * top.amplitude[0] ** 2) * np.pi / (2.0 * ellipk(m)) / CYCLE
    assert top.frequency == pytest.approx(backbone, rel=1e-4)


def den_hartog(friction: float, omega: float) -> float:
    """Amplitude of a mass on a spring with Coulomb friction, sliding all the time (1931)."""
    u = np.sin(np.pi / omega) / (omega * (1.0 + np.cos(np.pi / omega)))
    return float(np.sqrt(1.0 / (1.0 - omega**2) ** 2 - (friction * u) ** 2))


@pytest.mark.parametrize("omega", [0.7, 0.8, 1.2, 1.5])
def test_friction_against_den_hartog(omega: float) -> None:
    structure = oscillator(1.0, 1.0, law(("coulomb-friction", 0.2)))
    errors = []
    for harmonics in (16, 32, 128):
        state = steady_state(structure, SineDrive(1.0), omega / CYCLE, harmonics=harmonics)
        errors.append(abs(state.amplitude[0] / den_hartog(0.2, omega) - 1.0))
    assert max(errors) <= 3e-4
    assert errors[-1] <= 5e-5


def test_friction_that_sticks_twice_a_cycle_is_found_roughly() -> None:
    structure = oscillator(1.0, 1.0, law(("coulomb-friction", 0.7)), damping=0.2)
    state = steady_state(structure, SineDrive(1.0), 0.5 / CYCLE, harmonics=16)
    # It sticks for 29 % of the cycle.
    assert 0.2 < state.held.mean() < 0.4
    size, _ = agreement(state)
    assert size <= 0.08


def test_below_the_friction_limit_it_stays() -> None:
    structure = oscillator(1.0, 1.0, law(("coulomb-friction", 1.1)))
    state = steady_state(structure, SineDrive(1.0), 0.1, harmonics=8)
    assert np.abs(state.coefficients[1:]).max() < 1e-9
    assert state.held.all()


def test_two_degrees_of_freedom_under_base_motion() -> None:
    device = law(
        ("inertia", 0.3), ("fractional-derivative", 0.2, {"order": 1.4}),
        ("quadratic-damping", 0.5), ("coulomb-friction", 0.02),
    )  # fmt: skip
    structure = chain([1.0, 0.4], [4.0, 1.0], [0.05, 0.02], [Mount(device, 1, 0)])
    state = steady_state(structure, SineDrive(0.5, "base"), 0.2, harmonics=48)
    size, shape = agreement(state)
    assert size <= 1e-4
    assert shape <= 1e-4


def test_an_oscillator_pushed_by_negative_damping_is_unstable() -> None:
    for damping, expected in ((0.1, 0), (-0.1, 2)):
        structure = oscillator(1.0, 1.0, damping=damping)
        state = steady_state(structure, SineDrive(1.0), 0.4, harmonics=4)
        assert unstable_exponents(state) == expected


def test_bands_run_either_way() -> None:
    structure, drive = seeded_case(0)
    up = frequency_response(structure, drive, (0.12, 0.16), harmonics=6, stability=False)
    down = frequency_response(structure, drive, (0.16, 0.12), harmonics=6, stability=False)
    assert up.stable is None
    for end, start in ((up.points[0], down.points[-1]), (up.points[-1], down.points[0])):
        np.testing.assert_allclose(end.coefficients, start.coefficients, atol=1e-9)


def test_errors_say_what_is_wrong() -> None:
    segmented = sfoim(Device.preset("device-12"), (18.25, 0.48), (0.57, 1.89))
    with pytest.raises(InputError, match="of one band"):
        steady_state(oscillator(1.0, 1.0, segmented), SineDrive(1.0), 1.0)
    with pytest.raises(InputError, match="harmonics must be >= 1"):
        steady_state(oscillator(1.0, 1.0), SineDrive(1.0), 1.0, harmonics=0)
    with pytest.raises(InputError, match="band must be two frequencies"):
        frequency_response(oscillator(1.0, 1.0), SineDrive(1.0), (1.0, 1.0))
    with pytest.raises(InputError, match=r"at must be in 0\.\.0"):
        steady_state(oscillator(1.0, 1.0), SineDrive(1.0, at=1), 1.0)
