"""Files as instruments and their software write them: each by its format's own library."""

from __future__ import annotations

import datetime
import io
from pathlib import Path

import h5py
import hdf5storage
import numpy as np
import openpyxl
import pyuff
from asammdf import MDF, Signal
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

RATE = 200.0
TIME = np.arange(1200) / RATE
STROKE = 8.0 * np.sin(2 * np.pi * 1.5 * TIME)  # mm
LOAD = 0.6 * np.cos(2 * np.pi * 1.5 * TIME)  # kN


def tdms(
    tests: dict[str, float], *, waveform: bool = True, force: str = "Dev1/ai0"
) -> bytes:
    """A TDMS file of one group a test; each is the test above times a factor."""
    buffer = io.BytesIO()
    with TdmsWriter(buffer) as writer:
        objects: list[object] = [RootObject({"operator": "us"})]
        for group, factor in tests.items():
            wave = {"wf_increment": 1.0 / RATE, "wf_start_offset": 0.0, "wf_samples": TIME.size}
            own = wave if waveform else {}
            objects.append(GroupObject(group, {"remark": "warm"}))
            if not waveform:
                objects.append(ChannelObject(group, "Time", TIME, {"unit_string": "s"}))
            objects.append(
                ChannelObject(group, "LVDT", factor * STROKE, {"unit_string": "mm", **own})
            )
            objects.append(
                ChannelObject(group, force, factor * LOAD, {"unit_string": "kN", **own})
            )
        writer.write_segment(objects)
    return buffer.getvalue()


def workbook(path: Path) -> None:
    """A workbook as an engineer keeps it: a cover, a preamble and a unit row, two tests."""
    book = openpyxl.Workbook()
    cover = book.active
    cover.title = "Info"
    cover.append(["Customer", "nobody"])
    cover.append(["Date", datetime.date(2024, 5, 17)])
    for name, factor in (("Test 1", 1.0), ("Test 2", 0.5)):
        sheet = book.create_sheet(name)
        sheet.append(["Damper 7", None, None])
        sheet.append(["Operator", "Meier", None])
        sheet.append([])
        sheet.append(["Time", "Displacement", "Force"])
        sheet.append(["s", "mm", "kN"])
        for row in zip(TIME, factor * STROKE, factor * LOAD, strict=True):
            sheet.append([float(value) for value in row])
    book.save(path)


def matlab_73(path: Path) -> None:
    """A file of MATLAB's -v7.3: two structures with columns, and the sampling rate."""
    content = {
        f"run{i}": {"x": factor * STROKE[:, None], "F": factor * LOAD[:, None], "by": "us"}
        for i, factor in ((1, 1.0), (2, 0.5))
    }
    hdf5storage.savemat(str(path), {**content, "fs": RATE}, format="7.3", oned_as="column")


def hdf5(path: Path) -> None:
    """An HDF5 file of a data logger: groups, units as attributes, the rate as an attribute."""
    with h5py.File(path, "w") as file:
        for name, factor in (("monday", 1.0), ("tuesday", 0.5)):
            group = file.create_group(name)
            group.attrs["sampling_rate"] = RATE
            x = group.create_dataset("displacement", data=factor * STROKE, compression="gzip")
            x.attrs["units"] = "mm"
            force = group.create_dataset("force", data=(factor * LOAD).astype(np.float32))
            force.attrs["units"] = "kN"
        file["elsewhere"] = h5py.ExternalLink("other.h5", "/secret")


def uff58(path: Path, *, even: bool = True) -> None:
    """A universal file: force and displacement over time as two functions."""
    file = pyuff.UFF(str(path))
    kinds = ((8, "LVDT 3", "mm", STROKE), (13, "Load cell", "kN", LOAD))
    for node, (kind, name, unit, values) in enumerate(kinds, start=1):
        function = {
            "type": 58, "binary": 0, "func_type": 1, "id1": name, "rsp_node": node, "rsp_dir": 3,
            "ref_node": 1, "ref_dir": 3, "data": values, "x": TIME, "num_pts": TIME.size,
            "ord_data_type": 4, "abscissa_spacing": int(even), "abscissa_min": 0.0,
            "abscissa_inc": 1.0 / RATE, "abscissa_spec_data_type": 17,
            "abscissa_axis_units_lab": "s", "ordinate_spec_data_type": kind,
            "ordinate_axis_units_lab": unit, "orddenom_spec_data_type": 0,
        }  # fmt: skip
        file.write_sets(function, "add")


def mdf4(path: Path) -> None:
    """An MDF file of two channel groups."""
    with MDF(version="4.10") as file:
        for name, factor in (("slow", 1.0), ("fast", 0.5)):
            signals = [
                Signal(factor * STROKE, TIME, unit="mm", name="Weg"),
                Signal(factor * LOAD, TIME, unit="kN", name="Kraft"),
            ]
            file.append(signals, acq_name=name, common_timebase=True)
        file.save(path, overwrite=True)
