"""The paper's fractional models as baselines of any device: b0 and order fitted first."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from discover.motion_fit import Observation
from discover.rows import RecordRows
from models.checks import InputError
from models.constitutive import Band, ForceModel, SegmentedModel
from models.device import Device

FRACTIONAL = ("foim", "sfoim")
FOIM_TERMS = ("fractional-derivative", "coulomb-friction")
_DEAN = 100.0  # the paper's criterion, in its convention: where sfoim changes

Fit = Callable[[Sequence[RecordRows]], ForceModel]
Along = Callable[[Observation, SegmentedModel], float]


def fitted_sfoim(
    rows: Sequence[RecordRows], device: Device | None, *, fit: Fit, along: Along
) -> SegmentedModel:
    """Return the segmented fractional model, each band fitted to its own records.

    b and b0 enter only as b(1 + b0), so that the coefficient is fitted.

    Parameters
    ----------
    rows : sequence of RecordRows
        Of all records; those held out are not fitted.
    device : Device or None
        Gives the Dean number (the paper's convention); the bands part at 100.
    fit : callable
        Maps rows to the fitted terms.
    along : callable
        Dean number of an observation, from it and the bands.

    Raises
    ------
    InputError
        Without a device, or where the records of a band that may be fitted are none, or too few
        to give b0 and order.
    """
    if device is None:
        raise InputError("sfoim", expected="used with a device", found="none", where="--model")
    nothing = ForceModel(())
    bands = (Band(None, _DEAN, nothing), Band(_DEAN, None, nothing))
    empty = SegmentedModel(bands, "dean", "paper", device, "SFOIM")
    fitted = [r for r in rows if not r.observation.held_out]
    below = [r for r in fitted if along(r.observation, empty) < _DEAN]
    above = [r for r in fitted if along(r.observation, empty) >= _DEAN]
    if not below or not above:
        raise InputError(
            "records that may be fitted", expected=f"on both sides of De {_DEAN:g} for sfoim",
            found=f"all {'above' if above else 'below'}", where=device.name,
        )  # fmt: skip
    models = [
        ForceModel(fit(side).terms, "FOIM") for side in (below, above)
    ]
    for model, side, name in zip(models, (below, above), ("below", "above"), strict=True):
        if model.coefficient(FOIM_TERMS[0]) <= 0.0:
            raise InputError(
                f"b(1 + b0) {name} De {_DEAN:g}", expected="positive as fitted",
                found=f"{model.coefficient(FOIM_TERMS[0]):.4g} from {len(side)} record"
                + "s" * (len(side) > 1),
                where="sfoim",
            )  # fmt: skip
    bands = (Band(None, _DEAN, models[0]), Band(_DEAN, None, models[1]))
    return SegmentedModel(bands, "dean", "paper", device, "SFOIM")
