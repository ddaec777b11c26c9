"""Names by which laboratories call what a record needs, in English, German and French."""

from __future__ import annotations

import re

_WORDS = {
    "time": "time t zeit temps timestamp elapsed seconds sec laufzeit messzeit testzeit x_value",
    "displacement": "displacement disp deflection stroke position pos x travel lvdt weg hub"
    " auslenkung verschiebung kolbenweg deplacement course stellung laser crosshead ram",
    "force": "force f load loadcell kraft last effort fx fy fz lc kraftaufnehmer kolbenkraft",
    "velocity": "velocity vel v speed geschwindigkeit vitesse",
    "acceleration": "acceleration accel acc a beschleunigung",
    "temperature": "temperature temp temperatur oil",
}
NAMED = tuple(_WORDS)
"""Quantities whose names are known."""
_COMMANDS = set(
    "command cmd commanded setpoint soll sollwert target reference ref demand consigne".split()
)
_PLAIN = str.maketrans("éèêàäöüçâîô", "eeeaaoucaio")
_SPLIT = re.compile(r"[^a-z_]+|_(?!value)")
_LONG = 4  # characters, from which a word also counts at the start or the end of another
_LONGEST = 80  # characters of a header that are looked at

CANONICAL, WORD, PART, LETTER = 1.0, 0.8, 0.6, 0.5
"""How much a name says: it is the quantity's own, one of its words, holds one, or is a letter."""


def name_score(header: str, quantity: str) -> float:
    """Return how surely a header's name is that of a quantity, from 0 to 1.

    A name that is of a command, as "displacement setpoint", counts for half.

    Examples
    --------
    >>> name_score("Force", "force"), name_score("Kolbenkraft 2", "force")
    (1.0, 0.8)
    >>> name_score("Weg_soll", "displacement"), name_score("x", "displacement")
    (0.4, 0.5)
    >>> name_score("Voltage", "force")
    0.0
    """
    plain = _plain(header)
    if plain == quantity:
        return CANONICAL
    tokens = [token for token in _SPLIT.split(plain) if token]
    words = _WORDS[quantity].split()
    score = 0.0
    for token in tokens:
        if token in words:
            score = max(score, LETTER if len(token) == 1 else WORD)
        elif any(
            len(word) >= _LONG and (token.startswith(word) or token.endswith(word))
            for word in words
        ):
            score = max(score, PART)
    return 0.5 * score if of_command(header) else score


def of_command(header: str) -> bool:
    """Return whether a header's name is of what was asked for, not of what was measured.

    Examples
    --------
    >>> of_command("displacement setpoint"), of_command("Sollweg"), of_command("Istweg")
    (True, True, False)
    """
    tokens = [token for token in _SPLIT.split(_plain(header)) if token]
    long = tuple(word for word in _COMMANDS if len(word) >= _LONG)
    return any(token in _COMMANDS or token.startswith(long) for token in tokens)


def _plain(header: str) -> str:
    """Return a header's name in small letters without accents, and without the groups it is in."""
    plain = header[:_LONGEST].strip().lower().translate(_PLAIN)
    return plain.rsplit("/", 1)[-1].rsplit(".", 1)[-1]


def known_name(header: str) -> bool:
    """Return whether a header's name is one of some quantity.

    Examples
    --------
    >>> known_name("Axial Force"), known_name("Operator")
    (True, False)
    """
    return any(name_score(header, quantity) for quantity in NAMED)
