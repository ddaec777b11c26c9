"""Where work runs: in this process, in several of this machine, or on a Dask cluster."""

from discover.executor.choice import executor
from discover.executor.interface import Executor, Lost

__all__ = ["Executor", "Lost", "executor"]
