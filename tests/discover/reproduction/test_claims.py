"""Every claim's verdict, worked out a second time without the package's formulas.

Each oracle below returns whether the paper's statement holds (None where it can't be checked) and,
where the claim's computed value is one number, that number by its own route.
"""

import math

import mpmath
import numpy as np
import pytest

from discover.reproduction.claims import CLAIMS, devices, operators
from discover.reproduction.claims import boundary as boundary_claims
from discover.reproduction.claims import fits as fit_claims
from discover.reproduction.paper import M1
from models.device import Device
from tests.discover.reproduction.by_hand import (
    MODELS,
    PHASE,
    RECORDS,
    ROWS,
    T,
    areas,
    damping,
    dean,
    deviation,
    e_d,
    f_low,
    flow_order,
    fractional_force,
    fundamental,
    inertance,
    integer_force,
    length,
    phase_of_integer,
    schmidt,
    standard_reynolds,
    table_3,
    worst_with_friction,
)


def oracle_friction_share():
    c1, c2 = damping(T[12])

    def share(f):
        v = 2 * math.pi * f * 0.005
        rest = math.hypot(T[12]["b"] * 2 * math.pi * f * v, c2 * v + c1 * v * v)
        return 400 / (400 + rest)

    return share(0.3) > 0.5 and share(15) < 0.1, None


def oracle_composition():
    def caputo(fun, order, t):
        return mpmath.quad(lambda s: fun(s) * (t - s) ** (-order), [0, t]) / mpmath.gamma(1 - order)

    t = mpmath.mpf(2)
    inner_slope = mpmath.mpf("0.4") / mpmath.gamma(mpmath.mpf("1.4"))
    twice = caputo(lambda s: inner_slope * s ** mpmath.mpf("-0.6"), mpmath.mpf("0.6"), t)
    once = 0  # the second derivative of t is zero
    return abs(twice - once) < 1e-6, None


def oracle_caputo_sine():
    # At t = 0+ the Caputo derivative is 0; at mid-cycle by quadrature it is not the steady state.
    t = mpmath.mpf(1)
    value = mpmath.quad(lambda s: mpmath.cos(s) / mpmath.sqrt(t - s), [0, t]) / mpmath.gamma(0.5)
    at_one = abs(value - mpmath.sin(t + mpmath.pi / 4))
    return bool(at_one < 0.01 and math.sin(math.pi / 4) < 0.01), math.sin(math.pi / 4)


def oracle_time_scale():
    # The substitution s = tau/omega in the integral of t^2: exact on both sides.
    omega, order, t = 3.7, 0.6, 1.5
    direct = 2 * omega**2 / math.gamma(3 - order) * t ** (2 - order)  # of (omega t)^2
    scaled = omega**order * 2 / math.gamma(3 - order) * (omega * t) ** (2 - order)
    return math.isclose(direct, scaled, rel_tol=1e-12), None


def oracle_equivalents():
    order, omega, amplitude = 1.89, 2 * math.pi * 12, 0.005
    exact = amplitude * omega**order * np.sin(PHASE + order * math.pi / 2)
    m = omega ** (order - 2) * math.sin((order - 1) * math.pi / 2)
    c = omega ** (order - 1) * math.cos((order - 1) * math.pi / 2)
    built = -m * amplitude * omega**2 * np.sin(PHASE) + c * amplitude * omega * np.cos(PHASE)
    return bool(np.allclose(built, exact, rtol=1e-9, atol=1e-9)), None


def oracle_proportion():
    ratios = []
    for f in (0.5, 3.0, 15.0):
        omega = 2 * math.pi * f
        value = (1j * omega) ** 1.89  # of D^1.89: real part -omega^2 m, imaginary omega c
        ratios.append(-value.real / value.imag)
    return max(ratios) / min(ratios) - 1 < 1e-6, ratios[0]


def oracle_order_below_one():
    z = np.geomspace(1e-2, 20, 200)
    orders = [flow_order(12, w**2 * T[12]["mu"] / (2 * math.pi * 0.005**2 * 800)) for w in z]
    return min(orders) <= 0.48, None


def oracle_one_record():
    columns = np.stack([np.cos(PHASE), np.sin(PHASE), np.sin(PHASE + 0.945 * math.pi)])
    return bool(np.linalg.matrix_rank(columns, tol=1e-6) == 3), None


def oracle_across():
    cases = ((3, 0.01), (8, 0.005), (12, 0.005), (15, 0.005))
    return np.ptp([phase_of_integer(f, a) for f, a in cases]) <= 0.01, None


