# SPDX-License-Identifier: BSD-3-Clause
"""What arguments may be, for type checkers."""

import os
from typing import TYPE_CHECKING, Any, Callable, Mapping, Optional, Protocol, Union

import numpy.typing as npt

if TYPE_CHECKING:
    from ._core import CoveredMesh, Pose, RobotDescription, RobotModel, SolidMesh, SphereTree, TriangleMesh
    from ._robots import RobotSpheres
    from ._shapes import Primitive


class HasFaces(Protocol):
    """A mesh of another package, as trimesh has them: shapes (n, 3) and (m, 3)."""

    @property
    def vertices(self) -> Any: ...

    @property
    def faces(self) -> Any: ...


Array = npt.ArrayLike
Path = Union[str, "os.PathLike[str]"]
MeshLike = Union["TriangleMesh", HasFaces, Path]
PoseLike = Union["Pose", npt.ArrayLike, None]
Body = Union["SphereTree", "SolidMesh", "CoveredMesh", "Primitive"]
Robot = Union["RobotModel", "RobotDescription"]
SpheresByLink = Union["RobotSpheres", Mapping[str, npt.ArrayLike]]
Progress = Optional[Callable[[Optional[float], str], object]]
"""Called with the share that is done, None where it is not known, and a word on what is being done."""
