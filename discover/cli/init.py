"""``inerter init``: a ``campaign.toml`` from the files of a folder, and a look at them."""

from __future__ import annotations

import os
import shlex
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.results import deliver, result_folder, working
from models.checks import InputError, one_of, printable, shown
from models.device import PRESETS

if TYPE_CHECKING:
    from discover.readers import Answers, Draft

_QUANTITIES = ("time", "displacement", "force", "velocity", "acceleration", "temperature")
_NAME = "campaign.toml"


Files = Annotated[
    list[Path],
    typer.Argument(metavar="FOLDER|FILE...", help="A folder of records, or the records."),
]
Title = Annotated[
    str | None,
    typer.Option("--title", metavar="TEXT", help="Of the campaign [default: the folder's name]."),
]
Column = Annotated[
    list[str] | None,
    typer.Option(
        "--column", metavar="QUANTITY=HEADER", help="A column, as force=F1; may be given again."
    ),
]
Unit = Annotated[
    list[str] | None,
    typer.Option(
        "--unit",
        metavar="QUANTITY=UNIT",
        help="A unit that no file states, as force=kN; may be given again.",
    ),
]
SamplingRate = Annotated[
    str | None,
    typer.Option(
        "--sampling-rate", metavar="QUANTITY", help="Of files without a time column, as '1 kHz'."
    ),
]
Preset = Annotated[
    str | None,
    typer.Option("--device", metavar="PRESET", help="The device: " + ", ".join(PRESETS) + "."),
]
Replace = Annotated[bool, typer.Option("--replace", help="Replace a campaign.toml that is there.")]


def init(
    context: typer.Context,
    files: Files,
    title: Title = None,
    column: Column = None,
    unit: Unit = None,
    sampling_rate: SamplingRate = None,
    device: Preset = None,
    replace_: Replace = False,
    out: options.Out = None,
    as_json: options.AsJson = False,
) -> int:
    """Write campaign.toml from what is there, and show each record.

    Columns and units are guessed, with how surely and why; what can't be known is asked for, on a
    terminal only. A quarter of the records is held out.
    """
    if device is not None:
        one_of("device", device, tuple(PRESETS), where="--device")
    named = _pairs(column, "--column", "HEADER")
    units = _pairs(unit, "--unit", "UNIT")
    folder, inside = _found(files)
    target = folder / _NAME
    _check_target(target, replaced=replace_)
    results = result_folder("init", folder, out)

    # Loaded here: --help and complaints about options need no numerics.
    from discover.cli.questions import at_terminal, rate
    from discover.readers import Answers, read_campaign, record_files
    from discover.readers.columns import QUANTITIES
    from discover.readers.units import check_unit
    from discover.report.draft import draft_document, draft_figures, draft_lines, draft_report
    from discover.report.files import page_files

    for quantity, text in units.items():
        check_unit(text, QUANTITIES[quantity], name=quantity, where="--unit")
    given = Answers(named, units, None if sampling_rate is None else rate(sampling_rate))
    draft = _draft(
        folder, inside or record_files(folder), given, title, device,
        asking=at_terminal() and not as_json,
    )  # fmt: skip
    _write(target, draft.toml())
    written = read_campaign(folder)
    document = draft_document(draft, content_hash=written.content_hash, written=str(target))
    invocation: Invocation = context.obj
    command = invocation.replacing()
    lines = draft_lines(
        draft, written=str(target), campaign=shlex.quote(str(folder)), command=command
    )
    with working("Drawing"):
        figures = draft_figures(draft)
        page = draft_report(draft, document, figures, lines=lines, command=command)
    pages = page_files(page, figures)
    deliver(
        document, name="init.json", folder=results, files=pages, summary=lines, as_json=as_json
    )
    return 0


def _check_target(target: Path, *, replaced: bool) -> None:
    """Refuse to write where a file is there and not to be replaced, or where nobody may write."""
    where = str(target.parent)
    if target.exists() and not replaced:
        raise InputError(
            target.name, expected="new (--replace writes over it)", found="one that is there",
            where=where,
        )  # fmt: skip
    if not os.access(target.parent, os.W_OK):
        raise InputError("folder", expected="writable", found="not so", where=where)


def _draft(
    folder: Path,
    files: Sequence[str],
    given: Answers,
    title: str | None,
    device: str | None,
    *,
    asking: bool,
) -> Draft:
    """Return the campaign as it is guessed from its files, after questions where somebody answers.

    Without a sampling rate, files that have no time column can't be read at all: it is asked for
    first. The other questions show what was guessed.
    """
    from discover.cli.questions import ask, rate
    from discover.readers import draft_campaign
    from discover.readers.draft import TimeMissing

    def drafted(answers: Answers, preset: str) -> Draft:
        with working(f"Reading {folder}"):
            return draft_campaign(
                folder, files, title=title or folder.resolve().name, answers=answers, device=preset
            )

    try:
        draft = drafted(given, device or "")
    except TimeMissing:
        if not asking:
            raise
        given = replace(given, sampling_rate=rate(typer.prompt("Sampling rate", err=True)))
        draft = drafted(given, device or "")
    if not asking:
        return draft
    return drafted(*ask(draft, given, device))


def _pairs(texts: Sequence[str] | None, where: str, what: str) -> Mapping[str, str]:
    pairs: dict[str, str] = {}
    for text in texts or ():
        quantity, equals, value = text.partition("=")
        if not equals or not value.strip():
            raise InputError("value", expected=f"QUANTITY={what}", found=shown(text), where=where)
        pairs[one_of("quantity", quantity.strip(), _QUANTITIES, where=where)] = value.strip()
    return pairs


def _found(files: Sequence[Path]) -> tuple[Path, list[str]]:
    """Return the campaign's folder and the files inside it; none of them for a folder."""
    for path in files:
        if not path.is_dir() and not path.is_file():
            from discover.readers.inside import kind_of

            raise InputError(str(path), expected="a folder or a file", found=kind_of(path))
    if len(files) == 1 and files[0].is_dir():
        return files[0], []
    folders = [path for path in files if path.is_dir()]
    if folders:
        raise InputError(
            printable(str(folders[0])), expected="given alone, since it is a folder",
            found=f"{len(files)} arguments",
        )  # fmt: skip
    folder = Path(os.path.commonpath([path.absolute().parent for path in files]))
    return folder, [path.absolute().relative_to(folder).as_posix() for path in files]


def _write(target: Path, text: str) -> None:
    """Write a file whole or not at all."""
    handle, name = tempfile.mkstemp(prefix=f".{target.name}-", dir=target.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
