"""The command ``inerter``: one file a verb."""

from __future__ import annotations

import os
import sys

from discover.cli import signals

TYPE_CHECKING = False  # as of typing, whose import costs the first interrupts
if TYPE_CHECKING:
    from collections.abc import Sequence

INTERRUPTED = 130
BAD_INPUT = 2
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command inside this process and return its exit code; see `discover.cli.app.main`."""
    from discover.cli.app import main as run

    return run(arguments)


def program() -> int:
    """Run the command as a program of its own: interrupted at any moment, it ends with 130."""
    try:
        signals.begin()
        for name in _THREADS:  # matrices are small: more threads take longer
            os.environ.setdefault(name, "1")
        code = BAD_INPUT
        hiding = _hiding()
        if hiding:
            print(f"inerter: {hiding}", file=sys.stderr)
        else:
            code = main()
        signals.end()
        return code
    except BaseException as error:
        if not (isinstance(error, KeyboardInterrupt) or signals.interrupted()):
            raise
        signals.end()
        exec("")  # as in `discover.cli.app.main`
        print("inerter: interrupted", file=sys.stderr)
        return INTERRUPTED


def _hiding() -> str:
    """Return what to tell where another ``models`` hides the package, else an empty string.

    It is found and not imported: it may be a script of the user's.
    """
    from importlib.util import find_spec
    from pathlib import Path

    home = Path(__file__).parents[2]
    found = find_spec("models")
    place = None if found is None or found.origin is None else Path(found.origin)
    if place is None or place.resolve() == (home / "models" / "__init__.py").resolve():
        return ""
    return f"{place} hides this program's package 'models': rename it, or run from another folder"


__all__ = ["main", "program"]
