"""The executor that is asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from discover.executor.interface import Executor


def _silent(line: str) -> None:
    """Tell nobody."""


@contextmanager
def executor(
    jobs: int = 1, cluster: str | None = None, *, tell: Callable[[str], None] = _silent
) -> Iterator[Executor]:
    """Yield the executor for so many processes, or for a Dask cluster.

    Parameters
    ----------
    jobs : int
        Processes of this machine; with 1 the work is done in this one.
    cluster : str, optional
        Address of a Dask scheduler, as ``tcp://host:8786``; then `jobs` is not used.
    tell : callable, optional
        Is told in a line what the work waits for.

    Raises
    ------
    InputError
        Where the cluster can't be reached or its workers lack this package.

    Examples
    --------
    >>> with executor() as here:
    ...     list(here.finished(abs, [-1, 2]))
    [(0, 1), (1, 2)]
    """
    if cluster is not None:
        from discover.executor.cluster import on_cluster

        with on_cluster(cluster, tell) as there:
            yield there
    elif jobs > 1:
        from discover.executor.processes import Processes

        yield Processes(jobs)
    else:
        from discover.executor.here import Here

        yield Here()
