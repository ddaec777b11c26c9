"""Which column is what, in which unit, how surely and why: for files that no campaign describes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from discover.readers.columns import QUANTITIES, split_header, stated_unit
from discover.readers.names import CANONICAL, LETTER, WORD, name_score, of_command
from discover.readers.source import Source
from discover.readers.units import measures, to_si, weight_unit
from models.checks import Array, InputError, shown

SURE, LIKELY, UNSURE = "sure", "likely", "unsure"
_GUESSED = ("time", "force", "displacement", "velocity", "acceleration", "temperature")
_NEEDED = ("time", "force", "displacement")
_NEAR = 0.05  # of a score, within which two columns are equally likely
_FEWEST = 16  # samples, from which a guess is made by the values
_SMALL_STROKE = 0.3  # below it metres, from it on millimetres: of what laboratories write
_COARSE_STEP = 0.3  # s: from it on a finer unit
_TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}  # s, coarsest first
_FINE_STEP, _LATE = 1e-5, 1e4  # steps below the one, from beyond the other on, are a date's in days


@dataclass(frozen=True)
class Guess:
    """What a column is taken for."""

    quantity: str
    """Such as "force"."""
    header: str
    """The column's, as in the file."""
    sure: str
    """"sure", "likely" or "unsure"."""
    why: str
    """In words."""
    unit: str
    """Its unit, stated or guessed."""
    unit_stated: bool
    """Whether the file states the unit."""
    others: tuple[str, ...] = ()
    """Headers that are as likely."""
    unit_named: bool = False
    """Whether its header ends in the unit, as ``disp_mm`` or ``Force lbs``: no guess at values."""
    unit_told: bool = False
    """Whether the user says the unit."""

    @property
    def unit_by(self) -> str:
        """Return in words what the unit was taken by, "" where the file states it."""
        if self.unit_told:
            return "you said so"
        if self.unit_stated:
            return ""
        return "by its name" if self.unit_named else "guessed"

    @property
    def unit_guessed(self) -> bool:
        """Return whether nobody states the unit, nor the header's end."""
        return not (self.unit_told or self.unit_stated or self.unit_named)


@dataclass(frozen=True)
class TableGuess:
    """What a table is taken for."""

    columns: Mapping[str, Guess]
    """By quantity."""
    lacks: tuple[str, ...]
    """Quantities that a record needs and the table has not."""


def guess_table(source: Source) -> TableGuess:
    """Return which columns of a table are what.

    A unit of the right kind, a name that laboratories use, and what the values do (time rises
    evenly) each speak for a column; a unit of another kind speaks against it.

    Parameters
    ----------
    source : Source
        The table. Its columns are read where their values have to tell.

    Examples
    --------
    >>> t = np.arange(20) / 100.0
    >>> headers = ("Zeit [s]", "Weg [mm]", "F")
    >>> table = Source("a.csv", headers, lambda i: [t, 1e3 * t**2, t][: len(i)])
    >>> found = guess_table(table)
    >>> [(q, g.header, g.sure) for q, g in found.columns.items()]
    [('time', 'Zeit [s]', 'sure'), ('force', 'F', 'likely'), ('displacement', 'Weg [mm]', 'sure')]
    """
    columns: dict[str, Guess] = {}
    taken: set[int] = set()
    for quantity in _GUESSED:
        guess = _column(source, quantity, taken)
        if guess is not None:
            columns[quantity] = guess
            taken.add(source.headers.index(guess.header))
    columns = {**_by_elimination(source, columns), **columns}
    ordered = {q: columns[q] for q in _GUESSED if q in columns}
    timed = source.step is not None
    lacks = tuple(q for q in _NEEDED if q not in columns and not (q == "time" and timed))
    return TableGuess(ordered, lacks)


def _column(source: Source, quantity: str, taken: set[int]) -> Guess | None:
    """Return the likeliest column by name and unit, or None where none speaks for itself."""
    scores: dict[int, tuple[float, float, bool]] = {}
    for index, header in enumerate(source.headers):
        unit = stated_unit(source, index)
        fitting = unit is not None and measures(unit, QUANTITIES[quantity])
        name = name_score(split_header(header)[0], quantity)
        weighed = quantity == "force" and name > 0.0 and weight_unit(unit or "") is not None
        if index in taken or (unit is not None and not (fitting or weighed)):
            continue
        if source.roles.get(quantity) == index:
            name = CANONICAL
        elif quantity != "time" and name_score(header, "time") and _is_rising(source, index):
            continue  # the time of that channel
        if name > 0.0 or (fitting and quantity in _NEEDED):
            commanded = 0.5 if of_command(split_header(header)[0]) else 1.0
            scores[index] = (name + commanded * fitting, name, fitting)
    ordered = sorted(scores, key=lambda i: -scores[i][0])
    if quantity == "time":
        rising = [i for i in ordered if _is_rising(source, i)]
        # One that fails is still the time: reading it tells its line and what is wrong there.
        known = {i for i in ordered if _named_unit(source.headers[i], quantity)}
        named = [i for i in ordered if scores[i][0] >= WORD or i in known]
        ordered = rising or (named if source.step is None else [])
    for index in ordered:
        score, name, fitting = scores[index]
        near = [i for i in scores if i != index and score - scores[i][0] < _NEAR]
        if quantity == "time":
            near = []
        return _guess(source, quantity, index, name=name, fitting=fitting, near=near)
    return None


