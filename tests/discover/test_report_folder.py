import json

import pytest

from discover.report.folder import MANIFEST, check_replaceable, write_folder
from models.checks import InputError


def content(folder):
    return {
        p.relative_to(folder).as_posix(): p.read_text()
        for p in folder.rglob("*")
        if p.is_file() and p.name != MANIFEST
    }


def test_results_replace_earlier_results_and_leave_nothing_of_them(tmp_path):
    target = tmp_path / "out"
    write_folder(target, {"a.json": "1", "figures/x.svg": "x"})
    write_folder(target, {"a.json": "2"})
    assert content(target) == {"a.json": "2"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_a_folder_with_anything_else_is_refused_and_left_alone(tmp_path):
    target = tmp_path / "out"
    write_folder(target, {"a.json": "1"})
    (target / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match=r"earlier results, got .*notes\.txt"):
        write_folder(target, {"a.json": "2"})
    assert content(target) == {"a.json": "1", "notes.txt": "mine"}


def test_a_fresh_folder_refuses_even_earlier_results(tmp_path):
    write_folder(tmp_path / "out", {"a": "1"}, fresh=True)
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"a"}
    with pytest.raises(InputError, match="new or empty folder, got one that holds a"):
        check_replaceable(tmp_path / "out", fresh=True)


def test_an_empty_folder_is_filled(tmp_path):
    (tmp_path / "out").mkdir()
    write_folder(tmp_path / "out", {"a": "1"}, fresh=True)
    assert content(tmp_path / "out") == {"a": "1"}


class Interrupting(dict):
    def items(self):
        yield "first.txt", "1"
        raise KeyboardInterrupt


def test_an_interrupt_while_writing_leaves_the_earlier_results(tmp_path):
    target = tmp_path / "out"
    write_folder(target, {"a.json": "1"})
    with pytest.raises(KeyboardInterrupt):
        write_folder(target, Interrupting(first="1"))
    assert content(target) == {"a.json": "1"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_a_file_in_the_way_is_named(tmp_path):
    (tmp_path / "out").write_text("")
    with pytest.raises(InputError, match="a folder, got a file"):
        write_folder(tmp_path / "out", {"a": "1"})


def test_a_file_among_the_parents_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="in a writable folder"):
        write_folder(tmp_path / "file" / "out", {"a": "1"})


def test_the_manifest_lists_what_was_written(tmp_path):
    write_folder(tmp_path / "out", {"b": "1", "a": b"\x00"})
    assert json.loads((tmp_path / "out" / MANIFEST).read_text()) == ["a", "b"]
