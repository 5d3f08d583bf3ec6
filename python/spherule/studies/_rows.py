# SPDX-License-Identifier: BSD-3-Clause
"""A study of rows: cut into chunks, run, and put together in order."""

import pickle
from dataclasses import dataclass
from functools import partial
from typing import Any, Dict, Iterator, List, Optional

import numpy as np

from .._arguments import Path, Progress
from .._core import RobotChecker
from .._error import Error
from .._version import VERSION
from ._engines import Task, Work, check_counts, run_tasks
from ._output import Parts, parts_in
from ._sources import Identity, Source, digest_of


@dataclass(frozen=True)
class Run:
    """How a study is run. None of it changes results."""

    output: Optional[Path]
    client: Any
    threads: int
    retries: int
    progress: Progress

    def __post_init__(self) -> None:
        check_counts(threads=self.threads, retries=self.retries)


class RowResults:
    """The results of all rows, in parts one behind the other, each an array."""

    def __init__(self, parts: Parts, sizes: List[int], empty: Any) -> None:
        self._parts, self._sizes, self._empty = parts, sizes, empty

    def __len__(self) -> int:
        return sum(self._sizes)

    def __iter__(self) -> Iterator[Any]:
        return (self._parts.get(index) for index in range(len(self._sizes)))

    def array(self) -> Any:
        """All of them in one new array."""
        return np.concatenate([self._empty, *self])


def checker_identity(checker: RobotChecker) -> str:
    """Equal for checkers that decide alike by the same numbers."""
    return digest_of(pickle.dumps(checker))


def run_rows(
    kind: str, checker: RobotChecker, options: Dict[str, Any], source: Source, chunk: int, empty: Any,
    work: "Work[Any, Any]", run: Run,
) -> RowResults:  # fmt: skip
    """The results of `work` on all rows, `chunk` at a time. `empty` are those of no rows."""
    if chunk < 1:
        raise Error("chunk", f"{chunk}: it is a count of rows, at least 1")
    count = source.shape[0]
    sizes = [min(chunk, count - first) for first in range(0, count, chunk)]

    def identity() -> Identity:
        return {
            "format": "spherule-study", "version": 1, "spherule": VERSION, "kind": kind,
            "checker": checker_identity(checker), "options": options, "source": source.identity(),
            "chunk": chunk, "count": count,
        }  # fmt: skip

    parts = parts_in(run.output, identity)
    try:
        present = parts.present(sizes, empty)
        done = sum(sizes[index] for index in present)
        tasks = (
            Task(index, partial(source.rows, index * chunk, size), source.stays)
            for index, size in enumerate(sizes)
            if index not in present
        )
        if run.progress is not None and present:
            run.progress(done / count, kind)
        for index, part in run_tasks(
            work, tasks, client=run.client, threads=run.threads, retries=run.retries
        ):
            parts.put(index, part)
            done += sizes[index]
            if run.progress is not None:
                run.progress(done / count, kind)
    finally:
        parts.close()
    return RowResults(parts, sizes, empty)
