"""The rows of records: what they are projected on."""

import numpy as np
import pytest

from discover.naming.rows import _orthonormal
from discover.sine_fit import harmonic_design


@pytest.mark.parametrize("cycles", [0.6, 1.3, 8.3])
def test_the_projections_are_orthonormal_each_along_what_is_new_of_it(cycles):
    """Against numpy's QR; in less than a cycle harmonics are hardly told apart."""
    time = np.arange(900) / 900 * cycles
    slow = np.polynomial.legendre.legvander(2.0 * time / time[-1] - 1.0, 3)[:, 1:]
    columns = np.concatenate([harmonic_design(time, 1.0, 12)[:, :25], slow], axis=1)
    found = _orthonormal(columns)
    np.testing.assert_allclose(found.T @ found, np.eye(28), atol=1e-9)
    along = np.einsum("ij,ij->j", found, columns)
    assert np.all(along > -1e-9 * np.abs(along).max())
    if cycles > 1.0:
        basis, triangle = np.linalg.qr(columns)
        np.testing.assert_allclose(found, basis * np.sign(np.diagonal(triangle)), atol=1e-9)
