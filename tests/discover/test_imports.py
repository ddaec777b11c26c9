"""What a command must not wait for: libraries that take long to load and that it does without."""

import subprocess
import sys

import pytest

SLOW = ("numba", "pandas", "pysindy", "scipy.signal", "scipy.stats", "sklearn", "distributed")


def loaded(lines):
    code = f"import sys\n{lines}\nprint(*sys.modules)"
    ran = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=sys.path[0]
    )
    return set(ran.stdout.split())


def test_help_loads_no_numerics():
    modules = loaded(
        "import contextlib, io\n"
        "from discover.cli import main\n"
        "with contextlib.redirect_stdout(io.StringIO()): main(['check', '--help'])"
    )
    assert "discover.cli.check" in modules
    assert not modules & {*SLOW, "matplotlib", "scipy", "pint", "pyarrow", "jinja2"}


@pytest.mark.slow
def test_check_loads_no_learning_library(tmp_path):
    modules = loaded(
        "import contextlib, io\n"
        "from discover.cli import main\n"
        "with contextlib.redirect_stdout(io.StringIO()):\n"
        f"    main(['check', '-o', {str(tmp_path / 'out')!r}])"
    )
    assert "discover.data_check.check" in modules
    # The noise of sine tests is compiled, which is worth its wait; nothing else is.
    assert not modules & set(SLOW) - {"numba"}
