"""Several files of one test, each with some of its channels, as one table."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePath

import numpy as np

from discover.readers.columns import QUANTITIES, find_column, split_header, stated_unit
from discover.readers.guess import guess_table
from discover.readers.names import NAMED, known_name, name_score
from discover.readers.one_clock import off_clock
from discover.readers.source import Source
from discover.readers.units import measures, to_si
from models.checks import Array, InputError

_WORD = re.compile(r"\d+|[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[^\W\d_]+")


@dataclass(frozen=True)
class _Part:
    """One file's table."""

    source: Source
    time: int | None
    """Its column of time."""
    times: Array | None
    """(N,) s; None where the file says nothing of time."""
    size: int
    """N."""


def name_words(file: str) -> tuple[str, ...]:
    """Return the words and numbers of a file's path without its suffix.

    Examples
    --------
    >>> name_words("monday/Test01_ForceLC.csv")
    ('monday', 'Test', '01', 'Force', 'LC')
    """
    return tuple(_WORD.findall(PurePath(file).with_suffix("").as_posix()))


def named_quantity(words: Sequence[str]) -> str | None:
    """Return the quantity that a file's words name, None where they name none or two.

    Examples
    --------
    >>> named_quantity(["LVDT", "2"]), named_quantity(["ch", "1"])
    ('displacement', None)
    """
    scores = {q: max((name_score(word, q) for word in words), default=0.0) for q in NAMED}
    best = max(scores.values())
    found = [q for q, score in scores.items() if score == best]
    return found[0] if best > 0.0 and len(found) == 1 else None


def joined(sources: Sequence[Source], files: Sequence[str], names: Mapping[str, str]) -> Source:
    """Return the tables of files that hold one test's channels, side by side.

    Their times must be the same; of several columns of time the first one is kept. A header that
    several files have gets before it what their names differ in, as ``force/value``; what such a
    file's only channel is, its name tells where the header does not.

    Parameters
    ----------
    sources : sequence of Source
        A table of each file.
    files : sequence of str
        Their names.
    names : mapping
        Headers by quantity, of which that of the time is looked for in each.

    Raises
    ------
    InputError
        Where the times or the numbers of samples do not agree.
    """
    parts = [_part(source, names) for source in sources]
    count = _agreed(parts, files)
    own = _own_words(files)
    columns = _columns(parts)
    first = next((part for part in parts if part.times is not None), parts[0])

    def read(indices: Sequence[int]) -> list[Array]:
        chosen = [columns[i] for i in indices]
        own = {at: [i for other, i in chosen if other == at] for at, _ in chosen}
        values = {at: iter(parts[at].source.read(inside)) for at, inside in own.items()}
        return [next(values[at])[:count] for at, _ in chosen]

    def place(row: int) -> str:
        each = [part.source.place(row) for part in parts]
        told = [f"{text} of {file}" for text, file in zip(each, files, strict=True)]
        return each[0] if len(set(each)) == 1 else ", ".join(told)

    def cell(row: int, index: int) -> str:
        at, i = columns[index]
        inside = parts[at].source
        return inside.cell(row, i) if inside.cell else f"{inside.read([i])[0][row]:.6g}"

    def moved(of: Sequence[Mapping[int, str]]) -> dict[int, str]:
        return {k: of[at][i] for k, (at, i) in enumerate(columns) if i in of[at]}

    return Source(
        " + ".join(files), _headers(parts, columns, own), read, place, cell=cell,
        roles=_roles(parts, columns, own),
        units=moved([part.source.units for part in parts]),
        notes=moved([part.source.notes for part in parts]),
        expected=moved([part.source.expected for part in parts]),
        step=first.source.step if first.time is None else None, start=first.source.start,
        told=_told(parts, files, count),
    )  # fmt: skip


def _columns(parts: Sequence[_Part]) -> list[tuple[int, int]]:
    """Return the place of each column's file and its own in it: of the times, the first one's."""
    first = next((at for at, part in enumerate(parts) if part.times is not None), None)
    return [
        (at, i)
        for at, part in enumerate(parts)
        for i in range(len(part.source.headers))
        if i != part.time or at == first
    ]


