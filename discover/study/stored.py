"""A study in a file: written by `Study.save`, read by `load_study`."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from discover.dean import DeanCheck
from discover.figure_data import StudyFigureData
from discover.next_test import NextTest
from discover.records import Finding
from discover.rows import Unexplained
from discover.study.result import (
    Extra,
    FrictionCurve,
    Interval,
    Nuisance,
    Study,
    StudyBand,
    StudyBoundary,
    TermEstimate,
)
from models.checks import InputError
from models.constitutive import FittedTerm, SegmentedModel

_SCHEMA = "inerter.study/1"
_WRITTEN = "a study as `inerter discover` or Study.save writes it"


def load_study(path: str | Path) -> Study:
    """Return a study from its file.

    Parameters
    ----------
    path : str or Path
        A ``study.json``, of `Study.save` or of ``inerter discover`` with its ``model.json`` beside
        it; or the folder that holds it.

    Returns
    -------
    Study
        All but its pictures, which need the records.

    Raises
    ------
    InputError
        Where there is no such file, or it holds no study.

    Examples
    --------
    >>> load_study("no-such-folder/study.json")
    Traceback (most recent call last):
    models.checks.InputError: no-such-folder/study.json: file must be readable, got No such file...
    """
    file = Path(path)
    file = file / "study.json" if file.is_dir() else file
    document = _table(file)
    if document.get("schema") != _SCHEMA:
        found = repr(document.get("schema"))
        raise InputError("schema", expected=repr(_SCHEMA), found=found, where=str(file))
    model = document.get("model") or _table(file.with_name("model.json"))
    try:
        return _study(document, SegmentedModel.from_dict(model, where=str(file)))
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            "a key of the study", expected=_WRITTEN, found=repr(error), where=str(file)
        ) from None


def _table(file: Path) -> dict[str, Any]:
    try:
        table = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError("file", expected="readable", found=error.strerror or "not", where=str(file)
                         ) from None
    except ValueError as error:
        raise InputError("not valid JSON", found=str(error), where=str(file)) from None
    if not isinstance(table, dict):
        raise InputError(
            "document", expected=_WRITTEN, found=type(table).__name__, where=str(file)
        )
    return table


def _drawn() -> StudyFigureData:
    raise InputError(
        "pictures", expected="drawn from the records (run the study again)",
        found="a study from a file",
    )


def _study(d: Mapping[str, Any], model: SegmentedModel) -> Study:
    test = d["next_test"]
    return Study(
        title=d["campaign"]["title"],
        content_hash=d["campaign"]["hash"],
        seed=d["seed"],
        coordinate=d["coordinate"],
        relative_error_percent=d["relative_error_percent"],
        held_out_relative_error_percent=d.get("held_out_relative_error_percent"),
        held_out_with_own_values_percent=d.get("held_out_with_own_values_percent"),
        identifiable=d["identifiable"],
        findings=tuple(
            Finding(f["level"], f["text"], f.get("record"), f.get("about")) for f in d["findings"]
        ),
        bands=tuple(_band(b) for b in d["bands"]),
        nuisance=tuple(
            Nuisance(n["id"], n["value"], _pair(n["interval"]), n["unit"]) for n in d["nuisance"]
        ),
        boundaries=tuple(_boundary(b) for b in d["boundaries"]),
        dean_check=_dean(d["dean_check"]),
        next_test=None if test is None else NextTest(
            test["frequency_hz"], test["amplitude_m"], _names(test["separates"]), test["gain"]
        ),
        model=model,
        draw=_drawn,
    )


def _pair(ends: Any) -> Interval:
    low, high = ends
    return (float(low), float(high))


def _pair_or_none(ends: Any) -> Interval | None:
    return None if ends is None else _pair(ends)


def _names(names: Any) -> tuple[str, str]:
    first, second = names
    return (str(first), str(second))


def _term(d: Mapping[str, Any]) -> TermEstimate:
    fitted = FittedTerm.from_dict(d)
    shapes = {n: _pair(d[f"{n}_interval"]) for n in fitted.shape if f"{n}_interval" in d}
    return TermEstimate(fitted, d["std_error"], _pair(d["interval"]), shapes)


def _band(d: Mapping[str, Any]) -> StudyBand:
    left = d["remainder_percent"]
    return StudyBand(
        lower=d["lower"],
        upper=d["upper"],
        lower_hz=d["lower_hz"],
        upper_hz=d["upper_hz"],
        records=tuple(d["records"]),
        family=d["family"],
        structure=d["structure"],
        terms=tuple(_term(t) for t in d["terms"]),
        error_percent=d["error_percent"],
        relative_error_percent=d["relative_error_percent"],
        noise_percent=d["noise_percent"],
        probability=d["probability"],
        equivalents=tuple((e["structure"], e["probability"]) for e in d["equivalents"]),
        extras=tuple(
            Extra(
                _term(e), e["probability"],
                tuple((a["effect"], a["probability"]) for a in e["alternatives"]),
            )
            for e in d["extras"]
        ),
        remainder=Unexplained(left["value"], _pair(left["interval"])),
        friction=None if d["friction"] is None else _friction(d["friction"]),
    )


def _friction(d: Mapping[str, Any]) -> FrictionCurve:
    keys = [k for k in ("presliding_displacement", "transition_speed") if k in d]
    key = keys[0] if keys else ""
    return FrictionCurve(
        d["curve"],
        key,
        d[key] if key else 0.0,
        _pair(d[f"{key}_interval"]) if key else (0.0, 0.0),
        d["probability"],
        d["differs_by_record"],
    )


def _boundary(d: Mapping[str, Any]) -> StudyBoundary:
    return StudyBoundary(
        coordinate=d["coordinate"],
        bracket=_pair(d["bracket"]),
        interval=_pair(d["interval"]),
        speed=d["speed"],
        frequency_hz=d["frequency_hz"],
        dean=d.get("dean"),
        dean_interval=_pair_or_none(d.get("dean_interval")),
        width=d.get("width"),
    )


def _dean(d: Mapping[str, Any]) -> DeanCheck:
    return DeanCheck(
        convention=d["convention"],
        criterion=d["criterion"],
        verdict=d["verdict"],
        boundary_dean=d["boundary_dean"],
        interval=_pair_or_none(d["interval"]),
        boundary_dean_paper=d["boundary_dean_paper"],
        boundary_dean_standard=d["boundary_dean_standard"],
        amplitude_exponent=d["amplitude_exponent"],
        amplitude_exponent_interval=_pair_or_none(d["amplitude_exponent_interval"]),
        reason=d["reason"],
    )
