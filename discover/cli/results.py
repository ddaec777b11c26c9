"""Where results go: a folder written whole, and stdout."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer
from rich.console import Console

from discover.cli import signals
from discover.document import json_text
from discover.report.folder import check_replaceable, write_folder
from discover.report.lock import folder_lock
from models.checks import LONGEST_LINE, InputError, InputErrors, printable

if TYPE_CHECKING:
    from discover.records import Campaign

_MOST_WARNINGS = 5
_LONGEST_LABEL = 100  # characters: file systems end at 255, with the campaign's name
_run: ContextVar[contextlib.ExitStack | None] = ContextVar("run", default=None)


@contextlib.contextmanager
def one_run() -> Iterator[None]:
    """Let go at the end of the block of what a run holds: the lock on its folder of results."""
    with contextlib.ExitStack() as stack:
        token = _run.set(stack)
        try:
            yield
        finally:
            _run.reset(token)


def result_folder(
    verb: str, campaign: str | Path, out: Path | None, *, model: str | None = None
) -> Path:
    """Return the folder that results go to, held for this run, refused early where it can't be.

    Its name says the verb, the campaign, and the model where the answer depends on one.

    Raises
    ------
    InputError
        Where it holds something that is not an earlier result, or another run writes to it.
    """
    name = Path(campaign).resolve().name or "campaign"
    named = f"{verb}-{name}" if model is None else f"{verb}-{name}-{model_label(model)}"
    folder = Path("inerter-out", named) if out is None else out
    hold_folder(folder)
    check_replaceable(folder)
    return folder


def model_label(model: str) -> str:
    """Return a model's name as a part of a folder's: of a model.json, that of its folder.

    Examples
    --------
    >>> model_label("ioim-laminar"), model_label("fit:inertia,viscous-damping")
    ('ioim-laminar', 'fit-inertia-viscous-damping')
    >>> model_label("inerter-out/discover-rig/model.json"), model_label("mine.json")
    ('discover-rig', 'mine')
    """
    path = Path(model)
    if path.suffix == ".json":
        own = path.resolve().parent.name if path.stem == "model" else path.stem
    else:
        own = model
    label = re.sub(r"[^\w.]+", "-", own).strip("-.") or "model"
    if len(label) <= _LONGEST_LABEL:
        return label
    return f"{label[:_LONGEST_LABEL]}-{hashlib.sha256(label.encode()).hexdigest()[:8]}"


def hold_folder(folder: Path) -> None:
    """Hold a folder until this run ends, so that no other run writes to it.

    Raises
    ------
    InputError
        Where another run holds it.
    """
    stack = _run.get()
    if stack is not None:
        stack.enter_context(folder_lock(folder))


@contextlib.contextmanager
def after_reading(campaign: Campaign) -> Iterator[None]:
    """Tell beside an error what reading the campaign warned of: it may be why.

    Raises
    ------
    InputErrors
        For an `InputError` in the block, where there were warnings.
    """
    try:
        yield
    except InputErrors:
        raise
    except InputError as error:
        warnings = [f for f in campaign.findings if f.level == "warning"][:_MOST_WARNINGS]
        if not warnings:
            raise
        told = [InputError(f.text, where=f.record or "") for f in warnings]
        advice = "reading warned of what is said after the first line: it may be why"
        raise InputErrors([error, *told], advice=advice) from None


@contextlib.contextmanager
def working(text: str) -> Iterator[Callable[[str], None]]:
    """Show `text` on a terminal's stderr while work runs; keep libraries off stdout.

    Yields
    ------
    callable
        Shows how far the work is, beside `text`.
    """
    signals.meet()
    with contextlib.ExitStack() as stack:
        status = Console(stderr=True).status(text) if sys.stderr.isatty() else None
        if status is not None:
            stack.enter_context(status)
        stack.enter_context(contextlib.redirect_stdout(io.StringIO()))

        def tell(so_far: str) -> None:
            if status is not None:
                status.update(f"{text}: {so_far}")

        yield tell
    signals.meet()


def deliver(
    document: Mapping[str, Any],
    *,
    name: str,
    folder: Path,
    files: Mapping[str, str | bytes],
    summary: Sequence[str],
    as_json: bool,
) -> None:
    """Write the document and `files` to `folder`, then print the document or the summary.

    Parameters
    ----------
    document : mapping
        The result.
    name : str
        Its file name.
    folder : Path
        From `result_folder`.
    files : mapping
        What else goes there.
    summary : sequence of str
        Lines for a person; the folder or the report is named below them.
    as_json : bool
        Print the document instead, and nothing else.
    """
    text = json_text(document)
    signals.meet()
    written = write_folder(folder, {name: text, **files})
    if as_json:
        typer.echo(text, nl=False)
        return
    for line in summary:
        typer.echo(printable(line, longest=LONGEST_LINE))
    last = written / ("report.html" if "report.html" in files else name)
    typer.echo(f"{'Report' if last.name == 'report.html' else 'Document'}: {shown_path(last)}")


def shown_path(path: Path) -> str:
    """Return `path` as seen from here where it lies below, else in full."""
    here = Path(os.getcwd())
    return str(path.relative_to(here)) if path.is_relative_to(here) else str(path)
