"""The gap between a campaign and a model by its name, as ``gap`` and ``batch`` ask for it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from discover.cli.baseline_notes import baseline_notes
from discover.gap import FRACTIONAL, close_gap
from discover.named_model import named_model, paper_values

if TYPE_CHECKING:
    from discover.gap import Gap
    from discover.records import Campaign

FIT = "fit:"
"""Before the terms of a model whose coefficients are fitted first."""


def gap_answer(
    campaign: Campaign,
    model: str,
    *,
    fixed: bool = False,
    effects: Sequence[str] | None = None,
    seed: int = 0,
    jobs: int = 1,
    tell: Callable[[str], None] | None = None,
) -> tuple[dict[str, Any], Gap]:
    """Return the document of a gap search, with what to know of the baseline, and its result.

    Parameters
    ----------
    campaign : Campaign
        The records.
    model : str
        As typed after ``--model``.
    fixed, effects, seed, jobs, tell
        As `discover.gap.close_gap` takes them.
    """
    device = campaign.device
    # The paper's b0 and order serve its own devices; for others they are fitted first.
    first = model in FRACTIONAL and device is not None and not paper_values(model, device)
    chosen = model if first or model.startswith(FIT) else named_model(model, device)
    found = close_gap(
        campaign, chosen, fixed=fixed, effects=effects, seed=seed, jobs=jobs, tell=tell
    )
    document = found.to_dict()
    document["findings"] += baseline_notes(
        model, found.given, device, fixed=fixed, fitted=found.fitted
    )
    return document, found
