"""The page of documents: every key of real ones, with what the values' own fields say of it."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from document_examples import examples
from document_words import BY_NAME, COMMON, EVERYWHERE, HELD_BY, LIKE, OPEN, SAID

from models.terms import TERMS


def documents_page() -> str:
    """Return the page, from documents that the shipped campaigns give."""
    shown = examples()
    lines = [
        "# Documents",
        "",
        "Every verb writes its answer as a JSON document. Numbers are SI, finite or null. A key"
        " that is told as `a[].b` stands in every entry of the list `a`, one told as `a.NAME.b` in"
        " `a` below every name that is there. A key for which there is nothing to say may be left"
        " out of a document. A term's shape parameters stand beside its coefficient by their own"
        " names: [terms and effects](terms.md) lists them. F is the measured force, e that less the"
        " model's, ||F|| the root of the sum of squares over all samples.",
        "",
    ]
    for name, (what, documents) in shown.items():
        lines += [f"## {name}.json", "", f"It is {what}.", "", "| key | meaning |", "|---|---|"]
        for key in _with_told(name, [k for d in documents for k in document_keys(d)]):
            lines.append(f"| `{key}` | {_meaning(name, key)} |")
        lines.append("")
    return "\n".join(lines)


def _with_told(name: str, found: Sequence[str]) -> list[str]:
    """Return keys once each, with those that the examples lack beside what they belong to."""
    keys = list(dict.fromkeys(found))
    said = [key.removeprefix(f"{name}.") for key in SAID if key.startswith(f"{name}.")]
    said += [key for key in COMMON if "findings" in keys and key.startswith("findings")]
    for key in said:
        if key in keys:
            continue
        above = re.sub(r"(\[\])?(\.NAME)?\.[^.]+$", "", key)
        near = [i for i, k in enumerate(keys) if above != key and _below(k, above)]
        keys.insert(near[-1] + 1 if near else len(keys), key)
    return keys


def _below(key: str, above: str) -> bool:
    return key == above or key.startswith((f"{above}.", f"{above}[]"))


def document_keys(document: Mapping[str, Any], above: str = "") -> Iterator[str]:
    """Yield every key, those of lists once over all entries, without shapes of terms.

    A mapping by names that the records or the device have is told as ``a.NAME.b``.
    """
    shapes = {p.name for t in TERMS.values() for p in t.parameters} if "id" in document else set()
    for key, value in document.items():
        if key.removesuffix("_interval") in shapes:
            continue
        path = f"{above}{key}"
        yield path
        if key in OPEN or path in OPEN:
            continue
        if isinstance(value, Mapping) and key in BY_NAME:
            yield from document_keys(_merged(value.values()), f"{path}.NAME.")
        elif isinstance(value, Mapping):
            yield from document_keys(value, f"{path}.")
        elif isinstance(value, list):
            yield from document_keys(_merged(value), f"{path}[].")


def _merged(entries: Iterable[Any]) -> dict[str, Any]:
    """Return one entry with the keys of all, each with a value that tells most."""
    merged: dict[str, Any] = {}
    for entry in entries:
        for key, value in entry.items() if isinstance(entry, Mapping) else ():
            before = merged.get(key)
            if isinstance(before, list) and isinstance(value, list):
                merged[key] = [*before, *value]
            elif before in (None, [], {}):
                merged[key] = value
    return merged


def _meaning(name: str, key: str) -> str:
    """Return what a key means: by its own name here, or by the field that it comes from."""
    if key in COMMON:
        return _cell(COMMON[key])
    whole = f"{name}.{key}"
    like = next((whole.replace(a, b, 1) for a, b in LIKE.items() if whole.startswith(a)), whole)
    if said := SAID.get(whole) or SAID.get(like):
        return _cell(said)
    place, _, last = f"{name}.{key}".rpartition(".")
    holder = HELD_BY.get(place)
    said = {} if holder is None else _fields(holder)
    if last in said:
        return _cell(said[last])
    parts = key.split(".")
    for i in range(len(parts)):
        if (near := ".".join(parts[i:])) in EVERYWHERE:
            return _cell(EVERYWHERE[near])
    raise KeyError(f"{name}.json: nothing says what {key} is; say it in docs/document_words.py")


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*").replace("None", "null")


@cache
def _fields(holder: type) -> dict[str, str]:
    """Return what a value's fields and properties say of themselves."""
    (body,) = ast.parse(textwrap.dedent(inspect.getsource(holder))).body
    told: dict[str, str] = {}
    if not isinstance(body, ast.ClassDef):
        return told
    for field, said in zip(body.body, [*body.body[1:], None], strict=True):
        if isinstance(field, ast.FunctionDef) and field.decorator_list:
            told[field.name] = ast.get_docstring(field) or ""
        if not isinstance(field, ast.AnnAssign) or not isinstance(field.target, ast.Name):
            continue
        if isinstance(said, ast.Expr) and isinstance(said.value, ast.Constant):
            told[field.target.id] = " ".join(str(said.value.value).split())
    return told
