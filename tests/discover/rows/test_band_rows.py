"""Rows of records that are no sine test: white where noise is left, sizes in the record's force."""

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.records import Record
from discover.rows import force_rows, record_rows
from models.constitutive import FittedTerm, ForceModel

LAW = ForceModel((FittedTerm("viscous-damping", 800.0), FittedTerm("stiffness", 4e3)))


def recorded(*, noise=0.02, seed=0, gain=1.0):
    time = np.arange(6000) / 200.0
    omega = 2.0 * np.pi * np.geomspace(0.51, 6.1, 23)
    turn = np.outer(time, omega) + 1.7 * np.arange(23.0) ** 2
    x, v = 1e-3 * np.sin(turn).sum(axis=1), 1e-3 * (np.cos(turn) * omega).sum(axis=1)
    force = 800.0 * v + 4e3 * x
    level = noise * np.std(force)
    force = force + level * np.random.default_rng(seed).standard_normal(time.size)
    return Record(f"random-{seed}.csv", time, gain * force, x)


@pytest.fixture(scope="module")
def rows():
    return record_rows(observe(recorded()))


def over_force(rows, parts):
    """Return the mean square (..., windows) of rows' errors over the force's, in each window."""
    squares = (parts / rows.size) ** 2
    return np.stack([squares[..., part].sum(axis=-1) for part in rows.windows], axis=-1)


def test_windows_share_the_rows(rows):
    assert rows.cycle is None
    assert rows.coarse is rows
    assert rows.file == "random-0.csv"
    ends = [0, *(part.stop for part in rows.windows)]
    assert [part.start for part in rows.windows] == ends[:-1]
    assert ends[-1] == rows.target.size == rows.size.size
    for window, part in zip(rows.observation.windows, rows.windows, strict=True):
        assert part.stop - part.start == 2 * window.omega.size


def test_a_law_s_rows_are_those_of_its_force(rows):
    motion = rows.motion
    force = 800.0 * motion.velocity + 4e3 * motion.displacement
    np.testing.assert_allclose(force_rows(rows, LAW), rows.of_motion(force), rtol=1e-9, atol=1e-9)
    # What it leaves of its own record is noise: white, of unit size.
    left = rows.target - force_rows(rows, LAW)
    assert np.mean(left**2) == pytest.approx(1.0, abs=0.2)
    assert np.linalg.norm(left) < 0.1 * np.linalg.norm(rows.target)


def test_a_force_is_its_share_of_the_size(rows):
    # The whole force: the lines hold all of it but what lies beyond the band.
    whole = over_force(rows, rows.target)
    share = np.array([w.share for w in rows.observation.windows])
    assert np.sum(share * whole) == pytest.approx(1.0, rel=0.05)


def test_units_of_force_change_no_row_s_meaning():
    one, other = (record_rows(observe(recorded(gain=g))) for g in (1.0, 1e3))
    np.testing.assert_allclose(other.target, one.target, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(other.size, one.size, rtol=1e-6)
    scale = np.abs(one.remainder).max()
    np.testing.assert_allclose(other.remainder, one.remainder, atol=1e-6 * scale)
    np.testing.assert_allclose(other.loudness, one.loudness, rtol=1e-6)


def test_what_no_term_has_is_as_large_as_the_force(rows):
    # All functions together make the record's own force, each the same part of it.
    share = np.array([w.share for w in rows.observation.windows])
    each = over_force(rows, rows.remainder) @ share
    np.testing.assert_allclose(each, 1.0 / each.size, rtol=1e-9)
    # An independent error of the record's size fills each window once; none is a sine test's.
    np.testing.assert_allclose(over_force(rows, rows.loudness), [[0.0], [1.0]] + 0.0 * share)


def test_what_no_term_has_holds_any_smooth_response_and_static_law(rows):
    # A spring, a damper and a cubic spring are made of the generic functions almost wholly.
    for name in ("viscous-damping", "stiffness", "cubic-stiffness"):
        wanted = force_rows(rows, ForceModel((FittedTerm(name, 1e3),))) / rows.size
        columns = (rows.remainder / rows.size).T
        left = wanted - columns @ np.linalg.lstsq(columns, wanted)[0]
        assert np.linalg.norm(left) < 0.3 * np.linalg.norm(wanted), name


@pytest.mark.parametrize(("i", "j"), [(k, n - k) for n in (2, 3) for k in range(n + 1)])
def test_what_no_term_has_holds_products_of_displacement_and_velocity(rows, i, j):
    motion = rows.motion
    x = motion.displacement - motion.displacement.mean()
    wanted = rows.of_motion(x**i * motion.velocity**j) / rows.size
    columns = (rows.remainder / rows.size).T
    left = wanted - columns @ np.linalg.lstsq(columns, wanted)[0]
    assert np.linalg.norm(left) < 1e-6 * np.linalg.norm(wanted)
