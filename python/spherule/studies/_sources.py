# SPDX-License-Identifier: BSD-3-Clause
"""Where the rows of a study come from: an array, a file, or a generator with a seed."""

import hashlib
import importlib
import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Dict, Optional, Protocol, Sequence, Tuple, Union

import numpy as np

from .._arguments import Array, Robot
from .._core import RobotDescription
from .._error import Error
from .._record import Floats

Identity = Dict[str, Any]
"""What tells one source, or one study, from another; fit for JSON."""


class Source(Protocol):
    """Rows of equal width. `stays`: they are in this process and have to be sent to others."""

    @property
    def stays(self) -> bool: ...

    @property
    def shape(self) -> Tuple[int, int]: ...

    def rows(self, first: int, count: int) -> Floats: ...

    def identity(self) -> Identity: ...


def digest_of(data: Any) -> str:
    """Of bytes or of an array whose rows lie one behind the other."""
    return hashlib.sha256(data).hexdigest()


def file_identity(path: Path) -> Identity:
    status = path.stat()
    return {"file": str(path.resolve()), "bytes": status.st_size, "modified": status.st_mtime_ns}


def as_table(array: Any, name: str) -> Any:
    """Of shape (n, ...): the rows flat, without a copy where that can be."""
    if array.ndim < 2:
        raise Error(name, f"its shape is {array.shape}: it has no rows")
    return array.reshape(array.shape[0], math.prod(array.shape[1:]))


@dataclass(frozen=True)
class ArrayRows:
    """Rows of an array in memory."""

    array: Floats
    stays = True

    @property
    def shape(self) -> Tuple[int, int]:
        return self.array.shape[0], self.array.shape[1]

    def rows(self, first: int, count: int) -> Floats:
        return self.array[first : first + count]

    def identity(self) -> Identity:
        return {"array": digest_of(np.ascontiguousarray(self.array)), "shape": list(self.shape)}


@dataclass(frozen=True)
class FileRows:
    """Rows of a file, which whoever needs them reads: it lies where all see it."""

    path: Path
    stays = False

    def identity(self) -> Identity:
        return file_identity(self.path)


class NpyRows(FileRows):
    """Of an NPY file, mapped into memory."""

    def mapped(self) -> Any:
        try:
            array = np.load(self.path, mmap_mode="r")
        except FileNotFoundError:
            raise
        except (OSError, ValueError) as error:
            raise Error(str(self.path), f"no array that can be mapped: {error}") from error
        if not isinstance(array, np.ndarray) or array.dtype.kind not in "biuf":
            raise Error(str(self.path), "no array of real numbers")
        return array

    def table(self) -> Any:
        return as_table(self.mapped(), str(self.path))

    @property
    def stored_shape(self) -> Tuple[int, ...]:
        shape: Tuple[int, ...] = self.mapped().shape
        return shape

    @property
    def shape(self) -> Tuple[int, int]:
        rows, columns = self.table().shape
        return rows, columns

    def rows(self, first: int, count: int) -> Floats:
        return np.array(self.table()[first : first + count], dtype=np.float64)


class ParquetRows(FileRows):
    """Of a Parquet file, a column a joint, read a row group at a time by pyarrow."""

    def file(self) -> Any:
        try:
            parquet = importlib.import_module("pyarrow.parquet")
        except ImportError as error:
            raise Error(str(self.path), "Parquet files are read by pyarrow, which is not installed") from error
        return parquet.ParquetFile(str(self.path))

    @property
    def shape(self) -> Tuple[int, int]:
        metadata = self.file().metadata
        return int(metadata.num_rows), int(metadata.num_columns)

    def rows(self, first: int, count: int) -> Floats:
        file = self.file()
        pieces, start = [], 0
        for group in range(file.metadata.num_row_groups):
            size = file.metadata.row_group(group).num_rows
            low, high = max(first - start, 0), min(first + count - start, size)
            if low < high:
                columns = file.read_row_group(group).columns
                pieces.append(np.column_stack([np.asarray(c)[low:high] for c in columns]))
            start += size
        rows: Floats = np.concatenate(pieces).astype(np.float64, copy=False)
        return rows


