"""The help of every public name gives its shapes and units, its errors, and an example."""

import importlib
import inspect
import re
from pathlib import Path

import pytest

import discover

API = Path(__file__).parents[1] / "docs" / "api.md"
MODELS = (
    "constitutive", "cores", "equivalents", "flow", "fractional", "linear", "motion", "simulation",
    "structure",
)  # fmt: skip


def listed():
    """Return the public names: of `discover`, of the page of the interface, of `models`."""
    names = {f"discover.{name}" for name in discover.__all__}
    names |= set(re.findall(r"^\.\. auto(?:function|class):: (\S+)", API.read_text(), re.M))
    for module in MODELS:
        public = importlib.import_module(f"models.{module}")
        own = getattr(public, "__all__", None) or [
            n for n, o in vars(public).items()
            if not n.startswith("_") and getattr(o, "__module__", None) == public.__name__
        ]  # fmt: skip
        names |= {f"models.{module}.{name}" for name in own}
    return sorted(names)


def found(name):
    """Return the object of a dotted name."""
    module, _, own = name.rpartition(".")
    return getattr(importlib.import_module(module), own)


FUNCTIONS = [name for name in listed() if inspect.isroutine(found(name))]
CLASSES = [name for name in listed() if inspect.isclass(found(name))]


def test_there_is_something_to_look_at():
    assert {"discover.run_study", "models.constitutive.foim"} <= set(FUNCTIONS)
    assert {"discover.Campaign", "models.constitutive.ForceModel"} <= set(CLASSES)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_s_help_tells_arguments_result_errors_and_an_example(name):
    function = found(name)
    text = inspect.getdoc(function)
    asked = {"Yields" if inspect.isgeneratorfunction(function) else "Returns", "Examples"}
    if inspect.signature(function).parameters:
        asked.add("Parameters")
    if re.search(r"\braise InputError|\bone_of\(", inspect.getsource(function)):
        asked.add("Raises")
    assert asked <= set(re.findall(r"^(\w+)\n-{3,}$", text, re.M))
    told = re.findall(r"^(\*?\w+(?:, \w+)*)(?: : .*)?$", text, re.M)
    named = {part.lstrip("*") for line in told for part in line.split(", ")}
    assert set(inspect.signature(function).parameters) <= named


@pytest.mark.parametrize("name", CLASSES)
def test_every_field_of_a_class_has_its_line(name):
    kind = found(name)
    assert inspect.getdoc(kind)
    source = inspect.getsource(kind)
    body = source.split('"""', 2)[-1].split("\n    def ")[0].split("\n    @")[0]
    fields = re.findall(r"^    (\w+): [^\n]*\n(\s*)(\"{3}|\w|\))?", body, re.M)
    assert [n for n, _, start in fields if not n.startswith("_") and start != '"""'] == []


MADE = [n for n in CLASSES if n.removeprefix("discover.") in discover.__all__]


@pytest.mark.parametrize("name", MADE)
def test_a_class_that_users_make_shows_an_example(name):
    kind = found(name)
    helped = [inspect.getdoc(kind) or ""]
    helped += [inspect.getdoc(m) or "" for _, m in inspect.getmembers(kind, inspect.isroutine)]
    assert any(">>>" in text for text in helped) or issubclass(kind, Exception)
