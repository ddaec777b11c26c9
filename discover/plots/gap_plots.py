"""The pictures of a gap search by name, as its `plot` offers them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.figure_data import GapFigureData
from discover.plots.gap import (
    contest,
    effect_shape,
    gap_by_record,
    gap_by_round,
    misfit_surface,
)
from discover.plots.picture import Picture, picture
from discover.plots.record_plots import RecordPlots


class GapPlots(RecordPlots):
    """What ``gap.plot`` offers: every method returns a `Picture`.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    data : GapFigureData
        What the pictures need besides.
    """

    _answer = "a gap"

    def __init__(self, document: Mapping[str, Any], data: GapFigureData) -> None:
        super().__init__(data.records)
        self._document = document
        self._data = data

    def records(self) -> Picture:
        """Return every record's gap before and after, beside its noise."""
        return picture("records", gap_by_record(self._document["records"]))

    def rounds(self) -> Picture:
        """Return the gap from round to round."""
        return picture("rounds", gap_by_round(self._document))

    def contests(self) -> Picture:
        """Return each round's candidates with their probabilities."""
        rounds = enumerate(self._document["rounds"], start=1)
        return picture("contests", *(contest(r, name=f"contest-{i}") for i, r in rounds))

    def shapes(self) -> Picture:
        """Return the force that each added effect has, over what it follows."""
        drawn = [effect_shape(s, name=f"shape-{s.round + 1}") for s in self._data.shapes]
        return picture("shapes", *drawn)

    def surface(self) -> Picture:
        """Return the baseline's misfit over displacement and velocity."""
        return picture("surface", misfit_surface(self._data))
