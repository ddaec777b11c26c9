"""Work over the processes of one machine, by joblib's loky."""

from __future__ import annotations

import signal
import warnings
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from typing import Any, ClassVar

from joblib.externals.loky import ProcessPoolExecutor
from joblib.externals.loky.process_executor import BrokenProcessPool

from discover.executor.interface import MOST_LOSSES, Lost, R, T


@dataclass(frozen=True)
class Processes:
    """Does `jobs` items at a time, each in a process of its own.

    No more items are handed out than there are processes. So an interrupt has nothing to take
    back, and where a process dies it is known which items it may have been.
    """

    apart: ClassVar[bool] = True
    jobs: int
    """Number of processes."""

    def finished(
        self, function: Callable[[T], R], items: Sequence[T]
    ) -> Iterator[tuple[int, R | Lost]]:
        """Yield each item's place and result as they are done; see `Executor`."""
        waiting = deque(range(len(items)))
        suspects: deque[int] = deque()  # ran when a process died; each runs alone to be cleared
        losses = dict.fromkeys(waiting, 0)
        running: dict[Future[R], int] = {}
        pool = self._pool()
        try:
            while waiting or suspects or running:
                queue, most = (suspects, 1) if suspects else (waiting, self.jobs)
                while queue and len(running) < most:
                    place = queue.popleft()
                    running[pool.submit(function, items[place])] = place
                done, _ = wait(running, return_when=FIRST_COMPLETED)
                if any(isinstance(f.exception(), BrokenProcessPool) for f in done):
                    done, _ = wait(running)  # a pool that lost a process does nothing more
                lost = []
                for future in done:
                    place = running.pop(future)
                    if isinstance(future.exception(), BrokenProcessPool):
                        lost.append(place)
                    else:
                        yield place, future.result()
                if not lost:
                    continue
                pool.shutdown(kill_workers=True)
                pool = self._pool()
                if len(lost) == 1:
                    losses[lost[0]] += 1
                    if losses[lost[0]] >= MOST_LOSSES:
                        reason = "its process died each time, as where memory runs out"
                        yield lost.pop(), Lost(reason)
                suspects.extend(sorted(lost))
        finally:
            pool.shutdown(kill_workers=True)

    def _pool(self) -> Any:
        return ProcessPoolExecutor(max_workers=self.jobs, initializer=_begin)


def _begin() -> None:
    """Leave interrupts to the process that started this one, and say nothing."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore")
