"""Fixtures of all tests."""

import pytest

from tests.undrawn import blank_pictures


@pytest.fixture
def undrawn():
    """Leave the pictures of pages blank: see `tests.undrawn`."""
    with blank_pictures():
        yield
