"""Two ways to the eigenvalues, simulated steady states, stated errors that hold."""

from __future__ import annotations

import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel, foim, sfoim
from models.device import Device
from models.linear import (
    dynamic_stiffness,
    eigenvalues,
    modes,
    oustaloup,
    rational_structure,
    transfer_function,
)
from models.simulation import PeriodicPast, simulate, sine_load
from models.structure import Mount, Structure, chain, oscillator


def fractional(*terms: tuple[float, float]) -> ForceModel:
    return ForceModel(
        tuple(FittedTerm("fractional-derivative", c, {"order": order}) for c, order in terms)
    )


def random_chain(seed: int) -> Structure:
    rng = np.random.default_rng(seed)
    size, q = int(rng.integers(1, 4)), int(rng.integers(2, 11))
    terms = [(float(rng.uniform(0.05, 2.0)), int(rng.integers(1, 2 * q)) / q) for _ in range(2)]
    lower = None if size == 1 else 0
    return chain(
        rng.uniform(0.5, 2.0, size), rng.uniform(0.5, 3.0, size), rng.uniform(0.0, 0.3, size),
        [Mount(fractional(*terms), size - 1, lower)],
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(20))
def test_both_ways_to_the_eigenvalues_agree(seed: int) -> None:
    structure = random_chain(seed)
    one = eigenvalues(structure, method="commensurate")
    other = eigenvalues(structure, method="contour")
    assert one.shape == other.shape
    assert np.abs(one - other).max() <= 1e-8 * np.abs(one).max()
    for s in one:
        smallest = np.linalg.svd(dynamic_stiffness(structure, s), compute_uv=False)[-1]
        assert smallest <= 1e-10


def test_orders_with_a_denominator_of_a_hundred() -> None:
    structure = oscillator(250.0, 2e4, foim(Device.preset("device-12"), 0.57, 1.89))
    one = eigenvalues(structure, method="commensurate")
    other = eigenvalues(structure, method="contour")
    np.testing.assert_allclose(one, other, rtol=1e-8)
    assert modes(structure).damping_ratios[0] > 0.0


def test_whole_orders_against_the_state_matrix() -> None:
    structure = chain([1.0, 2.0], [3.0, 1.0], [0.2, 8.0])
    inverse = np.linalg.inv(structure.mass)
    state = np.block(
        [[np.zeros((2, 2)), np.eye(2)],
         [-inverse @ structure.stiffness, -inverse @ structure.damping]]
    )  # fmt: skip
    exact = np.sort_complex(np.linalg.eigvals(state))
    for method in ("commensurate", "contour"):
        found = np.sort_complex(eigenvalues(structure, method=method))
        np.testing.assert_allclose(found, exact, atol=1e-9)


def test_an_irrational_order_lies_between_its_neighbours() -> None:
    order = 2.0**0.5
    value = eigenvalues(oscillator(1.0, 1.0, fractional((0.3, order))))[0]
    residual = value**2 + 0.3 * value**order + 1.0
    assert abs(residual) < 1e-12
    with pytest.raises(InputError, match="common denominator"):
        eigenvalues(oscillator(1.0, 1.0, fractional((0.3, order))), method="commensurate")


@settings(max_examples=20, deadline=None)
@given(st.floats(0.01, 100.0), st.floats(0.1, 1.9))
def test_eigenvalues_scale_with_the_unit_of_time(rate: float, order: float) -> None:
    plain = eigenvalues(oscillator(1.0, 1.0, fractional((0.4, order))), method="contour")
    fast = oscillator(1.0, rate**2, fractional((0.4 * rate ** (2.0 - order), order)))
    np.testing.assert_allclose(eigenvalues(fast, method="contour"), rate * plain, rtol=1e-9)


def test_ringing_of_a_simulation_is_the_mode() -> None:
    structure = oscillator(1.0, 1.0, fractional((0.05, 1.5)))
    value = modes(structure).eigenvalues[0]
    free = simulate(structure, step=0.005, duration=60.0, displacement=1.0, richardson=True)
    x, t = free.displacement[:, 0], free.time
    crossings = np.nonzero(np.diff(np.sign(x)))[0]
    at = t[crossings] - x[crossings] * np.diff(t)[crossings] / np.diff(x)[crossings]
    late = at[2:]
    frequency = np.pi * (late.size - 1) / (late[-1] - late[0])
    assert frequency == pytest.approx(value.imag, rel=2e-3)


@pytest.mark.parametrize("order", [0.5, 1.2, 1.89])
@pytest.mark.parametrize("acts", ["force", "base"])
def test_transfer_function_is_the_simulated_steady_state(order: float, acts: str) -> None:
    law = fractional((0.4, order))
    structure = chain([1.0, 0.6], [2.0, 1.0], [0.1, 0.05], [Mount(law, 1, 0)])
    for omega in (0.3, 0.9, 1.6, 3.0):
        period = 2.0 * np.pi / omega
        compliance = np.array(
            [transfer_function(structure, omega, acts=acts, output=i) for i in (0, 1)]
        )
        past = PeriodicPast(np.stack([np.zeros(2), -1j * compliance]), 1.0 / period)
        response = simulate(
            structure, sine_load(1.0, 1.0 / period, acts=acts), step=period / 1000,
            duration=8 * period, past=past, richardson=True,
        )  # fmt: skip
        last = response.time > 6.9999 * period
        turn = np.exp(-1j * omega * response.time[last][:-1])
        found = 2j * np.mean(response.displacement[last][:-1] * turn[:, None], axis=0)
        assert np.abs(found - compliance).max() <= 1e-5 * np.abs(compliance).max()


