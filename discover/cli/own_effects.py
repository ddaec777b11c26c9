"""Effects that a user brings along: which files are named, and what is searched then."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from models.terms import Term

_FILE = ".py"


def own_effects(files: Sequence[Path] | None) -> tuple[Term, ...]:
    """Return the terms that files define, each file's once.

    Raises
    ------
    InputError
        Where a file or its term is at fault.
    """
    from models.terms import load_term

    return tuple(load_term(file) for file in dict.fromkeys(files or ()))


def asked_effects(
    only: Sequence[str] | None, files: Sequence[Path] | None
) -> tuple[tuple[str, ...] | None, tuple[Term, ...]]:
    """Return the ids that may be named, None for all, and the user's own terms among them.

    Parameters
    ----------
    only : sequence of str, optional
        Of ``--effects``: ids, and files that end in ``.py``.
    files : sequence of Path, optional
        Of ``--effect-file``: their effects always take part.

    Raises
    ------
    InputError
        Where a file or its term is at fault.
    """
    listed = [Path(name) for name in only or () if name.endswith(_FILE)]
    own = own_effects([*(files or ()), *listed])
    if only is None:
        return None, own
    ids = (*(name for name in only if not name.endswith(_FILE)), *(term.id for term in own))
    return tuple(dict.fromkeys(ids)), own


def listed_effects(own: Sequence[Term]) -> list[dict[str, str]]:
    """Return id, file and hash of a user's terms, as ``gap.json`` holds them."""
    return [{"id": t.id, **t.source.to_dict()} for t in own if t.source is not None]


def own_notes(listed: Sequence[Mapping[str, str]]) -> list[dict[str, str]]:
    """Return findings that say where effects come from.

    Examples
    --------
    >>> own_notes([{"id": "drag", "file": "drag.py", "sha256": "ab" * 32}])[0]["text"]
    'The effect drag is your own: drag.py, sha256 abababababab….'
    """
    return [
        {
            "level": "note",
            "text": f"The effect {e['id']} is your own: {e['file']}, sha256 {e['sha256'][:12]}….",
        }
        for e in listed
    ]
