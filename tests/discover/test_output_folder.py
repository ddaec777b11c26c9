"""Folders of results: shared, linked, mounted, read-only, or left by a run that was killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from discover.cli import main
from discover.report import folder as folders
from discover.report.folder import MANIFEST, check_replaceable, write_folder
from discover.report.lock import folder_lock
from discover.report.swap import rename_twice
from models.checks import InputError

ROOT = Path(__file__).parents[2]


def content(folder: Path) -> dict[str, str]:
    return {
        p.relative_to(folder).as_posix(): p.read_text()
        for p in folder.rglob("*")
        if p.is_file() and p.name != MANIFEST
    }


def test_the_working_folder_is_filled_and_stays_the_one_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    before = os.stat(".").st_ino
    write_folder(".", {"a.json": "1", "figures/x.svg": "x"})
    write_folder(".", {"a.json": "2", "b.txt": "b"})
    assert content(here) == {"a.json": "2", "b.txt": "b"}
    assert os.stat(".").st_ino == before
    assert {p.name for p in here.iterdir()} == {"a.json", "b.txt", MANIFEST}
    (here / "mine.txt").write_text("")
    with pytest.raises(InputError, match="also holds mine.txt"):
        write_folder(".", {"a.json": "3"})


def test_a_mount_point_is_filled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "mounted"
    target.mkdir()
    before = target.stat().st_ino
    monkeypatch.setattr(folders.os.path, "ismount", lambda path: Path(path) == target)
    write_folder(target, {"a": "1"})
    write_folder(target, {"b": "2"})
    assert content(target) == {"b": "2"}
    assert target.stat().st_ino == before


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    for text in ("1", "2"):
        write_folder(tmp_path / "link", {"a": text})
    assert (tmp_path / "link").is_symlink()
    assert content(tmp_path / "real") == {"a": "2"}
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    with pytest.raises(InputError, match="output must be"):
        write_folder(tmp_path / "loop", {"a": "1"})


@pytest.mark.parametrize("kind", ["folder", "link", "folder inside"])
def test_what_is_the_users_own_in_an_old_result_is_refused_and_stays(
    tmp_path: Path, kind: str
) -> None:
    target = tmp_path / "out"
    write_folder(target, {"a": "1", "figures/b": "2"})
    mine = target / ("figures/mine" if kind == "folder inside" else "mine")
    if kind == "link":
        mine.symlink_to(tmp_path)
    else:
        mine.mkdir()
    with pytest.raises(InputError, match="earlier results, got one that also holds .*mine"):
        write_folder(target, {"a": "2"})
    assert os.path.lexists(mine)


@pytest.mark.parametrize("text", ["5", "{}", "[[1], 2]", "[", "null", "[" * 99999, '["../mine"]'])
def test_a_damaged_manifest_makes_the_folder_foreign(tmp_path: Path, text: str) -> None:
    target = tmp_path / "out"
    (tmp_path / "mine").write_text("")
    write_folder(target, {"a": "1"})
    (target / MANIFEST).write_text(text)
    with pytest.raises(InputError, match="also holds a$"):
        write_folder(target, {"a": "2"})
    assert (tmp_path / "mine").exists()


def test_a_read_only_folder_is_refused_before_any_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "out").mkdir()
    real = os.access  # root may write anywhere
    monkeypatch.setattr(
        folders.os, "access", lambda p, mode: Path(p) != tmp_path / "out" and real(p, mode)
    )
    with pytest.raises(InputError, match="output must be writable, got a folder that is not"):
        check_replaceable(tmp_path / "out")


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="only Linux has such a folder")
def test_a_place_that_holds_no_folders_is_refused_before_any_work() -> None:
    """To the superuser its permissions say that it may be written to."""
    with pytest.raises(InputError, match="output must be"):
        check_replaceable("/proc/inerter")


def test_what_a_killed_run_left_is_brought_back_and_cleared(tmp_path: Path) -> None:
    """Killed between the two renames of a system without an exchange."""
    write_folder(tmp_path / "out", {"a": "earlier"})
    old = tmp_path / ".out-old-123"
    old.mkdir()
    (tmp_path / "out").rename(old / "kept")
    (tmp_path / ".out-part-xyz").mkdir()
    with pytest.raises(KeyboardInterrupt):
        write_folder(tmp_path / "out", _Interrupting(a="1"))
    assert content(tmp_path / "out") == {"a": "earlier"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


class _Interrupting(dict):
    def items(self):
        yield "first.txt", "1"
        raise KeyboardInterrupt


def test_a_result_takes_the_place_of_the_one_before(tmp_path: Path) -> None:
    for text in ("1", "2", "3"):
        write_folder(tmp_path / "out", {"a": text})
    assert content(tmp_path / "out") == {"a": "3"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_two_renames_do_it_where_there_is_no_system_call(tmp_path: Path) -> None:
    write_folder(tmp_path / "out", {"a": "earlier"})
    write_folder(tmp_path / "part", {"b": "later"})
    rename_twice(tmp_path / "part", tmp_path / "out")
    assert content(tmp_path / "out") == {"b": "later"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_the_earlier_result_stays_where_the_new_one_can_t_take_its_place(tmp_path: Path) -> None:
    write_folder(tmp_path / "out", {"a": "earlier"})
    with pytest.raises(FileNotFoundError):
        rename_twice(tmp_path / "gone", tmp_path / "out")
    assert content(tmp_path / "out") == {"a": "earlier"}
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_a_second_run_into_the_same_folder_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = (
        "import sys, time; from pathlib import Path; from discover.report.lock import folder_lock\n"
        f"with folder_lock(Path({str(tmp_path / 'out')!r})):\n"
        "    print('held', flush=True); time.sleep(60)"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    holder = subprocess.Popen(
        [sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, text=True
    )
    try:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        assert main(["reproduce", "-o", str(tmp_path / "out")]) == 2
        err = capsys.readouterr().err
        assert f"output must be free to write to, got another run's (process {holder.pid})" in err
    finally:
        holder.kill()
        holder.wait()
    with folder_lock(tmp_path / "out"):  # the kernel has let it go
        write_folder(tmp_path / "out", {"a": "1"})


_WRITER = """
import sys
from models.checks import InputError
from discover.report.folder import write_folder
for turn in range(60):
    try:
        write_folder(sys.argv[1], {f"{i}.txt": sys.argv[2] for i in range(5)})
    except InputError as error:
        assert "free to write to" in str(error), error
