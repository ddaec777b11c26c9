"""Bands along a coordinate: how many, where they end, and what holds in each."""
