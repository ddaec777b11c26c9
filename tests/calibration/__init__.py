"""Calibration of the study: how often what it states is right, on devices that it has not seen."""
