"""One campaign of a batch, worked on wherever a process sees its files."""

from __future__ import annotations

import contextlib
import io
import json
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from discover.batch.answer import Answer
from models.checks import InputError

STAMP = "batch-item.json"
"""Beside a campaign's results: what they are results of."""


@dataclass(frozen=True)
class Item:
    """What is to be done with a campaign."""

    campaign: Path
    """Absolute."""
    given: str
    """The campaign as a person types it."""
    folder: Path
    """Of its results, absolute."""
    stamp: str
    """See `discover.batch.campaigns.stamp`."""
    model: str | None
    """That the gap is searched with; None for no gap."""
    seed: int
    """Of everything random."""


def work(item: Item) -> str:
    """Study a campaign, close its gap, write its folder; return why that failed, else "".

    A study stays where the gap fails. Whatever the fault, one campaign does not end the others.
    """
    with contextlib.redirect_stdout(io.StringIO()):
        try:
            return _worked(item)
        except Exception as error:
            return _line(error).replace(str(item.campaign), item.given)


def _worked(item: Item) -> str:
    from discover.document import json_text
    from discover.executor import executor
    from discover.readers import read_campaign
    from discover.report.folder import write_folder
    from discover.report.study import study_files
    from discover.study import StudyOptions, run_study

    with executor() as here:
        campaign = read_campaign(item.campaign, over=here)
    study = run_study(campaign, StudyOptions(seed=item.seed))
    document = study.to_dict()
    command = shlex.join(["inerter", "discover", item.given, "--seed", str(item.seed)])
    files: dict[str, str | bytes] = {
        "study.json": json_text(document),
        "model.json": json_text(study.model_dict()),
        **study_files(document, study.figure_data, command=command),
    }
    error = ""
    if item.model is not None:
        try:
            files |= _gap_files(campaign, item, item.model)
        except Exception as fault:
            error = f"gap: {_line(fault)}"
    files[STAMP] = json_text({"stamp": item.stamp, "error": error})
    write_folder(item.folder, files)
    return error


def _gap_files(campaign: Any, item: Item, model: str) -> dict[str, str | bytes]:
    from discover.cli.gap_answer import gap_answer
    from discover.document import json_text
    from discover.report.gap import gap_files

    document, found = gap_answer(campaign, model, seed=item.seed)
    command = shlex.join(
        ["inerter", "gap", item.given, "--model", model, "--seed", str(item.seed)]
    )
    files: dict[str, str | bytes] = {
        "gap.json": json_text(document),
        "model.json": json_text(found.model_dict()),
        **gap_files(document, found.figure_data, command=command),
    }
    return {f"gap/{name}": content for name, content in files.items()}


def _line(error: Exception) -> str:
    """Return an error in one line, that of a fault in this program with its kind."""
    text = " ".join(str(error).split())
    if isinstance(error, InputError):
        return text
    if isinstance(error, OSError):
        name = f"{error.filename}: " if error.filename else ""
        return f"{name}{error.strerror or text}"
    return f"a fault in this program: {type(error).__name__}: {text}"


def is_done(item: Item) -> bool:
    """Return whether a campaign's results are there, whole, and of what is asked now."""
    kept = _table(item.folder / STAMP)
    return kept.get("stamp") == item.stamp and not kept.get("error")


def answer_of(item: Item, label: str, error: str) -> Answer:
    """Return what a campaign's folder holds, beside the error that `work` gave."""
    failed = bool(error) and not error.startswith("gap: ")
    study = None if failed else _table(item.folder / "study.json")
    gap = None if error or item.model is None else _table(item.folder / "gap" / "gap.json")
    return Answer(label, item.given, study, gap, error)


def _table(file: Path) -> Mapping[str, Any]:
    """Return a document that a batch has written; an empty one where there is none."""
    try:
        table = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return table if isinstance(table, dict) else {}
