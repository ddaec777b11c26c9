"""The terms of a motion as features for pysindy.

`InerterLibrary` loads when it is asked for: pysindy takes a second to import.
"""

from typing import TYPE_CHECKING, Any

from discover.library.column import Column

if TYPE_CHECKING:
    from discover.library.feature_library import InerterLibrary

__all__ = ["Column", "InerterLibrary"]


def __getattr__(name: str) -> Any:
    if name == "InerterLibrary":
        from discover.library.feature_library import InerterLibrary

        return InerterLibrary
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
