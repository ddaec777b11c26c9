"""Options that several verbs share, and how their text becomes values."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from models.checks import InputError, number, one_of, shown

DEFAULT_SEED = 0
MOST_VALUES = 1000

ShippedCampaign = Annotated[
    Path | None,
    typer.Argument(
        metavar="[CAMPAIGN]",
        help="Folder with campaign.toml and its records, or one file of records"
        " [default: the shipped one].",
        show_default=False,
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--out",
        metavar="FOLDER",
        help="Folder of the results, written whole or not at all"
        " [default: ./inerter-out/<verb>-<campaign>, of gap with the model's name].",
        show_default=False,
    ),
]
AsJson = Annotated[
    bool, typer.Option("--json", help="Print the document on stdout and nothing else there.")
]
Seed = Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Makes a run repeatable.")]
Jobs = Annotated[int, typer.Option("--jobs", metavar="N", min=1, help="Number of processes.")]
Cluster = Annotated[
    str | None,
    typer.Option(
        "--cluster",
        metavar="ADDRESS",
        help="Of a Dask scheduler, as tcp://host:8786, whose workers do the work instead of"
        " --jobs processes; they see the same folders.",
        show_default=False,
    ),
]
Terms = Annotated[
    str | None,
    typer.Option("--terms", metavar="ID,ID,…", help="Only these terms, all of them kept."),
]
Orders = Annotated[
    str | None,
    typer.Option(
        "--orders",
        metavar="GRID",
        help="Orders to start from, as 0:2:0.1 or 0.5,1.5; they are refined continuously.",
    ),
]
Exponents = Annotated[
    str | None,
    typer.Option("--exponents", metavar="GRID", help="Velocity exponents, likewise."),
]
Bands = Annotated[
    int | None,
    typer.Option(
        "--bands", metavar="N", min=1, help="Fix the number of bands.", show_default=False
    ),
]
Coordinate = Annotated[
    str | None,
    typer.Option(
        "--coordinate",
        metavar="dean|speed|frequency",
        help="What bands lie on [default: dean where the device is known, else speed].",
    ),
]
Convention = Annotated[
    str, typer.Option("--convention", metavar="paper|standard", help="Of the Dean number.")
]
Criterion = Annotated[
    float,
    typer.Option(
        "--criterion", metavar="NUMBER", help="Dean number that the check holds the boundary to."
    ),
]
FIGURE_FORMATS = ("png", "pdf")
"""Of pictures, beside SVG, which is always written."""
Figures = Annotated[
    str | None,
    typer.Option(
        "--figures",
        metavar="png,pdf",
        help="Write each picture in these formats too, beside SVG.",
        show_default=False,
    ),
]
EffectFiles = Annotated[
    list[Path] | None,
    typer.Option(
        "--effect-file",
        metavar="FILE.py",
        help="A Python file that defines an effect of your own; may be given again.",
    ),
]


def grid(
    text: str | None, *, where: str, at_least: float | None = None, at_most: float | None = None
) -> tuple[float, ...] | None:
    """Return the values of ``start:stop:step`` (both ends in) or ``a,b,c``; None for none.

    Parameters
    ----------
    text : str or None
        As typed.
    where : str
        The option.
    at_least, at_most : float, optional
        Bounds of every value.

    Raises
    ------
    InputError
        For text that is neither.

    Examples
    --------
    >>> grid("0:0.4:0.1", where="--orders")
    (0.0, 0.1, 0.2, 0.3, 0.4)
    >>> grid("0.5,1.5", where="--orders")
    (0.5, 1.5)
    """
    if text is None:
        return None
    if ":" not in text:
        return tuple(
            number("value", part.strip(), at_least=at_least, at_most=at_most, where=where)
            for part in text.split(",")
        )
    parts = text.split(":")
    if len(parts) != 3:
        raise InputError("grid", expected="start:stop:step or a,b,c", found=text, where=where)
    start, stop, step = (
        number(name, part.strip(), at_least=low, at_most=at_most, where=where)
        for name, part, low in zip(
            ("start", "stop", "step"), parts, (at_least, at_least, None), strict=True
        )
    )
    if step <= 0.0 or stop < start:
        raise InputError("grid", expected="rising, with a step above 0", found=text, where=where)
    if (stop - start) / step > MOST_VALUES:
        raise InputError(
            "grid", expected=f"of at most {MOST_VALUES} values", found=text, where=where
        )
    # Counting instead of adding keeps 0.3 from becoming 0.30000000000000004.
    count = int(np.floor((stop - start) / step + 1e-9)) + 1
    return tuple(round(start + i * step, 12) for i in range(count))


def each_once(name: str, given: Sequence[str], *, where: str) -> None:
    """Refuse what is given twice.

    Raises
    ------
    InputError
        With the first that is.
    """
    twice = next((g for g in given if given.count(g) > 1), None)
    if twice is not None:
        raise InputError(name, expected="each once", found=f"{twice} twice", where=where)


def identifiers(text: str | None, *, where: str) -> tuple[str, ...] | None:
    """Return comma-separated ids; None for none.

    Raises
    ------
    InputError
        Where nothing stands between two commas, or an id stands twice.

    Examples
    --------
    >>> identifiers("inertia, viscous-damping", where="--terms")
    ('inertia', 'viscous-damping')
    """
    if text is None:
        return None
    parts = tuple(part.strip() for part in text.split(","))
    if not all(parts):
        raise InputError(
            "list", expected="ids parted by single commas", found=shown(text), where=where
        )
    twice = next((p for p in parts if parts.count(p) > 1), None)
    if twice is not None:
        raise InputError("list", expected="each id once", found=f"{twice} twice", where=where)
    return parts


def figure_formats(text: str | None) -> tuple[str, ...]:
    """Return the formats of pictures that are asked for beside SVG.

    Raises
    ------
    InputError
        For another one.

    Examples
    --------
    >>> figure_formats("png, pdf"), figure_formats("svg"), figure_formats(None)
    (('png', 'pdf'), (), ())
    """
    asked = identifiers(text, where="--figures") or ()
    for one in asked:
        one_of("format", one, ("svg", *FIGURE_FORMATS), where="--figures")
    return tuple(one for one in asked if one != "svg")
