"""``campaign.toml`` as text, with why beside what was guessed."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from discover.readers.entries import Entry
from discover.readers.guess import TableGuess
from models.checks import printable


def campaign_text(
    *,
    title: str,
    device: str,
    columns: Mapping[str, str],
    units: Mapping[str, str],
    guessed: Sequence[str],
    tests: Sequence[tuple[Entry, TableGuess]],
    left_out: Sequence[tuple[str, str]],
) -> str:
    """Return a ``campaign.toml``.

    Parameters
    ----------
    title, device : str
        Of the campaign; a preset, "" for none.
    columns, units : mapping
        ``[columns]`` and ``[units]``.
    guessed : sequence of str
        Those of ``[units]`` that nobody stated.
    tests : sequence of (Entry, TableGuess)
        Its records, and what their columns are taken for.
    left_out : sequence of (str, str)
        Files that are no record, with why.
    """
    lines = [f"title = {quoted(title)}", ""]
    if device:
        lines += ["[device]", f"preset = {quoted(device)}", ""]
    if columns:
        lines.append("[columns]")
        for quantity, header in columns.items():
            own = next(g.columns[quantity] for _, g in tests if quantity in g.columns)
            lines.append(f"{quantity} = {quoted(header)}  # {own.sure}: {printable(own.why)}")
        lines.append("")
    if units:
        lines.append("[units]")
        for quantity, unit in units.items():
            by = [g.columns[quantity].unit_by for _, g in tests if quantity in g.columns]
            why = "guessed" if quantity in guessed else next(filter(None, by), "")
            lines.append(f"{quantity} = {quoted(unit)}" + (f"  # {why}" if why else ""))
        if guessed:
            listed = ", ".join(quoted(quantity) for quantity in guessed)
            lines.append(f"guessed = [{listed}]  # no file states them: take out what you know")
        lines.append("")
    for entry, _ in tests:
        lines += [*_entry_lines(entry), ""]
    lines += [f"# left out: {printable(file)}: {printable(why)}" for file, why in left_out]
    return "\n".join(lines).rstrip("\n") + "\n"


def _entry_lines(entry: Entry) -> list[str]:
    files = [quoted(file) for file in entry.files]
    listed = f"[{', '.join(files)}]" if entry.beside else files[0]
    lines = ["[[records]]", f"file = {listed}"]
    if entry.part is not None:
        lines.append(f"{entry.key} = {quoted(str(entry.part))}")
    if entry.span_text:
        lines.append(f"range = {quoted(entry.span_text)}")
    for key, own in (("channel", entry.channel), ("units", entry.units)):
        if own:
            inside = ", ".join(f"{q} = {quoted(text)}" for q, text in own.items())
            lines.append(f"{key} = {{ {inside} }}")
    if entry.step is not None:
        lines.append(f'sampling_rate = "{1.0 / entry.step:.12g} Hz"')
    if entry.held_out:
        lines.append("held_out = true")
    return lines


def quoted(text: str) -> str:
    r"""Return a TOML basic string; JSON's escapes are among TOML's.

    Examples
    --------
    >>> quoted('a "b"')
    '"a \\"b\\""'
    """
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
