"""Few records of closed formulas as a sheet, and the dense covariance of their rows by formula."""

from __future__ import annotations

import numpy as np

from discover.motion_fit import observe
from discover.posterior.assess import Assessor
from discover.posterior.model import Evaluator
from discover.posterior.setup import space_of
from discover.rows import record_rows
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


def assessor_of(rows, *, friction=True, path=True):
    """Return what assesses models of these rows, with friction's curves or without."""
    space, curve = space_of(rows, TERMS["coulomb-friction"])
    return Assessor(
        space, Evaluator(space.sheet, space.scales), curve if friction else None, path=path
    )


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


def log_density(force, covariance):
    """Return the log density of rows (U R,), without the constant of their number, nats."""
    factor = np.linalg.cholesky(covariance)
    half = np.linalg.solve(factor, force)
    return -0.5 * float(half @ half) - float(np.sum(np.log(np.diag(factor))))
