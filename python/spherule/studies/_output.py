# SPDX-License-Identifier: BSD-3-Clause
"""Where the results of a study are kept: in memory, or in a folder from which a run goes on."""

import fcntl
import json
import os
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Protocol, Set

import numpy as np

from .._arguments import Path as PathLike
from .._error import Error
from ._sources import Identity

STUDY_FILE = "study.json"


def write_whole(path: Path, write: Callable[[Any], object]) -> None:
    """Writes a file beside its place, has it stored and renames it: it is there whole or not at all."""
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        with open(beside, "wb") as file:
            write(file)
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, path)
    except BaseException:
        beside.unlink(missing_ok=True)
        raise


def plain(identity: Identity) -> Identity:
    """As it comes back from its file: lists for tuples, Python's numbers for NumPy's."""

    def number(value: Any) -> Any:
        if isinstance(value, np.generic):
            return value.item()
        raise TypeError(f"{type(value).__name__} is no number")

    result: Identity = json.loads(json.dumps(identity, default=number))
    return result


class StudyFolder:
    """A folder that one study uses at a time, with what tells it from another in `study.json`."""

    def __init__(self, path: PathLike) -> None:
        self.path = Path(path)
        self.path.mkdir(parents=True, exist_ok=True)
        self.lock = os.open(self.path, os.O_RDONLY | os.O_DIRECTORY)
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(self.lock)
            raise Error(str(self.path), "another run is writing there") from None
        for left in self.path.glob(".*.[0-9]*"):  # of runs that were killed while they wrote
            if left.name.startswith((".part-", f".{STUDY_FILE}.")):
                left.unlink()

    def close(self) -> None:
        os.close(self.lock)

    def stored(self) -> Optional[Identity]:
        """Of the study that is there."""
        path = self.path / STUDY_FILE
        if not path.exists():
            return None
        try:
            identity = json.loads(path.read_text())
        except ValueError:
            identity = None
        if not isinstance(identity, dict):
            raise Error(str(path), "no file of a study")
        return identity

    def store(self, identity: Identity) -> None:
        text = json.dumps(identity, indent=1, sort_keys=True) + "\n"
        write_whole(self.path / STUDY_FILE, lambda file: file.write(text.encode()))

    def require_same(self, identity: Identity, among: Set[str]) -> None:
        """Throws Error unless the study that is there, if any, agrees in the keys `among`."""
        stored = self.stored()
        if stored is None:
            return
        for key in sorted(among):
            if stored.get(key) != identity.get(key):
                raise Error(
                    str(self.path),
                    f"holds another study: {key} is {stored.get(key)} there and {identity.get(key)} here",
                )


class Parts(Protocol):
    """Results by the index of their chunk."""

    def present(self, sizes: List[int], empty: Any) -> Set[int]: ...

    def put(self, index: int, part: Any) -> None: ...

    def get(self, index: int) -> Any: ...

    def close(self) -> None: ...


class PartsInMemory:
    """Gone with the process."""

    def __init__(self) -> None:
        self.parts: Dict[int, Any] = {}

    def present(self, sizes: List[int], empty: Any) -> Set[int]:
        return set()

    def put(self, index: int, part: Any) -> None:
        self.parts[index] = part

    def get(self, index: int) -> Any:
        return self.parts[index]

    def close(self) -> None:
        pass


class PartsInFolder:
    """An NPY file for each chunk."""

    def __init__(self, path: PathLike, identity: Identity) -> None:
        self.folder = StudyFolder(path)
        try:
            if self.folder.stored() is None and any(self.folder.path.glob("part-*.npy")):
                raise Error(str(path), f"has parts of a study, but no {STUDY_FILE} that says of which")
            identity = plain(identity)
            self.folder.require_same(identity, set(identity))
            self.folder.store(identity)
        except BaseException:
            self.folder.close()
            raise

    def file(self, index: int) -> Path:
        return self.folder.path / f"part-{index:08}.npy"

    def present(self, sizes: List[int], empty: Any) -> Set[int]:
        """Those of the right shape and type; others, cut by a failing disk, are made again."""
        return {index for index, size in enumerate(sizes) if self.is_whole(index, size, empty)}

    def is_whole(self, index: int, size: int, empty: Any) -> bool:
        try:
            part = self.get(index)
        except (OSError, ValueError, EOFError):
            return False
        return part.dtype == empty.dtype and part.shape == (size, *empty.shape[1:])

    def put(self, index: int, part: Any) -> None:
        write_whole(self.file(index), lambda file: np.save(file, part))

    def get(self, index: int) -> Any:
        return np.load(self.file(index), mmap_mode="r")

    def close(self) -> None:
        self.folder.close()


def parts_in(output: Optional[PathLike], identity: Callable[[], Identity]) -> Parts:
    if output is None:
        return PartsInMemory()
    return PartsInFolder(output, identity())
