"""Naming a missing effect: the contest of a catalogue of effects beside a model."""
