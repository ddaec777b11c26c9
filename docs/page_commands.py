"""The page of commands, from the program's own help."""

from __future__ import annotations

import re
from typing import Any

import typer

from discover.cli.app import app


def commands_page() -> str:
    """Return the page: every verb with its arguments and options."""
    group: Any = typer.main.get_command(app)
    context = group.make_context("inerter", [], resilient_parsing=True)
    lines = [
        "# Commands",
        "",
        "From the program itself; `inerter VERB --help` says the same. Every verb exits 0 when"
        " done, 1 where the answer is a failed check, 2 on bad input with one line that says what"
        " is wrong, 130 when interrupted. Results go to a folder, written whole or not at all.",
        "",
    ]
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        own = command.make_context(name, [], parent=context, resilient_parsing=True)
        usage = command.collect_usage_pieces(own)
        lines += [f"## inerter {name}", "", *_paragraphs(command.help), ""]
        lines += ["```text", _spelled(" ".join(["inerter", name, *usage])), "```", ""]
        lines += [line for p in command.params for line in _entry(p, own)]
    return "\n".join(lines)


def _spelled(written: str) -> str:
    """Return an argument as it is typed, without typer's braces and types (``<list[Path]>``)."""
    plain = re.sub(r"\{([^{}]*)\}(?:\.\.\.)?| <[^<>]+>", r"\1", written)
    return plain.replace("[[", "[").replace("]]", "]")


def _paragraphs(text: str | None) -> list[str]:
    return [_plain(line.strip()) for line in (text or "").splitlines()]


def _plain(text: str) -> str:
    """Return text as Markdown, options as code: two hyphens would become a dash."""
    parts = text.split("`")
    for i in range(0, len(parts), 2):
        plain = parts[i].replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*")
        parts[i] = re.sub(r"(?<![\w-])--[a-z][a-z-]*", r"`\g<0>`", plain)
    return "`".join(parts)


def _entry(parameter: Any, context: Any) -> list[str]:
    """Return a parameter as an entry: how it is written, what it does, its default."""
    record = parameter.get_help_record(context)
    if record is None:
        return []
    written, said = record
    text, _, rest = said.partition("  [")
    notes = [note for note in rest.rstrip("]").split("; ") if note]
    if " [default: " in text:  # said in the help itself
        text, _, default = text.rstrip(".").rpartition(" [default: ")
        notes = [f"default: {default.rstrip(']')}", *notes]
    told = f" ({'; '.join(_plain(n) for n in notes)})" if notes else ""
    return [f"`{_spelled(written)}`", f": {_plain(text.rstrip('.'))}{told}.", ""]
