"""The command's entry: which verbs there are, and how each ending becomes an exit code."""

from __future__ import annotations

import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from typing import Annotated

import typer

from discover._version import __version__
from discover.cli.batch import batch
from discover.cli.check import check
from discover.cli.compare import compare
from discover.cli.design import design
from discover.cli.discover import discover
from discover.cli.gap import gap
from discover.cli.init import init
from discover.cli.invocation import Invocation
from discover.cli.reproduce import reproduce
from discover.cli.results import one_run
from discover.cli.signals import interrupted, leaving
from discover.cli.simulate import simulate
from discover.cli.synth import synth
from models.checks import LONGEST_LINE, InputError, InputErrors, printable

BAD_INPUT = 2
INTERRUPTED = 130
INTERNAL_ERROR = 70

app = typer.Typer(
    name="inerter",
    help="Finds which model structure measured fluid-inerter records support, and where.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for verb in (init, check, discover, gap, compare, batch, simulate, synth, design, reproduce):
    app.command(verb.__name__)(verb)


def _print_version(value: bool) -> None:
    if value:
        typer.echo(f"inerter {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Name what every verb shares; typer shows the application's help instead."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit code.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows ``inerter``; by default what the process was started with.

    Returns
    -------
    int
        0 done, 1 a failed check, 2 bad input, 130 interrupted, 70 a fault in this program.
    """
    given = tuple(sys.argv[1:] if arguments is None else arguments) or ("--help",)
    if not sys.warnoptions:  # what a user should know is a finding in the document
        warnings.simplefilter("ignore")
    try:
        with one_run():
            result = _run(given)
        if result == INTERRUPTED:  # newer typer turns the interrupt into this code by itself
            raise KeyboardInterrupt
        sys.stdout.flush()
    except (KeyboardInterrupt, typer.Abort):
        return _interrupted()
    except BrokenPipeError:
        # The reader has gone; nothing more can be said to it, at exit either.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        return _interrupted() if interrupted() else _failed(error)
    return result if isinstance(result, int) else 0


def _interrupted() -> int:
    """Say that the run was interrupted; return its exit code."""
    leaving()
    # An interrupt of code in a string, as imports run it, would have Python leave by the
    # signal whatever is returned here, until other code in a string has run.
    exec("")
    return _complain("interrupted", INTERRUPTED)


def _failed(error: Exception) -> int:
    """Say what is wrong with the input, or that the program has a fault; return the exit code."""
    if isinstance(error, InputErrors):
        for line in error.lines:
            _complain(line, BAD_INPUT)
        return BAD_INPUT
    if isinstance(error, InputError):
        return _complain(str(error), BAD_INPUT)
    if isinstance(error, OSError):
        name = f"{error.filename}: " if error.filename else ""
        return _complain(f"{name}{error.strerror or error}", BAD_INPUT)
    usage = getattr(error, "format_message", None)
    if usage is not None:  # typer's own complaints about options
        missing = getattr(error, "param", None) if _is_missing(error) else None
        wanted = f" Expected: {text}" if (text := getattr(missing, "help", None)) else ""
        return _complain(f"{usage()}{wanted}", BAD_INPUT)
    if os.environ.get("INERTER_DEBUG"):
        traceback.print_exc()
    return _complain(
        f"a fault in this program: {type(error).__name__}: {error}; INERTER_DEBUG=1 shows where",
        INTERNAL_ERROR,
    )


def _is_missing(error: Exception) -> bool:
    """Tell whether typer complains of what was not given; its class stands in no public module."""
    return type(error).__name__ == "MissingParameter"


def _run(given: Sequence[str]) -> object:
    command = typer.main.get_command(app)
    return command.main(
        args=list(given), prog_name="inerter", standalone_mode=False, obj=Invocation(tuple(given))
    )


def _complain(text: str, code: int) -> int:
    """Print one line on stderr and return `code`."""
    print("inerter: " + printable(" ".join(text.split()), longest=LONGEST_LINE), file=sys.stderr)
    return code
