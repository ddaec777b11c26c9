"""The executor that is asked for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from discover.executor.interface import Executor


@contextmanager
def executor(jobs: int = 1, cluster: str | None = None) -> Iterator[Executor]:
    """Yield the executor for so many processes, or for a Dask cluster.

    Parameters
    ----------
    jobs : int
        Processes of this machine; with 1 the work is done in this one.
    cluster : str, optional
        Address of a Dask scheduler, as ``tcp://host:8786``; then `jobs` is not used.

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

        with on_cluster(cluster) as there:
            yield there
    elif jobs > 1:
        from discover.executor.processes import Processes

        yield Processes(jobs)
    else:
        from discover.executor.here import Here

        yield Here()
