"""What the design's loop found, in a sentence."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.words import counted, percent, significant


def serves_text(loop: Mapping[str, Any]) -> str:
    """Return whether one fractional model serves the designed device's whole range, and how well.

    Parameters
    ----------
    loop : mapping
        As `close_loop` collects it.

    Examples
    --------
    >>> band = {"structure": "FOIM"}
    >>> fit = {"order": 1.9, "error_percent": 2.0}
    >>> loop = {"bands": [band], "one_foim_serves": True, "records": 12, "noise_percent": 1.0}
    >>> names = ("", "_baseline", "_without_seal", "_baseline_without_seal")
    >>> serves_text({**loop, **{"one_foim" + name: fit for name in names}})[:31]
    'One FOIM serves the whole range'
    """
    bands = loop["bands"]
    structures = ", then ".join(str(band["structure"]) for band in bands)
    verdict = "serves" if loop["one_foim_serves"] else "does not serve"
    best = loop["one_foim"]

    def misses(name: str) -> str:
        return percent(loop[name]["error_percent"])

    return (
        f"One FOIM {verdict} the whole range on the virtual rig: discovery finds "
        f"{counted(len(bands), 'band')} ({structures}). The best single FOIM, of order "
        f"{significant(best['order'], 3)}, misses {misses('one_foim')} of the peak over "
        f"{counted(loop['records'], 'record')} (the baseline's {misses('one_foim_baseline')}); "
        f"without seals, the flow alone, {misses('one_foim_without_seal')} (the baseline's "
        f"{misses('one_foim_baseline_without_seal')}). Noise is {percent(loop['noise_percent'])}."
    )
