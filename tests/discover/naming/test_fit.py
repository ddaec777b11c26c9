"""Fits of a model to whitened rows, against closed formulas and plain least squares."""

import numpy as np
import pytest

from discover.gap.stages import stage
from discover.motion_fit import observe
from discover.naming.fit import (
    fit_model,
    free_parameters,
    kind_of,
    value_of,
    with_values,
)
from discover.naming.forces import model_force
from discover.naming.restart import best_range
from discover.naming.rows import record_rows
from discover.naming.unit_rows import UnitRows
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS
from tests.discover.gap_data import campaign, device


def test_how_a_channel_is_made_is_chosen_and_not_fitted():
    late = model(("time-delay", 1e-3, {"filter_order": 2.0, "digital": 1.0}))
    gain = model(("sensor-gain", 0.1, {"filter_time": 1e-3, "digital": 1.0}))
    assert [p.shape for p in free_parameters(late)] == [None]
    assert [p.shape for p in free_parameters(gain)] == [None, "filter_time"]


def rows_of(law, **options):
    return [record_rows(observe(r)) for r in campaign(law, **options).records]


def model(*terms):
    return ForceModel(tuple(FittedTerm(*t) for t in terms))


def with_power(start):
    return model(
        ("inertia", 1.0), ("viscous-damping", 1.0), ("power-law-damping", 1.0, {"exponent": start})
    )


def fitted(rows, start):
    return fit_model(rows, start, free_parameters(start))


def test_coefficients_are_those_of_plain_least_squares():
    rows = rows_of(device)
    fit = fitted(rows, model(("inertia", 1.0), ("viscous-damping", 1.0)))
    columns = [
        np.concatenate([r.project(getattr(r.observation.motion, name)) for r in rows])
        for name in ("acceleration", "velocity")
    ]
    target = np.concatenate([r.target for r in rows])
    plain = np.linalg.lstsq(np.stack(columns, axis=1), target, rcond=None)[0]
    between_points = (2.0 * np.pi / rows[0].observation.cycle.time.size) ** 2 / 8.0
    found = [t.coefficient for t in fit.model.terms]
    assert found == pytest.approx(list(plain), rel=2.0 * between_points)


@pytest.mark.parametrize("start", [0.25, 1.3, 2.6])
def test_an_exponent_is_found_from_far_away(start):
    def law(t, x, v, a):
        return device(t, x, v, a) + 900.0 * np.sign(v) * np.abs(v) ** 0.6

    fit = fitted(rows_of(law), with_power(start))
    assert fit.model.terms[-1].shape["exponent"] == pytest.approx(0.6, abs=0.03)
    assert fit.chi2 < 1.3 * fit.residual.size


@pytest.mark.parametrize("start", [0.8, 1.3])
def test_a_power_beside_viscous_damping_keeps_off_it(start):
    """Nearly the same twice, they are two huge forces whose difference is the noise's."""

    def law(t, x, v, a):
        return device(t, x, v, a) + 300.0 * np.sign(v) * np.abs(v) ** 1.01

    fit = fitted(rows_of(law), with_power(start))
    _, viscous, power = fit.model.terms
    assert abs(power.shape["exponent"] - 1.0) > 0.0999
    assert abs(viscous.coefficient) + abs(power.coefficient) < 4000.0


def test_a_stop_is_found_from_a_wrong_gap_and_a_wrong_exponent():
    def law(t, x, v, a):
        return device(t, x, v, a) + 4e6 * np.sign(x) * np.maximum(np.abs(x) - 0.0091, 0.0) ** 1.5

    begin = model(
        ("inertia", 1.0),
        ("viscous-damping", 1.0),
        ("end-stop", 1.0, {"gap": 0.0075, "exponent": 2.5, "side": 0.0}),
    )
    fit = fitted(rows_of(law), begin)
    found = fit.model.terms[-1]
    assert found.shape["gap"] == pytest.approx(0.0091, rel=0.01)
    assert found.shape["exponent"] == pytest.approx(1.5, abs=0.1)
    assert fit.chi2 < 1.3 * fit.residual.size


def test_a_record_left_out_is_predicted_by_a_fit_of_the_others():
    def law(t, x, v, a):
        return device(t, x, v, a) + 3e7 * x**3

    rows = rows_of(law)
    start = model(("inertia", 1.0), ("viscous-damping", 1.0), ("cubic-stiffness", 1.0))
    fit = fitted(rows, start)
    unseen = stage(rows, fit).unseen
    for index in (0, 5):
        rest = fitted([r for i, r in enumerate(rows) if i != index], start)
        motion = rows[index].observation.motion
        left = rows[index].observation.measured - rest.model.force(motion)
        assert unseen[index].error == pytest.approx(float(np.mean(left**2)), rel=1e-3)


def test_the_shapes_of_one_kind_differ_only_in_what_a_fit_changes():
    sharp = {"gap": 0.01, "exponent": 2.0, "side": 1.0}
    assert kind_of(sharp) == kind_of({**sharp, "gap": 0.02, "exponent": 1.2})
    assert kind_of(sharp) != kind_of({**sharp, "side": -1.0})
    assert kind_of({"transition_speed": 0.0}) != kind_of({"transition_speed": 0.01})


