"""Curves of records for pictures: decimated stretches, spectra, stiffness, what a model leaves."""

from discover.record_curves.response import response
from discover.record_curves.shown_samples import shown_samples
from discover.record_curves.view import RecordView, record_view

__all__ = ["RecordView", "record_view", "response", "shown_samples"]
