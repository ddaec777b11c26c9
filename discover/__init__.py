"""Model discovery for fluid inerters: which structure holds, where, how surely, what it misses.

Examples
--------
>>> import discover
>>> callable(discover.read_campaign) and callable(discover.run_study)
True
"""

from importlib import import_module

from discover._version import __version__

TYPE_CHECKING = False  # as of typing, whose import the command need not wait for
if TYPE_CHECKING:
    from typing import Any

    from discover.data_check import check_campaign
    from discover.gap import close_gap
    from discover.readers import read_campaign
    from discover.study import StudyOptions, load_study, run_study

__all__ = [
    "StudyOptions",
    "__version__",
    "check_campaign",
    "close_gap",
    "load_study",
    "read_campaign",
    "run_study",
]

_HOMES = {
    "StudyOptions": "discover.study",
    "check_campaign": "discover.data_check",
    "close_gap": "discover.gap",
    "load_study": "discover.study",
    "read_campaign": "discover.readers",
    "run_study": "discover.study",
}


def __getattr__(name: str) -> "Any":
    """Load what is asked for only then: the command's help need not wait for the numerics."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """Return the public names, loaded or not, for tab completion."""
    return sorted({*globals(), *__all__})
