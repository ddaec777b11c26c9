"""InerterLibrary against exact derivatives, and inside pysindy."""

from math import gamma

import numpy as np
import pysindy as ps
import pytest
from sklearn.base import clone

from discover.library import InerterLibrary
from discover.library.column import Column
from discover.regression import BestSubset
from models.checks import InputError

DT = 1.0 / 256.0
TIME = DT * (np.arange(512) + 0.5)  # two periods of 1 Hz, no sample on a reversal
OMEGA = 2.0 * np.pi


def sine(amplitude=0.01, cycles=1):
    return amplitude * np.sin(cycles * OMEGA * TIME)[:, None]


def library(**options):
    return InerterLibrary(**({"dt": DT, "kind": "weyl"} | options))


def test_features_of_a_sine_are_those_of_its_formula():
    a, w, t = 0.01, OMEGA, TIME
    v = a * w * np.cos(w * t)
    expected = {
        "inertia": -a * w**2 * np.sin(w * t),
        "viscous-damping": v,
        "quadratic-damping": v * np.abs(v),
        "stiffness": a * np.sin(w * t),
        "cubic-stiffness": a**3 * np.sin(w * t) ** 3,
        "force-offset": np.ones(512),
        "asymmetric-damping": np.abs(v),
    }
    half = a * w**0.5 * np.sin(w * t + np.pi / 4)
    most = a * w**1.7 * np.sin(w * t + 0.85 * np.pi)
    power = np.sign(v) * np.abs(v) ** 1.75
    features = library(terms=tuple(expected), orders=(0.5, 1.7), exponents=(1.75,))
    found = np.asarray(features.fit_transform(sine()))
    columns = np.column_stack([*expected.values(), half, most, power])
    np.testing.assert_allclose(found, columns, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("order", [0.3, 0.5, 1.4])
def test_from_rest_the_caputo_derivative_of_a_parabola(order):
    t = DT * np.arange(512)
    features = library(terms=(), orders=(order,), kind="caputo")
    found = np.asarray(features.fit_transform((t**2)[:, None]))[:, 0]
    expected = gamma(3.0) / gamma(3.0 - order) * t ** (2.0 - order)
    np.testing.assert_allclose(found[8:], expected[8:], rtol=1e-4)


def test_many_orders_equal_each_alone():
    orders = tuple(np.linspace(0.1, 1.9, 7))
    together = np.asarray(library(terms=(), orders=orders).fit_transform(sine()))
    for i, order in enumerate(orders):
        alone = np.asarray(library(terms=(), orders=(order,)).fit_transform(sine()))
        np.testing.assert_allclose(together[:, i], alone[:, 0], rtol=1e-12)


def test_measured_velocity_and_acceleration_are_used_as_they_are():
    rng = np.random.default_rng(0)
    measured = np.column_stack([sine(), rng.normal(size=(512, 2))])
    terms = ("stiffness", "viscous-damping", "quadratic-damping", "inertia")
    found = np.asarray(library(terms=terms, orders=(1.0,)).fit_transform(measured))
    v, a = measured[:, 1], measured[:, 2]
    np.testing.assert_array_equal(found[:, 1], v)
    np.testing.assert_array_equal(found[:, 2], v * np.abs(v))
    np.testing.assert_array_equal(found[:, 3], a)
    # A fractional derivative is always of the displacement.
    np.testing.assert_allclose(found[:, 4], 0.01 * OMEGA * np.cos(OMEGA * TIME), atol=1e-12)


def test_names_are_readable_and_carry_the_inputs():
    friction = Column("coulomb-friction", (("transition_speed", 0.02),))
    stribeck = Column("stribeck-friction", (("stribeck_velocity", 0.1),))
    features = library(
        terms=("inertia", "quadratic-damping", "cubic-stiffness", "force-offset", friction,
               stribeck),
        orders=(0.5,),
        exponents=(1.75,),
    )
    assert features.fit(sine()).get_feature_names(["x"]) == [
        "x''", "x'|x'|", "x^3", "1", "tanh(x'/0.02)", "stribeck-friction[stribeck_velocity=0.1](x)",
        "D^0.5 x", "|x'|^1.75 sign(x')",
    ]
    three = features.fit(np.repeat(sine(), 3, axis=1))
    assert three.get_feature_names(["x", "v", "a"])[:2] == ["a", "v|v|"]
    assert three.get_feature_names()[-2:] == ["D^0.5 x0", "|x1|^1.75 sign(x1)"]
    with pytest.raises(InputError, match="input_features must be 3 names"):
        three.get_feature_names(["x"])


def test_positions_for_the_optimizer_are_known_before_the_fit():
    features = library(terms=("stiffness", "inertia"), orders=(0.5, 1.5), exponents=(1.5,))
    assert features.nonnegative == (1, 2, 3, 4)
    assert features.exclusive == ((2, 3),)


def records(model, frequencies=(1, 2, 5), amplitudes=(0.004, 0.01)):
    """Return motions and forces of sines; the force is a formula of the sine's own."""
    motions, forces = [], []
    for cycles in frequencies:
        for amplitude in amplitudes:
            motions.append(sine(amplitude, cycles))
            forces.append(model(amplitude, cycles * OMEGA)[:, None])
    return motions, forces


def fractional_force(a, w):
    v = a * w * np.cos(w * TIME)
    return 580.0 * a * w**1.5 * np.sin(w * TIME + 0.75 * np.pi) + 12.0 * np.sign(v)


def full_library():
    orders = tuple(np.round(np.arange(0.1, 2.0, 0.1), 1))
    return library(orders=orders, exponents=(1.25, 1.5, 1.75))


def optimizer(features, **options):
    return BestSubset(
        max_terms=4, nonnegative=features.nonnegative, exclusive=features.exclusive, **options
    )


def test_sindy_finds_a_fractional_force_in_several_records(capsys):
    motions, forces = records(fractional_force)
    features = full_library()
    groups = np.repeat(np.arange(len(motions)), 512)
    model = ps.SINDy(
        feature_library=features, optimizer=optimizer(features, groups=groups)
    )
    model.fit(motions, t=DT, x_dot=forces, feature_names=["x"])
    names = np.array(model.get_feature_names())
    found = dict(zip(names, model.coefficients()[0], strict=True))
    kept = {n: c for n, c in found.items() if c}
    assert kept == pytest.approx({"sign(x')": 12.0, "D^1.5 x": 580.0}, rel=1e-9)
    model.print(lhs=["F"], precision=0)
    assert "D^1.5 x" in capsys.readouterr().out
    assert model.score(motions, t=DT, x_dot=forces) > 1.0 - 1e-12
    predicted = model.predict(motions)
    assert [p.shape for p in predicted] == [(512, 1)] * 6
    np.testing.assert_allclose(model.predict(motions[2]), predicted[2])


def test_sindy_finds_integer_terms_of_a_multisine_exactly():
    x = sine() + sine(0.003, 3) + sine(0.001, 7)
    features = full_library()
    parts = [(0.01, OMEGA), (0.003, 3.0 * OMEGA), (0.001, 7.0 * OMEGA)]
    v = sum(a * w * np.cos(w * TIME) for a, w in parts)
    acceleration = sum(-a * w**2 * np.sin(w * TIME) for a, w in parts)
    force = 100.0 * acceleration + 40.0 * v + 900.0 * v * np.abs(v)
    model = ps.SINDy(feature_library=features, optimizer=optimizer(features))
    model.fit(x, t=TIME, x_dot=force[:, None], feature_names=["x"])
    names = np.array(model.get_feature_names())
    kept = np.flatnonzero(model.coefficients()[0])
    assert names[kept].tolist() == ["x''", "x'", "x'|x'|"]
    np.testing.assert_allclose(model.coefficients()[0, kept], [100.0, 40.0, 900.0], rtol=1e-8)


def test_sindy_uses_measured_velocity_and_acceleration(capsys):
    v = 0.01 * OMEGA * np.cos(OMEGA * TIME)
    a = -0.01 * OMEGA**2 * np.sin(OMEGA * TIME) + 0.2 * np.cos(9.0 * OMEGA * TIME)
    measured = np.column_stack([sine(), v, a])  # an acceleration that the displacement lacks
    features = library(terms=("inertia", "viscous-damping", "stiffness"))
    model = ps.SINDy(feature_library=features, optimizer=BestSubset(2))
    force = 3.0 * a + 2.0 * v
    model.fit(measured, t=DT, x_dot=force[:, None], feature_names=["x", "v", "a"])
    np.testing.assert_allclose(model.coefficients(), [[3.0, 2.0, 0.0]], rtol=1e-9, atol=1e-12)
    model.print(lhs=["F"])
    assert capsys.readouterr().out == "F =  3.000 a +  2.000 v\n"


def test_trajectories_may_be_sampled_differently():
    coarse, fine = sine()[::2], sine()
    features = library(terms=("inertia",), dt=(2 * DT, DT)).fit([coarse, fine])
    one, other = features.transform([coarse, fine])
    np.testing.assert_allclose(one[:, 0], other[::2, 0], atol=1e-11)
    with pytest.raises(InputError, match="dt must be one for each of 1 trajectories, got 2"):
        features.transform(fine)


def test_scikit_learn_conventions():
    features = full_library()
    copy = clone(features)
    assert copy.get_params() == features.get_params()
    assert copy.set_params(orders=(0.5,)) is copy
    assert len(copy.columns) == len(features.columns) - 18
    x = sine()
    x.flags.writeable = False
    assert np.asarray(copy.fit_transform(x)).shape == (512, copy.n_output_features_)
    joined = copy + ps.PolynomialLibrary(degree=1, include_bias=False)
    assert np.asarray(joined.fit_transform(sine())).shape == (512, copy.n_output_features_ + 1)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dt": 0.0}, "InerterLibrary: dt must be a finite number > 0.0, got 0.0"),
        ({"kind": "riesz"}, "InerterLibrary: kind must be one of caputo"),
        ({"orders": (2.1,)}, "InerterLibrary: order must be .* <= 2.0, got "),
        ({"exponents": (0.0,)}, "InerterLibrary: exponent must be .* > 0.0"),
        ({"terms": "inertia"}, "terms must be a sequence of ids, got inertia"),
        ({"terms": ("mass",)}, "terms: term must be one of .*inertia.*, got 'mass'"),
        ({"terms": (3,)}, "term must be an id or a Column, got 3"),
        ({"terms": ("fractional-derivative",)}, "orders must be given for fractional-derivative"),
        ({"terms": ("inertia", "inertia")}, "features must be distinct"),
        ({"orders": (0.5, 0.5)}, "features must be distinct"),
        ({"terms": ()}, "terms, orders, exponents must be not all empty"),
        ({"terms": (Column("inertia", (("order", 1.0),)),)}, "parameter 'order' of inertia must"),
    ],
)
def test_parameters_are_checked_when_fitted(options, message):
    features = library(**options)
    with pytest.raises(InputError, match=message):
        features.fit(sine())


