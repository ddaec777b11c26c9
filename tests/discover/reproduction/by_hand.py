"""The paper's formulas written out a second time, for tests: nothing of the packages is used."""

import math

import numpy as np
from scipy import special
from scipy.optimize import minimize

# Table 1, SI.
T = {
    12: {"r1": 0.012, "r2": 0.028, "r3": 0.005, "r4": 0.1, "h": 0.012, "n": 14, "rho": 800.0,
         "mu": 0.027, "l0": 0.1, "b": 370.38, "f0": 400.0},
    10: {"r1": 0.014, "r2": 0.025, "r3": 0.006, "r4": 0.12, "h": 0.03, "n": 7, "rho": 802.0,
         "mu": 0.00168, "l0": 0.0, "b": 73.82, "f0": 550.0, "dr": 1e-4},
}
MODELS = {"M1": (12, 18.25, 0.48), "M2": (12, 0.57, 1.89), "M3": (10, 0.087, 1.98)}
RECORDS = {"M1": (0.5, 0.02), "M2": (12.0, 0.005), "M3": (3.0, 0.0175)}
ROWS = {
    "table-3-12-3hz": ("M2", 3.0, 0.01, 19.1), "table-3-12-8hz": ("M2", 8.0, 0.005, 2.6),
    "table-3-12-15hz": ("M2", 15.0, 0.005, 5.44), "table-3-10-0.5hz": ("M3", 0.5, 0.015, 0.2),
    "table-3-10-8hz": ("M3", 8.0, 0.005, 2.12), "table-3-10-12hz": ("M3", 12.0, 0.005, 1.85),
}
PHASE = 2 * np.pi * (np.arange(5000) + 0.5) / 5000


def areas(d):
    return math.pi * (d["r2"] ** 2 - d["r1"] ** 2), math.pi * d["r3"] ** 2


def length(d):
    return d["n"] * math.sqrt(d["h"] ** 2 + (2 * math.pi * d["r4"]) ** 2)


def inertance(d, *, ends=2.0):
    s1, s2 = areas(d)
    mass = d["rho"] * (length(d) + ends * d["l0"]) * s2
    return mass / (1 + (d["h"] / (2 * math.pi * d["r4"])) ** 2) * (s1 / s2) ** 2


def damping(d):
    """c1 of v|v| and c2 of v (Eq. 5)."""
    s1, s2 = areas(d)
    return 0.75 * d["rho"] * s1**3 / s2**2, 8 * d["mu"] * length(d) * s1**2 / (d["r3"] ** 2 * s2)


def integer_force(number, f, amplitude, *, laminar=None, friction=None):
    d = T[number]
    omega = 2 * math.pi * f
    v, a = amplitude * omega * np.cos(PHASE), -amplitude * omega**2 * np.sin(PHASE)
    s1, s2 = areas(d)
    f0 = d["f0"] if friction is None else friction
    c1, c2 = damping(d)
    if laminar if laminar is not None else number == 12:
        return d["b"] * a + c1 * v * abs(v) + c2 * v + f0 * np.sign(v)
    blasius = 0.0664 * d["mu"] ** 0.25 * d["rho"] ** 0.75 * length(d) * s1
    blasius *= d["r3"] ** -1.25 * (s1 / s2) ** 1.75
    film = 2 * math.pi * d["mu"] * d["r2"] * (2 * d["n"] * d["r3"]) / d["dr"]
    return (d["b"] * a + blasius * abs(v) ** 1.75 * np.sign(v) + c1 * v * abs(v) + film * v
            + f0 * np.sign(v))


def fractional_force(name, f, amplitude, *, b0=None, order=None, friction=None):
    number, b0_, order_ = MODELS[name]
    b0, order = (b0_ if b0 is None else b0), (order_ if order is None else order)
    omega, d = 2 * math.pi * f, T[number]
    f0 = d["f0"] if friction is None else friction
    steady = amplitude * omega**order * np.sin(PHASE + order * math.pi / 2)  # Eq. 4
    return d["b"] * (1 + b0) * steady + f0 * np.sign(np.cos(PHASE))


def e_d(force, reference, *, over=np.max):
    return 100 * math.sqrt(np.mean((force - reference) ** 2)) / over(np.abs(reference))


def deviation(name, f, amplitude, **kw):
    number = MODELS[name][0]
    return e_d(fractional_force(name, f, amplitude, **kw), integer_force(number, f, amplitude))


def dean(number, f, amplitude, *, paper=True):
    d = T[number]
    s1, s2 = areas(d)
    re = d["rho"] * 2 * d["r3"] * s1 / s2 * 2 * math.pi * f * amplitude / d["mu"]
    de = re * math.sqrt(d["r3"] / d["r4"])
    return 2 * math.sqrt(2) * de if paper else de


def f_low(number, amplitude, *, paper=True):
    return 100 / dean(number, 1.0, amplitude, paper=paper)  # De is linear in f


def standard_reynolds(number, f, amplitude):
    d = T[number]
    return dean(number, f, amplitude, paper=False) / math.sqrt(d["r3"] / d["r4"])


def schmidt(number):
    """Transition in a coil: 2300 (1 + 8.6 (d/D)^0.45)."""
    return 2300 * (1 + 8.6 * (T[number]["r3"] / T[number]["r4"]) ** 0.45)


def flow_order(number, f):
    """Order by phase of laminar pipe flow, from J0 and J2 of i^(3/2) Wo."""
    d = T[number]
    wo = d["r3"] * math.sqrt(2 * math.pi * f * d["rho"] / d["mu"])
    z = wo * np.exp(0.75j * math.pi)
    velocity_impedance = 1j * special.jv(0, z) / (-special.jv(2, z))
    return 1 + 2 / math.pi * np.angle(velocity_impedance)


def spread(key):
    name, f, amplitude, printed = ROWS[key]
    _, b0, order = MODELS[name]
    half = 0.005 if name == "M2" else 0.0005
    box = [(b0 - half, b0 + half), (order - 0.005, order + 0.005)]
    ends = []
    for sign in (1, -1):
        runs = [
            minimize(lambda p, s=sign: s * deviation(name, f, amplitude, b0=p[0], order=p[1]),
                     start, bounds=box, method="Powell").fun
            for start in [(b0, order), *((x, y) for x in box[0] for y in box[1])]
        ]
        ends.append(sign * min(runs))
    return ends[0], ends[1], printed


def table_3(key):
    low, high, printed = spread(key)
    name, f, amplitude, _ = ROWS[key]
    return low - 0.1 <= printed <= high + 0.1, deviation(name, f, amplitude)


def worst_with_friction(twelve, ten):
    return max(
        abs(
            e_d(
                fractional_force(name, f, a, friction=fr),
                integer_force(MODELS[name][0], f, a, friction=fr),
            ) - printed
        )
        for name, f, a, printed in ROWS.values()
        for fr in [twelve if MODELS[name][0] == 12 else ten]
    )


def phase_of_integer(f, amplitude):
    """Order by phase of Eq. 5 without friction, by describing function."""
    c1, c2 = damping(T[12])
    omega = 2 * math.pi * f
    c = c2 + 8 / (3 * math.pi) * c1 * omega * amplitude
    return 1 + 2 / math.pi * math.atan(omega * T[12]["b"] / c)


def fundamental(force):
    return np.sum(force * np.exp(-1j * PHASE))
