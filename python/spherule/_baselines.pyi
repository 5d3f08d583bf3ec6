# SPDX-License-Identifier: BSD-3-Clause
# The types of the methods of comparison; their docstrings say what is meant.

from typing import Sequence, Tuple

from ._arguments import Array, MeshLike, Progress
from ._core import SphereTree, TriangleMesh
from ._record import Floats
from ._results import Bounds

def voxelise(
    mesh: MeshLike,
    *,
    step: float = ...,
    max_error: float = ...,
    sphere: str = ...,
    filling: str = ...,
    padding: float = ...,
) -> Floats: ...
def pack_spheres(
    mesh: MeshLike,
    *,
    max_error: float,
    padding: float = ...,
    seed: int = ...,
    threads: int = ...,
    progress: Progress = ...,
) -> Tuple[Floats, Floats]: ...
def level_set_packing(
    mesh: MeshLike, *, step: float, min_radius: float = ..., max_spheres: int = ..., threads: int = ...
) -> Floats: ...
def medial_axis(
    mesh: MeshLike,
    *,
    spheres: int = ...,
    max_protrusion: float = ...,
    reduction: str = ...,
    seed: int = ...,
    threads: int = ...,
) -> Floats: ...
def octree_spheres(
    mesh: MeshLike, *, depth: int = ..., max_error: float = ..., filling: str = ..., padding: float = ...
) -> SphereTree: ...
def hubbard_spheres(
    mesh: MeshLike, *, counts: Sequence[int] = ..., seed: int = ..., threads: int = ...
) -> Tuple[Floats, ...]: ...
def made_conservative(
    mesh: MeshLike, spheres: Array, *, padding: float = ..., threads: int = ..., progress: Progress = ...
) -> Floats: ...
def convex_hull(mesh: MeshLike, *, padding: float = ...) -> TriangleMesh: ...
def decimate(mesh: MeshLike, *, target_triangles: int, max_error: float = ...) -> TriangleMesh: ...
def decompose(
    mesh: MeshLike, *, max_concavity: float = ..., min_parts: int = ...
) -> Tuple[TriangleMesh, ...]: ...
def measure_deviation(
    original: MeshLike, other: MeshLike, *, tolerance: float = ...
) -> Tuple[Bounds, Bounds]: ...