def oracle_linear():
    once, twice = fractional_force("M2", 2, 0.005), fractional_force("M2", 2, 0.01)
    gap = np.max(abs(twice - 2 * once)) / np.max(abs(twice))
    return bool(gap < 1e-6), None


def oracle_average():
    by = {
        over: max(
            abs(e_d(fractional_force(n, f, a), integer_force(MODELS[n][0], f, a), over=over) - p)
            for n, f, a, p in ROWS.values()
        )
        for over in (np.max, np.mean)
    }
    return by[np.mean] < by[np.max], None


def oracle_triangle():
    table = {"M1": (23.99, 31.95), "M2": (19.05, 21.2), "M3": (23.39, 23.44)}
    held = [
        abs(a - b) <= deviation(n, *RECORDS[n]) <= a + b for n, (a, b) in table.items()
    ]
    return all(held), None


def oracle_phase():
    angles = []
    for key in list(ROWS)[:3]:
        name, f, a, _ = ROWS[key]
        ratio = fundamental(fractional_force(name, f, a)) / fundamental(integer_force(12, f, a))
        angles.append(abs(np.degrees(np.angle(ratio))))
    return angles[0] > 2 * max(angles[1:]), None


def oracle_peak():
    worst = max(
        100 * abs(np.max(abs(fractional_force("M2", f, 0.005)))
                  / np.max(abs(integer_force(12, f, 0.005))) - 1)
        for f in (8.0, 15.0)
    )
    return worst < 10, worst


def worst_of(keys):
    return max(deviation(*ROWS[k][:3]) for k in keys)


def closer(frequencies):
    return [deviation("M1", f, 0.005) < deviation("M2", f, 0.005) for f in frequencies]


def oracle_segmented():
    grid = np.linspace(0.05, f_low(12, 0.005), 14)
    means = [np.mean([deviation(m, f, 0.005) for f in grid]) for m in ("M1", "M2")]
    return means[0] < means[1], None


def oracle_inertia():
    ratios = []
    for number, amplitudes in ((12, (0.005, 0.02)), (10, (0.005, 0.0175))):
        c1, c2 = damping(T[number])
        for a in amplitudes:
            omega = 2 * math.pi * f_low(number, a)
            c = c2 + 8 / (3 * math.pi) * c1 * omega * a
            ratios.append(omega * T[number]["b"] / c)
    return all(0.5 < r < 2 for r in ratios), None


def oracle_friction_hides():
    shares = []
    for f in np.linspace(0.05, f_low(12, 0.005), 14):
        difference = fractional_force("M2", f, 0.005) - integer_force(12, f, 0.005)
        shares.append(100 * math.sqrt(np.mean(difference**2)) / 400)
    return max(shares) < 25, max(shares)


def oracle_design():
    # A design by hand, within device [12]'s package, with its inertance, fluid and rod.
    d = dict(T[12], r2=0.06, r3=0.01, r4=0.08, h=0.03, n=1)
    s1, s2 = areas(d)
    slope = 1 + (d["h"] / (2 * math.pi * d["r4"])) ** 2
    total = inertance(T[12]) * slope / (d["rho"] * s2 * (s1 / s2) ** 2)
    d["n"] = (total - 0.2) / length(d)
    speed = 2 * math.pi * 10 * 0.005
    before, after = (c2 + 8 / (3 * math.pi) * c1 * speed for c1, c2 in (damping(T[12]), damping(d)))
    fits = (
        d["n"] >= 1 and d["n"] * d["h"] + 2 * d["r3"] <= 14 * 0.012 + 0.01
        and d["r4"] + d["r3"] <= 0.105 and d["r2"] + d["r3"] + 0.002 <= d["r4"]
        and after <= 2 * before and math.isclose(inertance(d), inertance(T[12]))
    )
    ratio = (d["r2"] ** 2 - 0.012**2) / (0.028**2 - 0.012**2)
    ratio *= math.sqrt(0.005 * 0.1 / (d["r3"] * d["r4"]))
    return fits and ratio >= 2, None


def oracle_low_means_inertial():
    def corner(d):
        return damping(d)[1] / (2 * math.pi * inertance(d))

    def critical(d):
        return d["mu"] / d["rho"] * math.sqrt(d["r3"] * d["r4"]) / (d["r2"] ** 2 - d["r1"] ** 2)

    agree = []
    for key in ("r2", "r3", "r4"):
        moved = dict(T[12], **{key: T[12][key] * 1.001})
        up = [fun(moved) / fun(T[12]) - 1 for fun in (critical, corner)]
        agree.append(up[0] * up[1] > 1e-9)
    return all(agree), None


