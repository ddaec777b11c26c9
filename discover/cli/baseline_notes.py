"""What to know about a baseline that was named on the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from discover.named_model import left_out
from models.constitutive import ForceModel, SegmentedModel

if TYPE_CHECKING:
    from models.device import Device

_FRACTIONAL = "fractional-derivative"


def baseline_notes(
    name: str,
    given: SegmentedModel | ForceModel,
    device: Device | None,
    *,
    fixed: bool,
    fitted: bool,
) -> list[dict[str, str]]:
    """Return findings, as documents hold them.

    Parameters
    ----------
    name : str
        As typed.
    given : SegmentedModel or ForceModel
        The baseline as it was held against the data.
    device : Device or None
        The campaign's.
    fixed : bool
        Whether it was asked that coefficients be held.
    fitted : bool
        Whether they were fitted first.
    """
    texts = list(left_out(name, device))
    several = isinstance(given, SegmentedModel) and len(given.bands) > 1
    if several and not fixed:
        texts.append("The model has several bands: its coefficients are held in each.")
    if fitted and name in ("foim", "sfoim") and device is not None:
        models = [b.model for b in given.bands] if isinstance(given, SegmentedModel) else [given]
        fractions = [t for m in models for t in m.terms if t.id == _FRACTIONAL]
        values = " and ".join(
            f"b0 = {t.coefficient / device.inertance - 1.0:.4g} with order {t.shape['order']:.4g}"
            for t in fractions
        )
        texts.append(f"Fitted first, with b = {device.inertance:.4g} kg of the device: {values}.")
    return [{"level": "note", "text": text} for text in texts]
