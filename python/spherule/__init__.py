# SPDX-License-Identifier: BSD-3-Clause
"""Spheres that provably cover meshes and robots, and collision checks on them.

Spheres are float64 arrays of shape (n, 4): x, y, z, radius. Poses are Pose, or matrices of shape
(4, 4). Lengths are in the unit of the mesh; robots are in metres and radians. Input that cannot be
used raises Error, a ValueError; what is of a wrong type TypeError.
"""

from . import _core
from ._core import *
from ._error import Error as Error
from ._functions import *
from ._results import *
from ._robots import *
from ._shapes import *
from ._version import VERSION

__version__: str = VERSION

for _name, _thing in list(vars().items()):
    if getattr(_thing, "__module__", "").startswith("spherule._"):
        _thing.__module__ = "spherule"
del _name, _thing, VERSION
