"""Terms needed together join at once; a fractional structure may have inertance besides."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import gamma

from discover.bands.extras import searched_with, with_several
from discover.bands.together import together
from discover.posterior.catalogue import term_log_prior
from discover.study import StudyOptions, run_study
from discover.study.prepare import prepare
from models.constitutive import FittedTerm
from models.terms import TERMS
from tests.discover.exact import campaign

SHAPE = 0.4  # order of the fractional force


def gas_spring(amplitude, omega, theta):
    """A mass and a damper on a gas whose pressure follows its volume."""
    x, v = amplitude * np.sin(theta), amplitude * omega * np.cos(theta)
    return -20.0 * omega**2 * x + 300.0 * v + 560.0 / (1.0 - x / 0.12) ** 1.3


def pad_under_a_mass(amplitude, omega, theta):
    """A mass on a pad of rubber, whose modulus comes from relaxation times, many a decade."""
    x = amplitude * np.sin(theta)
    rates = np.geomspace(1e-6, 1e8, 281)
    # A sum of exponentials that stands for t^-SHAPE / gamma(1 - SHAPE).
    weights = np.log(rates[1] / rates[0]) * rates**SHAPE / gamma(SHAPE) / gamma(1.0 - SHAPE)
    modulus = 1500.0 * np.sum(weights * 1j * omega / (rates + 1j * omega))
    return amplitude * np.imag(modulus * np.exp(1j * theta)) - 12.0 * omega**2 * x


def bare(law, **plan):
    device = prepare(campaign(law, **plan), StudyOptions()).device
    return searched_with(replace(device, bands=1), (), None)


def test_a_gas_spring_is_a_constant_and_powers_of_displacement_at_once():
    way = bare(
        gas_spring, frequencies=(0.2, 0.8, 2.5), amplitudes=(0.01, 0.025, 0.04), noise=0.01
    )
    terms = {t.id: t for t, _ in together(way)}
    assert {"force-offset", "stiffness", "quadratic-stiffness"} <= set(terms)
    assert terms["force-offset"].coefficient == pytest.approx(560.0, rel=0.02)
    assert terms["stiffness"].coefficient == pytest.approx(560.0 * 1.3 / 0.12, rel=0.1)
    assert "inertia" not in terms  # it makes the structure


def test_without_anything_that_may_join_nothing_does():
    device = prepare(
        campaign(gas_spring, frequencies=(0.2, 0.8), amplitudes=(0.01, 0.03), noise=0.01),
        StudyOptions(terms=("inertia", "viscous-damping")),
    ).device
    assert together(searched_with(replace(device, bands=1), (), None)) == []


def test_a_mass_on_a_fractional_pad_is_one_band_with_inertance_besides():
    records = campaign(
        pad_under_a_mass, frequencies=(0.2, 0.6, 2.0, 6.0), amplitudes=(0.002, 0.01), noise=0.01
    )
    study = run_study(records)
    (band,) = study.bands
    assert (band.structure, band.family) == ("FOIM", "mixed")
    (mass,) = band.extras
    assert mass.term.fitted.id == "inertia"
    assert mass.term.interval[0] < 12.0 < mass.term.interval[1]
    (order,) = (t.fitted.shape["order"] for t in band.terms if "order" in t.fitted.shape)
    assert order == pytest.approx(SHAPE, abs=0.005)
    assert "and inertance" not in study.summary().splitlines()[1]  # it stands beside


def test_what_has_joined_is_weighed_with_the_values_that_it_has_since():
    way = bare(
        gas_spring, frequencies=(0.2, 0.8, 2.5), amplitudes=(0.01, 0.025, 0.04), noise=0.01
    )
    before = ("quadratic-stiffness", 9e4, {"closure": 0.3, "side": 1.0})
    terms = [
        (FittedTerm(name, size, shape), term_log_prior(TERMS[name], 20))
        for name, size, shape in (
            ("force-offset", 560.0, {}), ("stiffness", 6000.0, {}), before,
        )
    ]
    settled = with_several(way, terms)
    model = settled.assessed
    again = searched_with(way.device, settled.joined, model.place, model)
    own = {p.fitted.id: p.fitted for p in model.model.terms}
    assert {j.id: j.terms for j in again.joined} == {j.id: (own[j.id],) for j in settled.joined}
    (since,) = (j.terms[0] for j in again.joined if j.id == before[0])
    assert since.shape["closure"] == pytest.approx(0.12, rel=0.3)  # and not 0.3 as it joined
