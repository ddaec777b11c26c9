"""The template engine: autoescaped, everything undefined is an error, filters for numbers."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import jinja2
from markupsafe import Markup, escape

from discover import words
from discover.friction_parts import whole_friction
from discover.report.equation import equation, symbols
from discover.shape_words import shape
from discover.study.verdict import not_ruled_out


def unit(text: str) -> Markup:
    r"""Return a unit with raised exponents, as HTML; nothing for a plain number's, "1".

    Examples
    --------
    >>> str(unit("N s^1.89/m"))
    'N\xa0s<sup>1.89</sup>/m'
    >>> str(unit("1"))
    ''
    """
    if text == "1":
        return Markup("")
    plain = str(escape(text)).replace("*", "·").replace(" ", "\u00a0")
    return Markup(re.sub(r"\^([-\d.]+)", r"<sup>\1</sup>", plain))


def readable(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return a term's coefficient, unit and interval, small lengths and times in parts.

    Examples
    --------
    >>> readable({"coefficient": 8e-4, "unit": "s", "interval": [7e-4, None]})
    {'coefficient': 0.8, 'unit': 'ms', 'interval': [0.7, None]}
    """
    name, factor = words.in_parts(entry["coefficient"], str(entry["unit"]))
    scaled = [None if v is None else factor * v
              for v in (entry["coefficient"], *(entry.get("interval") or ()))]  # fmt: skip
    return {"coefficient": scaled[0], "unit": name, "interval": scaled[1:] or None}


def prose(text: str) -> Markup:
    """Return a sentence as HTML: code between backticks, raised powers, minus signs, percents kept.

    Examples
    --------
    >>> str(prose("run `inerter gap <x>`"))
    'run <code>inerter gap &lt;x&gt;</code>'
    >>> str(prose("5 % of it grows as frequency^(0.4 ± 0.1)")).replace(words.THIN_SPACE, "_")
    '5_% of it grows as frequency<sup>0.4 ± 0.1</sup>'
    >>> str(prose("D^0.6 x and N s^2/m^2"))
    'D<sup>0.6</sup> x and N s<sup>2</sup>/m<sup>2</sup>'
    >>> str(prose("k from -1.5 to -0.9, by `--column force=-1`"))
    'k from −1.5 to −0.9, by <code>--column force=-1</code>'
    >>> str(prose("FOIM > 99 %")).replace(words.THIN_SPACE, "_").replace("\u00a0", "_")
    'FOIM &gt;_99_%'
    """
    plain = str(escape(text)).replace(" %", f"{words.THIN_SPACE}%")
    # Every other part stands between backticks.
    parts = plain.split("`") if plain.count("`") % 2 == 0 else [plain]
    told = [f"<code>{p}</code>" if i % 2 else _typeset(p) for i, p in enumerate(parts)]
    return Markup("".join(told))


def _typeset(text: str) -> str:
    """Return escaped text with minus signs and raised powers; "> 99" stays on one line."""
    signed = re.sub(r"(?<![\w.)^-])-(?=\d)", "−", text)
    raised = re.sub(r"\^(?:\(([^()]+)\)|(-?\d+(?:\.\d+)?|\w)\b)", r"<sup>\1\2</sup>", signed)
    return re.sub(r"(&[lg]t;) (?=\d)", "\\1\u00a0", raised)


def grouped(findings: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return findings, errors first, with those that say the same of several records made one.

    Examples
    --------
    >>> said = {"level": "note", "text": "has gaps"}
    >>> grouped([{**said, "record": "a.csv"}, {**said, "record": "b.csv"}])
    [{'level': 'note', 'text': 'has gaps', 'records': ['a.csv', 'b.csv']}]
    >>> [f["level"] for f in grouped([said, {"level": "error", "text": "has no force"}])]
    ['error', 'note']
    """
    found: dict[tuple[str, str], list[str]] = {}
    for f in findings:
        records = found.setdefault((str(f["level"]), str(f["text"])), [])
        records += [str(f["record"])] if f.get("record") else []
    kept = [{"level": k[0], "text": k[1], "records": records} for k, records in found.items()]
    return sorted(kept, key=lambda f: _LEVELS.index(f["level"]))


_LEVELS = ("error", "warning", "note")


# Kept: the templates that ship with the package do not change.
@cache
def environment() -> jinja2.Environment:
    """Return the engine for the templates that ship with the package."""
    engine = jinja2.Environment(
        loader=jinja2.PackageLoader("discover.report", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    engine.filters.update(
        term_name=words.term_name,
        short_name=words.short_name,
        significant=words.significant,
        percent=words.percent,
        quantity=words.quantity,
        probability=words.probability,
        interval=words.interval,
        readable=readable,
        kind_name=words.kind_name,
        zero_possible=words.zero_possible,
        counted=words.counted,
        band_range=words.band_range,
        not_ruled_out=not_ruled_out,
        equation=equation,
        symbols=symbols,
        whole_friction=whole_friction,
        capitalize_first=words.capitalize_first,
        prose=prose,
        grouped=grouped,
        spread=words.spread,
        unit=unit,
        shape=shape,
    )
    return engine


def render(template: str, *, command: str, document_name: str, **values: Any) -> str:
    """Return the page of `template`, style sheet and script inlined.

    Parameters
    ----------
    template : str
        File name among the templates.
    command : str
        What a person types to repeat the result.
    document_name : str
        The document that lies beside the page.
    **values
        What the template shows; ``document`` is always among it.
    """
    engine = environment()
    loader = engine.loader
    if loader is None:
        raise jinja2.TemplateNotFound(template)
    sheet = Markup(loader.get_source(engine, "style.css")[0])
    script = loader.get_source(engine, "figures.js")[0]
    # The page lets this script run and no other.
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return engine.get_template(template).render(
        command=command,
        document_name=document_name,
        stylesheet=sheet,
        script=Markup(script),
        script_hash=Markup(f"sha256-{digest}"),
        **values,
    )
