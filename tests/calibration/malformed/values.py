"""What stands where something else should: values of every type and size."""

from __future__ import annotations

import random
from typing import Any

_TEXTS = (
    "", " ", "x", "nan", "inf", "-1 mm", "1e400 Hz", "0 Hz", "5", "1 kg", "mm", "\x1b[2J\x07",
    "a" * 5000, "[" * 3000, " " * 3000, "../../etc/passwd", "/etc/passwd", "%s%n", "{{7*7}}",
    "<script>", "\u202e\u0000x", "1e-300 s", "*", "**", "[a", "inertia", "stiffness", "9^9^9^9 m",
)  # fmt: skip


def junk(rng: random.Random, *, depth: int = 0) -> Any:
    """Return a value of any type."""
    kind = rng.randrange(9)
    if kind == 0:
        return rng.choice((True, False))
    if kind == 1:
        return rng.choice((0, -1, 3, 10**6, 10**30, -(10**40), 2**63))
    if kind == 2:
        return rng.choice((0.5, -0.0, 1e-300, 1e300, -3.7, 1e30, 7.0))
    if kind in (3, 4, 5):
        return rng.choice(_TEXTS)
    if kind == 6:
        return [] if depth > 2 else [junk(rng, depth=depth + 1) for _ in range(rng.randrange(4))]
    if kind == 7:
        keys = ("id", "coefficient", "lower", "file", "preset", "x", "a b")
        chosen = rng.sample(keys, rng.randrange(3))
        return {} if depth > 2 else {key: junk(rng, depth=depth + 1) for key in chosen}
    return rng.choice((float("nan"), float("inf"), -float("inf")))


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of everything inside a document."""
    found = [path] if path else []
    items: Any = ()
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list):
        items = enumerate(value)
    for key, inside in items:
        found += places(inside, (*path, key))
    return found


def mutate(document: Any, rng: random.Random) -> None:
    """Change one place of a document: another value, none, one more key, or twice the same."""
    path = rng.choice(places(document))
    holder = document
    for key in path[:-1]:
        holder = holder[key]
    key = path[-1]
    turn = rng.random()
    if turn < 0.65:
        holder[key] = junk(rng)
    elif turn < 0.8:
        del holder[key]
    elif isinstance(holder, dict):
        holder[rng.choice(("x", "lower", "upper", "unit", "terms", "schema", "range"))] = junk(rng)
    else:
        holder.append(holder[key])
