"""The loop of the rough design: the designed device on the virtual rig, and discovery on it.

The paper expects that a low critical frequency makes one fractional model serve the whole working
range. Here that is tested on records of a device that was only computed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from discover.cli.design_words import serves_text
from discover.identification import Trial, identify_by_projection
from discover.motion_fit import observe
from discover.records import Campaign, Record
from discover.study import StudyOptions, run_study
from models.design import DesignResult
from models.device import Device
from models.rig import Chain, RigPhysics, run, sine_plan

_SHARES = (0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.0)  # of the highest working frequency
_AMPLITUDES = (1.0, 2.0)  # times the duty's
_NOISE = 0.01


def rig_campaign(
    device: Device,
    *,
    frequencies: Sequence[float],
    amplitudes: Sequence[float],
    noise: float = _NOISE,
    seal: bool = True,
    seed: int = 0,
) -> Campaign:
    """Return sine tests of a device on the virtual rig as a campaign.

    Parameters
    ----------
    device : Device
        What is tested.
    frequencies, amplitudes : sequence of float
        Hz and m; points beyond the rig's limits are left out.
    noise : float
        rms noise of the force over its rms.
    seal : bool
        Whether the seals rub: without them the flow is all there is.
    seed : int
        Makes it repeatable.
    """
    plan = sine_plan(device, frequencies=frequencies, amplitudes=amplitudes)
    physics = RigPhysics(seal="dynamic" if seal else "none")
    measured = run(device, plan, seed=seed, chain=Chain(noise=noise), physics=physics)
    records = tuple(
        Record(
            r.file, r.time, r.force, r.displacement, frequency=r.frequency, amplitude=r.amplitude
        )
        for r in measured
    )
    return Campaign(f"{device.name or 'device'} on the virtual rig", records, device=device)


def one_foim(campaign: Campaign) -> dict[str, Any]:
    """Return the best single fractional model of all records, as the paper identifies one.

    Parameters
    ----------
    campaign : Campaign
        Sine tests with a device whose friction is known.

    Returns
    -------
    dict
        ``order``, ``b0`` and ``error_percent``, e_d pooled over the records; order free from 0 to
        2, friction fixed at the device's.
    """
    seen = [observe(record) for record in campaign.records]
    trials = [Trial(one.motion, one.measured) for one in seen]
    found = identify_by_projection(trials, campaign.device, order_bounds=(0.0, 2.0))
    return {"order": found.order, "b0": found.b0, "error_percent": found.error_percent}


def judge(campaign: Campaign, *, seed: int = 0, jobs: int = 1) -> dict[str, Any]:
    """Return whether discovery finds that one fractional model serves a whole campaign.

    Parameters
    ----------
    campaign : Campaign
        Records over the working range.
    seed, jobs : int
        As for a study.

    Returns
    -------
    dict
        ``one_foim_serves``: true where one band is found and FOIM is its structure or among those
        that the data can't rule out. Beside it the bands.
    """
    found = run_study(campaign, StudyOptions(seed=seed, jobs=jobs)).to_dict()
    bands = found["bands"]
    possible = {str(bands[0]["structure"])} | {
        str(other["structure"]) for other in bands[0]["equivalents"]
    }
    kept = ("structure", "lower_hz", "upper_hz", "probability")
    return {
        "one_foim_serves": len(bands) == 1 and "FOIM" in possible,
        "records": len(campaign.records),
        "bands": [{key: band[key] for key in kept} for band in bands],
        "error_percent": found["relative_error_percent"],
    }


def close_loop(result: DesignResult, *, seed: int = 0, jobs: int = 1) -> dict[str, Any] | None:
    """Return what discovery says of the designed device's records on the rig.

    Parameters
    ----------
    result : DesignResult
        A design; its friction is taken to be the baseline's.
    seed, jobs : int
        As for a study.

    Returns
    -------
    dict or None
        What `judge` returns, the best single fractional model of the designed device and of the
        baseline in the same tests, with the seals' friction and without (the flow alone), and
        ``text``; None where nothing was designed.
    """
    if result.best is None:
        return None
    friction = result.baseline.device.coulomb_friction
    frequencies = [share * result.duty.frequency for share in _SHARES]
    amplitudes = [factor * result.duty.amplitude for factor in _AMPLITUDES]

    def tested(device: Device, *, seal: bool) -> Campaign:
        dry = friction if seal and friction is not None else 0.0
        return rig_campaign(
            replace(device, coulomb_friction=dry),
            frequencies=frequencies,
            amplitudes=amplitudes,
            seal=seal,
            seed=seed,
        )

    best, own = result.best.device, result.baseline.device
    designed = tested(best, seal=True)
    loop = {
        **judge(designed, seed=seed, jobs=jobs),
        "noise_percent": 100.0 * _NOISE,
        "one_foim": one_foim(designed),
        "one_foim_baseline": one_foim(tested(own, seal=True)),
        "one_foim_without_seal": one_foim(tested(best, seal=False)),
        "one_foim_baseline_without_seal": one_foim(tested(own, seal=False)),
        "frequencies_hz": frequencies,
        "amplitudes_m": amplitudes,
    }
    return {**loop, "text": serves_text(loop)}
