"""Text with columns, and what LabVIEW writes as text."""

from __future__ import annotations

from discover.readers.file_format import FileFormat
from discover.readers.long_text import open_long_text
from discover.readers.lvm import is_lvm, open_lvm
from discover.readers.source import Book
from discover.readers.text_table import open_text


def open_any_text(data: bytes, name: str) -> Book:
    """Open a text, by its first line as of LabVIEW or of anything else."""
    return open_lvm(data, name) if is_lvm(data) else open_text(data, name)


FORMAT = FileFormat(
    (".csv", ".tsv", ".txt", ".dat", ".asc", ".lvm"), open_any_text, open_long_text,
    pieces_of=(".csv", ".tsv"),
)  # fmt: skip
