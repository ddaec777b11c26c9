"""A picture as a value: shown by a notebook, written to a file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from models.checks import InputError


@dataclass(frozen=True, repr=False)
class Picture:
    """One or several drawings below each other.

    Examples
    --------
    >>> Picture("empty", ("<svg></svg>",))
    <Picture 'empty': a notebook shows it, save("empty.svg") writes it>
    """

    name: str
    """Short name, for files."""
    drawings: tuple[str, ...]
    """Each one ``<svg>`` element."""

    def __repr__(self) -> str:
        """Return what to do with it where no notebook shows it."""
        return f'<Picture {self.name!r}: a notebook shows it, save("{self.name}.svg") writes it>'

    def _repr_html_(self) -> str:
        """Return the drawings as a notebook shows them."""
        return "\n".join(f"<div>{svg}</div>" for svg in self.drawings)

    def save(self, path: str | Path) -> tuple[Path, ...]:
        """Write the drawings as SVG; of several, the second and further are numbered.

        Parameters
        ----------
        path : str or Path
            Ends in ``.svg``; a file that is there is replaced.

        Returns
        -------
        tuple of Path
            The files.

        Raises
        ------
        InputError
            For another kind of file.
        """
        target = Path(path)
        if target.suffix.lower() != ".svg":
            raise InputError("path", expected="a name that ends in .svg", found=str(path))
        written = []
        for number, svg in enumerate(self.drawings, start=1):
            file = target if number == 1 else target.with_stem(f"{target.stem}-{number}")
            head = "<svg xmlns='http://www.w3.org/2000/svg'"
            whole = svg if "xmlns=" in svg else svg.replace("<svg", head, 1)
            file.write_text(whole, encoding="utf-8")
            written.append(file)
        return tuple(written)


def picture(name: str, *drawings: str | None) -> Picture:
    """Return the drawings that there are as one picture.

    Raises
    ------
    InputError
        Where there is none.
    """
    there = tuple(d for d in drawings if d is not None)
    if not there:
        raise InputError(f"picture {name!r}", expected="of what was found", found="nothing of it")
    return Picture(name, there)
