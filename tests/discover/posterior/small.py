"""Few records of closed formulas as a sheet, and the dense covariance of their rows by formula."""

from __future__ import annotations

import numpy as np

from discover.motion_fit import observe
from discover.posterior.assess import Assessor
from discover.posterior.model import Composite, Evaluator
from discover.posterior.setup import space_of
from discover.records import Record
from discover.rows import record_rows
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS
from tests.discover.gap_data import PLAN, record

APART = ((0.5, 0.012), (2.0, 0.003), (8.0, 0.001), (2.0, 0.02))
"""Tests whose kernel has no direction that is left out."""
INDEPENDENT = 0.1
"""Share of the remainder's variance that differs from test to test (engine.md)."""


def rows_of(law, plan=PLAN, *, noise=0.01, seed=0, cycles=5):
    """Return the rows of sine tests of a law of t, x, v, a."""
    rng = np.random.default_rng(seed)
    return [
        record_rows(observe(record(f, a, law, rng, noise=noise, cycles=cycles))) for f, a in plan
    ]


def random_rows(seed=1):
    """Return a long record of random motion, whose units keep some directions of their rows."""
    rng = np.random.default_rng(seed)
    time = np.arange(12000) / 200.0
    omega = 2.0 * np.pi * np.sort(rng.uniform(0.3, 8.0, 60))[:, None]
    angle = omega * time + rng.uniform(0.0, 6.0, omega.shape)
    x, v, a = (
        np.sum(1e-3 * omega**k * np.minimum(1.0, 3.0 / omega) * turned, axis=0)
        for k, turned in enumerate((np.sin(angle), np.cos(angle), -np.sin(angle)))
    )
    force = 120.0 * a + 800.0 * v
    force = force + 0.01 * np.std(force) * rng.standard_normal(time.size)
    return record_rows(observe(Record(f"random-{seed}.csv", time, force, x)))


def assessor_of(rows, *, friction=True, named=True):
    """Return what assesses models of these rows, with friction's curves or without."""
    space, curve = space_of(rows, TERMS["coulomb-friction"])
    evaluator = Evaluator(space.sheet, space.scales)
    return Assessor(space, evaluator, curve if friction else None, named)


def model_of(**coefficients):
    """Return a model of terms in all units; an underscore stands for the hyphen of an id."""
    return Composite.of(
        ForceModel(tuple(FittedTerm(i.replace("_", "-"), c) for i, c in coefficients.items()))
    )


def of_formula(rows, formula):
    """Return the rows (U, R) of a formula of t, x, v, a on each sine test's steady cycle."""
    found = []
    for r in rows:
        m = r.cycle
        found.append(
            formula(m.time, m.displacement, m.velocity, m.acceleration) @ r.cycle_rows
        )
    return np.array(found)


def flat(columns):
    """Return columns (U, K, R) of units side by side, (U R, K)."""
    return columns.transpose(0, 2, 1).reshape(-1, columns.shape[1])


def dense(space, sizes):
    """Return the covariance (U R, U R) of rows, straight from the statement."""
    sheet = space.sheet
    units, _, size = sheet.remainder.shape
    whole = np.eye(units * size)
    loud = np.einsum("l,ulr->ur", np.square(sizes.loud), sheet.loudness**2)
    whole[np.diag_indices_from(whole)] += loud.ravel()
    place = np.log([[u.frequency, u.amplitude] for u in sheet.units])
    alike = np.exp(-0.5 * np.sum((place[:, None] - place[None]) ** 2, axis=2))
    alike = (1.0 - INDEPENDENT) * alike + INDEPENDENT * np.eye(units)
    blocks = whole.reshape(units, size, units, size)
    for i in range(units):
        for j in range(units):
            shared = sheet.remainder[i].T @ sheet.remainder[j]
            blocks[i, :, j] += sizes.remainder**2 * alike[i, j] * shared
        blocks[i, :, i] += sizes.friction**2 * space.own[i].T @ space.own[i]
    return whole


def widened(covariance, columns, spread):
    """Return the covariance of rows with columns (U, K, R) of normal coefficients."""
    matrix = flat(columns)
    return covariance + (matrix * np.square(spread)) @ matrix.T


def whole_force(columns, target):
    """Return the coefficients (K,) at which columns (U, K, R) have the force's size in the mean."""
    share = np.sum(columns**2, axis=2) / np.sum(target**2, axis=1)[:, None]
    return 1.0 / np.sqrt(share.mean(axis=0))


def log_density(force, covariance):
    """Return the log density of rows (U R,), without the constant of their number, nats."""
    factor = np.linalg.cholesky(covariance)
    half = np.linalg.solve(factor, force)
    return -0.5 * float(half @ half) - float(np.sum(np.log(np.diag(factor))))
