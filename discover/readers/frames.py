"""Records that are already in memory: frames or arrays as a campaign."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discover.readers.campaign import merged
from discover.readers.entries import Entry
from discover.readers.plausibility import implausible
from discover.readers.record import read_record
from discover.readers.source import Source
from discover.readers.tables import read_column_names, read_column_units, read_device
from discover.records import Campaign, Finding, Record
from models.checks import Array, InputError, number, shown
from models.device import Device

_FRAME = "a table with columns time, displacement and force"


def campaign_from_frames(
    frames: Mapping[str, Any],
    *,
    units: Mapping[str, str] | None = None,
    columns: Mapping[str, str] | None = None,
    device: Device | str | Mapping[str, Any] | None = None,
    held_out: Collection[str] = (),
    sampling_rate: float | None = None,
    title: str = "",
) -> Campaign:
    """Return a campaign of tables in memory; `Campaign.from_frames` describes it.

    Raises
    ------
    InputError
        As reading a campaign's folder does, with the record's name.
    """
    if not isinstance(frames, Mapping) or not frames:
        raise InputError(
            "frames",
            expected=f"a mapping of a record's name to {_FRAME}",
            found=type(frames).__name__ if frames is None or len(frames) else "nothing",
            where="Campaign.from_frames",
        )
    names = read_column_names(dict(columns or {}))
    stated = read_column_units(dict(units or {}))
    strange = sorted(set(held_out) - set(frames))
    if strange:
        raise InputError(
            "held_out", expected="names of frames", found=shown(strange[0]),
            where="Campaign.from_frames",
        )  # fmt: skip
    step = None if sampling_rate is None else 1.0 / number("sampling_rate", sampling_rate, above=0)
    digest = hashlib.sha256(json.dumps([names, stated, step], sort_keys=True).encode())
    records: list[Record] = []
    findings: list[Finding] = []
    read: list[Mapping[str, str | None]] = []
    for name, frame in frames.items():
        headers, arrays, own = _columns(frame, str(name))
        for header, array in zip(headers, arrays, strict=True):
            digest.update(f"{name}\0{header}\0{array.size}\0".encode() + array.tobytes())
        source = Source(str(name), headers, _reader(arrays, headers, str(name)), units=own)
        entry = Entry(str(name), held_out=name in held_out, step=step)
        record, found, own_units = read_record(source, entry, names=names, units=stated)
        records.append(record)
        findings.extend(found)
        read.append(own_units)
    described = _device(device)
    findings.extend(implausible(records, described, None, units=read))
    return Campaign(
        title=title or "records in memory",
        records=tuple(records),
        device=described,
        content_hash=digest.hexdigest(),
        findings=merged(findings, len(records)),
    )


def _device(given: Device | str | Mapping[str, Any] | None) -> Device | None:
    if given is None or isinstance(given, Device):
        return given
    if isinstance(given, str):
        return Device.preset(given)
    return read_device(given)


def _columns(frame: Any, name: str) -> tuple[tuple[str, ...], list[Array], dict[int, str]]:
    """Return headers, columns, and the units that the columns' type tells."""
    if hasattr(frame, "to_dataframe"):  # xarray, whose time is a coordinate
        frame = frame.to_dataframe()
    named = [n for n in getattr(getattr(frame, "index", None), "names", ()) if n is not None]
    if named:  # pandas: a time that is the index
        frame = frame.reset_index()
    keys = list(frame) if isinstance(frame, Mapping) else list(getattr(frame, "columns", ()))
    if not keys:
        raise InputError(
            "frame", expected=f"{_FRAME} (pandas, polars, xarray, or a mapping of arrays)",
            found=type(frame).__name__, where=name,
        )  # fmt: skip
    arrays, own = [], {}
    zero = None  # of all time stamps, so that columns that began apart stay so
    for position, key in enumerate(keys):
        values = np.asarray(frame[key])
        if values.dtype.kind in "mM":
            own[position] = "s"
            stamped = values.dtype.kind == "M" and values.size
            zero = values[:1] if stamped and zero is None else zero
            values = (values - (zero if stamped else values[:1])) / np.timedelta64(1, "s")
        arrays.append(_numbers(values))
    return tuple(str(key).strip() for key in keys), arrays, own


def _numbers(values: NDArray[Any]) -> Array:
    """Return a column in floats; text and what is no column is NaN, refused if it is asked for."""
    try:
        return np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        return np.full(len(values), np.nan)


def _reader(arrays: Sequence[Array], headers: Sequence[str], name: str) -> Any:
    def read(indices: Sequence[int]) -> list[Array]:
        size = arrays[indices[0]].size
        for index in indices:
            if arrays[index].shape != (size,):
                raise InputError(
                    headers[index], expected=f"of shape ({size},)",
                    found=f"{arrays[index].shape}", where=name,
                )  # fmt: skip
        return [arrays[index] for index in indices]

    return read
