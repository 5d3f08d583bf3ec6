# SPDX-License-Identifier: BSD-3-Clause
"""Very many configurations and motions."""

import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Callable, Dict, Iterator, Optional, Tuple, Union

import numpy as np

from .._arguments import Path, Progress
from .._core import RobotChecker
from .._error import Error
from .._record import Bools, Floats
from .._results import Verdict
from .._robots import EdgeResults
from ._engines import Ended
from ._rows import RowResults, Run, run_rows
from ._sources import Beside, RowsLike, Source, source_of

STEP = 1 << 15
"""Rows after which a thread looks whether its work is still wanted."""

EDGE = np.dtype([("verdict", np.int32), ("free_until", np.float64), ("contact_at", np.float64)])


def stepwise(rows: Floats, stopped: Callable[[], bool]) -> Iterator[slice]:
    for first in range(0, len(rows), STEP):
        if stopped():
            raise Ended
        yield slice(first, first + STEP)


@dataclass(frozen=True)
class CheckConfigs:
    """Configurations to whether they are free."""

    checker: RobotChecker

    def __call__(self, rows: Floats, stopped: Callable[[], bool]) -> Bools:
        free = np.empty(len(rows), dtype=bool)
        for part in stepwise(rows, stopped):
            free[part] = self.checker.check_configs(rows[part])
        return free


@dataclass(frozen=True)
class CheckEdges:
    """Rows of a start and an end to what is proved of the motion between them."""

    checker: RobotChecker
    options: Dict[str, Any]

    def __call__(self, rows: Floats, stopped: Callable[[], bool]) -> Any:
        found = np.empty(len(rows), dtype=EDGE)
        dof = self.checker.dof
        # Which contact of several is told depends on what was asked before: here, on the chunk alone.
        checker = copy.copy(self.checker)
        for part in stepwise(rows, stopped):
            start, end = rows[part, :dof], rows[part, dof:]
            results = checker.check_edges(start, end, **self.options)
            for name in EDGE.names or ():
                found[name][part] = getattr(results, name)
        return found


class RowStudy:
    """What was found for each of many rows."""

    def __init__(self, results: RowResults) -> None:
        self._results = results

    def __len__(self) -> int:
        return len(self._results)


class ConfigurationStudy(RowStudy):
    """What check_configs() found."""

    def parts(self) -> Iterator[Bools]:
        """`free` in parts one behind the other: where there is no room for all of it."""
        return iter(self._results)

    @property
    def free(self) -> Bools:
        """Which configurations are free, shape (n,)."""
        free: Bools = self._results.array()
        return free

    @cached_property
    def free_count(self) -> int:
        """How many are."""
        return sum(int(np.count_nonzero(part)) for part in self.parts())

    def __repr__(self) -> str:
        return f"ConfigurationStudy({self.free_count} of {len(self)} free)"


class EdgeStudy(RowStudy):
    """What check_edges() found."""

    def parts(self) -> Iterator[Any]:
        """In parts one behind the other: arrays with the fields verdict, free_until, contact_at."""
        return iter(self._results)

    @property
    def results(self) -> EdgeResults:
        """As the checker's own check_edges() returns them."""
        found = self._results.array()
        return EdgeResults(*(np.ascontiguousarray(found[name]) for name in EDGE.names or ()))

    @cached_property
    def counts(self) -> Tuple[int, int, int]:
        """How many are free, collide, and are neither proved."""
        all_counts = [np.bincount(part["verdict"], minlength=len(Verdict)) for part in self.parts()]
        free, collide, unknown = np.sum(all_counts, axis=0) if all_counts else (0, 0, 0)
        return int(free), int(collide), int(unknown)

    def __repr__(self) -> str:
        free, collide, unknown = self.counts
        return f"EdgeStudy({free} of {len(self)} free, {collide} collide, {unknown} not proved)"


def check_configs(
    checker: RobotChecker,
    configurations: RowsLike,
    *,
    output: Optional[Path] = None,
    client: Any = None,
    threads: int = 0,
    chunk: int = 1 << 20,
    retries: int = 3,
    progress: Progress = None,
) -> ConfigurationStudy:
    """Whether each of very many configurations is free.

    `configurations` is an array of shape (n, dof), an NPY file of one (mapped into memory), a Parquet
    file (where pyarrow is), or GeneratedRows. `output` is a folder for the results: a run that was
    ended goes on from what is there, of `chunk` configurations at a time. Works on `threads` of this
    machine (0: all), or on the workers of `client`, a dask.distributed Client, where files have to
    be found under the same name. A chunk that fails is tried `retries` more times.
    """
    source = source_of(configurations, "configurations", checker.dof)
    run = Run(output, client, threads, retries, progress)
    empty = np.empty(0, dtype=bool)
    return ConfigurationStudy(
        run_rows("configurations", checker, {}, source, chunk, empty, CheckConfigs(checker), run)
    )


def check_edges(
    checker: RobotChecker,
    edges: Union[RowsLike, Tuple[RowsLike, RowsLike]],
    *,
    resolution: float = 0.0001,
    first: bool = False,
    continuous: str = "as_given",
    output: Optional[Path] = None,
    client: Any = None,
    threads: int = 0,
    chunk: int = 1 << 18,
    retries: int = 3,
    progress: Progress = None,
) -> EdgeStudy:
    """What is proved of each of very many straight motions in joint space.

    `edges` is a tuple of starts and ends, each as check_configs() takes configurations, or one of these
    with rows of a start and an end: shape (n, 2, dof) or (n, 2 dof). The edges of a path are
    (path[:-1], path[1:]). `resolution`, `first` and `continuous` are those of
    RobotChecker.check_edges(), the rest those of check_configs(). Unless the first contact is
    requested, which one of several is told may depend on `chunk`, but on nothing else.
    """
    source = edge_source(checker.dof, edges)
    options: Dict[str, Any] = {"resolution": resolution, "first": first, "continuous": continuous}
    none = np.zeros((0, checker.dof))
    checker.check_edges(none, none, **options)  # refuses bad options before others work
    work = CheckEdges(checker, options)
    run = Run(output, client, threads, retries, progress)
    return EdgeStudy(
        run_rows("edges", checker, options, source, chunk, np.empty(0, dtype=EDGE), work, run)
    )


def edge_source(dof: int, edges: Union[RowsLike, Tuple[RowsLike, RowsLike]]) -> Source:
    if not isinstance(edges, tuple):
        return source_of(edges, "edges", 2 * dof)
    if len(edges) != 2:
        raise Error("edges", f"a tuple of {len(edges)}, not of starts and ends")
    starts, ends = (source_of(rows, name, dof) for rows, name in zip(edges, ("starts", "ends")))
    if starts.shape != ends.shape:
        raise Error("ends", f"{ends.shape[0]} of them, of starts {starts.shape[0]}")
    return Beside((starts, ends))
