"""Malformed campaigns by seed: what is written in ``campaign.toml``, and what lies beside it."""

from __future__ import annotations

import copy
import random
from pathlib import Path
from typing import Any

import numpy as np

from tests.calibration.malformed.values import junk, mutate

TIME = np.arange(400) / 100.0
HEADER = "time [s],displacement [mm],force [kN]"

WHOLE: dict[str, Any] = {
    "title": "sines",
    "device": {
        "preset": "device-12", "inertance": "370 kg", "turns": 14,
        "fluid": {"density": "800 kg/m^3", "viscosity": "27 mPa*s"},
    },
    "columns": {"time": "time", "force": "force"},
    "units": {"displacement": "mm"},
    "rig": {"max_stroke": "25 mm", "max_force": "20 kN"},
    "system": {"mass": "250 kg", "stiffness": "20 kN/m", "input": "applied_force"},
    "records": [
        {"file": "0.csv", "frequency": "1 Hz", "amplitude": "8 mm", "range": "0 s : 4 s"},
        {"file": "1.csv", "held_out": True, "channel": {"force": "force"}},
        {"file": "[2].csv", "sampling_rate": "100 Hz", "group": 1},
    ],
}  # fmt: skip


def malformed_campaign(folder: Path, seed: int) -> None:
    """Write one campaign into a folder: its table changed, its text damaged, or its records."""
    rng = random.Random(seed)
    table = copy.deepcopy(WHOLE)
    turn = rng.random()
    if turn < 0.45:
        for _ in range(rng.randrange(1, 4)):
            if table:
                mutate(table, rng)
    toml = toml_text(table).encode("utf-8", "replace")
    if 0.45 <= turn < 0.55:
        toml = _damaged(toml, rng)
    (folder / "campaign.toml").write_bytes(toml)
    for index, name in enumerate(("0.csv", "1.csv", "2.csv")):
        content = record(1.0 + index)
        if turn >= 0.55 and index < 2 and rng.random() < 0.6:
            content = _odd(content, rng) if rng.random() < 0.5 else _spoilt(content, rng)
        (folder / name).write_bytes(content)


def record(frequency: float) -> bytes:
    w = 2 * np.pi * frequency
    x = 8.0 * np.sin(w * TIME)
    force = -0.37 * w**2 * x * 1e-3 + 4e-3 * w * np.cos(w * TIME)
    rows = (f"{t:.6g},{a:.6g},{f:.6g}" for t, a, f in zip(TIME, x, force, strict=True))
    return (HEADER + "\n" + "\n".join(rows) + "\n").encode()


def toml_text(table: dict[str, Any]) -> str:
    lines: list[str] = []
    tables = {k: v for k, v in table.items() if isinstance(v, dict)}
    lists = {k: v for k, v in table.items() if _is_tables(v)}
    lines += [f"{_key(k)} = {_value(v)}" for k, v in table.items() if k not in {**tables, **lists}]
    for key, inside in tables.items():
        lines += [f"[{_key(key)}]"] + [f"{_key(k)} = {_value(v)}" for k, v in inside.items()]
    for key, listed in lists.items():
        for inside in listed:
            lines += [f"[[{_key(key)}]]"] + [f"{_key(k)} = {_value(v)}" for k, v in inside.items()]
    return "\n".join(lines) + "\n"


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(v, dict) for v in value)


def _key(key: Any) -> str:
    return _text(str(key))


def _text(text: str) -> str:
    inside = "".join(c if c.isprintable() and c not in '"\\' else f"\\u{ord(c):04x}" for c in text)
    return f'"{inside}"'


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + "}"
    return repr(value).replace("e+", "e")


def _damaged(data: bytes, rng: random.Random) -> bytes:
    result = bytearray(data)
    for _ in range(rng.randrange(1, 8)):
        result[rng.randrange(len(result))] = rng.randrange(256)
    if rng.random() < 0.3:
        del result[rng.randrange(1, len(result)) :]
    return bytes(result)


