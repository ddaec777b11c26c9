"""Model discovery for fluid inerters: which structure holds, where, how surely, what it misses.

Examples
--------
>>> import discover
>>> discover.read_campaign("data/segmented")
<Campaign ...: 24 records (3 held out) of device-12>
"""

from importlib import import_module

from discover._version import __version__

TYPE_CHECKING = False  # as of typing, whose import the command need not wait for
if TYPE_CHECKING:
    from typing import Any

    from discover.data_check import check_campaign
    from discover.gap import close_gap
    from discover.library import Column, InerterLibrary
    from discover.readers import read_campaign
    from discover.records import Campaign, Record
    from discover.regression import BestSubset, InerterRegressor
    from discover.simulate import simulate_forces
    from discover.study import StudyOptions, load_study, run_study
    from models.checks import InputError
    from models.device import Device

__all__ = [
    "BestSubset",
    "Campaign",
    "Column",
    "Device",
    "InerterLibrary",
    "InerterRegressor",
    "InputError",
    "Record",
    "StudyOptions",
    "__version__",
    "check_campaign",
    "close_gap",
    "load_study",
    "read_campaign",
    "run_study",
    "simulate_forces",
]

_HOMES = {
    "BestSubset": "discover.regression",
    "Campaign": "discover.records",
    "Column": "discover.library",
    "Device": "models.device",
    "InerterLibrary": "discover.library",
    "InerterRegressor": "discover.regression",
    "InputError": "models.checks",
    "Record": "discover.records",
    "StudyOptions": "discover.study",
    "check_campaign": "discover.data_check",
    "close_gap": "discover.gap",
    "load_study": "discover.study",
    "read_campaign": "discover.readers",
    "run_study": "discover.study",
    "simulate_forces": "discover.simulate",
}


def __getattr__(name: str) -> "Any":
    """Load what is asked for only then: the command's help need not wait for the numerics."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names, loaded or not, for tab completion."""
    return sorted(__all__)