@pytest.mark.parametrize(
    ("x", "message"),
    [
        (np.zeros((512, 4)), r"X must be \(N, 1\) displacement, .* got shape \(512, 4\)"),
        (np.zeros((4, 1)), "X must be at least 8 samples long, got 4"),
        (np.full((512, 1), np.nan), "InerterLibrary: X must be finite throughout"),
    ],
)
def test_motions_are_checked(x, message):
    with pytest.raises(InputError, match=message):
        library().fit(x)


def test_shapes_that_do_not_agree_are_refused():
    features = library().fit(sine())
    with pytest.raises(InputError, match="X must be of 1 columns, as fitted, got 2"):
        features.transform(np.zeros((512, 2)))
    with pytest.raises(InputError, match="trajectories must be of equally many columns"):
        features.fit([sine(), np.zeros((512, 2))])


def test_a_fit_without_the_force_is_refused():
    model = ps.SINDy(feature_library=library(), optimizer=BestSubset())
    with pytest.raises(InputError, match="x_dot must be the measured force"):
        model.fit(sine(), t=DT)


def test_friction_that_jumps_bends_the_damping_and_a_fitted_transition_does_not():
    motions, forces = records(
        lambda a, w: 2500.0 * a * w * np.cos(w * TIME) + 400.0 * np.tanh(a * w * np.cos(w * TIME)
                                                                       / 0.02)
    )
    terms = ("viscous-damping", "quadratic-damping", "coulomb-friction")
    jump = library(terms=terms)
    smooth = jump.with_fitted_transition(motions, forces)
    assert jump.transition_speed == 0.0
    assert smooth.transition_speed == pytest.approx(0.02, rel=1e-4)
    found = {}
    for name, features in (("jump", jump), ("smooth", smooth)):
        model = ps.SINDy(feature_library=features, optimizer=BestSubset(max_terms=3))
        model.fit(motions, t=DT, x_dot=forces, feature_names=["x"])
        found[name] = model.coefficients()[0]
    np.testing.assert_allclose(found["smooth"], [2500.0, 0.0, 400.0], rtol=1e-3, atol=1.0)
    assert abs(found["jump"][0] - 2500.0) > 50.0


def test_a_transition_needs_friction_and_a_force_of_its_records():
    with pytest.raises(InputError, match="terms must be with coulomb-friction"):
        library(terms=("inertia",)).with_fitted_transition(sine(), sine()[:, 0])
    with pytest.raises(InputError, match=r"force must be of lengths \[512\], got \[3\]"):
        library().with_fitted_transition(sine(), np.ones(3))