ORACLES = {
    "inertance-12": lambda: (abs(inertance(T[12]) - 370.38) < 0.005, inertance(T[12])),
    "fluid-mass": lambda: (
        abs(inertance(T[12], ends=0) - 370.38) < 0.005, inertance(T[12], ends=0)
    ),
    "inertance-10": lambda: (abs(inertance(T[10]) - 73.82) < 0.005, inertance(T[10])),
    "friction-order": lambda: (
        worst_with_friction(550, 400) <= worst_with_friction(400, 550), None
    ),
    "clearance": lambda: (T[10]["r2"] - T[10]["r1"] > 1e-4, None),
    "kinematic-viscosity": lambda: (
        abs((0.00168 / 802) / (0.027 / 800) / (0.0068 / 0.027) - 1) < 0.05,
        (0.00168 / 802) / (0.027 / 800),
    ),
    "order-with-viscosity": lambda: (flow_order(10, 3.0) > flow_order(12, 12.0), None),
    "friction-share": oracle_friction_share,
    "composition": oracle_composition,
    "time-scale": oracle_time_scale,
    "caputo-sine": oracle_caputo_sine,
    "equivalents": oracle_equivalents,
    "order-proportion": oracle_proportion,
    "order-range": lambda: (1 < MODELS["M1"][2] < 2, 0.48),
    "order-below-one": oracle_order_below_one,
    "order-at-0.5hz": lambda: (None, phase_of_integer(0.5, 0.02)),
    "one-record": oracle_one_record,
    "order-across-records": oracle_across,
    "linear-analysis": oracle_linear,
    "fewer-parameters": lambda: (len("b(1+b0) mu f0".split()) < len("b c1 c2 f0".split()), None),
    **{key: (lambda k=key: table_3(k)) for key in ROWS},
    "average-amplitude": oracle_average,
    "table-2-m1": lambda: (None, None),
    "table-2-m2": lambda: (None, None),
    "table-2-m3": lambda: (None, None),
    "table-2-triangle": oracle_triangle,
    "better-than-integer": lambda: (None, None),
    "figure-2b": lambda: (max(deviation("M2", 12, 0.005), 19.05, 21.2) <= 5, 21.2),
    "m2-at-0.5hz": lambda: (deviation("M2", 0.5, 0.02) > 10, deviation("M2", 0.5, 0.02)),
    "figure-3-phase": oracle_phase,
    "figure-3-peak": oracle_peak,
    "figure-5": lambda: (worst_of(list(ROWS)[3:]) < 5, worst_of(list(ROWS)[3:])),
    "better-for-10": lambda: (worst_of(list(ROWS)[3:]) < worst_of(list(ROWS)[:3]), None),
    "laminar-12": lambda: (
        max(standard_reynolds(12, f, a) for f, a in
            ((0.5, 0.02), (12, 0.005), (3, 0.01), (8, 0.005), (15, 0.005))) < schmidt(12),
        standard_reynolds(12, 15, 0.005),
    ),
    "turbulent-10": lambda: (
        min(standard_reynolds(10, f, a) for f, a in
            ((3, 0.0175), (0.5, 0.015), (8, 0.005), (12, 0.005))) > schmidt(10),
        standard_reynolds(10, 0.5, 0.015),
    ),
    "critical-frequency": lambda: (
        math.isclose(
            f_low(12, 0.005),
            100 / (8 * math.sqrt(2) * math.pi * 0.005) * 0.027 / 800
            * math.sqrt(0.0005) / (0.028**2 - 0.012**2), rel_tol=1e-9,
        ),
        f_low(12, 0.005),
    ),
    "usual-numbers": lambda: (
        math.isclose(dean(12, 1, 0.005), dean(12, 1, 0.005, paper=False)), None
    ),
    "amplitude-rule": lambda: (
        f_low(12, 0.01) < f_low(12, 0.005), math.log2(f_low(12, 0.01) / f_low(12, 0.005))
    ),
    "device-10-lower": lambda: (f_low(12, 0.005) > 3 * f_low(10, 0.005), None),
    "dean-below-reynolds": lambda: (
        all(f_low(n, 0.005) < 2000 / (2 * standard_reynolds(n, 1, 0.005)) for n in (12, 10)), None
    ),
    "helix-turbulence": lambda: (max(schmidt(12), schmidt(10)) < 2300, None),
    "m1-below-boundary": lambda: (dean(12, 0.5, 0.02) < 100, None),
    "figure-8-region": lambda: (0.5 < f_low(12, 0.005) < 2, f_low(12, 0.005)),
    "figure-8": lambda: (all(closer((0.3, 0.5))), None),
    "figure-9": lambda: (not any(closer((2.0, 5.0))), None),
    "segmented": oracle_segmented,
    "beyond-800": lambda: (None, None),
    "inertia-above-boundary": oracle_inertia,
    "error-below-friction": oracle_friction_hides,
    "design-lowers": oracle_design,
    "low-means-inertial": oracle_low_means_inertial,
}
VERDICT = {True: "reproduced", False: "not-reproduced", None: "unverifiable"}
CHECKED = [check() for check in CLAIMS]
LEAST = {"design-lowers"}  # its value is an optimum, the oracle only a design


