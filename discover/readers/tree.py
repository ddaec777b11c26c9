"""Files that are trees of named vectors: MATLAB, HDF5, numpy archives, TDMS, MDF."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from discover.readers.names import LETTER, name_score
from discover.readers.one_clock import NEAR, off_clock
from discover.readers.sampling_note import stated_step
from discover.readers.source import (
    MOST_VALUES,
    Book,
    LongVector,
    Source,
    column_pieces,
    column_reader,
)
from discover.readers.units import is_unit, measures, to_si
from models.checks import Array, InputError

_WIDEST = 64  # columns of a matrix that may be channels
_SAME = 1e-9  # of a sampling interval, to which two of them are one
_NESTED = (Mapping, list, np.ndarray)
_Read = Callable[[Sequence[int]], list[Array]]


@dataclass(frozen=True)
class Leaf:
    """One value of a tree."""

    path: tuple[str, ...]
    """Names of the groups that hold it, then its own."""
    value: Any
    """An array, or what numpy makes one of."""
    unit: str = ""
    """As the file states it beside the value; "" where it does not."""
    step: float | None = None
    """s, the sampling interval that the file states beside the value."""
    start: float = 0.0
    """s, the time of the first sample that goes with `step`."""
    role: str = ""
    """The quantity, where the format itself tells it; "" where it does not."""
    began: float = 0.0
    """s, by which its clock began after the first one of the file."""


def tree_book(name: str, leaves: list[Leaf], *, joint: str = "/") -> Book:
    """Return the book of a tree: all of it, and every group that holds vectors.

    Vectors count as columns; a matrix of at most 64 columns gives one column each, named as
    MATLAB would: ``data(:,1)``. A scalar may state the sampling rate. Anything else is left out.

    Parameters
    ----------
    name : str
        File, for messages.
    leaves : list of Leaf
        In the file's order.
    joint : str
        Between the names of a path.

    Raises
    ------
    InputError
        Where it holds no numeric vector.
    """
    vectors, notes = _vectors(_described(leaves))
    if not vectors:
        raise InputError("content", expected="numeric vectors", found="none", where=name)
    groups: dict[tuple[str, ...], list[Leaf]] = {}
    for leaf in vectors:
        groups.setdefault(leaf.path[:-1], []).append(leaf)
    parts = []
    for path, held in groups.items():
        part = joint.join(path)
        inside = name if len(groups) == 1 or not path else f"{name} [{part}]"
        below = () if len(groups) == 1 else path
        parts.append(_source(inside, held, _step_of(path, notes), joint, below=below, part=part))
    whole = None
    if len(parts) > 1:
        whole = _source(name, vectors, _step_of((), notes), joint, below=(), part="")
    return Book(name, tuple(parts), whole=whole)


def plain_leaves(content: Mapping[str, Any], path: tuple[str, ...] = ()) -> Iterator[Leaf]:
    """Return the leaves of nested dictionaries and lists, list members counted from 1.

    Examples
    --------
    >>> [leaf.path for leaf in plain_leaves({"runs": [{"t": 1}, {"t": 2}], "fs": 3})]
    [('runs(1)', 't'), ('runs(2)', 't'), ('fs',)]
    """
    for key, value in content.items():
        own = key.strip()
        members = _members(value)
        if isinstance(value, Mapping):
            yield from plain_leaves(value, (*path, own))
        elif members:
            yield from plain_leaves({f"{own}({i})": m for i, m in enumerate(members, 1)}, path)
        else:
            yield Leaf((*path, own), value)


def _members(value: Any) -> list[Any]:
    """Return what a list holds where that is not plain numbers; nothing for any other value."""
    if isinstance(value, np.ndarray) and value.dtype == object:
        value = list(value.ravel())
    nested = isinstance(value, list) and any(isinstance(m, _NESTED) for m in value)
    return list(value) if nested else []


def _described(leaves: list[Leaf]) -> list[Leaf]:
    """Return the leaves with the units, and the names, that texts beside them state.

    A unit is the text ``units.force`` beside ``force``, or ``Unit`` beside the only vector of a
    structure but its time, whose ``Name`` or ``label`` then stands for it.
    """
    texts = {
        tuple(part.lower() for part in leaf.path): leaf.value.strip()
        for leaf in leaves
        if isinstance(leaf.value, str) and leaf.value.strip()
    }
    if not texts:
        return leaves
    vectors = [leaf.path for leaf in leaves if _is_vector(leaf.value)]
    held = Counter(path[:-1] for path in vectors)
    timed = {path[:-1] for path in vectors if path[-1].lower() == "time"}
    result = []
    for leaf in leaves:
        *group, own = (part.lower() for part in leaf.path)
        others = held[leaf.path[:-1]] - 1 - (leaf.path[:-1] in timed and own != "time")
        alone = not others and _is_vector(leaf.value)
        path, unit = leaf.path, leaf.unit
        for word in ("unit", "units"):
            unit = unit or texts.get((*group, word, own), "")
            unit = unit or (texts.get((*group, word), "") if alone else "")
        named = texts.get((*group, "name")) or texts.get((*group, "label"))
        if alone and group and named:
            path = (*leaf.path[:-2], named)
        result.append(replace(leaf, path=path, unit=unit))
    return result


def _is_vector(value: Any) -> bool:
    array = _numeric(value)
    return array is not None and array.size > 1


def _vectors(leaves: list[Leaf]) -> tuple[list[Leaf], dict[tuple[str, ...], float]]:
    """Return every column as a leaf of its own, and the steps that scalars state by group."""
    vectors: list[Leaf] = []
    notes: dict[tuple[str, ...], float] = {}
    texts = _column_texts(leaves)
    for leaf in leaves:
        array = _numeric(leaf.value)
        if array is None:
            continue
        if array.size == 1:
            step = stated_step([(leaf.path[-1], f"{float(array.ravel()[0])!r} {leaf.unit}")])
            if step is not None:
                notes.setdefault(leaf.path[:-1], step)
            continue
        columns = list(_columns(leaf.path[-1], array))
        listed = texts.get((leaf.path[:-1], len(columns)), []) if len(columns) > 1 else []
        names = [t for t in listed if not all(map(is_unit, t))] or listed[:1]
        units = [t for t in listed if t not in names]
        plain = [own for own, _ in columns]
        called = names[0] if len(names) == 1 else plain
        stated = units[0] if len(units) == 1 else [leaf.unit] * len(plain)
        for own, unit, (_, column) in zip(called, stated, columns, strict=True):
            path = (*leaf.path[:-1], own)
            vectors.append(replace(leaf, path=path, value=column, unit=leaf.unit or unit))
    return vectors, notes


def _column_texts(
    leaves: Sequence[Leaf],
) -> dict[tuple[tuple[str, ...], int], list[list[str]]]:
    """Return lists of texts by their group and length: a matrix's names, and perhaps its units.

    They stand beside the matrix, as ``{'Time','Force'}`` and ``{'s','kN'}``.
    """
    found: dict[tuple[tuple[str, ...], int], list[list[str]]] = {}
    for leaf in leaves:
        listed = leaf.value if isinstance(leaf.value, list) else []
        if isinstance(leaf.value, np.ndarray) and leaf.value.dtype.kind in "OUST":
            listed = leaf.value.ravel().tolist()
        texts = [own.decode("utf-8", "replace") if isinstance(own, bytes) else own
                 for own in listed]  # fmt: skip
        if len(texts) > 1 and all(isinstance(own, str) and own.strip() for own in texts):
            found.setdefault((leaf.path[:-1], len(texts)), []).append([t.strip() for t in texts])
    return found


def _numeric(value: Any) -> Any:
    """Return an array of numbers, or a long vector that stays in its file; None for others."""
    if isinstance(value, LongVector):
        return value
    try:
        array = np.asarray(value)
    except ValueError:  # lists of unequal lengths
        return None
    if array.dtype.kind not in "iufb" or not 0 < array.size <= MOST_VALUES:
        return None
    return array


def _columns(name: str, array: Any) -> Iterator[tuple[str, Any]]:
    if not isinstance(array, np.ndarray):
        yield name, array
        return
    vector = array.squeeze()
    if vector.ndim == 1:
        yield name, vector
    elif vector.ndim == 2:
        tall = vector if vector.shape[0] >= vector.shape[1] else vector.T
        if tall.shape[1] <= _WIDEST:
            for index in range(tall.shape[1]):
                yield f"{name}(:,{index + 1})", tall[:, index]


def _step_of(path: tuple[str, ...], notes: Mapping[tuple[str, ...], float]) -> float | None:
    """Return the step that the group or one above it states, else the only one in the file."""
    above = (path[:count] for count in range(len(path), -1, -1))
    found = next((notes[p] for p in above if p in notes), None)
    return next(iter(notes.values())) if found is None and len(set(notes.values())) == 1 else found


def _source(
    name: str,
    leaves: list[Leaf],
    step: float | None,
    joint: str,
    *,
    below: tuple[str, ...],
    part: str,
) -> Source:
    """Return some leaves as a table, a step stated beside them before one of their group."""
    leaves = _from_the_first(leaves)
    headers = tuple(joint.join(leaf.path[len(below) :]) for leaf in leaves)
    waves = [leaf for leaf in leaves if leaf.step is not None]
    usual = _usual_wave(waves)
    named = [leaf.role for leaf in leaves]
    columns = [leaf.value for leaf in leaves]
    long = [c.size for c in columns if isinstance(c, LongVector)]
    return Source(
        name,
        headers,
        _together(column_reader(name, headers, columns), name, leaves),
        part=part,
        units={i: leaf.unit for i, leaf in enumerate(leaves) if leaf.unit},
        roles={role: named.index(role) for role in named if role and named.count(role) == 1},
        step=usual.step if usual else step,
        start=usual.start if usual else 0.0,
        rows=max(long, default=None),
        pieces=column_pieces(name, headers, columns) if long else None,
        times=_own_times(leaves),
    )


def _from_the_first(leaves: Sequence[Leaf]) -> list[Leaf]:
    """Return leaves whose times count from when the first one's clock began."""
    zero = min(leaf.began for leaf in leaves)
    found = []
    for leaf in leaves:
        late = leaf.began - zero
        if late and leaf.role == "time":
            leaf = replace(leaf, value=np.asarray(leaf.value) + late)
        found.append(replace(leaf, start=leaf.start + late if leaf.step else leaf.start))
    return found


