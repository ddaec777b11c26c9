"""Bands whose number is asked for: what is stated of them is what the search found."""

from pathlib import Path

from discover import read_campaign
from discover.study import StudyOptions, run_study

RIG = Path(__file__).parents[3] / "data" / "device-12-rig"


def test_records_lie_in_the_bands_that_were_fitted_to_them():
    """Two bands of one law each, on a device that neither describes."""
    options = StudyOptions(terms=("fractional-derivative", "coulomb-friction"), bands=2)
    found = run_study(read_campaign(RIG), options)
    (boundary,) = found.boundaries
    low, high = boundary.bracket
    assert low <= boundary.coordinate <= high
    assert all(band.relative_error_percent < 100.0 for band in found.bands)
