"""NI TDMS as a source of columns (npTDMS)."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from discover.readers.content import content_error, optional_package
from discover.readers.sampling_note import stated_step
from discover.readers.source import Book
from discover.readers.tree import Leaf, tree_book

_UNITS = ("unit_string", "NI_UnitDescription")
_STEP, _START = "wf_increment", "wf_start_offset"


def open_tdms(data: bytes, name: str) -> Book:
    """Open a TDMS file: its groups are tests, its channels columns.

    Waveforms carry their own sampling interval, channels their unit.

    Raises
    ------
    InputError
        Where it is not such a file, holds no numeric channel, or npTDMS is missing.
    """
    nptdms = optional_package("nptdms", extra="tdms", name=name)
    try:
        file = nptdms.TdmsFile.read(io.BytesIO(data))
        leaves = list(_leaves(file))
    except Exception as error:  # the library lets errors of many kinds through
        raise content_error("a TDMS file", error, name) from None
    return tree_book(name, leaves)


def _leaves(file: Any) -> Iterator[Leaf]:
    for key, value in _numbers(file.properties):
        yield Leaf((key,), value)
    for group in file.groups():
        for key, value in _numbers(group.properties):
            yield Leaf((group.name, key), value)
        for channel in group.channels():
            yield _leaf(group.name, channel)


def _leaf(group: str, channel: Any) -> Leaf:
    values = channel[:]
    own = channel.properties
    if values.dtype.kind == "M":
        seconds = (values - values[:1]) / np.timedelta64(1, "ns") / 1e9
        return Leaf((group, channel.name), seconds, unit="s")
    step = own.get(_STEP)
    if not isinstance(step, int | float) or not step > 0.0:
        step = stated_step([(key, repr(value)) for key, value in _numbers(own)])
    return Leaf(
        (group, channel.name),
        values,
        unit=next((str(own[key]).strip() for key in _UNITS if own.get(key)), ""),
        step=step,
        start=float(own.get(_START, 0.0)) if step else 0.0,
    )


def _numbers(properties: Mapping[str, Any]) -> list[tuple[str, float]]:
    kept = (int, float, np.integer, np.floating)
    return [
        (key, float(value))
        for key, value in properties.items()
        if isinstance(value, kept) and not isinstance(value, bool)
    ]
