"""The keys that every document of a campaign begins with."""

from __future__ import annotations

from typing import Any

from discover._version import __version__


def document_header(name: str, *, seed: int, title: str, content_hash: str) -> dict[str, Any]:
    """Return schema, version, seed and the campaign's title and hash.

    Examples
    --------
    >>> document_header("study", seed=0, title="sines", content_hash="ab")["schema"]
    'inerter.study/1'
    """
    return {
        "schema": f"inerter.{name}/1",
        "version": __version__,
        "seed": seed,
        "campaign": {"title": title, "hash": content_hash},
    }
