"""The pictures of a study by name, as its `plot` offers them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.figure_data import StudyFigureData
from discover.plots.errors import error_by_record
from discover.plots.picture import Picture, picture
from discover.plots.probabilities import probability_bars
from discover.plots.record_map import record_map
from discover.plots.record_plots import RecordPlots


class StudyPlots(RecordPlots):
    """What ``study.plot`` offers: every method returns a `Picture`.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    data : StudyFigureData
        What the pictures need besides.
    """

    _answer = "a study"

    def __init__(self, document: Mapping[str, Any], data: StudyFigureData) -> None:
        super().__init__(data.records)
        self._document = document
        self._data = data

    def map(self) -> Picture:
        """Return the plan of sine tests, by structure, with the boundary."""
        return picture("map", record_map(self._document, self._data))

    def probabilities(self) -> Picture:
        """Return how probable each structure is, a bar a band."""
        return picture("probabilities", probability_bars(self._document, self._data))

    def errors(self) -> Picture:
        """Return every record's error beside its noise."""
        return picture("errors", *error_by_record(self._data))
