"""Which code an outcome is of."""

from __future__ import annotations

import subprocess


def current_commit() -> str:
    """Return the commit, with "+" where files that are tracked have changed."""
    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], capture_output=True, text=True, check=False)
        return done.stdout.strip()

    dirty = git("status", "--porcelain", "--untracked-files=no")
    return git("rev-parse", "--short", "HEAD") + ("+" if dirty else "")