def _spoilt(content: bytes, rng: random.Random) -> bytes:
    """Return a record with something wrong: a header, a field, a row, its size, its encoding."""
    lines = content.decode().splitlines()
    row = rng.randrange(1, len(lines))
    fields = lines[row].split(",")
    kind = rng.randrange(16)
    if kind == 0:
        lines[0] = str(junk(rng)) + "," + lines[0]
    elif kind == 1:
        column = rng.randrange(3)
        names = lines[0].split(",")
        names[column] = str(junk(rng)).replace("\n", " ")
        lines[0] = ",".join(names)
    elif kind == 2:
        fields[rng.randrange(3)] = str(junk(rng)).replace("\n", " ")
        lines[row] = ",".join(fields)
    elif kind == 3:
        lines[row] = rng.choice(("", ",,", "1,2", "1,2,3,4", "# note", "END", HEADER))
    elif kind == 4:
        del lines[row : row + rng.choice((1, 30, 300))]
    elif kind == 5:
        lines = lines[: rng.choice((1, 2, 5, 17, 40))]
    elif kind == 6:
        power = rng.choice((-300, -200, -30, -12, 12, 30, 200, 300))
        column = rng.randrange(3)
        lines[1:] = [_scaled(line, column, power) for line in lines[1:]]
    elif kind == 7:
        column = rng.randrange(3)
        value = rng.choice(("0", "1e30", "-5", "1e-40"))
        lines[1:] = [_put(line, column, value) for line in lines[1:]]
    elif kind == 8:
        rng.shuffle(lines)
    elif kind == 9:
        lines[1:] = lines[:0:-1]
    elif kind == 10:
        return _damaged(content, rng)
    elif kind == 11:
        return content.decode().encode(rng.choice(("utf-16", "utf-32", "utf-16-be", "utf-8-sig")))
    elif kind == 12:
        return rng.choice((b"", b"\0" * 5000, b"\xff\xfe", b"\n" * 999, b"1\n" * 99, b",,,\n" * 99))
    elif kind == 13:
        lines[1:] = [_put(line, 1, f"{rng.gauss(0.0, 1.0):.6g}") for line in lines[1:]]
    elif kind == 14:
        lines[1:] = [_put(line, 2, str(i % 2)) for i, line in enumerate(lines[1:])]
    else:
        lines = lines[:row] + [HEADER.replace("force", "load")] + lines[row:]
    return "\n".join(lines).encode("utf-8", "replace")


def _odd(content: bytes, rng: random.Random) -> bytes:
    """Return a record that is well written, of something that no test should be."""
    rows = np.array([line.split(",") for line in content.decode().splitlines()[1:]], dtype=float)
    time, x, force = rows.T.copy()
    kind = rng.randrange(10)
    noise = np.random.default_rng(rng.randrange(2**32)).standard_normal(time.size)
    if kind == 0:
        x = np.round(x / 4.0) * 4.0  # the sensor's steps are as large as the motion
    elif kind == 1:
        x = x + 10.0 ** rng.choice((3, 6, 9))
    elif kind == 2:
        force = force + 10.0 ** rng.choice((3, 6, 9))
    elif kind == 3:
        x = np.where(time < 2.0, 0.0, x[-1])  # one step
    elif kind == 4:
        force = noise
    elif kind == 5:
        x = np.cumsum(noise)
    elif kind == 6:
        x = np.clip(x, -rng.random(), rng.random())
    elif kind == 7:
        x, force = x * 10.0 ** rng.randrange(-9, 9), force * 10.0 ** rng.randrange(-9, 9)
    elif kind == 8:
        time = np.cumsum(0.01 * np.exp(rng.choice((0.5, 2.0)) * noise))
    else:
        force = np.where(np.arange(time.size) == 200, 1.0, 0.0)  # one sample
    lines = [f"{t:.9g},{a:.9g},{f:.9g}" for t, a, f in zip(time, x, force, strict=True)]
    return (HEADER + "\n" + "\n".join(lines) + "\n").encode()


def _put(line: str, column: int, value: str) -> str:
    fields = line.split(",")
    fields[column] = value
    return ",".join(fields)


def _scaled(line: str, column: int, power: int) -> str:
    return _put(line, column, f"{line.split(',')[column]}e{power}")