@dataclass(frozen=True)
class GeneratedRows:
    """Rows that `make(rng, count)` returns, of shape (count, columns).

    They are made in blocks of `block` rows, block i with numpy.random.default_rng([seed, i]): row by
    row they depend on `seed` and `block` alone. On other processes `make` has to be importable.
    """

    make: Callable[[np.random.Generator, int], Array]
    count: int
    seed: int
    block: int = 1 << 16
    stays = False

    def __post_init__(self) -> None:
        if self.count < 0 or self.block < 1:
            raise Error("count" if self.count < 0 else "block", "must not be so small")

    def made(self, index: int, count: int) -> Floats:
        """The first rows of a block as `make` returns them when so many are wanted."""
        rows = np.asarray(self.make(np.random.default_rng([self.seed, index]), count), dtype=np.float64)
        if rows.shape[:1] != (count,):
            raise Error("make", f"its shape is {rows.shape}, {count} rows were to be made")
        table: Floats = as_table(rows, "make")
        return table

    def block_rows(self, index: int) -> Floats:
        """Those of a block; the last one may have fewer."""
        return self.made(index, self.block)[: self.count - index * self.block]

    @property
    def shape(self) -> Tuple[int, int]:
        """Rows, and numbers a row."""
        return self.count, self.made(0, 1).shape[1]

    def rows(self, first: int, count: int) -> Floats:
        """`count` rows from `first` on."""
        blocks = range(first // self.block, (first + count - 1) // self.block + 1)
        made = np.concatenate([self.block_rows(i) for i in blocks])
        start = first - blocks[0] * self.block
        return made[start : start + count]

    def identity(self) -> Identity:
        """What tells it from others: by name, numbers and the first block."""
        name = getattr(self.make, "__qualname__", type(self.make).__qualname__)
        sample = digest_of(np.ascontiguousarray(self.block_rows(0))) if self.count > 0 else ""
        return {"generator": name, "seed": self.seed, "count": self.count, "block": self.block, "first": sample}


@dataclass(frozen=True)
class Uniform:
    """Makes configurations that are uniform between two bounds."""

    lower: Tuple[float, ...]
    upper: Tuple[float, ...]

    def __call__(self, rng: np.random.Generator, count: int) -> Floats:
        rows = rng.random((count, len(self.lower)))
        rows *= np.subtract(self.upper, self.lower)
        rows += self.lower
        return np.minimum(rows, self.upper, out=rows)  # rounding may lead beyond


def uniform_configurations(robot: Robot, count: int, *, seed: int) -> GeneratedRows:
    """Random configurations, uniform between the limits of the joints; those without limits turn
    between -pi and pi."""
    model = robot.model if isinstance(robot, RobotDescription) else robot
    lower, upper = np.array(model.limits, dtype=np.float64).reshape(-1, 2).T
    free = ~(np.isfinite(lower) & np.isfinite(upper)) | (lower >= upper)
    lower, upper = np.where(free, -np.pi, lower), np.where(free, np.pi, upper)
    return GeneratedRows(Uniform(tuple(lower.tolist()), tuple(upper.tolist())), count, seed)


RowsLike = Union[Array, str, "os.PathLike[str]", GeneratedRows]


def source_of(rows: RowsLike, name: str, width: Optional[int]) -> Source:
    """What a study is given, `width` numbers a row (None: any); `name` is that of the argument."""
    source: Union[GeneratedRows, NpyRows, ParquetRows, ArrayRows]
    if isinstance(rows, GeneratedRows):
        source = rows
    elif isinstance(rows, (str, os.PathLike)):
        path = Path(rows)
        if not path.exists():
            raise Error(str(path), "no such file")
        is_parquet = path.suffix.lower() in (".parquet", ".pq")
        source = ParquetRows(path) if is_parquet else NpyRows(path)
    else:
        source = ArrayRows(as_table(np.asarray(rows, dtype=np.float64), name))
    if width is not None and source.shape[1] != width and source.shape[0] > 0:
        raise Error(name, f"{source.shape[1]} numbers a row, {width} are needed")
    return source


@dataclass(frozen=True)
class Beside:
    """The rows of several sources, one beside the other."""

    sources: Sequence[Source]

    @property
    def stays(self) -> bool:
        return any(source.stays for source in self.sources)

    @property
    def shape(self) -> Tuple[int, int]:
        return self.sources[0].shape[0], sum(source.shape[1] for source in self.sources)

    def rows(self, first: int, count: int) -> Floats:
        return np.concatenate([source.rows(first, count) for source in self.sources], axis=1)

    def identity(self) -> Identity:
        return {"beside": [source.identity() for source in self.sources]}
