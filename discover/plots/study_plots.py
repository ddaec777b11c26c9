"""The pictures of a study by name, as its `plot` offers them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from discover.figure_data import ShownRecord, StudyFigureData
from discover.plots.errors import error_by_record
from discover.plots.loops import record_curves
from discover.plots.picture import Picture, picture
from discover.plots.probabilities import probability_bars
from discover.plots.record_map import record_map
from discover.plots.representative import representative
from models.checks import one_of


class StudyPlots:
    """What ``study.plot`` offers: every method returns a `Picture`.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    data : StudyFigureData
        What the pictures need besides.
    """

    def __init__(self, document: Mapping[str, Any], data: StudyFigureData) -> None:
        self._document = document
        self._data = data

    def __repr__(self) -> str:
        """Return the names of the pictures."""
        names = [f"{n}()" for n in vars(StudyPlots) if not n.startswith("_")]
        return f"<Pictures of a study: {', '.join(names)}>"

    def map(self) -> Picture:
        """Return the plan of sine tests, by structure, with the boundary."""
        return picture("map", record_map(self._document, self._data))

    def probabilities(self) -> Picture:
        """Return how probable each structure is, a bar a band."""
        return picture("probabilities", probability_bars(self._document, self._data))

    def errors(self) -> Picture:
        """Return every record's error beside its noise."""
        return picture("errors", *error_by_record(self._data))

    def loops(self, *files: str) -> Picture:
        """Return force over time, displacement and velocity, measured and by the model.

        Parameters
        ----------
        *files : str
            Names of records; a few that show the most where none is given.
        """
        known = {r.file: r for r in self._data.records}
        chosen: Sequence[ShownRecord] = representative(self._data.records)
        if files:
            chosen = [known[one_of("record", f, sorted(known))] for f in files]
        drawn = [record_curves(r, name=f"loops-{i}") for i, r in enumerate(chosen, start=1)]
        return picture("loops", *drawn)
