"""The sampling rate or interval that a file's header states in place of a time column."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from discover.readers.units import quantity
from models.checks import InputError

_RATE = re.compile(
    r"fs|f_?s(ample)?|sampl(e|ing)[\s_-]*(rate|freq(uency)?)|(scan|data|daq|acquisition)[\s_-]*rate"
    r"|abtast(rate|frequenz)|messrate|fr(é|e)quence[\s_-]*d.?[\s_]?(é|e)chantillonnage"
    r"|samples?[\s_-]*(/|per)[\s_-]*s(ec(ond)?)?",
    re.IGNORECASE,
)
_STEP = re.compile(
    r"dt|(x[\s_-]*|time[\s_-]*)?increment|delta[\s_-]*[tx]|(sampl(e|ing)|scan|time)[\s_-]*(interval|period|time|step|increment)"
    r"|wf_increment|abtast(intervall|zeit|periode)"
    r"|p(é|e)riode[\s_-]*d.?[\s_]?(é|e)chantillonnage",
    re.IGNORECASE,
)
_OWN_UNIT = re.compile(r"(.*?)[\s_]*[\[(]([^\[\]()]{1,20})[\])]")
_LONGEST = 80  # characters of a name or a value
_RATE_UNITS = {"": "Hz", "s/s": "Hz", "samples/s": "Hz", "sps": "Hz", "1/sec": "Hz", "s-1": "Hz"}


def stated_step(notes: Iterable[tuple[str, str]]) -> float | None:
    """Return the sampling interval that one of a header's notes states, s; None where none does.

    Parameters
    ----------
    notes : iterable of (str, str)
        Names and values, as ``("Sampling rate [Hz]", "1000")`` or ``("dt", "5 ms")``.

    Examples
    --------
    >>> stated_step([("Operator", "Meier"), ("Abtastrate", "0,5 kHz")])
    0.002
    >>> stated_step([("Delta_X", "0.005")])
    0.005
    """
    for name, value in notes:
        if len(name) > _LONGEST or len(value) > _LONGEST:
            continue
        found = _step(name.strip(" \t:=#%\"'"), value.strip(" \t:=\"'"))
        if found is not None:
            return found
    return None


def _step(name: str, value: str) -> float | None:
    own = _OWN_UNIT.fullmatch(name)
    plain, unit = (own[1], own[2].strip()) if own else (name, "")
    rate = _RATE.fullmatch(plain)
    if rate is None and _STEP.fullmatch(plain) is None:
        return None
    match = re.fullmatch(r"([+-]?[\d.,]+(?:[eE][+-]?\d+)?)\s*(\S{0,12})", value)
    if match is None:
        return None
    number, unit = match[1].replace(",", "."), match[2] or unit
    if rate is not None:
        unit = _RATE_UNITS.get(unit.lower(), unit)
    try:
        kind = "frequency" if rate is not None else "time"
        si = quantity(f"{number} {unit or 's'}", kind, name="sampling", where="")
    except InputError:
        return None
    if not si > 0.0:
        return None
    step = 1.0 / si if rate is not None else si
    return step if math.isfinite(step) else None