def test_steady_state_is_reached_from_rest() -> None:
    structure = oscillator(1.0, 1.0, fractional((0.6, 1.5)))
    omega = 1.3
    period = 2.0 * np.pi / omega
    cycles = 400
    response = simulate(
        structure, sine_load(1.0, 1.0 / period), step=period / 400, duration=cycles * period,
        richardson=True,
    )  # fmt: skip
    last = slice(-401, -1)
    turn = np.exp(-1j * omega * response.time[last])
    found = 2j * np.mean(response.displacement[last, 0] * turn)
    assert abs(found / transfer_function(structure, omega) - 1.0) <= 1e-5


def test_quantities_of_the_transfer_function() -> None:
    structure = oscillator(2.0, 8.0, fractional((0.4, 1.5)))
    w = np.array([0.5, 2.0, 7.0])
    x = transfer_function(structure, w)
    np.testing.assert_allclose(transfer_function(structure, w, quantity="velocity"), 1j * w * x)
    acceleration = transfer_function(structure, w, quantity="acceleration")
    np.testing.assert_allclose(acceleration, -(w**2) * x)
    # A base that moves slowly carries the mass; one that moves fast leaves it behind.
    carried = transfer_function(
        structure, np.array([1e-4, 1e6]), acts="base", quantity="absolute-acceleration"
    )
    assert abs(carried[0] - 1.0) < 1e-6
    assert abs(carried[1]) < 1e-2


@pytest.mark.parametrize("order", [0.2, 0.5, 0.9, 1.3, 1.89])
@pytest.mark.parametrize("refined", [True, False])
@pytest.mark.parametrize("margin", [1.0, 30.0])
def test_the_error_stated_for_oustaloup_holds(order: float, refined: bool, margin: float) -> None:
    power = oustaloup(order, (0.1, 200.0), pairs=12, margin=margin, refined=refined)
    omega = np.exp(np.random.default_rng(1).uniform(np.log(0.1), np.log(200.0), 20_000))
    error = np.abs(power(1j * omega) / (1j * omega) ** order - 1.0).max()
    assert 0.9 * power.error < error <= power.error


def test_refined_and_wider_is_better() -> None:
    plain = oustaloup(0.5, (0.1, 100.0), pairs=20, margin=100.0, refined=False)
    refined = oustaloup(0.5, (0.1, 100.0), pairs=20, margin=100.0)
    assert refined.error < 0.1 * plain.error < 1e-3
    assert plain.error < oustaloup(0.5, (0.1, 100.0), pairs=20, margin=1.0, refined=False).error


@pytest.mark.parametrize("order", [0.5, 1.5])
def test_to_control(order: float) -> None:
    power = oustaloup(order, (0.1, 10.0), pairs=6)
    system = power.to_control()
    assert isinstance(system, control.TransferFunction)
    for s in (0.3j, 2j, 9j):
        assert complex(system(s)) == pytest.approx(complex(power(s)), rel=1e-6)
    partial = power.gain + np.sum(power.residues / (2j + power.poles))
    assert (2j) ** power.whole * partial == pytest.approx(complex(power(2j)), rel=1e-9)


@pytest.mark.parametrize("order", [0.5, 1.89])
def test_rational_structure_holds_its_error(order: float) -> None:
    structure = chain([1.0, 0.6], [2.0, 1.0], [0.1, 0.05], [Mount(fractional((0.4, order)), 1, 0)])
    rational = rational_structure(structure, (0.1, 20.0), acts="base")
    omega = np.geomspace(0.1, 20.0, 777)
    exact = np.stack(
        [transfer_function(structure, omega, acts="base", output=i) for i in (0, 1)], axis=1
    )
    gap = np.linalg.norm(rational.response(omega) - exact, axis=1) / np.linalg.norm(exact, axis=1)
    assert gap.max() <= rational.error < 0.01
    assert np.linalg.eigvals(rational.a).real.max() < 0.0
    system = rational.to_control()
    assert system.nstates == rational.a.shape[0]


def test_segmented_models_and_bad_requests_are_refused() -> None:
    law = sfoim(Device.preset("device-12"), (18.25, 0.48), (0.57, 1.89))
    with pytest.raises(InputError, match="of one band"):
        transfer_function(oscillator(1.0, 1.0, law), 1.0)
    with pytest.raises(InputError, match=r"output must be in 0\.\.0"):
        transfer_function(oscillator(1.0, 1.0), 1.0, output=1)
    with pytest.raises(InputError, match="not whole"):
        oustaloup(1.0, (1.0, 2.0))
    with pytest.raises(InputError, match="upper end of the band"):
        oustaloup(0.5, (2.0, 1.0))
    with pytest.raises(InputError, match="pairs must be >= 1"):
        oustaloup(0.5, (1.0, 2.0), pairs=0)
