"""Exact best subsets of columns, as a function, for pysindy and for scikit-learn.

The names below load when they are asked for: pysindy takes a second to import.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from discover.regression.best_subset import Subset, SubsetPath, best_subsets
    from discover.regression.optimizer import BestSubset
    from discover.regression.regressor import InerterRegressor

__all__ = ["BestSubset", "InerterRegressor", "Subset", "SubsetPath", "best_subsets"]
_HOME = {
    "BestSubset": "optimizer",
    "InerterRegressor": "regressor",
    "Subset": "best_subset",
    "SubsetPath": "best_subset",
    "best_subsets": "best_subset",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
