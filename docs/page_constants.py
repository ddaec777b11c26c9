"""The page of constants: every number that a module is set by, with what its source says of it."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("discover", "models")
_LONGEST = 60  # characters of a value that is shown whole
_NAME = re.compile(r"_?[A-Z][A-Z0-9_]*")


@dataclass(frozen=True)
class Constant:
    """One number, or a table of numbers, at the head of a module."""

    module: str
    """Its file, from the project's root."""
    name: str
    """As in the source."""
    value: str
    """As in the source."""
    said: str
    """What the comment beside it, the text below it or the comment above it says; "" for none."""


def constants(package: str) -> Iterator[Constant]:
    """Yield the constants of a package, file by file.

    Parameters
    ----------
    package : str
        Its folder, from the project's root.
    """
    for file in sorted((ROOT / package).rglob("*.py")):
        yield from _of_file(file)


def constants_page() -> str:
    """Return the page as Markdown."""
    listed = [
        "# Constants",
        "",
        "Every number at the head of a module, written from the source: its value, and what the"
        " comment beside it says it is, with its unit. What has no unit is a count or a ratio."
        " Where a number comes from is said in the module's own text: a source, a derivation, or"
        " the command that calibrates it. Where nothing stands beside a value, its name says what"
        " it is; all have their text on the way from a file to an answer (readers to study and"
        " gap).",
        "",
    ]
    for package in PACKAGES:
        listed += [f"## {package}", ""]
        folder = module = ""
        for constant in constants(package):
            where = constant.module.rpartition("/")[0]
            if where != folder:
                folder = where
                listed += ["", f"### {folder}"]
            if constant.module != module:
                module = constant.module
                listed += ["", f"**`{module}`**", ""]
            said = f": {_prose(constant.said)}" if constant.said else ""
            listed.append(f"- `{constant.name}` = {_code(constant.value)}{said}")
        listed.append("")
    return "\n".join(listed)


def _of_file(file: Path) -> Iterator[Constant]:
    source = file.read_text(encoding="utf-8")
    comments = {
        token.start[0]: (token.string.lstrip("# "), not token.line[: token.start[1]].strip())
        for token in tokenize.generate_tokens(io.StringIO(source).readline)
        if token.type == tokenize.COMMENT
    }
    body = ast.parse(source).body
    for node, following in zip(body, [*body[1:], None], strict=True):
        for names, value in _numbers(node, source):
            beside = [
                comments[line][0]
                for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
                if line in comments
            ]
            beside = [text for text in beside if not text.startswith(("fmt:", "noqa", "type:"))]
            said = " ".join(beside) or _text(following) or _above(comments, node.lineno)
            module = file.relative_to(ROOT).as_posix()
            yield Constant(module, names, value, said)


def _numbers(node: ast.stmt, source: str) -> Iterator[tuple[str, str]]:
    """Yield names and value of an assignment of numbers: no object that is made with some."""
    if isinstance(node, ast.Assign):
        target, value = node.targets[0], node.value
    elif isinstance(node, ast.AnnAssign) and node.value is not None:
        target, value = node.target, node.value
    else:
        return
    parts = target.elts if isinstance(target, ast.Tuple) else [target]
    names = [part.id for part in parts if isinstance(part, ast.Name)]
    if len(names) != len(parts) or not all(_NAME.fullmatch(name) for name in names):
        return
    inside = list(ast.walk(value))
    made = any(
        isinstance(n, ast.Call) and isinstance(n.func, ast.Name) and n.func.id[:1].isupper()
        for n in inside
    )
    if any(_is_number(n) for n in inside) and not made:
        written = ast.get_source_segment(source, value) or ""
        yield ", ".join(names), ast.unparse(value) if "\n" in written else written


def _is_number(node: ast.AST) -> bool:
    if not isinstance(node, ast.Constant) or isinstance(node.value, bool):
        return False
    return isinstance(node.value, int | float)


def _text(node: ast.stmt | None) -> str:
    """Return a statement that is nothing but text, in one line."""
    if not isinstance(node, ast.Expr) or not isinstance(node.value, ast.Constant):
        return ""
    return " ".join(str(node.value.value).split())


def _above(comments: dict[int, tuple[str, bool]], line: int) -> str:
    """Return the comment that stands alone on the lines right above one."""
    texts: list[str] = []
    while comments.get(line - 1, ("", False))[1]:
        line -= 1
        texts.insert(0, comments[line][0])
    return " ".join(texts)


def _prose(text: str) -> str:
    """Return a comment as text that shows as it stands; names between backticks stay code."""
    parts = text.split("`")
    shown = [p if i % 2 else re.sub(r"([\\*_<>$\[\]^~])", r"\\\1", p) for i, p in enumerate(parts)]
    return "`".join(shown)


def _code(value: str) -> str:
    """Return a value, a long table cut off."""
    short = value if len(value) <= _LONGEST else value[:_LONGEST] + "…"
    return f"`{short}`"
