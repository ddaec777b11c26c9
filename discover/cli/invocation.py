"""What was typed, and the line that repeats it."""

from __future__ import annotations

import shlex
from dataclasses import dataclass


@dataclass(frozen=True)
class Invocation:
    """The arguments that followed ``inerter``."""

    arguments: tuple[str, ...]
    """As given."""

    def plain(self) -> str:
        """Return the command as it was typed.

        Examples
        --------
        >>> Invocation(("init", "my rig")).plain()
        "inerter init 'my rig'"
        """
        return shlex.join(["inerter", *self.arguments])

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
