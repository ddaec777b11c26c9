"""The campaigns of a batch: where they are, what their folders of results are called."""

from __future__ import annotations

import hashlib
import json
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from discover._version import __version__
from discover.readers import CAMPAIGN_FILE


@dataclass(frozen=True)
class Listed:
    """A campaign of a batch."""

    label: str
    """Name of its folder of results, and in the table."""
    path: Path
    """Of the campaign, absolute."""
    given: str
    """As a person types it."""


def listed_campaigns(given: Sequence[Path]) -> tuple[Listed, ...]:
    """Return the campaigns that are meant, each once, in the order given.

    A folder that is no campaign stands for those of its folders that are. A label is the
    campaign's name; where several share it, with that of the folder above before it; where that is
    not enough, with digits that depend on the path.
    """
    paths: dict[Path, str] = {}
    for one in given:
        for path in _expanded(one):
            paths.setdefault(path.resolve(), str(path))
    labels = _told_apart(list(paths))
    return tuple(
        Listed(label, path, text)
        for (path, text), label in zip(paths.items(), labels, strict=True)
    )


def _expanded(given: Path) -> list[Path]:
    if given.name == CAMPAIGN_FILE and given.is_file():
        return [given.parent]
    if not given.is_dir() or (given / CAMPAIGN_FILE).exists():
        return [given]
    inside = sorted(p.parent for p in given.glob(f"*/{CAMPAIGN_FILE}"))
    return inside or [given]


def _told_apart(paths: Sequence[Path]) -> list[str]:
    names = [_label(p.name) for p in paths]
    longer = [_label(f"{p.parent.name}-{p.name}") for p in paths]
    digits = [hashlib.sha256(os.fsencode(p)).hexdigest()[:8] for p in paths]
    # Names differ on file systems that take no account of case too.
    same, still = (Counter(n.casefold() for n in group) for group in (names, longer))
    result = []
    for name, long, code in zip(names, longer, digits, strict=True):
        if same[name.casefold()] == 1:
            result.append(name)
        elif still[long.casefold()] == 1 and long.casefold() not in same:
            result.append(long)
        else:
            result.append(f"{long}-{code}")
    return result


def _label(name: str) -> str:
    return name.lstrip(".") or "campaign"


def stamp(campaign: Listed, asked: Mapping[str, Any]) -> str:
    """Return what tells whether a result is still that of the campaign and of what is asked.

    It changes with the names, sizes and times of the campaign's files, with what is asked and with
    the version of this package.
    """
    content = json.dumps([__version__, dict(asked), _files(campaign.path)], sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()


def _files(path: Path) -> list[tuple[str, int, int]]:
    found = [path] if path.is_file() else sorted(p for p in path.rglob("*") if p.is_file())
    told = []
    for file in found:
        state = file.stat()
        told.append((file.relative_to(path.parent).as_posix(), state.st_size, state.st_mtime_ns))
    return told
