"""The documentation's list of constants leaves none out, and the engine's say what they are."""

import importlib
import pkgutil
import re
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
ENGINE = [f"discover/{name}" for name in ("posterior", "bands", "gap", "study", "rows")]
DATA = [
    f"discover/{name}"
    for name in (
        "readers", "record_checks", "data_check", "motion_fit", "sine_fit", "record_curves",
        "regression",
    )
]  # fmt: skip


@pytest.fixture(scope="module")
def pages():
    """Return the module that writes the page, found where Sphinx finds it."""
    sys.path.insert(0, str(ROOT / "docs"))
    try:
        import page_constants
    finally:
        sys.path.remove(str(ROOT / "docs"))
    return page_constants


@pytest.fixture(scope="module")
def listed(pages):
    """Return the constants on the page: file and name."""
    told, module = set(), ""
    for line in pages.constants_page().splitlines():
        if at := re.fullmatch(r"\*\*`([^`]+)`\*\*", line):
            module = at[1]
        elif row := re.match(r"- `([^`]+)` = `[^`]+`", line):
            told |= {(module, name) for name in row[1].split(", ")}
    return told


def numbers_of(module):
    """Return the names that a loaded module itself gives to numbers and arrays of them."""
    source = Path(module.__file__).read_text(encoding="utf-8")
    for name, value in vars(module).items():
        own = re.search(rf"^(?:\w+, )*{name}\b[^(\n]*= ", source, re.M)
        if re.fullmatch(r"_?[A-Z][A-Z0-9_]*", name) and own and not isinstance(value, bool):
            whole = value if isinstance(value, tuple) else (value,)
            if whole and all(isinstance(v, int | float | np.ndarray) for v in whole):
                yield name


@pytest.mark.parametrize("folder", ENGINE)
def test_page_lists_every_number_that_the_loaded_modules_hold(listed, folder):
    package = importlib.import_module(folder.replace("/", "."))
    held = set()
    for _, name, _ in pkgutil.iter_modules(package.__path__, package.__name__ + "."):
        module = importlib.import_module(name)
        file = Path(module.__file__).relative_to(ROOT).as_posix()
        held |= {(file, constant) for constant in numbers_of(module)}
    assert held
    assert held <= listed


@pytest.mark.parametrize("folder", [*ENGINE, *DATA])
def test_every_number_of_the_engine_and_of_the_data_s_way_to_it_says_what_it_is(pages, folder):
    found = list(pages.constants(folder))
    assert found
    assert [f"{c.module}: {c.name}" for c in found if not c.said] == []


def test_value_and_comment_are_those_of_the_source(pages, tmp_path, monkeypatch):
    monkeypatch.setattr(pages, "ROOT", tmp_path)
    (tmp_path / "made").mkdir()
    (tmp_path / "made" / "module.py").write_text(
        "A = 0.5  # of the force\n"
        "_LEAST, _MOST = -12, 0  # powers of two\n"
        "B: float = 2e3\n"
        '"""Hz."""\n'
        "# Samples.\n"
        "C = 7\n"
        "D = 8\n"
        'NAME = "text"\n'
        "ON = True\n"
        "OBJECT = Thing(3)\n"
        "lower = 4\n"
    )
    told = [(c.module, c.name, c.value, c.said) for c in pages.constants("made")]
    assert told == [
        ("made/module.py", "A", "0.5", "of the force"),
        ("made/module.py", "_LEAST, _MOST", "-12, 0", "powers of two"),
        ("made/module.py", "B", "2e3", "Hz."),
        ("made/module.py", "C", "7", "Samples."),
        ("made/module.py", "D", "8", ""),
    ]
