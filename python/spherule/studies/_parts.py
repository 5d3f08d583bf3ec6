# SPDX-License-Identifier: BSD-3-Clause
"""Covers of many parts."""

import dataclasses
import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, Mapping, Optional, Tuple, Union

import numpy as np

from .._arguments import MeshLike, Progress
from .._arguments import Path as PathLike
from .._core import TriangleMesh, load_spheres, read_mesh, save_spheres
from .._error import Error
from .._functions import simplify
from .._record import Record
from .._results import SphereFile
from .._version import VERSION
from ._engines import Ended, Task, check_counts, default_threads, run_tasks
from ._output import StudyFolder, plain
from ._sources import Identity, digest_of, file_identity

ENDING = ".json"
KEYS = {"format", "version", "spherule", "kind", "options"}
"""In which a folder has to agree; parts may come and change."""


@dataclass(frozen=True, repr=False, eq=False)
class PartCover(Record):
    """The cover of one part, or why there is none."""

    name: str
    file: Optional[SphereFile]
    """Spheres, certificate and options, as load_spheres() returns them; None where `error` says why."""
    error: str = ""

    @property
    def covered(self) -> bool:
        """Whether the part is proved to be covered."""
        return self.file is not None and self.file.certificate is not None and self.file.certificate.covered


@dataclass(frozen=True)
class CoverPart:
    """A mesh to its cover. Bad input is a result: one bad part ends no study of ten thousand."""

    options: Mapping[str, Any]
    scale: float

    def __call__(self, mesh: MeshLike, stopped: Callable[[], bool]) -> Union[SphereFile, str]:
        def look(share: Optional[float], what: str) -> None:
            if stopped():
                raise Ended

        try:
            if isinstance(mesh, (str, os.PathLike)):
                mesh = read_mesh(mesh, scale=self.scale)
            file = simplify(mesh, progress=look, **self.options).file
        except Error as error:
            return str(error)
        return dataclasses.replace(file, options={**file.options, "scale": self.scale})


def named(parts: Union[Mapping[str, MeshLike], Iterable[PathLike]]) -> Dict[str, MeshLike]:
    """Parts by name: files by theirs without the ending."""
    if isinstance(parts, Mapping):
        result = dict(parts)
    else:
        result = {}
        for path in parts:
            name = Path(path).stem
            if name in result:
                raise Error(str(path), f"another part is named {name}, too: give a dict of names")
            result[name] = path
    for name in result:
        if not name or "/" in name or name.startswith(".") or name == "study":
            raise Error("parts", f"{name!r} is no name of a file")
    return result


def identity_of(mesh: MeshLike) -> Identity:
    if isinstance(mesh, (str, os.PathLike)):
        path = Path(mesh)
        return file_identity(path) if path.exists() else {"file": str(path)}
    if not isinstance(mesh, TriangleMesh):
        mesh = TriangleMesh(mesh.vertices, mesh.faces)
    arrays = mesh.vertices.tobytes() + mesh.triangles.tobytes() + np.float64(mesh.vertex_error).tobytes()
    return {"mesh": digest_of(arrays)}


def file_if_whole(path: Path) -> Optional[SphereFile]:
    """None for one that was cut by a failing disk."""
    try:
        return load_spheres(path)
    except Error:
        return None


class Covers:
    """The covers that are made, in memory and, where there is one, in a folder."""

    def __init__(self, output: Optional[PathLike], options: Mapping[str, Any], meshes: Mapping[str, MeshLike]) -> None:
        self.found: Dict[str, PartCover] = {}
        self.folder = None if output is None else StudyFolder(output)
        if self.folder is None:
            return
        try:
            identity = {
                "format": "spherule-study", "version": 1, "spherule": VERSION, "kind": "parts",
                "options": {name: repr(value) for name, value in options.items()},
                "parts": {name: identity_of(mesh) for name, mesh in meshes.items()},
            }  # fmt: skip
            identity = plain(identity)
            self.folder.require_same(identity, KEYS)
            self.take_over(self.folder, identity)
        except BaseException:
            self.folder.close()
            raise

    def take_over(self, folder: StudyFolder, identity: Identity) -> None:
        """Finds what is there of parts that are as they were, and says of which parts the rest will be."""
        known = (folder.stored() or {}).get("parts", {})
        for name, part in identity["parts"].items():
            path = folder.path / (name + ENDING)
            if not path.exists():
                continue
            if name not in known:
                raise Error(str(path), "is there, and not of this study: it would be overwritten")
            file = file_if_whole(path) if known[name] == part else None
            if file is not None:
                self.found[name] = PartCover(name, file)
            else:
                path.unlink()
        folder.store({**identity, "parts": {**known, **identity["parts"]}})

    def put(self, name: str, result: Union[SphereFile, str]) -> None:
        if isinstance(result, str):
            self.found[name] = PartCover(name, None, result)
            return
        if self.folder is not None:
            save_spheres(result, self.folder.path / (name + ENDING))
        self.found[name] = PartCover(name, result)

    def close(self) -> None:
        if self.folder is not None:
            self.folder.close()


def give(mesh: MeshLike) -> MeshLike:
    return mesh


def task_of(index: int, mesh: MeshLike) -> "Task[MeshLike]":
    """Files are read by the worker, meshes are sent."""
    is_file = isinstance(mesh, (str, os.PathLike))
    return Task(index, partial(give, str(mesh) if is_file else mesh), not is_file)


def cover_parts(
    parts: Union[Mapping[str, MeshLike], Iterable[PathLike]],
    *,
    scale: float = 1.0,
    output: Optional[PathLike] = None,
    client: Any = None,
    threads: int = 0,
    retries: int = 3,
    progress: Progress = None,
    **options: Any,
) -> Dict[str, PartCover]:
    """Covers many parts, each as simplify() does with `options`: by name, a PartCover.

    `parts` are files, named as they are without the ending, or meshes or files by name; numbers in
    files are multiplied by `scale`. `output` is a folder for a spheres file each, NAME.json: a run
    that was ended goes on from what is there, and parts that came or changed since are made. A part
    that cannot be used has an `error` and is tried again by the next run. Works on `threads` of this
    machine (0: all), or on the workers of `client`, a dask.distributed Client, where files have to
    be found under the same name. A part that fails otherwise is tried `retries` more times.
    """
    check_counts(threads=threads, retries=retries)
    meshes = named(parts)
    covers = Covers(output, {"scale": scale, **options}, meshes)
    try:
        names = list(meshes)
        waiting = [i for i, name in enumerate(names) if name not in covers.found]
        workers = default_threads(threads)
        each = 1 if client is not None else max(1, workers // max(1, len(waiting)))
        work = CoverPart({"threads": each, **options}, scale)
        tasks = (task_of(index, meshes[names[index]]) for index in waiting)
        for index, result in run_tasks(work, tasks, client=client, threads=workers, retries=retries):
            covers.put(names[index], result)
            if progress is not None:
                progress(len(covers.found) / len(names), names[index])
    finally:
        covers.close()
    return {name: covers.found[name] for name in names}
