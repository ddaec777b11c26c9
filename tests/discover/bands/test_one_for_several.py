"""Numbers of every test's own give way to one that all share, once another term explains the rest.
"""

from dataclasses import replace

import numpy as np

from discover.bands.ways import found
from discover.study import StudyOptions
from discover.study.prepare import prepare
from tests.discover.exact import campaign


def two_valves(amplitude, omega, theta):
    """A damper of two rates under a constant force, with a harmonic that no term has."""
    v = amplitude * omega * np.cos(theta)
    odd = 90.0 * amplitude * omega * np.sin(3.0 * theta)
    return np.where(v > 0.0, 2000.0, 500.0) * v + odd - 180.0


def test_the_offsets_of_tests_become_one_once_the_asymmetry_has_joined():
    records = campaign(
        two_valves, frequencies=(0.3, 1.0, 3.0), amplitudes=(0.01, 0.03), noise=0.003
    )
    device = prepare(records, StudyOptions()).device
    device = replace(device, bands=1, extras=("force-offset", "asymmetric-damping"))
    joined = {j.id: j.terms for j in found(device).joined}
    assert set(joined) == {"force-offset", "asymmetric-damping"}
    (shared,) = joined["force-offset"]
    assert shared.shape["only"] == 0.0