def _guess(
    source: Source, quantity: str, index: int, *, name: float, fitting: bool, near: list[int]
) -> Guess:
    header = source.headers[index]
    reasons = []
    if name:
        reasons.append("the name says so" if name > LETTER else "the letter is usual")
    if fitting:
        reasons.append(f"the unit is one of {QUANTITIES[quantity]}")
    sure = SURE if name == CANONICAL or (name and fitting) else LIKELY
    others = tuple(source.headers[i] for i in near)
    if others:
        sure = UNSURE
        reasons.append("others are as likely")
    unit = stated_unit(source, index)
    stated = unit is not None and measures(unit, QUANTITIES[quantity])
    weight = weight_unit(unit or "") if quantity == "force" else None
    named = None if stated else weight or _named_unit(header, quantity)
    return Guess(
        quantity,
        header,
        sure,
        " and ".join(reasons),
        unit if stated and unit is not None else named or _guessed_unit(source, index, quantity),
        stated,
        others,
        unit_named=named is not None,
    )


def _named_unit(header: str, quantity: str) -> str | None:
    """Return the unit that a header ends in after a blank or an underscore, or None.

    A force that is said to be in a unit of mass is that of its weight.
    """
    name, last = split_header(header)
    if last is None:
        name, _, last = header.strip().replace("_", " ").rpartition(" ")
    if not (name and last):
        return None
    if quantity == "force" and (weight := weight_unit(last)) is not None:
        return weight
    return last if measures(last, QUANTITIES[quantity]) else None


def _values(source: Source, index: int) -> Array | None:
    """Return a column that is numbers throughout, or None."""
    try:
        (column,) = source.read([index])
    except InputError:
        return None
    fine = column.size >= _FEWEST and np.isfinite(column).all()
    return column if fine else None


def _is_rising(source: Source, index: int) -> bool:
    column = _values(source, index)
    return column is not None and bool((np.diff(column) >= 0.0).all() and column[-1] > column[0])


def _guessed_unit(source: Source, index: int, quantity: str) -> str:
    """Return the unit in which the values would be of a usual size."""
    column = _values(source, index)
    if column is not None and quantity == "displacement":
        return "m" if 0.5 * np.ptp(column) < _SMALL_STROKE else "mm"
    if column is not None and quantity == "time":
        step = (column[-1] - column[0]) / (column.size - 1)
        if step < _FINE_STEP and column[0] > _LATE:
            return "d"  # since 1900, as spreadsheets count
        return next((u for u, size in _TIME_UNITS.items() if size * step < _COARSE_STEP), "ns")
    return {"force": "N", "velocity": "m/s", "acceleration": "m/s^2", "temperature": "degC"}.get(
        quantity, "s" if quantity == "time" else "m"
    )


def _by_elimination(source: Source, found: Mapping[str, Guess]) -> Mapping[str, Guess]:
    """Return guesses for what nothing speaks for, of the columns that nothing else is.

    Time is a column that rises evenly, and no motion and no force does. Of two that are left
    displacement is the smoother.
    """
    used = {guess.header for guess in found.values()}
    free = {
        i: column
        for i, header in enumerate(source.headers)
        if header not in used
        and stated_unit(source, i) is None
        and not any(name_score(split_header(header)[0], q) for q in _GUESSED)
        and (column := _values(source, i)) is not None
        and np.ptp(column) > 0.0
        and not (np.diff(column) == 1.0).all()  # a counter of samples
    }
    result: dict[str, Guess] = {}
    even = [i for i, column in free.items() if _evenly_spaced(column)]
    free = {i: column for i, column in free.items() if i not in even}
    if even and "time" not in found and source.step is None:
        result["time"] = _eliminated(source, even[0], "time", "it alone rises evenly")
    wanted = [q for q in ("displacement", "force") if q not in found]
    smooth = sorted(free, key=lambda i: _roughness(free[i]))
    if 0 < len(wanted) <= len(smooth):
        ends = {"displacement": smooth[0], "force": smooth[-1]}
        for quantity in wanted:
            why = "of what is left it is the " + ("smoother" if quantity[0] == "d" else "rougher")
            result[quantity] = _eliminated(source, ends[quantity], quantity, why)
    return result


def _eliminated(source: Source, index: int, quantity: str, why: str) -> Guess:
    unit = _guessed_unit(source, index, quantity)
    sure = LIKELY if quantity == "time" else UNSURE
    return Guess(quantity, source.headers[index], sure, why, unit, unit_stated=False)


def _evenly_spaced(column: Array) -> bool:
    steps = np.diff(column)
    return bool(steps.min() > 0.0 and steps.max() < 3.0 * np.median(steps))


def _roughness(column: Array) -> float:
    return float(np.sqrt(np.mean(np.diff(column, 2) ** 2)) / np.ptp(column))


def in_si(guess: Guess, values: Array) -> Array:
    """Return a guessed column's values in SI."""
    return to_si(values, guess.unit, QUANTITIES[guess.quantity])


def listed(table: TableGuess) -> Iterator[str]:
    """Yield in words what each column is taken for.

    Examples
    --------
    >>> force = Guess("force", "F", "likely", "the letter is usual", "N", unit_stated=False)
    >>> list(listed(TableGuess({"force": force}, ())))
    ["force is column 'F' (likely: the letter is usual), in N (guessed)"]
    """
    for guess in table.columns.values():
        stated = guess.unit_by and f" ({guess.unit_by})"
        yield (
            f"{guess.quantity} is column {shown(guess.header)} ({guess.sure}: {guess.why}), in"
            f" {guess.unit}{stated}"
        )
