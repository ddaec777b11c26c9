"""A number over the devices of a fleet: its name, and its picture on the page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from markupsafe import Markup

from discover.words import capitalize_first, raised

_MOST_PICTURES = 24


def quantity_name(quantity: Mapping[str, Any]) -> str:
    """Return a fleet's quantity in words.

    Examples
    --------
    >>> quantity_name({"kind": "boundary", "name": "dean", "structure": ""})
    'boundary, Dean number'
    >>> quantity_name({"kind": "shape", "name": "order of x", "structure": "FOIM"})
    'order of x in FOIM'
    """
    if quantity["kind"] == "boundary":
        known = {"dean": "Dean number", "speed": "speed amplitude"}
        return f"boundary, {known.get(quantity['name'], quantity['name'])}"
    place = f" in {quantity['structure']}" if quantity["structure"] else ""
    return f"{quantity['name']}{place}"


def pictured(
    quantity: Mapping[str, Any], number: int, draw: Callable[..., str], name: str
) -> dict[str, Any]:
    """Return a quantity with its label and picture; the first ones have a picture.

    Parameters
    ----------
    quantity : mapping
        As in ``batch.json``.
    number : int
        Its place on the page, from 0.
    draw : callable
        Makes the picture of it, with a `name` and the axis' `label`.
    name : str
        Of the pictures, before their numbers.
    """
    label = capitalize_first(quantity_name(quantity))
    if number >= _MOST_PICTURES:
        return {**quantity, "label": label, "svg": Markup("")}
    unit = f" ({raised(quantity['unit'])})" if quantity["unit"] not in ("", "1") else ""
    svg = Markup(draw(quantity, name=f"{name}-{number}", label=label + unit))
    return {**quantity, "label": label, "svg": svg}
