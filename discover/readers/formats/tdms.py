"""NI TDMS as a source of columns (npTDMS)."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from discover.readers.content import content_error, optional_package
from discover.readers.file_format import FileFormat
from discover.readers.sampling_note import stated_step
from discover.readers.source import Book
from discover.readers.tree import Leaf, tree_book

_UNITS = ("unit_string", "NI_UnitDescription")
_STEP, _START, _BEGAN = "wf_increment", "wf_start_offset", "wf_start_time"


def open_tdms(data: bytes, name: str) -> Book:
    """Open a TDMS file: its groups are tests, its channels columns.

    Waveforms carry their own sampling interval and when they began, channels their unit.

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
    zero = min(
        (time for group in file.groups() for c in group.channels() if (time := _began(c))),
        default=None,
    )
    for key, value in _numbers(file.properties):
        yield Leaf((key,), value)
    for group in file.groups():
        for key, value in _numbers(group.properties):
            yield Leaf((group.name, key), value)
        for channel in group.channels():
            yield _leaf(group.name, channel, zero)


def _began(channel: Any) -> Any:
    """Return when a channel's clock began, None where the file does not tell it."""
    if channel.dtype.kind == "M":
        return channel[0] if len(channel) else None
    found = channel.properties.get(_BEGAN)
    return found if isinstance(found, np.datetime64) and not np.isnat(found) else None


def _leaf(group: str, channel: Any, zero: Any) -> Leaf:
    """Return a channel, whose clock began some time after `zero`, the first one of the file."""
    values = channel[:]
    own = channel.properties
    time = _began(channel)
    began = 0.0 if time is None else float((time - zero) / np.timedelta64(1, "ns")) / 1e9
    if values.dtype.kind == "M":
        seconds = (values - values[:1]) / np.timedelta64(1, "ns") / 1e9
        return Leaf((group, channel.name), seconds, unit="s", role="time", began=began)
    step = own.get(_STEP)
    if not isinstance(step, int | float) or not step > 0.0:
        step = stated_step([(key, repr(value)) for key, value in _numbers(own)])
    return Leaf(
        (group, channel.name),
        values,
        unit=next((str(own[key]).strip() for key in _UNITS if own.get(key)), ""),
        step=step,
        start=float(own.get(_START, 0.0)) if step else 0.0,
        began=began,
    )


def _numbers(properties: Mapping[str, Any]) -> list[tuple[str, float]]:
    kept = (int, float, np.integer, np.floating)
    return [
        (key, float(value))
        for key, value in properties.items()
        if isinstance(value, kept) and not isinstance(value, bool)
    ]


FORMAT = FileFormat((".tdms",), open_tdms)
