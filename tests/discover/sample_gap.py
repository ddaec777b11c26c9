"""A gap search as its document and figure data, written by hand: the report's input in tests."""

import numpy as np

from discover.figure_data import EffectShape, GapCurves, GapFigureData, MisfitCell
from tests.discover.sample_study import sample_response


def curves(frequency, amplitude, *, held_out=False):
    omega = 2.0 * np.pi * frequency
    time = np.linspace(0.0, 2.0 / frequency, 300)
    x, v = amplitude * np.sin(omega * time), amplitude * omega * np.cos(omega * time)
    before = -370.0 * omega**2 * x + 4000.0 * v
    after = before + 400.0 * np.tanh(v / 2e-3)
    noise = 20.0 * np.random.default_rng(1).standard_normal(time.size)
    return GapCurves(
        file=f"{frequency:g}hz-{1e3 * amplitude:g}mm.csv",
        kind="sine",
        held_out=held_out,
        frequency=frequency,
        amplitude=amplitude,
        time=time,
        displacement=x,
        velocity=v,
        force=after + noise,
        responses=(
            sample_response(frequency, noise),
            sample_response(frequency, after + noise - before),
        ),
        before=before,
        after=after,
        noise_percent=1.0 + 0.1 * frequency,
        gap_before_percent=40.0 / frequency,
        gap_after_percent=1.2 + 0.1 * frequency,
    )


def sample_gap_data():
    v = np.linspace(-0.1, 0.1, 101)
    force = 400.0 * np.tanh(v / 2e-3)
    return GapFigureData(
        records=(
            curves(0.5, 0.01),
            curves(1.0, 0.01),
            curves(2.0, 0.01, held_out=True),
            curves(4.0, 0.005),
        ),
        shapes=(
            EffectShape(
                0,
                "coulomb-friction",
                "velocity",
                "m/s",
                v,
                force,
                force - 15.0,
                force + 15.0,
                v[::2],
                force[::2] + 8.0 * np.sin(300.0 * v[::2]),
            ),
        ),
        surface=tuple(
            MisfitCell(a, b, float(np.sign(b)))
            for a in np.linspace(-0.9, 0.9, 10)
            for b in np.linspace(-0.9, 0.9, 10)
        ),
    )


def sample_gap_document():
    data = sample_gap_data()
    term = {"id": "inertia", "coefficient": 371.0, "unit": "kg", "interval": [369.0, 373.0]}
    told = {k: v for k, v in term.items() if k != "interval"}
    return {
        "schema": "inerter.gap/1",
        "version": "1.0.0",
        "seed": 0,
        "campaign": {"title": "Device [12], friction hidden", "hash": "cd" * 32},
        "baseline": {"terms": [told], "fitted": True},
        "gap_percent": 18.3,
        "noise_percent": 1.1,
        "held_out_gap_percent": 21.0,
        "where": [
            {"record": r.file, "share": 0.25, "profile": "direction of motion"}
            for r in data.records
        ],
        "mended": [
            {**term, "coefficient": 371.4, "interval": [370.0, 372.8]},
            {"id": "coulomb-friction", "coefficient": 401.0, "unit": "N",
             "interval": [396.0, 406.0]},
        ],
        "rounds": [
            {
                "effect": "coulomb-friction",
                "parameters": {"transition_speed": 0.002},
                "coefficient": 402.0,
                "interval": [395.0, 409.0],
                "unit": "N",
                "probability": 0.93,
                "alternatives": [{"effect": "stribeck-friction", "probability": 0.06}],
                "gap_before_percent": 18.3,
                "gap_after_percent": 2.4,
                "held_out_before_percent": 21.0,
                "held_out_after_percent": 2.6,
                "rms_record_gap_before_percent": 19.0,
                "rms_record_gap_after_percent": 2.5,
                "share_percent": 98.6,
                "shape_adequate": False,
                "held_out_better": True,
            },
            {
                "effect": "force-offset",
                "parameters": {},
                "coefficient": -3.2,
                "interval": [-3.6, -2.8],
                "unit": "N",
                "probability": 0.999,
                "alternatives": [],
                "gap_before_percent": 2.4,
                "gap_after_percent": 1.2,
                "held_out_before_percent": 2.6,
                "held_out_after_percent": 1.3,
                "rms_record_gap_before_percent": 2.5,
                "rms_record_gap_after_percent": 1.2,
                "share_percent": 95.0,
                "shape_adequate": True,
                "held_out_better": True,
            },
        ],
        "records": [
            {
                "file": r.file,
                "held_out": r.held_out,
                "noise_percent": r.noise_percent,
                "gap_before_percent": r.gap_before_percent,
                "gap_after_percent": r.gap_after_percent,
            }
            for r in data.records
        ],
        "verdict": "closed",
        "final_gap_percent": 1.2,
        "final_held_out_gap_percent": 1.3,
        "unexplained_percent": 0.1,
        "remainder_percent": {"value": 0.21, "interval": [0.1, 0.32]},
    }
