"""A gradual change between two models is found with its width; a sharp one stays sharp."""

import numpy as np
import pytest

from discover.study import run_study
from tests.discover.exact import DEVICE_12, campaign, fractional

LOWER = fractional(370.38 * 19.25, 0.48, 400.0)
UPPER = fractional(370.38 * 1.57, 1.89, 400.0)
AREA = np.pi * (0.028**2 - 0.012**2)
DEAN_PER_SPEED = 2.0 * 800.0 * 0.01 * AREA / (0.027 * np.pi * 0.005**2) * np.sqrt(0.1)


def mixed(width):
    def force(amplitude, omega, theta):
        distance = np.log(DEAN_PER_SPEED * amplitude * omega / 100.0)
        share = 1.0 / (1.0 + np.exp(-distance * 2.0 * np.log(9.0) / width))
        return (1.0 - share) * LOWER(amplitude, omega, theta) + share * UPPER(
            amplitude, omega, theta
        )

    return force


@pytest.mark.parametrize("width", [0.5, 1.5])
def test_the_width_of_a_gradual_change_is_found(width):
    study = run_study(campaign(mixed(width)))
    (boundary,) = study.boundaries
    assert boundary.width == pytest.approx(width, rel=0.25)
    assert boundary.dean_interval[0] < 100.0 < boundary.dean_interval[1]
    assert any("gradual" in f.text for f in study.findings)


def test_a_sharp_change_has_no_width():
    def sharp(amplitude, omega, theta):
        law = LOWER if DEAN_PER_SPEED * amplitude * omega < 100.0 else UPPER
        return law(amplitude, omega, theta)

    (boundary,) = run_study(campaign(sharp, DEVICE_12)).boundaries
    assert boundary.width is None