@pytest.mark.parametrize("gain", [0.27, -0.1])
def test_a_range_s_gain_is_found_though_it_moves_the_model_s_own_peaks(gain):
    """The threshold lies between measured peaks; the model's are those without the gain."""

    def law(t, x, v, a):
        force = device(t, x, v, a)
        return (1.0 + gain) * force if np.abs(force).max() > 300.0 else force

    rows = rows_of(law)
    peaks = sorted(float(np.abs(r.observation.measured).max()) for r in rows)
    after = next(i for i, p in enumerate(peaks) if p > 300.0 * (1.0 + gain))
    begin = model(
        ("inertia", 100.0),
        ("viscous-damping", 1000.0),
        ("sensor-gain", 0.01, {"threshold": np.sqrt(peaks[after - 1] * peaks[after])}),
    )
    fit = best_range(rows, fitted(rows, begin))
    assert [t.coefficient for t in fit.model.terms] == pytest.approx([120.0, 800.0, gain], rel=0.01)
    assert fit.chi2 < 1.3 * fit.residual.size


def test_a_clipped_channel_s_device_is_found_while_it_clips():
    def law(t, x, v, a):
        return np.minimum(device(t, x, v, a), 250.0)

    limit = {"limit": 240.0, "softness": 0.0, "side": 1.0}
    begin = model(("inertia", 100.0), ("viscous-damping", 600.0), ("sensor-clipping", 0.8, limit))
    fit = fitted(rows_of(law), begin)
    assert [t.coefficient for t in fit.model.terms] == pytest.approx([120.0, 800.0, 1.0], rel=0.02)
    assert fit.model.terms[-1].shape["limit"] == pytest.approx(250.0, rel=0.01)


@pytest.mark.parametrize("start", [1.3, 1.7, 1.9])
def test_an_order_keeps_off_the_whole_ones_beside_it(start):
    """Inertance that grows with frequency: a difference of huge forces of nearly second order."""

    def law(t, x, v, a):
        omega = np.abs(v).max() / np.abs(x).max()
        return (120.0 + 15.0 * np.log(omega)) * a + 800.0 * v

    begin = model(
        ("inertia", 100.0), ("viscous-damping", 800.0),
        ("fractional-derivative", 100.0, {"order": start}),
    )
    fit = fitted(rows_of(law), begin)
    assert 1.1 - 1e-9 <= fit.model.terms[-1].shape["order"] <= 1.9 + 1e-9
    assert abs(fit.model.terms[0].coefficient) < 1000.0
    # at the bound the others still reach their least squares
    held = [p for p in fit.parameters if p.shape is None]
    linear = fit_model(rows_of(law), fit.model, held)
    assert fit.chi2 == pytest.approx(linear.chi2, rel=1e-3)


@pytest.mark.parametrize("sensor", [
    ("time-delay", 8e-4),
    ("sensor-gain", 0.12, {"filter_time": 0.004}),
    ("sensor-gain", 0.12),
    ("sensor-clipping", 0.9, {"limit": 30.0}),
])
def test_tangents_of_what_a_sensor_reads_are_those_of_the_whole_model(sensor):
    """Whether a sensor passes on sums or not: against differences of the model's own force."""
    rows = rows_of(device)[1::3]
    start = model(
        ("inertia", 110.0), ("viscous-damping", 700.0), ("stiffness", 900.0),
        ("power-law-damping", 60.0, {"exponent": 1.6}), sensor,
    )
    free = free_parameters(start)
    fit = fit_model(rows, start, free, iterations=0)
    for parameter, tangent in zip(free, fit.tangents, strict=True):
        value = value_of(start, parameter)
        above, below = (
            np.concatenate([
                r.project(model_force(r.observation, with_values(start, [parameter], [moved])))
                for r in rows
            ])
            for moved in (1.0005 * value, 0.9995 * value)
        )
        exact = (above - below) / (1e-3 * value)
        assert np.linalg.norm(tangent - exact) < 0.01 * np.linalg.norm(exact), parameter


def test_an_order_alone_may_be_nearly_two():
    order = 1.97

    def law(t, x, v, a):
        omega, reach = np.abs(v).max() / np.abs(x).max(), np.abs(x).max()
        return 150.0 * omega**order * reach * np.sin(omega * t + 0.5 * np.pi * order)

    fit = fitted(rows_of(law), model(("fractional-derivative", 100.0, {"order": 1.8})))
    assert fit.model.terms[0].shape["order"] == pytest.approx(order, abs=0.002)


def test_a_model_in_which_nothing_is_free_is_evaluated_once():
    """Starts of joints are ranked so, by the hundred."""

    class Counted(UnitRows):
        times = 0

        def of_model(self, rows, model):
            self.times += 1
            return super().of_model(rows, model)

    units = Counted()
    shape = TERMS["series-compliance"].shape({})
    sprung = model(("inertia", 100.0), ("series-compliance", 1e-6, shape))
    fit = fit_model(rows_of(device), sprung, (), units=units)
    assert units.times == 1
    assert fit.model is sprung
