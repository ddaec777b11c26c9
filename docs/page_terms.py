"""The pages of terms: formula, parameters and the loop of each, from ``models/terms``."""

from __future__ import annotations

import inspect
import re
from io import StringIO

import numpy as np
from matplotlib.figure import Figure

from discover.plots.style import MODEL, house_style
from discover.words import term_name
from models.checks import Array
from models.motion import Motion, sine_motion
from models.terms import TERMS, Shape, Term

AMPLITUDE, FREQUENCY = 0.01, 1.0  # of the sine test that loops are drawn for, m and Hz
_ACTS = {
    "force": "a force that adds",
    "input": "a change of the motion before the device sees it",
    "output": "a change of the force on its way to the record",
}
_FOLLOWS = {
    "motion": "the motion at the moment",
    "path": "the path of the motion",
    "time": "the time since the record began",
}
_DEVICE = "100 kg, 1000 N s/m and 50 N of friction"
_SIZE = 0.3  # of the device's force, that an effect is drawn at


def terms_pages() -> dict[str, str]:
    """Return the overview and the pictures that it shows, by file."""
    listed = [
        "# Terms and effects",
        "",
        "One vocabulary serves as terms of a model and as effects that a model may lack. A term"
        " adds a force, its coefficient times a column; others change the motion or the force."
        " Every name is written from `models/terms`, one file each, as is its picture: a sine test"
        f" of {1e3 * AMPLITUDE:g} mm at {FREQUENCY:g} Hz. Of a term that adds a force the picture"
        f" is that force over its peak; of others it is a device ({_DEVICE}) without (grey) and"
        " with it (red), at a size that shows.",
        "",
        "Bounds of a parameter are in its own unit, or in shares of the campaign's greatest"
        " displacement, speed or force where they are told as such.",
        "",
    ]
    files = {}
    for term in (TERMS[i] for i in sorted(TERMS)):
        listed += _section(term)
        files[f"loops/{term.id}.svg"] = _picture(term)
    return {"terms.md": "\n".join(listed), **files}


def _section(term: Term) -> list[str]:
    told = [f"**{term_name(term.id)}**: {_plain(term.summary)}."]
    told.append(f"Unit of the coefficient: `{term.unit or 'none'}`.")
    sign = " It can't be negative." if term.nonnegative else ""
    told.append(f"It is {_ACTS[term.acts]}.{sign}")
    if term.column is not None:
        follows = term.remembers(_shape(term))
        told.append(f"It follows {_FOLLOWS[follows]}.")
    if term.needs:
        told.append(f"It means something only beside {_listed(term.needs, ' or ')}.")
    if term.mistaken_for:
        told.append(f"Tests of little variety can't tell it from {_listed(term.mistaken_for)}.")
    lines = [f"({term.id})=", f"## {term.id}", "", " ".join(told), ""]
    described = inspect.getdoc(term.column or term.transform)
    if described:
        described = re.sub(r"^Return ", "It gives ", described)
        lines += [_paragraphs(described), ""]
    if term.parameters:
        names = ("parameter", "from", "to", "default", "unit", "fitted")
        lines += [f"| {' | '.join(names)} |", "|---" * len(names) + "|"]
        for p in term.parameters:
            scaled = f" of the {p.scaled_by}" if p.scaled_by else ""
            lines.append(
                f"| `{p.name}` | {p.lower:g}{scaled} | {p.upper:g}{scaled} | {p.default:g} |"
                f" {p.unit or '–'} | {'yes' if p.fitted else 'chosen'} |"
            )
        lines.append("")
    picture = f"![Force of {term.id} over displacement and over speed](loops/{term.id}.svg)"
    return [*lines, picture, ""]


def _paragraphs(text: str) -> str:
    """Return a docstring's paragraphs as Markdown; names between backticks stay code."""
    parts = " ".join(text.replace("\n\n", "\0").split("\n")).replace("\0", "\n\n").split("`")
    return "`".join(p if i % 2 else p.replace("*", "\\*").replace("<", "\\<")
                    for i, p in enumerate(parts))  # fmt: skip


def _plain(text: str) -> str:
    return text.replace("*", "\\*").replace("|", "\\|").rstrip(".")


def _listed(ids: tuple[str, ...], joint: str = ", ") -> str:
    return joint.join(f"[{i}](#{i})" if i in TERMS else i for i in ids)


def _device(motion: Motion) -> Array:
    v = motion.velocity
    return np.asarray(100.0 * motion.acceleration + 1000.0 * v + 50.0 * np.tanh(v / 0.002))


def _shape(term: Term) -> Shape:
    """Return the shape that is drawn: parameters at their defaults, scaled by the test's sizes."""
    motion = sine_motion(AMPLITUDE, FREQUENCY)
    peaks = {
        "displacement": AMPLITUDE, "speed": float(np.abs(motion.velocity).max()),
        "force": float(np.abs(_device(motion)).max()),
    }  # fmt: skip
    given = {
        p.name: p.default * peaks[p.scaled_by]
        for p in term.parameters if p.scaled_by and p.default
    }
    return term.shape(given)


def _picture(term: Term) -> str:
    """Return the term's loops as SVG."""
    motion = sine_motion(AMPLITUDE, FREQUENCY, samples=1024)
    shape = _shape(term)
    cycles = motion
    if term.remembers(shape) != "motion" or term.column is None:
        cycles = sine_motion(AMPLITUDE, FREQUENCY, samples=1024, cycles=3)
    last = slice(-1024, None)
    x, v = 1e3 * cycles.displacement[last], 1e3 * cycles.velocity[last]
    if term.column is not None:
        force = term.column(cycles, shape)[last]
        curves = [(force / (np.abs(force).max() or 1.0), MODEL)]
        label = "Force over its peak"
    else:
        curves = [(_device(cycles)[last], "#aab4c0"), (_changed(term, cycles, shape)[last], MODEL)]
        label = "Force (N)"
    with house_style():
        figure = Figure(figsize=(6.6, 2.7), dpi=96, layout="constrained")
        over_path, over_speed = figure.subplots(1, 2, sharey=True)
        for force, colour in curves:
            over_path.plot(np.append(x, x[0]), np.append(force, force[0]), color=colour)
            over_speed.plot(np.append(v, v[0]), np.append(force, force[0]), color=colour)
        over_path.set(xlabel="Displacement (mm)", ylabel=label)
        over_speed.set(xlabel="Speed (mm/s)")
        stream = StringIO()
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None})
    return stream.getvalue()


def _changed(term: Term, motion: Motion, shape: Shape) -> Array:
    """Return the device's force with an effect that changes it, at a size that shows."""
    transform = term.transform
    if transform is None:
        raise ValueError(f"{term.id} changes neither motion nor force")
    plain = _device(motion)
    aim = _SIZE * float(np.linalg.norm(plain))
    most = min(1e3, term.coefficient_bounds(shape)[1])
    best = plain
    for coefficient in np.geomspace(1e-9, most, 200):
        changed = transform(_device, motion, float(coefficient), shape)
        if not np.linalg.norm(changed - plain) <= aim:
            break
        best = changed
    return best
