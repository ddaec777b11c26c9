"""A sine test that is read in pieces, against the same samples in memory."""

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.record_checks import check_record
from discover.records import LongRecord, Piece, Record
from discover.rows import accuracy, record_rows
from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel

RATE, FREQUENCY, AMPLITUDE = 500.0, 1.6123, 0.01
SAMPLES = 150_000


def samples(*, ramp=0.0, size=SAMPLES):
    """Return time, displacement and force: inertia, damping, friction; noise in both channels."""
    rng = np.random.default_rng(3)
    time = 5.0 + np.arange(size) / RATE
    angle = 2.0 * np.pi * FREQUENCY * time
    grown = 1.0 if not ramp else np.clip((time - time[0]) / ramp, 0.0, 1.0)
    place = AMPLITUDE * grown * (np.sin(angle) + 0.02 * np.sin(3.0 * angle + 0.3))
    force = grown * (-300.0 * np.sin(angle) + 50.0 * np.cos(angle))
    force += 20.0 * np.tanh(np.cos(angle) / 0.05) + 0.02 * (time - time[0])
    noise = rng.standard_normal((2, size))
    return time, place + 2e-6 * noise[0], force + 6.0 * noise[1]


def in_memory(columns):
    time, place, force = columns
    return Record("a", time, force, place)


def in_pieces(columns, *, held=80_000, piece=10_007, read=None):
    """Return the record whose first samples alone are held."""
    time, place, force = columns

    def pieces():
        for first in range(0, time.size, piece):
            part = slice(first, first + piece)
            if read is not None:
                read.append(time[part].size)
            yield Piece(time[part], place[part], force[part])

    long = LongRecord(time.size, pieces)
    return Record("a", time[:held], force[:held], place[:held], long=long)


MODEL = ForceModel(
    (
        FittedTerm("inertia", 300.0 / AMPLITUDE / (2.0 * np.pi * FREQUENCY) ** 2),
        FittedTerm("viscous-damping", 45.0 / AMPLITUDE / (2.0 * np.pi * FREQUENCY)),
        FittedTerm("coulomb-friction", 20.0),
    )
)


@pytest.mark.parametrize(("piece", "ramp"), [(10_007, 0.0), (65_536, 8.0)])
def test_rows_are_those_of_the_whole_record(piece, ramp):
    columns = samples(ramp=ramp)
    long = record_rows(observe(in_pieces(columns, piece=piece)))
    start = long.observation.usable.start or 0
    assert (start > 0) == (ramp > 0.0)
    whole = record_rows(observe(in_memory([c[start:] for c in columns])))
    assert long.observation.frequency == pytest.approx(whole.observation.frequency, rel=1e-12)
    assert long.observation.duration == pytest.approx(whole.observation.duration, rel=1e-12)
    for name in ("target", "size", "cycle_rows"):
        found, expected = getattr(long, name), getattr(whole, name)
        np.testing.assert_allclose(
            found, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max(), err_msg=name
        )


def test_errors_are_over_all_samples():
    columns = samples()
    columns[2][100_000:] += 5.0 * np.random.default_rng(4).standard_normal(SAMPLES - 100_000)
    whole = accuracy(observe(in_memory(columns)), MODEL)
    long = accuracy(observe(in_pieces(columns)), MODEL)
    assert long.error_power == pytest.approx(whole.error_power, rel=1e-9)
    assert long.force_power == pytest.approx(whole.force_power, rel=1e-9)
    assert long.samples == whole.samples


def test_errors_of_what_drifts_follow_the_time():
    drifting = ForceModel((*MODEL.terms, FittedTerm("sensor-drift", 0.02)))
    columns = samples()
    whole = accuracy(observe(in_memory(columns)), drifting)
    long = accuracy(observe(in_pieces(columns)), drifting)
    still = accuracy(observe(in_memory(columns)), MODEL).error_power
    assert still - whole.error_power > 5.0  # N^2: the drift is there, and its model takes it off
    assert still - long.error_power == pytest.approx(still - whole.error_power, rel=1e-2)


def test_few_passes_are_enough():
    read = []
    observe(in_pieces(samples(), read=read))
    assert sum(read) <= 4 * SAMPLES


def test_a_check_tells_all_samples_and_cycles():
    found = check_record(observe(in_pieces(samples())))
    assert found.samples == SAMPLES
    assert found.kind.cycles == pytest.approx(FREQUENCY * SAMPLES / RATE, rel=1e-4)


@pytest.mark.parametrize("change", ["amplitude", "frequency"])
def test_a_motion_that_changes_later_is_told(change):
    time, place, force = samples()
    late = time > time[0] + 200.0
    if change == "amplitude":
        place = np.where(late, 0.8 * place, place)
    else:
        turn = 2.0 * np.pi * 1.001 * FREQUENCY * time
        place = np.where(late, AMPLITUDE * np.sin(turn), place)
    with pytest.raises(InputError, match="steady sine throughout"):
        observe(in_pieces((time, place, force)))
