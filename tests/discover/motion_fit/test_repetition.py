"""What cycles differ by, where it is taken apart from what changes slowly."""

import numpy as np
from scipy.sparse import csr_array, eye_array

from discover.motion_fit.repetition import _without_changes


def test_samples_that_are_left_out_do_not_run_away():
    """What repeats may lie in them alone: nothing kept then says how it changes."""
    rng = np.random.default_rng(0)
    time = np.arange(528) / 128.0
    phase = np.mod(0.97 * time, 1.0)
    kept = np.abs(phase - 0.5) > 0.03
    repeated = np.where(kept, 1e-7 * rng.standard_normal(528), 5.0)
    left = 0.4 * rng.standard_normal(528)
    nothing = csr_array(0.0 * eye_array(528))
    found = _without_changes(nothing, time, left, repeated, 0.97, kept)
    np.testing.assert_array_equal(found[~kept], left[~kept])
    assert np.abs(found).max() <= 1.5 * np.abs(left).max()
    assert np.std(found[kept]) < np.std(left[kept])
