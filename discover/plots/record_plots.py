"""The pictures that every answer about records offers, whatever was asked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from discover.figure_data import ShownRecord
from discover.plots.loops import record_curves
from discover.plots.picture import Picture, picture
from discover.plots.representative import representative
from models.checks import one_of


class RecordPlots:
    """Pictures of records, each by a method's name.

    Parameters
    ----------
    records : sequence of ShownRecord
        In the campaign's order.
    """

    _answer: ClassVar[str]
    """What the pictures are of, as a sentence says it: "a study"."""

    def __init__(self, records: Sequence[ShownRecord]) -> None:
        self._records = records

    def __repr__(self) -> str:
        """Return the names of the pictures, the answer's own first."""
        methods = [*vars(type(self)), *vars(RecordPlots)]
        names = ", ".join(f"{name}()" for name in methods if not name.startswith("_"))
        return f"<Pictures of {self._answer}: {names}>"

    def loops(self, *files: str) -> Picture:
        """Return force over time, displacement and velocity: measured, and by each model.

        Parameters
        ----------
        *files : str
            Names of records; a few that show the most where none is given.
        """
        known = {r.file: r for r in self._records}
        chosen: Sequence[ShownRecord] = representative(self._records)
        if files:
            chosen = [known[one_of("record", f, sorted(known))] for f in files]
        drawn = [record_curves(r, name=f"loops-{i}") for i, r in enumerate(chosen, start=1)]
        return picture("loops", *drawn)
