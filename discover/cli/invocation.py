"""What was typed, and the line that repeats it."""

from __future__ import annotations

import shlex
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Invocation:
    """The arguments that followed ``inerter``."""

    arguments: tuple[str, ...]
    """As given."""

    def replacing(self) -> str:
        """Return the command that repeats the work over the file that it wrote.

        Examples
        --------
        >>> Invocation(("init", "my rig")).replacing()
        "inerter init 'my rig' --replace"
        """
        typed = self.arguments
        again = () if "--replace" in typed else ("--replace",)
        return shlex.join(["inerter", *typed, *again])

    def repeat(self, *, seed: int) -> str:
        """Return the command that repeats the work, its seed written out.

        Examples
        --------
        >>> Invocation(("discover", "my rig")).repeat(seed=0)
        "inerter discover 'my rig' --seed 0"
        """
        typed = self.arguments
        seeded = any(a == "--seed" or a.startswith("--seed=") for a in typed)
        return shlex.join(["inerter", *typed, *([] if seeded else ["--seed", str(seed)])])


def to_copy(arguments: Sequence[str]) -> str:
    """Return a command that runs here as it stands: by its path where it is on no search path.

    Examples
    --------
    >>> to_copy(["gap", "my rig"])
    "inerter gap 'my rig'"
    """
    typed = sys.argv[0]
    by_path = Path(typed).name == "inerter" and shutil.which("inerter") is None
    return shlex.join([typed if by_path else "inerter", *arguments])
