"""A study as its document and figure data, written by hand: the report's input in tests."""

import copy
import math

import numpy as np

from discover.figure_data import (
    BaselineAnswer,
    RecordCurves,
    StructureProbability,
    StudyFigureData,
)
from discover.residual_data import Response

SPEED_TO_DEAN = 798.8
FREQUENCIES = (0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 5.0, 8.0, 12.0, 15.0)
AMPLITUDES = (0.005, 0.010, 0.020)


def sample_response(frequency, left):
    spectrum = np.geomspace(frequency / 4.0, 100.0 * frequency, 40)
    phase = (np.arange(48) + 0.5) / 48
    stiffness = np.array([-370.0 * (2.0 * math.pi * frequency) ** 2 + 1e5j * frequency])
    return Response(
        frequency=spectrum,
        force=1000.0 / spectrum,
        left=np.full(40, float(np.std(left))),
        noise=np.full(40, 2.0),
        stiffness_frequency=np.array([frequency]),
        stiffness=stiffness,
        model_stiffness=0.99 * stiffness,
        coherence=np.zeros(0),
        phase=phase,
        over_phase=np.interp(phase, np.linspace(0.0, 1.0, left.size), left),
        lag=0.002 * np.arange(1, 41),
        correlation=0.1 * np.cos(np.arange(40)),
        correlation_limit=0.05,
        gain_percent=0.3,
        error_over_noise=1.1,
    )


def curves(frequency, amplitude, *, seed=0):
    generator = np.random.default_rng(seed)
    omega = 2.0 * math.pi * frequency
    dean = SPEED_TO_DEAN * omega * amplitude
    slow = dean < 100.0
    time = np.linspace(0.0, 2.0 / frequency, 400)
    x = amplitude * np.sin(omega * time)
    v = amplitude * omega * np.cos(omega * time)
    model = -370.4 * omega**2 * x + 9.1e4 * v * np.abs(v) * (not slow) + 2.2e4 * v
    model = model + 400.0 * np.tanh(v / 1e-3)
    noise = 0.02 * np.std(model) * generator.standard_normal(time.size)
    held_out = frequency == 2.0
    return RecordCurves(
        file=f"{frequency:g}hz-{1e3 * amplitude:g}mm.csv",
        kind="sine",
        held_out=held_out,
        band=0 if slow else 1,
        structure="FOIM" if slow else "IOIM-laminar",
        frequency=frequency,
        amplitude=amplitude,
        dean_paper=dean,
        dean_standard=dean / (2.0 * math.sqrt(2.0)),
        responses=(sample_response(frequency, noise),),
        time=time,
        displacement=x,
        velocity=v,
        force=model + noise,
        model_force=model,
        error_percent=1.2,
        relative_error_percent=2.0 + 0.4 * generator.random() + (1.5 if held_out else 0.0),
        noise_percent=2.0,
    )


def term(identifier, coefficient, unit, **shape):
    error = 0.01 * abs(coefficient)
    interval = [coefficient - 2.0 * error, coefficient + 2.0 * error]
    return {
        "id": identifier,
        "coefficient": coefficient,
        "std_error": error,
        "interval": interval,
        "unit": unit,
        **shape,
    }


EXTRA = {
    **term("stiffness", 1210.0, "N/m"),
    "probability": 0.93,
    "alternatives": [{"effect": "cubic-stiffness", "probability": 0.06}],
}
FRICTION_CURVE = {
    "curve": "deflects over 0.05 mm before it slides (0.04 to 0.06 mm)",
    "probability": 0.98,
    "differs_by_record": 0.021,
    "presliding_displacement": 5e-5,
    "presliding_displacement_interval": [4e-5, 6e-5],
}


def sample_data():
    plan = [(f, a) for f in FREQUENCIES for a in AMPLITUDES if f * f * a * 40 < 9.81 * 5]
    records = tuple(curves(f, a, seed=i) for i, (f, a) in enumerate(plan))
    return StudyFigureData(
        records=records,
        baselines=(
            BaselineAnswer("STLSQ", 0, (("D^1.5", 812.0), ("sign(v)", 401.0)), 3.4, 0.01),
            BaselineAnswer("SR3", 0, (), None, 0.02),
            BaselineAnswer("STLSQ", 1, (("a", 371.0), ("v", 2.1e4)), 2.9, 0.01),
        ),
        probabilities=(
            StructureProbability(0, "FOIM", 0.81),
            StructureProbability(0, "IOIM-linear", 0.17),
            StructureProbability(0, "other", 0.02),
            StructureProbability(1, "IOIM-laminar", 0.985),
            StructureProbability(1, "IOIM-turbulent", 0.015),
        ),
        dean_per_speed_paper=SPEED_TO_DEAN,
        dean_per_speed_standard=SPEED_TO_DEAN / (2.0 * math.sqrt(2.0)),
    )


