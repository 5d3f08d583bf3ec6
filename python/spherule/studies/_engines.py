# SPDX-License-Identifier: BSD-3-Clause
"""Runs tasks on threads of this machine or on the workers of a Dask client."""

import asyncio
import contextlib
import importlib
import os
import threading
import time
from collections import deque
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from itertools import chain
from typing import Any, Callable, Dict, Generic, Iterable, Iterator, List, Optional, Tuple, TypeVar

from .._error import Error

Input = TypeVar("Input")
Result = TypeVar("Result")
Stopped = Callable[[], bool]
Work = Callable[[Input, Stopped], Result]
"""Makes a result of an input; may look whether it is still wanted."""


@dataclass(frozen=True)
class Task(Generic[Input]):
    """A piece of a study."""

    index: int
    take: Callable[[], Input]
    """Makes or reads the input: on the worker, unless it `stays` where the study was started."""
    stays: bool


LOST = (CancelledError, asyncio.CancelledError)
"""What Dask raises where data went with a worker."""


PATIENCE = 60.0
"""Seconds without a result after which it is looked where tasks are."""

SETTLING = 0.5
"""Seconds until a scheduler knows of a worker that died."""


class Ended(Exception):
    """Raised by work that is no longer wanted."""


def never() -> bool:
    return False


class Retries:
    """Counts the failures of each task, and raises the one that is too many.

    What is wrong with the input is so again: that is not tried twice.
    """

    def __init__(self, most: int) -> None:
        self.most = most
        self.failures: Dict[int, int] = {}

    def note(self, task: int, error: BaseException) -> None:
        count = self.failures[task] = self.failures.get(task, 0) + 1
        if count > self.most or isinstance(error, (Error, TypeError)):
            raise error


def check_counts(*, threads: int, retries: int) -> None:
    for name, value in (("threads", threads), ("retries", retries)):
        if value < 0:
            raise Error(name, f"{value}: it is a count, at least 0")


def default_threads(threads: int) -> int:
    return threads if threads > 0 else len(os.sched_getaffinity(0))


def run_on_threads(
    work: "Work[Input, Result]", tasks: Iterable["Task[Input]"], threads: int, retries: int
) -> Iterator[Tuple[int, Result]]:
    """Yields what `work` makes of each, as it is ready; few more than `threads` are under way."""
    stop = threading.Event()
    failures = Retries(retries)
    waiting: "Iterator[Task[Input]]" = iter(tasks)
    again: "deque[Task[Input]]" = deque()
    pool = ThreadPoolExecutor(threads, thread_name_prefix="spherule")
    running: "Dict[Future[Result], Task[Input]]" = {}

    def run(task: "Task[Input]") -> Result:
        return work(task.take(), stop.is_set)

    try:
        while True:
            while len(running) < 2 * threads:
                found = next(chain(popped(again), waiting), None)
                if found is None:
                    break
                running[pool.submit(run, found)] = found
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                task = running.pop(future)
                error = future.exception()
                if error is None:
                    yield task.index, future.result()
                else:
                    failures.note(task.index, error)
                    again.append(task)
    finally:
        stop.set()
        pool.shutdown(wait=False, cancel_futures=True)


def popped(queue: "deque[Task[Input]]") -> "Iterator[Task[Input]]":
    while queue:
        yield queue.popleft()


def work_on(work: "Work[Input, Result]", take: Callable[[], Input]) -> Result:
    """What a Dask worker does with an input that it makes itself."""
    return work(take(), never)


def work_on_sent(work: "Work[Input, Result]", sent: Input) -> Result:
    return work(sent, never)


class DaskRun(Generic[Input, Result]):
    """Tasks on a client. Dask itself moves those of a worker that dies to another one; what was sent
    there and is lost with it is sent again, which counts as a retry."""

    def __init__(self, client: Any, work: "Work[Input, Result]", retries: int) -> None:
        self.distributed = importlib.import_module("distributed")
        self.client = client
        self.work = work
        self.failures = Retries(retries)
        self.running: "Dict[Any, Task[Input]]" = {}
        self.sent_work: Any = None

    def slots(self) -> int:
        """How many tasks are kept with the scheduler: workers may come and go."""
        threads: Dict[str, int] = self.client.nthreads()
        return 2 * max(1, sum(threads.values()))

    def submit(self, task: "Task[Input]") -> Any:
        if self.sent_work is None or self.sent_work.status != "finished":
            self.sent_work = self.client.scatter(self.work, broadcast=True, hash=False)
        options = {"pure": False, "retries": 0}
        if task.stays:
            sent = self.client.scatter(task.take(), hash=False)
            future = self.client.submit(work_on_sent, self.sent_work, sent, **options)
        else:
            future = self.client.submit(work_on, self.sent_work, task.take, **options)
        return future

    def place(self, task: "Task[Input]") -> None:
        """Submits it, again where a worker dies of which the scheduler does not know yet."""
        while True:
            try:
                future = self.submit(task)
            except (OSError, *LOST) as error:
                self.note(task, error)
                time.sleep(SETTLING)
            else:
                self.running[future] = task
                return

    def note(self, task: "Task[Input]", error: BaseException) -> None:
        self.failures.note(task.index, error)
        if isinstance(error, (OSError, *LOST)):
            self.sent_work = None

    def finished(self) -> List[Any]:
        """Futures that are no longer pending, of which it waits for one."""
        with contextlib.suppress(TimeoutError, asyncio.TimeoutError, *LOST):
            self.distributed.wait(list(self.running), timeout=PATIENCE, return_when="FIRST_COMPLETED")
        found = [future for future in self.running if future.status != "pending"]
        if not found:
            self.place_again_what_no_worker_has()
        return found

    def place_again_what_no_worker_has(self) -> None:
        """Schedulers were seen to forget tasks of workers that died."""
        held = {key for keys in self.client.processing().values() for key in keys}
        for future in [future for future in self.running if future.key not in held]:
            task = self.running.pop(future)
            self.client.cancel([future])
            self.sent_work = None
            self.place(task)

    def results(self, tasks: Iterable["Task[Input]"]) -> Iterator[Tuple[int, Result]]:
        waiting = iter(tasks)
        try:
            while True:
                while len(self.running) < self.slots():
                    task = next(waiting, None)
                    if task is None:
                        break
                    self.place(task)
                if not self.running:
                    return
                for future in self.finished():
                    task = self.running.pop(future)
                    try:
                        result = future.result()
                    except (Exception, *LOST) as error:
                        self.note(task, error)
                        self.place(task)
                    else:
                        yield task.index, result
        finally:
            self.client.cancel(list(self.running))


def run_tasks(
    work: "Work[Input, Result]",
    tasks: Iterable["Task[Input]"],
    *,
    client: Any,
    threads: int,
    retries: int,
) -> Iterator[Tuple[int, Result]]:
    """Yields index and result of each task, in the order in which they are ready."""
    if client is None:
        return run_on_threads(work, tasks, default_threads(threads), retries)
    return DaskRun(client, work, retries).results(tasks)