def test_every_claim_has_an_oracle_and_there_are_more_than_twenty():
    assert sorted(claim.id for claim in CHECKED) == sorted(ORACLES)
    assert len(CHECKED) >= 20


@pytest.mark.parametrize("claim", CHECKED, ids=lambda claim: claim.id)
def test_verdict_and_value_agree_with_the_oracle(claim):
    holds, value = ORACLES[claim.id]()
    assert claim.verdict == VERDICT[None if holds is None else bool(holds)]
    if value is not None:
        assert claim.computed == pytest.approx(value, rel=2e-3, abs=1e-6)


def test_numbers_of_the_contradictions():
    by_id = {claim.id: claim for claim in CHECKED}
    assert f"{dean(12, 0.5, 0.02):.0f}" in by_id["m1-below-boundary"].computed
    assert f"{dean(12, 0.5, 0.02, paper=False):.0f}" in by_id["m1-below-boundary"].computed
    for key, pairs in (("figure-8", (0.3, 0.5)), ("figure-9", (2.0, 5.0))):
        for f in pairs:
            for name in ("M1", "M2"):
                assert f"{deviation(name, f, 0.005):.1f}" in by_id[key].computed
    assert f"{schmidt(12):.0f}" in by_id["helix-turbulence"].computed
    orders = by_id["order-across-records"].computed
    assert orders.split(", ")[0] == f"{phase_of_integer(3, 0.01):.2f}"
    # The composition's left side by quadrature.
    slope = mpmath.mpf("0.4") / mpmath.gamma(1.4)
    twice = mpmath.quad(lambda s: slope * s**-0.6 * (2 - s) ** -0.6, [0, 1, 2]) / mpmath.gamma(0.4)
    assert f"{float(twice):.3f}" in by_id["composition"].computed


def test_claims_can_turn_out_otherwise(monkeypatch):
    # What each verdict hangs on, moved: it must follow.
    from dataclasses import replace

    from discover.reproduction import paper

    monkeypatch.setattr(operators, "M1", replace(M1, order=1.2))
    assert operators.order_range().verdict == "reproduced"
    assert operators.low_order_from_flow().verdict == "reproduced"
    monkeypatch.setitem(paper.PRINTED_INERTANCE, "device-10", 67.93)
    assert devices.inertance_of_10().verdict == "reproduced"
    monkeypatch.setitem(paper.PRINTED_INERTANCE, "device-12", 380.0)
    assert devices.inertance_of_12().verdict == "not-reproduced"
    slow = replace(M1, condition=replace(M1.condition, frequency=0.1))
    monkeypatch.setattr(boundary_claims, "M1", slow)
    assert boundary_claims.m1_below_boundary().verdict == "reproduced"
    row = fit_claims.TABLE_3[3]
    assert fit_claims.table_3_claim(replace(row, error_percent=0.35)).verdict == "reproduced"
    assert fit_claims.table_3_claim(replace(row, error_percent=2.0)).verdict == "not-reproduced"


def test_presets_hold_table_1():
    for number, d in T.items():
        device = Device.preset(f"device-{number}")
        pairs = (("r1", "rod_radius"), ("r2", "cylinder_radius"), ("r3", "channel_radius"),
                 ("r4", "helix_radius"), ("h", "helix_pitch"), ("n", "turns"),
                 ("l0", "transition_length"), ("f0", "coulomb_friction"))
        for key, name in pairs:
            assert getattr(device, name) == d[key]
        assert device.fluid.density == d["rho"] and device.fluid.viscosity == d["mu"]
