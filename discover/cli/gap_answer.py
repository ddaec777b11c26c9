"""The gap between a campaign and a model by its name, as ``gap`` and ``batch`` ask for it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from discover.cli.baseline_notes import baseline_notes
from discover.gap import FRACTIONAL, close_gap, prepare_baseline
from discover.motion_fit import observe_all
from discover.named_model import named_model, paper_values
from models.checks import InputError

if TYPE_CHECKING:
    from discover.gap import Gap
    from discover.records import Campaign
    from models.constitutive import ForceModel, SegmentedModel
    from models.device import Device

FIT = "fit:"
"""Before the terms of a model whose coefficients are fitted first."""


def fitted_first(model: str, device: Device | None) -> bool:
    """Return whether a model's coefficients have to be fitted before it predicts anything.

    Examples
    --------
    >>> fitted_first("fit:inertia", None), fitted_first("model.json", None)
    (True, False)
    """
    if model.startswith(FIT):
        return True
    # The paper's b0 and order serve its own devices; for others they are fitted first.
    return model in FRACTIONAL and device is not None and not paper_values(model, device)


def predicting_model(
    campaign: Campaign, model: str, *, seed: int = 0, jobs: int = 1
) -> ForceModel | SegmentedModel:
    """Return a model as typed, fitted to the records that are not held out where it has to be.

    Parameters
    ----------
    campaign : Campaign
        The records.
    model : str
        As `gap_answer` takes it.
    seed, jobs : int
        Of the fit, and records that are read at a time.

    Raises
    ------
    InputError
        For an unknown model, or one that is to be fitted where every record is held out.
    """
    if not fitted_first(model, campaign.device):
        return named_model(model, campaign.device, where="simulate")
    if not campaign.fitted:
        raise InputError(
            "records", expected="at least one that is not held out", found="none", where=model
        )
    observations = observe_all(campaign.records, jobs)
    return prepare_baseline(
        observations, model, fixed=True, device=campaign.device, seed=seed
    ).whole


def gap_answer(
    campaign: Campaign,
    model: str,
    *,
    fixed: bool = False,
    effects: Sequence[str] | None = None,
    seed: int = 0,
    tell: Callable[[str], None] | None = None,
) -> tuple[dict[str, Any], Gap]:
    """Return the document of a gap search, with what to know of the baseline, and its result.

    Parameters
    ----------
    campaign : Campaign
        The records.
    model : str
        As typed after ``--model``.
    fixed, effects, seed, tell
        As `discover.gap.close_gap` takes them.
    """
    device = campaign.device
    chosen = model if fitted_first(model, device) else named_model(model, device)
    found = close_gap(
        campaign, chosen, fixed=fixed, effects=effects, seed=seed, tell=tell
    )
    document = found.to_dict()
    document["findings"] += baseline_notes(
        model, found.given, device, fixed=fixed, fitted=found.fitted
    )
    return document, found
