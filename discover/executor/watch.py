"""Waiting for a Dask cluster's results while there is anybody who may give them."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from models.checks import InputError

SETTING = "distributed.scheduler.no-workers-timeout"
"""Dask's own, for a time without workers; its default is to wait for ever."""
LONGEST = 300.0
"""s without any worker, where that setting says none: Dask counts a silent worker as dead after
as long (`distributed.scheduler.worker-ttl`), so one that is restarted has come back by then."""

_LOOK = 1.0  # s between two looks at the workers
_PAUSE = 0.05  # s between two looks at the results


@dataclass
class Watch:
    """Notes how long a cluster has been without workers, and ends a wait that is too long."""

    client: Any
    """Of `distributed`."""
    address: str
    """Of the scheduler, as given."""
    tell: Callable[[str], None]
    """Is told in a line that there is no worker."""
    longest: float = LONGEST
    """s without any worker, after which the work ends."""
    _since: float | None = None
    _looked: float = -_LOOK

    def ready(self, completed: Any) -> Iterator[Any]:
        """Yield the futures of an `as_completed` as they are done.

        Raises
        ------
        InputError
            Where the cluster has no worker for too long.
        """
        while not completed.is_empty():
            while not completed.has_ready():
                self._look()
                time.sleep(_PAUSE)
            yield next(completed)

    def _look(self) -> None:
        now = time.monotonic()
        if now < self._looked + _LOOK:
            return
        self._looked = now
        if self.client.nthreads():
            self._since = None
        elif self._since is None:
            self._since = now
            self.tell(
                f"--cluster {self.address}: no worker is there any more; waiting up to"
                f" {self.longest:.3g} s for one"
            )
        elif now - self._since > self.longest:
            raise no_workers(self.address, f"none for {self.longest:.3g} s")


def no_workers(address: str, found: str) -> InputError:
    """Return the error of a cluster without workers, with what was found in their place."""
    return InputError(
        "workers", expected="at least one until the work is done", found=found,
        where=f"--cluster {address}",
    )
