import numpy as np
import pytest

from discover.motion_fit.harmonic_lines import harmonic_lines
from discover.sine_fit import harmonic_design


@pytest.mark.parametrize("samples", [700, 10_001])
@pytest.mark.parametrize("drift", [True, False])
@pytest.mark.parametrize("count", [1, 7, 31])
def test_coefficients_are_those_of_all_columns_at_once(count, drift, samples):
    generator = np.random.default_rng(count)
    time = np.sort(generator.uniform(0.0, 4.0, samples))
    columns = generator.standard_normal((3, time.size))
    middle = float(time.mean())
    fit = harmonic_lines(time, 1.7, count, middle=middle if drift else None)
    design = harmonic_design(time, 1.7, count, trend=drift)
    expected = np.linalg.lstsq(design, columns.T, rcond=None)[0].T
    found = fit.solve(columns)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())
    np.testing.assert_allclose(fit.fitted(found[0]), design @ found[0], rtol=0.0, atol=1e-12)


def test_lines_keep_the_mean_square_of_a_whole_cycle():
    time = np.arange(400) / 400.0
    force = 2.0 + 3.0 * np.cos(2 * np.pi * time + 0.3) + 0.5 * np.sin(6 * np.pi * time)
    lines = harmonic_lines(time, 1.0, 5, middle=None).lines(force)
    assert np.sum(np.abs(lines) ** 2) == pytest.approx(np.mean(force**2), rel=1e-12)


def test_memory_does_not_grow_with_harmonics_times_samples():
    import tracemalloc

    time = np.arange(300_000) / 1000.0
    column = np.sin(2 * np.pi * 1.3 * time)[None]
    tracemalloc.start()
    fit = harmonic_lines(time, 1.3, 31, middle=150.0)
    fit.fitted(fit.solve(column)[0])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4 * time.nbytes  # of columns there would be 64
