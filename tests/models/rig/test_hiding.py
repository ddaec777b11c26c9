import pickle

import numpy as np
import pytest

from models.checks import InputError
from models.device import Device
from models.rig import (
    CATALOGUE,
    FORMS,
    OUTSIDE,
    Chain,
    Plan,
    RigPhysics,
    find_effect,
    random_device,
    run,
    sine_point,
)

TWELVE = Device.preset("device-12")
PLAN = Plan(
    tuple(
        sine_point(f, a)
        for f, a in [(0.3, 0.02), (1.0, 0.01), (3.0, 0.005), (3.0, 0.02), (9.0, 0.005)]
    )
)
ALL = [f"{key}:{form}" for key, forms in FORMS.items() for form in forms]
CONTRACT = (
    "inertia viscous-damping quadratic-damping power-law-damping coulomb-friction "
    "fractional-derivative stiffness cubic-stiffness force-offset asymmetric-damping "
    "stribeck-friction time-delay series-compliance end-stop backlash cavitation hysteresis "
    "position-dependent-friction thermal-drift sensor-gain sensor-drift sensor-clipping"
).split()
ONE_FORM = {"inertia", "viscous-damping", "stiffness", "force-offset", "time-delay"}


def forces(hidden=None, *, seed=3, physics=None, device=TWELVE):
    simple = RigPhysics.simple() if physics is None else physics
    records = run(device, PLAN, seed=seed, hidden=hidden, physics=simple, chain=Chain.ideal())
    return np.concatenate([r.true_force for r in records]), records


@pytest.fixture(scope="module")
def plain():
    return forces()


@pytest.mark.parametrize("name", ALL)
def test_size_is_the_one_asked_for(name, plain):
    base, clean = plain
    changed, records = forces({name: 0.1})
    size = np.sqrt(np.mean((changed - base) ** 2) / np.mean(base**2))
    assert size == pytest.approx(0.1, rel=0.01)
    assert records[0].hidden[0].size == 0.1
    for one, two in zip(clean, records, strict=True):
        np.testing.assert_array_equal(one.displacement, two.displacement)


@pytest.mark.parametrize("size", [0.05, 0.2])
@pytest.mark.parametrize(
    "name", ["series-compliance:mount", "backlash:play", "cavitation:make-up", "time-delay:skew"]
)
def test_searched_sizes_on_the_full_physics(name, size):
    device = random_device(np.random.default_rng(5))
    physics = RigPhysics()
    base, _ = forces(device=device, physics=physics)
    changed, _ = forces({name: size}, device=device, physics=physics)
    found = np.sqrt(np.mean((changed - base) ** 2) / np.mean(base**2))
    assert found == pytest.approx(size, rel=0.01)


def test_every_effect_has_the_forms_that_it_should():
    assert len(OUTSIDE) >= 5
    for key in CATALOGUE:
        assert len(FORMS[key]) >= (1 if key in ONE_FORM else 2), key
    assert set(CATALOGUE) == set(CONTRACT)


# Orders near 0.4 and 1.5, friction odd and even along the stroke, records of one range only.
UNLIKE = {"fractional-derivative", "position-dependent-friction", "sensor-gain"}


@pytest.mark.parametrize("key", [k for k in CATALOGUE if k not in ONE_FORM | UNLIKE])
def test_forms_of_one_effect_differ_but_resemble_each_other(key, plain):
    base, _ = plain
    changes = [forces({f"{key}:{form}": 0.05})[0] - base for form in FORMS[key]]
    for other in changes[1:]:
        correlation = np.corrcoef(changes[0], other)[0, 1]
        assert correlation < 0.99999
        assert correlation > 0.15


def test_gain_by_range_leaves_the_small_records_alone(plain):
    _, clean = plain
    _, records = forces({"sensor-gain:range": 0.1})
    ratios = [
        np.sqrt(np.mean(b.true_force**2) / np.mean(a.true_force**2))
        for a, b in zip(clean, records, strict=True)
    ]
    assert ratios[0] == 1.0
    assert abs(ratios[-1] - 1.0) > 0.09