"""


def test_two_writers_leave_one_whole_result_and_nothing_else(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    writers = [
        subprocess.Popen(
            [sys.executable, "-c", _WRITER, str(tmp_path / "out"), name],
            env=environment, stderr=subprocess.PIPE, text=True,
        )
        for name in "xy"
    ]  # fmt: skip
    while any(w.poll() is None for w in writers):
        found = content_or_none(tmp_path / "out")
        assert found is None or found in ("x", "y")
    assert [w.communicate()[1] for w in writers] == ["", ""]
    assert len(set(content(tmp_path / "out").values())) == 1
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def content_or_none(folder: Path) -> str | None:
    """One file of a result at this moment: there is never none once there was one."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except FileNotFoundError:
        assert not getattr(content_or_none, "met", False), "a moment without any result"
        return None
    content_or_none.met = True
    try:
        file = os.open("0.txt", os.O_RDONLY, dir_fd=handle)
    except FileNotFoundError:  # taken away after the folder was opened
        return None
    finally:
        os.close(handle)
    with os.fdopen(file) as text:
        return text.read()


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signals for another process")
@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("after", [0.3, 0.8, 1.5, 2.5])
def test_an_interrupt_ends_with_130_or_comes_after_all_is_written(
    tmp_path: Path, number: signal.Signals, after: float
) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "discover", "check", "-o", "out"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    time.sleep(after)
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    if process.returncode == 0 and after > 1.0:  # on a fast machine all was done before
        assert [p.name for p in tmp_path.iterdir()] == ["out"]
        assert (tmp_path / "out" / "report.html").is_file()
        return
    assert (out, err, process.returncode) == ("", "inerter: interrupted\n", 130)
    assert list(tmp_path.iterdir()) == []


def ran(program: str) -> subprocess.CompletedProcess[str]:
    """Run lines of Python to their end in a process of their own."""
    return subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signals for one thread")
@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM"])
def test_an_interrupt_inside_a_finaliser_ends_what_is_waited_for(number: str) -> None:
    program = f"""
import signal, time
from discover.cli import signals

class Dying:
    def __del__(self):
        signal.raise_signal(signal.{number})

if "{number}" == "SIGTERM":  # as of a program that was started in the background
    signal.signal(signal.SIGINT, signal.SIG_IGN)
signals.begin()
began = time.monotonic()
try:
    Dying()
    time.sleep(30.0)
    print("lost")
except KeyboardInterrupt:
    print("interrupted" if time.monotonic() - began < 15.0 else "late")
"""
    done = ran(program)
    assert (done.stdout, done.stderr, done.returncode) == ("interrupted\n", "", 0)


@pytest.mark.skipif(os.name == "nt", reason="Windows can't hold signals back")
def test_an_interrupt_inside_a_finaliser_waits_where_none_may_come() -> None:
    program = """
import signal, time
from discover.cli import signals
from discover.report.swap import without_signals

class Dying:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)

signals.begin()
signals._PAUSE = 0.5  # so that it comes within, on a slow machine too
try:
    Dying()
    with without_signals():
        time.sleep(1.0)
        print("whole")
    print("lost")
except KeyboardInterrupt:
    print("interrupted")
"""
    done = ran(program)
    assert (done.stdout, done.stderr, done.returncode) == ("whole\ninterrupted\n", "", 0)


def test_an_interrupt_of_which_a_library_makes_an_error_is_one() -> None:
    program = """
import signal, sys
from discover import cli

def loading(arguments=None):
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        raise ImportError("initialization failed")

cli.main = loading
sys.exit(cli.program())
"""
    done = ran(program)
    assert (done.stderr, done.returncode) == ("inerter: interrupted\n", 130)


def test_an_interrupt_that_a_library_catches_is_met_before_the_next_step() -> None:
    program = """
import signal, sys
from discover import cli
from discover.cli.results import working

def loading(arguments=None):
    try:
        signal.raise_signal(signal.SIGINT)
    except:  # as where a library tries an import
        pass
    with working("Fitting"):
        print("lost")

cli.main = loading
sys.exit(cli.program())
"""
    done = ran(program)
    assert (done.stdout, done.stderr, done.returncode) == ("", "inerter: interrupted\n", 130)


@pytest.mark.parametrize("name", ["models.py", "models/__init__.py"])
def test_a_models_of_the_users_own_is_named_and_not_run(tmp_path: Path, name: str) -> None:
    mine = tmp_path / name
    mine.parent.mkdir(exist_ok=True)
    mine.write_text("print('run')\n")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(tmp_path), str(ROOT)))}
    done = subprocess.run(
        [sys.executable, "-m", "discover", "--version"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        f"inerter: {mine} hides this program's package 'models': rename it, or run from another"
        " folder\n"
    )
