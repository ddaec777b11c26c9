"""Work over the workers of a Dask cluster."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, ClassVar

from threadpoolctl import threadpool_limits

from discover._version import __version__
from discover.executor.interface import Lost, R, T
from discover.executor.watch import LONGEST, SETTING, Watch, no_workers
from models.checks import InputError

_one_at_a_time = threading.Lock()


@dataclass(frozen=True)
class Cluster:
    """Does the items on a cluster, whose scheduler does those of lost workers again."""

    apart: ClassVar[bool] = True
    client: Any
    """Of `distributed`."""
    watch: Watch
    """Over its workers."""

    def finished(
        self, function: Callable[[T], R], items: Sequence[T]
    ) -> Iterator[tuple[int, R | Lost]]:
        """Yield each item's place and result as they are done; see `Executor`.

        Raises
        ------
        InputError
            Where the scheduler goes, or no worker is there for too long.
        """
        killed = []
        for place, result in self._submitted(function, items, range(len(items))):
            if isinstance(result, Lost):
                killed.append(place)
            else:
                yield place, result
        for place in sorted(killed):  # who is killed again, alone, has taken its worker down itself
            yield from self._submitted(function, items, [place])

    def _submitted(
        self, function: Callable[[T], R], items: Sequence[T], places: Sequence[int]
    ) -> Iterator[tuple[int, R | Lost]]:
        """Yield places and results as they are done; lost are all that were on dying workers."""
        from distributed import KilledWorker, as_completed
        from distributed.scheduler import NoValidWorkerError

        futures = {
            self.client.submit(_one_at_a_time_here, function, items[place], pure=False): place
            for place in places
        }
        with self.client.as_current():
            completed = as_completed(list(futures))
        try:
            for future in self.watch.ready(completed):
                place = futures[future]
                error = future.exception() if future.status == "error" else None
                if isinstance(error, KilledWorker):
                    yield place, Lost("its worker died each time, as where memory runs out")
                elif isinstance(error, NoValidWorkerError):  # the scheduler has waited itself
                    raise no_workers(self.watch.address, "none for as long as it waits")
                elif error is not None:
                    raise error
                elif future.status == "finished":
                    yield place, future.result()
                elif future.status in ("lost", "pending"):  # the result died with its worker
                    completed.add(future)
                    continue
                else:
                    raise _scheduler_gone(self.watch.address)
                del futures[future]  # the cluster forgets it
        except (OSError, TimeoutError, asyncio.CancelledError):
            raise _scheduler_gone(self.watch.address) from None
        finally:
            if futures and self.client.status == "running":
                self.client.cancel(list(futures))


def _one_at_a_time_here(function: Callable[[T], R], item: T) -> R:
    """Do an item on a worker: pictures and limits on threads are the whole process's."""
    with _one_at_a_time, threadpool_limits(1):
        return function(item)


@contextmanager
def on_cluster(address: str, tell: Callable[[str], None]) -> Iterator[Cluster]:
    """Yield the executor of a cluster.

    Parameters
    ----------
    address : str
        Of its scheduler. It and a first worker are waited for as long as Dask's own setting says
        (`distributed.comm.timeouts.connect`). Where all workers go, others are waited for as long
        as another says (`distributed.scheduler.no-workers-timeout`), by default `LONGEST`.
    tell : callable
        Is told in a line where the work waits for workers.

    Raises
    ------
    InputError
        Where `distributed` is not installed, the scheduler can't be reached, no worker comes, or
        one has another version of this package.
    """
    where = f"--cluster {address}"
    try:
        import dask
        from dask.utils import parse_timedelta
        from distributed import Client
    except ImportError:
        extra = "pip install 'inerter-discovery[distributed]'"
        raise InputError(
            "the package distributed", expected=f"installed ({extra})", found="none", where=where
        ) from None
    # It tells what is wrong in many lines; here it is one.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    patience = float(parse_timedelta(dask.config.get("distributed.comm.timeouts.connect")))
    try:
        client = Client(address, timeout=patience, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        reason = str(error).strip().splitlines()[0] if str(error).strip() else "no answer"
        raise InputError("scheduler", expected="reachable", found=reason, where=where) from None
    try:
        _check_workers(client, where, patience)
        yield Cluster(client, Watch(client, address, tell, _longest()))
    finally:
        client.close()


def _check_workers(client: Any, where: str, patience: float) -> None:
    """Raise where there are no workers, or such as would give other answers."""
    try:
        client.wait_for_workers(1, timeout=patience)
    except TimeoutError:
        raise InputError("workers", expected="at least one", found="none", where=where) from None
    wanted = f"with inerter-discovery {__version__} installed"
    try:
        versions = client.run(_version)
    except ImportError as error:
        raise InputError("workers", expected=wanted, found=str(error), where=where) from None
    other = sorted(set(versions.values()) - {__version__})
    if other:
        raise InputError("workers", expected=wanted, found=f"one with {other[0]}", where=where)


def _longest() -> float:
    """Return how many seconds the work may be without workers."""
    import dask
    from dask.utils import parse_timedelta

    set_to = dask.config.get(SETTING, None)
    return LONGEST if set_to is None else float(parse_timedelta(set_to))


def _version() -> str:
    return __version__


def _scheduler_gone(address: str) -> InputError:
    return InputError(
        "scheduler", expected="there until the work is done", found="gone",
        where=f"--cluster {address}",
    )