def test_constitutive_sizes_against_formulas(plain):
    base, records = plain
    x = np.concatenate([r.true_displacement for r in records])
    changed, _ = forces({"stiffness": 0.1})
    change = changed - base
    slope = float(x @ change / (x @ x))
    np.testing.assert_allclose(change, slope * x, atol=1e-6 * np.max(np.abs(change)))
    assert slope > 0.0


def test_delay_is_a_delay(plain):
    base, records = plain
    changed, hidden = forces({"time-delay": 0.05})
    tau = hidden[0].hidden[0].amount
    last = records[-1].true_force.size
    omega = 2 * np.pi * 9.0
    t = records[-1].time
    kernel = np.exp(-1j * omega * t)
    whole = int(len(t) // (1000 / 9.0) * (1000 / 9.0))
    before, after = (np.sum((f[-last:] * kernel)[:whole]) for f in (base, changed))
    assert -np.angle(after / before) / omega == pytest.approx(tau, rel=0.02)


def test_friction_takes_energy(plain):
    base, records = plain
    for name in (
        "coulomb-friction",
        "stribeck-friction",
        "hysteresis",
        "quadratic-damping",
        "power-law-damping",
        "fractional-derivative:rubber",
        "fractional-derivative:side-line",
    ):
        changed, _ = forces({name: 0.1})
        start = 0
        for r in records:
            stop = start + r.time.size
            v = np.gradient(r.true_displacement, r.time)
            assert np.mean((changed - base)[start:stop] * v) > 0.0, (name, r.file)
            start = stop


def test_rubber_and_side_line_have_their_orders():
    # Phase of the added force against displacement at two frequencies: order pi/2.
    plan = Plan((sine_point(0.5, 0.01), sine_point(5.0, 0.01)))
    quiet = RigPhysics.simple(distortion=0.0)
    clean = run(TWELVE, plan, seed=1, physics=quiet)
    for name, low, high in (("rubber", 0.25, 0.65), ("side-line", 1.4, 1.6)):
        hidden = {f"fractional-derivative:{name}": 0.1}
        changed = run(TWELVE, plan, seed=1, physics=quiet, hidden=hidden)
        for a, b in zip(clean, changed, strict=True):
            kernel = np.exp(-2j * np.pi * a.frequency * a.time)
            change = np.sum((b.true_force - a.true_force) * kernel)
            order = np.angle(change / np.sum(a.true_displacement * kernel)) * 2 / np.pi
            assert low < order < high


def test_two_at_once_are_both_there(plain):
    base, _ = plain
    one, _ = forces({"stiffness": 0.1})
    two, _ = forces({"inertia": 0.1})
    both, records = forces({"stiffness": 0.1, "inertia": 0.1})
    np.testing.assert_allclose(both - base, one + two - 2 * base, atol=1e-9 * np.max(np.abs(base)))
    assert [h.effect.id for h in records[0].hidden] == ["stiffness", "inertia"]


def test_truth_travels_between_processes():
    _, records = forces({"cavitation": 0.1})
    again = pickle.loads(pickle.dumps(records[0].hidden[0]))
    assert again == records[0].hidden[0]


def test_names_and_forms():
    assert find_effect("backlash").form == "play"
    assert find_effect("outside:echo").id == "outside:echo"
    assert find_effect("outside:echo:rectified").id == "outside:echo"
    with pytest.raises(InputError, match="hidden effect: effect must be one of"):
        find_effect("magic")
    with pytest.raises(InputError, match="form of backlash must be one of play, bushing"):
        find_effect("backlash:loose")


def test_impossible_sizes_are_refused():
    with pytest.raises(InputError, match="size of stiffness must be above 0"):
        forces({"stiffness": 0.0})
    with pytest.raises(InputError, match="named once"):
        forces({"backlash": 0.1, "backlash:play": 0.1})
    with pytest.raises(InputError, match="size of sensor-clipping:amplifier"):
        forces({"sensor-clipping": 1.5})
