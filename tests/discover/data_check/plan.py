"""Plans of exact sine tests of a mass with a damper."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from discover.data_check import check_campaign
from discover.data_check.plan import Plan, SineTest, plan_of
from discover.motion_fit import observe
from discover.records import Campaign, Record
from discover.rows import record_rows

WIDE = ((0.5, 0.01), (1.0, 0.01), (2.0, 0.01), (2.0, 0.005), (6.0, 0.005), (12.0, 0.005))
SINGLE = ((2.0, 0.005), (2.0, 0.01), (2.0, 0.02))


def record(frequency, amplitude, *, noise=0.02, second=0.0, seed=0, **options):
    """Return eight cycles at a hundred samples each; `second` is the motion's second harmonic."""
    generator = np.random.default_rng([seed, round(100 * frequency), round(1e4 * amplitude)])
    time = np.arange(800) / (100.0 * frequency)
    omega = 2.0 * np.pi * frequency
    x, v, a = np.zeros((3, time.size))
    for order, size in ((1, amplitude), (2, second * amplitude)):
        phase = order * omega * time
        x += size * np.sin(phase)
        v += size * order * omega * np.cos(phase)
        a -= size * (order * omega) ** 2 * np.sin(phase)
    force = 370.0 * a + 4000.0 * v
    force += noise * np.std(force) * generator.standard_normal(time.size)
    name = f"{frequency:g}-{1e3 * amplitude:g}.csv"
    return Record(name, time, force, displacement=x, **options)


def campaign(plan, *, rig=None, device=None, **options):
    """Return the campaign of a plan of (frequency, amplitude), Hz and m."""
    records = tuple(record(f, a, **options) for f, a in plan)
    return Campaign("plan", records, rig=rig, device=device)


@cache
def checked(plan, **options):
    """Return the check of these tests; the same is made once."""
    return check_campaign(campaign(plan, **options))


def planned(plan, **options):
    """Return the plan of these tests as a check sees it."""
    return plan_of([record_rows(observe(r)) for r in campaign(plan, **options).records])


def louder(plan: Plan, factor: float) -> Plan:
    """Return a plan with so many times the noise."""
    sines = tuple(
        SineTest(s.frequency, s.amplitude, factor * s.deviation) for s in plan.sines
    )
    return replace(plan, sines=sines, size=plan.size / factor, noise=factor * plan.noise)


def white(plan: Plan, sigma: np.ndarray, size: float) -> Plan:
    """Return a plan of 800 samples a test with white noise (T,), N, and force of such a size."""
    sines = tuple(
        SineTest(s.frequency, s.amplitude, np.full(s.deviation.size, own / np.sqrt(800.0)))
        for s, own in zip(plan.sines, sigma, strict=True)
    )
    return replace(plan, sines=sines, size=size)
