"""A comparison in lines for the terminal and as a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from discover.plots.comparison import side_by_side
from discover.plots.model_errors import model_errors
from discover.report.environment import render
from discover.report.files import page_files, table_csv
from discover.report.records import only_drawn, picture
from discover.words import (
    COORDINATES,
    capitalize_first,
    interval,
    listed,
    named_line,
    percent,
    short_name,
    significant,
)

_MOST = 6  # quantities that a line names


def comparison_lines(document: Mapping[str, Any]) -> list[str]:
    """Return the comparison in a few sentences.

    Parameters
    ----------
    document : mapping
        As in ``comparison.json``.
    """
    lines = [f"{side['name']}: {structures(side)}." for side in document["sides"]]
    same = "the same everywhere" if document["same_structures"] else "not the same"
    lines.append(f"Structures: {same}.")
    quantities = document["quantities"]
    comparable = any(q["differs"] is not None for q in quantities)
    for differs, name in ((True, "Differ"), (False, "Agree")) if comparable else ():
        some = [_value_line(q) for q in quantities if q["differs"] is differs]
        more = [f"{len(some) - _MOST} more"] if len(some) > _MOST else []
        lines.append(f"{name}: " + ("; ".join([*some[:_MOST], *more]) or "nothing") + ".")
    unknown: dict[tuple[bool, str], list[str]] = {}
    for q in quantities:
        if q["differs"] is None:
            alone = sum(v is not None for v in q["values"]) < 2
            unknown.setdefault((alone, q["why"]), []).append(quantity_name(q))
    for (alone, why), names in sorted(unknown.items(), key=lambda item: not item[0][0]):
        shown = list(dict.fromkeys(names))
        more = [f"{len(shown) - _MOST} more"] if len(shown) > _MOST else []
        told = "; ".join([*shown[:_MOST], *more])
        lines.append(
            f"{capitalize_first(why)}: {told}." if alone else f"Can't be told: {told} ({why})."
        )
    for entry in document["errors"]:
        ranked = sorted(entry["models"], key=lambda m: int(m["rank"]))
        misses = listed(f"{m['name']} {percent(_ranked_error(m))}" for m in ranked)
        lines.append(
            f"Errors: of the force on {entry['ranked_on']} of “{entry['campaign']['title']}”,"
            f" {misses}; noise {percent(entry['noise_percent'])}."
        )
    lines += [f"Note: {f['text']}" for f in document["findings"]]
    return lines


def structures(side: Mapping[str, Any]) -> str:
    """Return an answer's structures with their bands."""
    names = [b["structure"] for b in side["bands"]]
    if len(names) == 1:
        return str(names[0])
    ends = [b["upper"] for b in side["bands"][:-1]]
    parts = [f"{n} below {significant(e, 3)}" for n, e in zip(names, ends, strict=False)]
    return ", ".join([*parts, f"{names[-1]} above"]) + f" ({COORDINATES[side['coordinate']]})"


def quantity_name(quantity: Mapping[str, Any]) -> str:
    """Return a quantity in words, with its band where there are several."""
    term = short_name(quantity["term"])
    what = quantity["quantity"].replace("_", " ").replace("stribeck", "Stribeck")
    name = term if what == "coefficient" else f"{what} of {term}"
    return name if quantity["band"] == "everywhere" else f"{name} ({quantity['band']})"


def _value_line(quantity: Mapping[str, Any]) -> str:
    values = [value_text(v) for v in quantity["values"] if v is not None]
    return f"{quantity_name(quantity)}: {listed(values)}"


def value_text(value: Mapping[str, Any] | None) -> str:
    """Return a value with unit and interval; a dash for none."""
    if value is None:
        return "–"
    text = significant(value["value"], 4)
    if value["unit"] and value["unit"] != "1":
        text += f" {value['unit']}"
    if value["interval"] is not None:
        text += f" ({interval(value['interval'], 4)})"
    return text


def _ranked_error(model: Mapping[str, Any]) -> float | None:
    held_out: float | None = model["held_out_relative_error_percent"]
    return model["relative_error_percent"] if held_out is None else held_out


def comparison_files(
    document: Mapping[str, Any], *, command: str, formats: Sequence[str] = ()
) -> dict[str, str | bytes]:
    """Return page, pictures and table of a comparison by file name.

    Parameters
    ----------
    document : mapping
        As in ``comparison.json``.
    command : str
        What a person types to repeat it.
    formats : sequence of str
        Of the pictures, beside SVG.
    """
    quantities = document["quantities"]
    names = [side["name"] for side in document["sides"]]
    labels = [quantity_name(q) for q in quantities]
    drawn = {"side-by-side": side_by_side(quantities, names, labels=labels)}
    for number, entry in enumerate(document["errors"], start=1):
        # In the order given, so that an answer has one colour in all pictures.
        drawn[f"errors-{number}"] = model_errors(entry["models"], name=f"errors-{number}")
    figures = only_drawn(drawn)
    page = render(
        "comparison.html",
        command=command,
        document_name="comparison.json",
        document=document,
        verdict=[named_line(line) for line in comparison_lines(document)],
        sides=[{"side": s, "structures": structures(s)} for s in document["sides"]],
        rows=[
            {"name": label, "values": q["values"], "differs": q["differs"], "why": q["why"]}
            for label, q in zip(labels, quantities, strict=True)
        ],
        side_by_side=picture(figures, "side-by-side"),
        errors=[
            {"entry": e, "svg": picture(figures, f"errors-{i}")}
            for i, e in enumerate(document["errors"], start=1)
        ],
    )
    return {**page_files(page, figures, formats), "coefficients.csv": _csv(quantities, names)}


def _csv(quantities: Sequence[Mapping[str, Any]], names: Sequence[str]) -> str:
    rows = [
        {
            "answer": name, "band": q["band"], "term": q["term"], "quantity": q["quantity"],
            "value": v["value"], "lower": (v["interval"] or (None, None))[0],
            "upper": (v["interval"] or (None, None))[1], "unit": v["unit"],
            "differs": q["differs"], "p": q["p"],
        }
        for q in quantities
        for name, v in zip(names, q["values"], strict=True)
        if v is not None
    ]  # fmt: skip
    return table_csv(rows, ("answer", "band", "term", "quantity", "value"))
