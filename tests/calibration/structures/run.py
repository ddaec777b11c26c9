"""Run the study on cases and keep each outcome as it comes."""

from __future__ import annotations

import json
import signal
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from time import perf_counter, process_time

from joblib import Parallel, delayed

import discover
from tests.calibration.structures.case import Case
from tests.calibration.structures.scoring import Outcome, score

_LISTS = ("brackets", "orders", "exponents", "inertances", "false_extras")


LIMIT = 600
"""s of processor time, after which a study counts as failed."""


@contextmanager
def within(seconds: int) -> Iterator[None]:
    """Raise TimeoutError in the block after so many seconds of processor time; 0 for never.

    Processor time, so that a busy machine fails no study.
    """
    def late(number: int, frame: object) -> None:
        raise TimeoutError(f"no answer within {seconds} s")

    before = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def answered(case: Case, commit: str = "", limit: int = LIMIT) -> Outcome:
    """Return the outcome of one case; an error of the study is an outcome too."""
    campaign = case.campaign
    began, worked = perf_counter(), process_time()

    def took() -> dict[str, float]:
        return {"seconds": perf_counter() - began, "worked": process_time() - worked}

    try:
        with within(limit), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            document = discover.run_study(campaign).to_dict()
    except Exception as error:  # a study of hours shall count a failure, not end with it
        failure = f"{type(error).__name__}: {error}"
        return score(case, None, failure=failure, commit=commit, **took())
    return score(case, document, commit=commit, **took())


def outcomes(
    wanted: Sequence[Case], *, jobs: int = 1, keep: Path | None = None, commit: str = "",
    limit: int = LIMIT,
) -> Iterator[Outcome]:
    """Yield the outcome of every case as it comes; those in the file `keep` are not run again.

    Failures are run again. Each new outcome is appended to `keep` as one line of JSON.
    """
    known = {o.key: o for o in read(keep)} if keep is not None else {}
    left = []
    for case in wanted:
        if case.key in known and not known[case.key].failure:
            yield known[case.key]
        else:
            left.append(case)
    found = Parallel(n_jobs=jobs, return_as="generator_unordered")(
        delayed(answered)(case, commit, limit) for case in left
    )
    for one in found:
        if keep is not None:
            keep.parent.mkdir(parents=True, exist_ok=True)
            with keep.open("a") as file:
                file.write(json.dumps(asdict(one)) + "\n")
        yield one


def read(path: Path) -> list[Outcome]:
    """Return the outcomes in a file, the last of each case; a line cut off is left out."""
    found: dict[str, Outcome] = {}
    for line in path.read_text().splitlines() if path.exists() else ():
        try:
            values = json.loads(line)
        except json.JSONDecodeError:
            continue
        one = Outcome(**values | {name: tuple(values[name]) for name in _LISTS})
        found[one.key] = one
    return list(found.values())