def _roles(
    parts: Sequence[_Part], columns: Sequence[tuple[int, int]], own: Sequence[Sequence[str]]
) -> dict[str, int]:
    """Return columns by the quantity that their file's name tells, where the header does not."""
    roles: dict[str, int] = {}
    for at, part in enumerate(parts):
        quantity = named_quantity(own[at])
        data = [k for k, (place, i) in enumerate(columns) if place == at and i != part.time]
        alone = len(data) == 1 and quantity is not None
        if alone and quantity and _may_be(part.source, columns[data[0]][1], quantity):
            roles.setdefault(quantity, data[0])
    return roles


def _part(source: Source, names: Mapping[str, str]) -> _Part:
    time = find_column(source, "time", names.get("time", "time"))
    if time is None and source.step is None:
        guess = guess_table(source).columns.get("time")
        time = None if guess is None else source.headers.index(guess.header)
    if time is not None:
        (column,) = source.read([time])
        unit = stated_unit(source, time) or ""
        seconds = to_si(column, unit, "time") if measures(unit, "time") else column
        return _Part(source, time, np.asarray(seconds, dtype=np.float64), column.size)
    size = source.read([0])[0].size
    if source.step is None:
        return _Part(source, None, None, size)
    return _Part(source, None, source.start + source.step * np.arange(float(size)), size)


def _agreed(parts: Sequence[_Part], files: Sequence[str]) -> int:
    """Return how many samples all files have, or refuse files that do not go together."""
    sizes = [part.size for part in parts]
    where = " + ".join(files)
    timed = [(p.times, f) for p, f in zip(parts, files, strict=True) if p.times is not None]
    if len(timed) < len(parts) and len(set(sizes)) > 1:
        listed = ", ".join(f"{n} in {file}" for n, file in zip(sizes, files, strict=True))
        raise InputError(
            "samples", expected="as many in every file, where one of them has no time",
            found=listed, where=where,
        )  # fmt: skip
    count = min(sizes)
    if not timed:
        return count
    first, own = timed[0]
    for times, file in timed[1:]:
        bad = off_clock(first[:count], times[:count])
        if bad.size:
            row = int(bad[0])
            raise InputError(
                "time", expected=f"the same in every file of the test, as {first[row]:.9g} s in"
                f" {own}",
                found=f"{times[row]:.9g} s in sample {row + 1} of {file}; save the channels of a"
                " test with one clock and one rate",
                where=where,
            )  # fmt: skip
    return count


def _own_words(files: Sequence[str]) -> list[tuple[str, ...]]:
    """Return what the names of files differ in."""
    words = [name_words(file) for file in files]
    everywhere = set.intersection(*(set(own) for own in words))
    found = [tuple(word for word in own if word not in everywhere) for own in words]
    return [own or each for own, each in zip(found, words, strict=True)]


def _may_be(source: Source, index: int, quantity: str) -> bool:
    """Return whether neither name nor unit of a column says that it is something else."""
    unit = stated_unit(source, index)
    fits = unit is None or measures(unit, QUANTITIES[quantity])
    return fits and not known_name(source.headers[index])


def _headers(
    parts: Sequence[_Part], columns: Sequence[tuple[int, int]], own: Sequence[tuple[str, ...]]
) -> tuple[str, ...]:
    plain = [parts[at].source.headers[i] for at, i in columns]
    many = Counter(_name(header) for header in plain)
    return tuple(
        f"{' '.join(own[at])}/{header}" if many[_name(header)] > 1 else header
        for header, (at, _) in zip(plain, columns, strict=True)
    )


def _name(header: str) -> str:
    return split_header(header)[0].lower()


def _told(parts: Sequence[_Part], files: Sequence[str], count: int) -> tuple[str, ...]:
    """Return what to tell of the files, and of samples that only some of them have."""
    told = [text for part in parts for text in part.source.told]
    for part, file in zip(parts, files, strict=True):
        if part.size > count:
            told.append(
                f"the last {part.size - count} samples of {file} are left out: the other file of"
                " the test has none there"
            )
    return tuple(told)
