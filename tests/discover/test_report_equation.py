"""A model as an equation."""

import pytest

from discover.report.equation import equation


@pytest.mark.parametrize(("identifier", "power"), [("quadratic", 2), ("cubic", 3)])
def test_a_spring_is_written_as_its_power_only_where_it_is_that(identifier, power):
    term = {"id": f"{identifier}-stiffness", "coefficient": 70.0, "unit": "N"}
    written = f"<msup><mi>x</mi><mn>{power}</mn></msup>"
    assert written in equation([term])
    closing = equation([term | {"closure": 0.1}])
    assert written not in closing
    assert f"{identifier} stiffness" in closing
