"""Rank and conditioning of the structures on a plan of tests, before any fit.

The columns are the slopes of a structure's force with each of its parameters, whitened by the noise
and scaled to unit length. A direction among them counts for the rank where the tests would notice
it: where a force of the measured size along it changes the log-likelihood by what rules a structure
out at 5 %. At no noise this is the rank of algebra.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.data_check.nominal import TELLING, nominal_shapes, supports_of
from discover.data_check.result import Conditioning
from discover.library.dictionary import Dictionary
from discover.regression.covariance import jacobian_of
from discover.regression.support import ProfiledFit, Support
from discover.triangle import Triangle, WindowRows, triangle_of
from models.checks import Array

_ROUND_OFF = 1e-9  # of the greatest singular value: below it a column is a mixture of the others


def conditioning(
    windows: Sequence[WindowRows], dictionary: Dictionary
) -> tuple[Conditioning, ...]:
    """Return rank and condition number of each structure on these tests.

    Parameters
    ----------
    windows : sequence of WindowRows
        Of the records that may be fitted.
    dictionary : Dictionary
        Of their columns.
    """
    triangle = triangle_of(windows)
    found = []
    for name, support in supports_of(dictionary).items():
        values, least = _singular_values((support,), triangle, dictionary)
        singular = values[-1] <= _ROUND_OFF * values[0]
        found.append(
            Conditioning(
                name,
                support.ids,
                columns=values.size,
                rank=int(np.sum(values > least)),
                condition=None if singular else float(values[0] / values[-1]),
            )
        )
    return tuple(found)


def joint_rank(
    supports: Sequence[Support], triangle: Triangle, dictionary: Dictionary
) -> tuple[int, int]:
    """Return the rank and the number of the distinct columns of several structures together."""
    values, least = _singular_values(supports, triangle, dictionary)
    return int(np.sum(values > least)), values.size


def _singular_values(
    supports: Sequence[Support], triangle: Triangle, dictionary: Dictionary
) -> tuple[Array, float]:
    """Return the singular values (p,), falling, and the least that the tests would notice."""
    engine = ProfiledFit(triangle, dictionary)
    slopes = np.column_stack([_slopes(engine, s, dictionary) for s in supports])
    slopes = np.unique(slopes, axis=1)  # a term that two structures share is one column
    columns = engine.triangle.columns @ slopes
    norms = np.linalg.norm(columns, axis=0)
    found = np.linalg.svd(columns / np.where(norms > 0.0, norms, 1.0), compute_uv=False)
    values = np.zeros(columns.shape[1])  # fewer rows than columns leave directions unseen
    values[: found.size] = found
    noticed = np.sqrt(2.0 * TELLING / max(engine.energy, 1e-300))
    return values, max(float(noticed), _ROUND_OFF * float(values[0]))


def _slopes(engine: ProfiledFit, support: Support, dictionary: Dictionary) -> Array:
    """Return (K, p) slopes on the dictionary's columns with coefficients and free shapes."""
    fit = engine.at(support, nominal_shapes(support))
    return jacobian_of(replace(fit, coefficients=np.ones_like(fit.coefficients)), dictionary)