def _own_times(leaves: Sequence[Leaf]) -> Callable[[int, slice], Array | None]:
    """Return what tells a column's times: of its waveform, or of the clock in its group."""
    clocks = _clocks(leaves)

    def times(index: int, part: slice) -> Array | None:
        leaf = leaves[index]
        if leaf.step is not None:
            rows = range(leaf.value.size)[part]
            return np.asarray(leaf.start + leaf.step * np.arange(rows.start, rows.stop))
        clock = clocks.get(leaf.path[:-1])
        if clock is None:
            return None
        unit = leaves[clock].unit
        values = np.array(leaves[clock].value[part], dtype=np.float64)
        return to_si(values, unit, "time") if measures(unit, "time") else values

    return times


def _clocks(leaves: Sequence[Leaf]) -> dict[tuple[str, ...], int]:
    """Return the place of the column of time in each group that has one."""
    return {
        leaf.path[:-1]: i
        for i, leaf in enumerate(leaves)
        if leaf.role == "time" or name_score(leaf.path[-1], "time") >= LETTER
    }


def _usual_wave(waves: Sequence[Leaf]) -> Leaf | None:
    """Return a channel of the sampling that most channels have, of the fastest such."""
    if not waves:
        return None
    counts = Counter((wave.step, wave.start) for wave in waves)
    return min(waves, key=lambda wave: (-counts[wave.step, wave.start], wave.step or 0.0))


