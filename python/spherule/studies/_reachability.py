# SPDX-License-Identifier: BSD-3-Clause
"""Reachability maps: process points x tool turns x postures."""

from dataclasses import dataclass
from typing import Any, Callable, List, Optional, Tuple, Union

import numpy as np

from .._arguments import Array, Path, Progress
from .._core import RobotChecker
from .._error import Error
from .._record import Bools, Floats, Ints, Record
from ._checks import CheckConfigs
from ._rows import Run, run_rows
from ._sources import ArrayRows, Identity, NpyRows, RowsLike, Source, digest_of, source_of

CELL = np.dtype([("found", np.int32), ("free", np.int32), ("posture", np.int32)])

Inverse = Callable[[Floats], Array]
"""Postures, shape (k, dof), that bring the tool to a pose of shape (4, 4); none: shape (0, dof)."""


@dataclass(frozen=True, repr=False, eq=False)
class Reachability(Record):
    """For every process point and tool turn, arrays of shape (points, turns)."""

    found: Ints
    """How many postures there are."""
    free: Ints
    """How many of them are free."""
    posture: Ints
    """Index of the first that is free; -1 where none is."""

    @property
    def reachable(self) -> Bools:
        """Which process points are reached with some turn of the tool, shape (points,)."""
        reachable: Bools = (self.free > 0).any(axis=1)
        return reachable


def turned(pose: Floats, angle: float) -> Floats:
    """The tool turned about its z axis."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    result: Floats = pose @ turn
    return result


@dataclass(frozen=True)
class MapPoints:
    """Process points to the cells of the map: rows of poses by an inverse, or of the postures."""

    checker: RobotChecker
    turns: Tuple[float, ...]
    inverse: Optional[Inverse]

    def postures(self, row: Floats) -> List[Floats]:
        """For every turn, shape (k, dof)."""
        dof = self.checker.dof
        if self.inverse is None:
            return list(row.reshape(len(self.turns), -1, dof))
        pose = row.reshape(4, 4)
        return [np.asarray(self.inverse(turned(pose, a)), dtype=np.float64).reshape(-1, dof) for a in self.turns]

    def __call__(self, rows: Floats, stopped: Callable[[], bool]) -> Any:
        cells = np.zeros((len(rows), len(self.turns)), dtype=CELL)
        cells["posture"] = -1
        lists = [postures for row in rows for postures in self.postures(row)]
        if not lists:
            return cells
        owner = np.repeat(np.arange(len(lists)), [len(postures) for postures in lists])
        index = np.concatenate([np.arange(len(postures)) for postures in lists])
        configurations = np.concatenate(lists)
        exists = ~np.isnan(configurations).any(axis=1)
        owner, index = owner[exists], index[exists]
        free = CheckConfigs(self.checker)(configurations[exists], stopped)
        flat = cells.reshape(-1)
        flat["found"] = np.bincount(owner, minlength=len(flat))
        flat["free"] = np.bincount(owner[free], minlength=len(flat))
        first = np.unique(owner[free], return_index=True)
        flat["posture"][first[0]] = index[free][first[1]]
        return cells


def reachability(
    checker: RobotChecker,
    points: Optional[RowsLike],
    postures: Union[Inverse, RowsLike],
    *,
    turns: Array = (0.0,),
    output: Optional[Path] = None,
    client: Any = None,
    threads: int = 0,
    chunk: int = 256,
    retries: int = 3,
    progress: Progress = None,
) -> Reachability:
    """Which process points the robot reaches without contact, with which turns of its tool.

    `points` are poses of the tool, shape (n, 4, 4), each taken with its z axis turned by every angle of
    `turns` (radians). `postures(pose)` is the robot's inverse kinematics: configurations of shape
    (k, dof) for a pose of shape (4, 4). Instead of it, an array or file of shape (n, turns, k, dof)
    has them, NaN where there is none; then `points` may be None. The rest is as in check_configs(), of
    `chunk` points at a time. Limits of joints count where the checker enforces them.
    """
    angles = tuple(np.asarray(turns, dtype=np.float64).reshape(-1).tolist())
    if not angles or not np.isfinite(angles).all():
        raise Error("turns", "are angles, at least one: without a turn it is (0.0,)")
    inverse = postures if callable(postures) else None
    if inverse is not None:
        if points is None:
            raise Error("points", "an inverse needs them")
        source = source_of(points, "points", 16)
        name = getattr(inverse, "__qualname__", type(inverse).__qualname__)
        options: Identity = {"turns": list(angles), "inverse": name}
        if source.shape[0] > 0:
            # Two inverses of one name differ here.
            first = MapPoints(checker, angles, inverse).postures(source.rows(0, 1)[0])
            options["first"] = digest_of(np.concatenate(first).tobytes())
    else:
        source = posture_source(postures, len(angles), checker.dof)
        options = {"turns": list(angles)}
    run = Run(output, client, threads, retries, progress)
    work = MapPoints(checker, angles, inverse)
    empty = np.zeros((0, len(angles)), dtype=CELL)
    cells = run_rows("reachability", checker, options, source, chunk, empty, work, run).array()
    return Reachability(*(np.ascontiguousarray(cells[name]) for name in CELL.names or ()))


def require_posture_shape(shape: Tuple[int, ...], turns: int, dof: int) -> None:
    if len(shape) != 4 or shape[1] != turns or shape[3] != dof:
        raise Error("postures", f"its shape is {shape}, (points, {turns}, postures, {dof}) is needed")


def posture_source(postures: Any, turns: int, dof: int) -> Source:
    source: Source
    if isinstance(postures, (list, tuple, np.ndarray)):
        array = np.asarray(postures, dtype=np.float64)
        require_posture_shape(array.shape, turns, dof)
        return ArrayRows(array.reshape(len(array), -1))
    source = source_of(postures, "postures", None)
    if isinstance(source, NpyRows):
        require_posture_shape(source.stored_shape, turns, dof)
    if source.shape[1] % (turns * dof) != 0:
        raise Error("postures", f"{source.shape[1]} numbers a point, a multiple of {turns * dof} is needed")
    return source
