"""The units of a drafted campaign: stated by files, said in ``[units]``, or a record's own."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

from discover.readers.columns import QUANTITIES, split_header
from discover.readers.guess import Guess, TableGuess
from discover.readers.units import same_unit, turns_sign
from models.checks import InputError

_LARGER = ("mm", "ms", "kN")  # of two guesses of a unit the one that some record needs


def settled(tables: Sequence[TableGuess], answers: Mapping[str, str]) -> list[TableGuess]:
    """Return the tables with a unit for every column whose file states none.

    It is the user's; else the one that other files state for a column of the same name; else the
    one by the values of all columns of that name, since one bench writes one unit.

    Parameters
    ----------
    tables : sequence of TableGuess
        As guessed, each alone.
    answers : mapping
        Units by quantity, as the user says. Where a file states one, they may only turn its sign.

    Raises
    ------
    InputError
        Where no file has such a column, or every file that has it states another unit.
    """
    for quantity, unit in answers.items():
        _check_answer(tables, quantity, unit)
    alike: dict[tuple[str, str], list[Guess]] = {}
    for table in tables:
        for quantity, guess in table.columns.items():
            alike.setdefault((quantity, _name(guess)), []).append(guess)
    return [
        replace(
            table,
            columns={
                quantity: _settled(guess, answers.get(quantity), alike[quantity, _name(guess)])
                for quantity, guess in table.columns.items()
            },
        )
        for table in tables
    ]


def _settled(guess: Guess, answer: str | None, alike: Sequence[Guess]) -> Guess:
    if guess.unit_stated:
        turned = answer is not None and turns_sign(guess.unit, answer, QUANTITIES[guess.quantity])
        return replace(guess, unit=answer, unit_told=True) if turned and answer else guess
    if answer is not None:
        return replace(guess, unit=answer, unit_told=True)
    return replace(guess, unit=_likely(alike))


def _check_answer(tables: Sequence[TableGuess], quantity: str, unit: str) -> None:
    """Refuse the user's unit of a column where it could not be taken."""
    own = [table.columns[quantity] for table in tables if quantity in table.columns]
    if tables and not own:
        there = sorted({q for table in tables for q in table.columns})
        raise InputError(
            quantity, expected="a column that some file has, as " + ", ".join(there),
            found="none; --column can name it", where="--unit",
        )  # fmt: skip
    kind = QUANTITIES[quantity]
    fitting = (
        not g.unit_stated or same_unit(g.unit, unit, kind) or turns_sign(g.unit, unit, kind)
        for g in own
    )
    if own and not any(fitting):
        stated = " or ".join(dict.fromkeys(g.unit for g in own))
        raise InputError(
            f"unit of {quantity}",
            expected=f"the one that the files state, {stated}, or that with its sign turned, as"
            f" '-1 {own[0].unit}'",
            found=unit,
            where="--unit",
        )


def guessed_units(tables: Sequence[TableGuess], units: Mapping[str, str]) -> tuple[str, ...]:
    """Return the quantities of ``[units]`` that nobody stated, for some table.

    Examples
    --------
    >>> cell = Guess("force", "F", "likely", "", "kN", unit_stated=False)
    >>> guessed_units([TableGuess({"force": cell}, ())], {"force": "kN"})
    ('force',)
    """
    return tuple(
        quantity
        for quantity in units
        if any(quantity in t.columns and t.columns[quantity].unit_guessed for t in tables)
    )


def common_units(tables: Sequence[TableGuess]) -> dict[str, str]:
    """Return ``[units]``: of each quantity that some file states no unit for, the usual one.

    Examples
    --------
    >>> cell = Guess("force", "F", "likely", "", "kN", unit_stated=False)
    >>> common_units([TableGuess({"force": cell}, ())])
    {'force': 'kN'}
    """
    units = {}
    for quantity in QUANTITIES:
        own = [t.columns[quantity] for t in tables if quantity in t.columns]
        open_ = Counter(g.unit for g in own if g.unit_told or not g.unit_stated)
        if open_:
            units[quantity] = open_.most_common(1)[0][0]
    return units


def own_units(table: TableGuess, units: Mapping[str, str]) -> dict[str, str]:
    """Return a record's own units, where they are not those of ``[units]``.

    Examples
    --------
    >>> cell = Guess("force", "F [N]", "sure", "", "N", unit_stated=True)
    >>> own_units(TableGuess({"force": cell}, ()), {"force": "kN", "time": "s"})
    {'force': 'N'}
    """
    return {
        quantity: guess.unit
        for quantity, guess in table.columns.items()
        if quantity in units and not same_unit(guess.unit, units[quantity], QUANTITIES[quantity])
    }


def _name(guess: Guess) -> str:
    return split_header(guess.header)[0]


def _likely(alike: Sequence[Guess]) -> str:
    """Return the unit of columns of one name of which some file states none."""
    stated = Counter(g.unit for g in alike if g.unit_stated)
    if stated:
        return stated.most_common(1)[0][0]
    open_ = [g.unit for g in alike]
    return next((unit for unit in _LARGER if unit in open_), open_[0])
