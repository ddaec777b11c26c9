"""What MATLAB 5 files may hold: every type of number, strings, cells, structures; whole or not."""

import io
import struct

import numpy as np
import pytest
import scipy.io

from discover.readers.mat_guard import damage

TYPES = "int8 uint8 int16 uint16 int32 uint32 int64 uint64 float32 float64".split()


def written(content, **options):
    buffer = io.BytesIO()
    scipy.io.savemat(buffer, content, **options)
    return buffer.getvalue()


def nested(depth):
    inside = np.arange(3.0)
    for _ in range(depth):
        cell = np.empty((1, 1), dtype=object)
        cell[0, 0] = inside
        inside = cell
    return {"a": inside}


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("name", TYPES)
def test_numbers_of_every_type_are_whole(name, packed):
    values = np.arange(1, 8).astype(name)
    content = {"a": values, "b": values.reshape(7, 1, 1)[:6].reshape(3, 2), "c": values[:0]}
    assert damage(written(content, do_compression=packed)) == ""


@pytest.mark.parametrize("packed", [False, True])
def test_complex_numbers_strings_cells_and_structures_are_whole(packed):
    cell = np.empty((1, 3), dtype=object)
    cell[:] = [["text", np.eye(2) * 1j, np.zeros((0, 0))]]
    content = {
        "text": "Kraft", "other": "größer", "cell": cell,
        "both": {"one": np.float32([1, 2]), "two": {"three": "4", "five": 1j}},
    }  # fmt: skip
    assert damage(written(content, do_compression=packed)) == ""


@pytest.mark.parametrize("name", TYPES)
def test_numbers_that_do_not_fill_the_dimensions_are_damage(name):
    whole = written({"a": np.arange(1, 41).astype(name)})
    place = whole.index(struct.pack("<ii", 1, 40))
    for sides, told in (
        ((1, 39), "don't fill the dimensions"),
        ((2, 40), "more values than bytes|don't fill"),
        ((-1, 40), "more values than bytes"),
    ):
        broken = whole[:place] + struct.pack("<ii", *sides) + whole[place + 8 :]
        assert any(text in damage(broken) for text in told.split("|"))


def test_a_file_that_is_cut_off_anywhere_is_damage():
    whole = written({"a": np.arange(5.0), "b": {"c": np.arange(3)}})
    # Whole variables may be missing at the end: each begins at a place where one ends.
    ends = [128, 128 + 8 + struct.unpack_from("<I", whole, 132)[0], len(whole)]
    for size in range(129, len(whole)):
        assert (damage(whole[:size]) == "") == (size in ends)


def test_structures_in_each_other_have_an_end():
    assert damage(written(nested(16))) == ""
    assert "more than 16 deep" in damage(written(nested(17)))


def test_files_of_other_versions_are_not_looked_at():
    assert damage(b"") == ""
    assert damage(b"not a file of MATLAB" * 20) == ""
    assert damage(written({"a": np.arange(4.0)}, format="4")) == ""
