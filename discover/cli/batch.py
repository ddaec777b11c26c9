"""``inerter batch``: studies and gaps of many campaigns, one table and one page over all."""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.reading import say
from discover.cli.results import hold_folder, shown_path
from models.checks import LONGEST_LINE, InputError, printable

if TYPE_CHECKING:
    from discover.cli.batch_work import Item
    from discover.executor import Executor

FAILED = 1
MARK = ".inerter-batch"
"""In the folder of a batch: what lies there is its own."""


Campaigns = Annotated[
    list[Path],
    typer.Argument(
        metavar="CAMPAIGN…",
        help="Folders with campaign.toml, files of records, or folders of such folders.",
    ),
]
Out = Annotated[
    Path,
    typer.Option(
        "-o", "--out", metavar="FOLDER", help="Folder of all results; what is done there stays."
    ),
]
Model = Annotated[
    str | None,
    typer.Option(
        "--model",
        metavar="M",
        help="Search each campaign's gap to this model too, named as for `inerter gap`.",
        show_default=False,
    ),
]
Pooled = Annotated[
    bool,
    typer.Option(
        "--pooled",
        help="Weigh each device's answers with what the others say, and show what that changes.",
    ),
]


def batch(
    context: typer.Context,
    campaigns: Campaigns,
    out: Out,
    model: Model = None,
    pooled: Pooled = False,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
    cluster: options.Cluster = None,
) -> int:
    """Study many campaigns: one table and one page.

    The same command goes on where an earlier one was stopped.

    Exits 1 where a campaign failed: it is told in one line, and the others are done.
    """
    _check_folder(out)
    hold_folder(out)

    # Loaded here: --help and complaints about options need no numerics.
    from discover.batch.campaigns import listed_campaigns, stamp
    from discover.batch.document import batch_document
    from discover.batch.pooled_table import POOLED_FILES, pooled_files, pooled_rows
    from discover.batch.table import table_files, table_rows
    from discover.cli.batch_work import Item, answer_of
    from discover.document import json_text
    from discover.executor import executor
    from discover.report.batch import batch_lines, batch_report

    model, model_hash = _model(model)
    asked = {"seed": seed, "model": model, "model_hash": model_hash}
    listed = listed_campaigns(campaigns)
    if pooled and len(listed) < 2:
        raise InputError("campaigns", expected="two or more", found="one", where="--pooled")
    home = out.resolve()
    labels = [one.label for one in listed]
    items = [Item(c.path, c.given, home / c.label, stamp(c, asked), model, seed) for c in listed]
    with executor(jobs, cluster, tell=say) as where:
        out.mkdir(parents=True, exist_ok=True)
        (out / MARK).touch()
        errors = _work_off(items, labels, where)
    answers = [answer_of(*each) for each in zip(items, labels, errors, strict=True)]
    rows = table_rows(answers)
    document = batch_document(answers, rows, seed=seed, model=model, pool=pooled)
    invocation: Invocation = context.obj
    page = batch_report(document, rows, command=invocation.repeat(seed=seed))
    text = json_text(document)
    files = {**table_files(rows), "batch.json": text.encode(), "report.html": page.encode()}
    if pooled:
        files |= pooled_files(pooled_rows(document["pooling"]))
    _write(out, files, gone=[name for name in POOLED_FILES if name not in files])
    if as_json:
        typer.echo(text, nl=False)
    else:
        tables = [name for name in ("table.csv", "pooled.csv") if name in files]
        _tell(batch_lines(document), [home / name for name in (*tables, "report.html")])
    return FAILED if any(errors) else 0


def _tell(lines: Sequence[str], files: Sequence[Path]) -> None:
    """Print what was found, and where it is."""
    names = {"table.csv": "Table", "pooled.csv": "Pooled table", "report.html": "Report"}
    for line in (*lines, *(f"{names[f.name]}: {shown_path(f)}" for f in files)):
        typer.echo(printable(line, longest=LONGEST_LINE))


def _work_off(items: Sequence[Item], labels: Sequence[str], where: Executor) -> list[str]:
    """Do what is not done yet; return why each item failed, "" where it did not."""
    from discover.cli.batch_work import is_done, work
    from discover.executor import Lost

    errors = [""] * len(items)
    todo = [i for i, item in enumerate(items) if not is_done(item)]
    with _progress(len(items), len(items) - len(todo)) as tell:
        for place, found in where.finished(work, [items[i] for i in todo]):
            error = found.reason if isinstance(found, Lost) else found
            errors[todo[place]] = error
            tell(f"{labels[todo[place]]}: {error}" if error else "")
    return errors


def _model(name: str | None) -> tuple[str | None, str]:
    """Return a model's name, a file's in full, with the hash of its content."""
    if name is None or not Path(name).is_file():
        return name, ""
    file = Path(name).resolve()
    return str(file), hashlib.sha256(file.read_bytes()).hexdigest()


def _check_folder(out: Path) -> None:
    """Refuse a folder that holds anything but an earlier batch."""
    where = str(out)
    if not out.exists():
        return
    if not out.is_dir():
        raise InputError("output", expected="a folder", found="a file", where=where)
    found = sorted(p.name for p in out.iterdir())
    if found and MARK not in found:
        raise InputError(
            "output", expected="a new folder or that of an earlier batch",
            found=f"one that holds {found[0]}", where=where,
        )


def _write(folder: Path, files: Mapping[str, bytes], *, gone: Sequence[str]) -> None:
    """Write the files of the whole batch, each whole or not at all; remove those that are gone."""
    with tempfile.TemporaryDirectory(prefix=".part-", dir=folder) as part:
        for name, content in files.items():
            (Path(part) / name).write_bytes(content)
        for name in files:
            os.replace(Path(part) / name, folder / name)
    for name in gone:
        (folder / name).unlink(missing_ok=True)


@contextlib.contextmanager
def _progress(count: int, done: int) -> Iterator[Callable[[str], None]]:
    """Show on a terminal how many campaigns are done; print what fails as it does.

    Yields
    ------
    callable
        Counts one more; is given why it failed, or "".
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    bar = Progress(
        "Campaigns", BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(),
        console=Console(stderr=True), disable=not sys.stderr.isatty(), transient=True,
    )
    with bar:
        task = bar.add_task("", total=count, completed=done)

        def tell(error: str) -> None:
            bar.advance(task)
            if error:
                say(error)

        yield tell
