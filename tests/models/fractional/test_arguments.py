import numpy as np
import pytest

from models.checks import InputError
from models.fractional import (
    band_limited_derivative,
    derivative,
    fractional_derivative,
    harmonic_factors,
    low_pass,
    noise_cutoff,
    spectral_derivative,
    stream_derivative,
)
from models.fractional.convolution import SpectrumCache
from models.fractional.estimate import truncation_error

X = np.sin(0.1 * np.arange(100))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: derivative(X, 2.1, 0.1), r"order must be in \[-1, 2\], got 2.1"),
        (lambda: derivative(X, [[0.5]], 0.1), "order must be a number or a vector"),
        (lambda: derivative(X, np.nan, 0.1), "order must be finite"),
        (lambda: derivative(X, 0.5, 0.0), "dt must be a finite number > 0"),
        (lambda: derivative(X, 0.5, 0.1, kind="riesz"), "kind must be one of caputo"),
        (lambda: derivative(X, 0.5, 0.1, scheme="bdf7"), "kind caputo: scheme must be one of"),
        (lambda: derivative(X, 0.5, 0.1, kind="weyl", scheme="gl"), "kind weyl: scheme must"),
        (lambda: derivative(X, 1.5, 0.1, scheme="l1"), r"order must be in \(0, 1\)"),
        (lambda: derivative([1.0], 0.5, 0.1), "x must be at least 2 samples long"),
        (lambda: derivative([1.0, np.inf, 2.0], 0.5, 0.1), "inf at index 1"),
        (lambda: derivative(["a", "b"], 0.5, 0.1), "x must be numeric"),
        (lambda: derivative(X[:8], 0.5, 0.1, kind="weyl", scheme="harmonics"), "one and a half"),
        (lambda: band_limited_derivative(X, 0.5, 0.1, cutoff=6.0), "cutoff must be .* <= 5"),
        (lambda: band_limited_derivative(X, 0.5, 0.1, cutoff=0.0), "cutoff must be .* > 0"),
        (lambda: low_pass(X, 0.1, cutoff=1.0, edge_noise=0.0), "edge_noise must be .* > 0"),
        (lambda: low_pass(X[:3], 0.1, cutoff=1.0), "at least 4 samples"),
        (lambda: noise_cutoff(X[:10], 0.1), "at least 16 samples"),
        (lambda: spectral_derivative(X, 0.5, 0.1, cutoff=0.0), "cutoff must be"),
        (lambda: harmonic_factors(3.0, 1.0), "order must be"),
        (lambda: list(stream_derivative([X], [0.5], 0.1, kind="weyl")), "kind must be one of"),
        (lambda: list(stream_derivative([X], [0.5], 0.1, scheme="l1")), "scheme must be one of"),
    ],
)
def test_bad_input_says_what_and_what_was_found(call, message):
    with pytest.raises(InputError, match=message):
        call()


def test_result_says_what_was_done():
    result = fractional_derivative(X, [0.5, 1.5], 0.1)
    assert (result.operator, result.scheme, result.cutoff) == ("caputo", "bdf6", None)
    assert result.error.shape == (2,)
    with pytest.raises(AttributeError):
        result.scheme = "gl"
    plain = fractional_derivative(X, 0.5, 0.1, kind="grunwald-letnikov")
    assert plain.scheme == "gl"
    assert plain.error.shape == ()


@pytest.mark.parametrize("scheme", ["gl", "bdf2", "bdf3", "bdf6", "l1"])
def test_error_estimate_is_near_the_error(scheme):
    t = 0.02 * np.arange(500)
    result = fractional_derivative(t**2.5, 0.5, 0.02, scheme=scheme)
    exact = 3.323350970447843 / 2.0 * t**2
    error = np.sqrt(np.mean((result.values - exact) ** 2) / np.mean(exact**2))
    assert error / 5.0 < result.error < 5.0 * error


def test_records_too_short_to_thin_have_no_truncation_to_show():
    def slope(x, dt):
        return np.gradient(x, dt, axis=-1)[None]

    for count, shown in ((63, False), (64, True)):
        x = np.sin(0.1 * np.arange(count))[None]
        found = truncation_error(slope, x, 0.1, slope(x, 0.1), 2)
        assert found.shape == (1,)
        assert bool(found[0] > 0.0) is shown


def test_cache_drops_the_longest_unused():
    cache = SpectrumCache(320)
    rows = [np.zeros(10, dtype=complex) for _ in range(3)]
    cache.put("a", rows[0])
    cache.put("b", rows[1])
    assert cache.get("a") is rows[0]
    cache.put("c", rows[2])
    assert cache.get("b") is None
    assert cache.get("a") is rows[0]
    cache.put("too large", np.zeros(100, dtype=complex))
    assert cache.get("too large") is None