def sample_document():
    data = sample_data()
    files = [[r.file for r in data.records if r.band == k] for k in (0, 1)]
    return {
        "schema": "inerter.study/1",
        "version": "1.0.0",
        "seed": 0,
        "campaign": {"title": "Device [12], sine tests", "hash": "ab" * 32},
        "coordinate": "dean",
        "relative_error_percent": 2.21,
        "held_out_relative_error_percent": 3.7,
        "identifiable": False,
        "findings": [
            {"level": "warning", "text": "Band 1: the records leave FOIM and IOIM-linear open."},
            {"level": "note", "text": "force column mended", "record": files[0][0]},
        ],
        "bands": [
            {
                "lower": None,
                "upper": 98.0,
                "lower_hz": 0.1,
                "upper_hz": 0.5,
                "records": files[0],
                "family": "fractional",
                "structure": "FOIM",
                "terms": [
                    term(
                        "fractional-derivative",
                        1520.0,
                        "N*s^1.48/m",
                        order=1.48,
                        order_interval=[1.42, 1.55],
                    ),
                    term("coulomb-friction", 402.0, "N"),
                    term("stiffness", 1210.0, "N/m"),
                ],
                "extras": [copy.deepcopy(EXTRA)],
                "friction": copy.deepcopy(FRICTION_CURVE),
                "remainder_percent": {"value": 0.52, "interval": [0.31, 0.68]},
                "error_percent": 1.3,
                "relative_error_percent": 2.3,
                "noise_percent": 2.0,
                "probability": 0.81,
                "equivalents": [
                    {"structure": "FOIM", "probability": 0.81},
                    {"structure": "IOIM-linear", "probability": 0.17},
                ],
            },
            {
                "lower": 98.0,
                "upper": None,
                "lower_hz": 0.5,
                "upper_hz": 15.0,
                "records": files[1],
                "family": "integer",
                "structure": "IOIM-laminar",
                "terms": [
                    term("inertia", 371.2, "kg"),
                    term("quadratic-damping", 91_200.0, "N*s^2/m^2"),
                    term("viscous-damping", 22_010.0, "N*s/m"),
                    term("coulomb-friction", 402.0, "N"),
                    term("stiffness", 1210.0, "N/m"),
                ],
                "extras": [copy.deepcopy(EXTRA)],
                "friction": copy.deepcopy(FRICTION_CURVE),
                "remainder_percent": {"value": 0.1, "interval": [0.0, 0.25]},
                "error_percent": 1.2,
                "relative_error_percent": 2.2,
                "noise_percent": 2.0,
                "probability": 0.985,
                "equivalents": [{"structure": "IOIM-laminar", "probability": 0.985}],
            },
        ],
        "nuisance": [
            {"id": "time-delay", "value": 2.1e-4, "interval": [1.5e-4, 2.7e-4], "unit": "s"}
        ],
        "boundaries": [
            {
                "coordinate": 98.0,
                "interval": [84.0, 117.0],
                "dean": 98.0,
                "dean_interval": [84.0, 117.0],
                "speed": 98.0 / SPEED_TO_DEAN,
                "frequency_hz": 1.95,
                "bracket": [80.3, 125.5],
            }
        ],
        "dean_check": {
            "convention": "paper",
            "criterion": 100.0,
            "verdict": "consistent",
            "boundary_dean": 98.0,
            "interval": [84.0, 117.0],
            "boundary_dean_paper": 98.0,
            "boundary_dean_standard": 34.6,
            "amplitude_exponent": -0.97,
            "amplitude_exponent_interval": [-1.12, -0.84],
            "reason": "The boundary lies at a Dean number that holds 100.",
        },
        "next_test": {
            "frequency_hz": 0.7,
            "amplitude_m": 0.012,
            "separates": ["FOIM", "IOIM-linear"],
            "gain": 6.4,
        },
    }