def _together(read: _Read, name: str, leaves: Sequence[Leaf]) -> _Read:
    """Return what reads columns, and refuses those that are not sampled as the first of them is."""

    def checked(indices: Sequence[int]) -> list[Array]:
        waves = [leaf for leaf in (leaves[i] for i in indices) if leaf.step is not None]
        for leaf in waves[1:]:
            first, step = waves[0], waves[0].step or 1.0
            late = abs(leaf.start - first.start) > NEAR * step
            if late or abs((leaf.step or 1.0) - step) > _SAME * step:
                raise InputError(
                    "/".join(leaf.path),
                    expected=f"sampled as {'/'.join(first.path)} is, every {step:.6g} s from"
                    f" {first.start:.6g} s on",
                    found=f"every {leaf.step:.6g} s from {leaf.start:.6g} s on; save channels of"
                    " several rates at one rate, and from one time on",
                    where=name,
                )
        _check_clocks(read, name, leaves, indices)
        return read(indices)

    return checked


def _check_clocks(read: _Read, name: str, leaves: Sequence[Leaf], indices: Sequence[int]) -> None:
    """Refuse columns of groups whose own columns of time do not agree."""
    clocks = _clocks(leaves)
    groups = {leaves[i].path[:-1]: "/".join(leaves[i].path) for i in indices}
    own = [(clocks[group], column) for group, column in groups.items() if group in clocks]
    if len(own) < 2:
        return
    first, *others = read([clock for clock, _ in own])
    for (_, column), times in zip(own[1:], others, strict=True):
        if off_clock(first, times).size:
            apart = float(np.abs(times - first).max())
            raise InputError(
                column, expected=f"sampled at the times of {own[0][1]}",
                found=f"times up to {apart:.6g} off; save channels with one clock", where=name,
            )  # fmt: skip
