# SPDX-License-Identifier: BSD-3-Clause
"""Solids of a few numbers, and zones."""

from dataclasses import dataclass
from typing import Optional, Tuple, Union

__all__ = [
    "Box",
    "SolidSphere",
    "Cylinder",
    "Capsule",
    "HalfSpace",
    "ZoneSphere",
    "ZoneBox",
    "ZoneCapsule",
    "Zone",
    "Primitive",
]

Triple = Tuple[float, float, float]


@dataclass(frozen=True)
class Box:
    """The points with |x_i| <= size_i / 2: full edge lengths, as in URDF."""

    size: Triple


@dataclass(frozen=True)
class SolidSphere:
    """The points within `radius` of the origin."""

    radius: float


@dataclass(frozen=True)
class Cylinder:
    """Along z: x^2 + y^2 <= radius^2 and |z| <= length / 2."""

    radius: float
    length: float


@dataclass(frozen=True)
class Capsule:
    """The points within `radius` of the segment |z| <= length / 2 of the axis."""

    radius: float
    length: float


@dataclass(frozen=True)
class HalfSpace:
    """The points with z <= 0."""


Primitive = Union[Box, SolidSphere, Cylinder, Capsule, HalfSpace]


@dataclass(frozen=True)
class ZoneSphere:
    """All points within `radius` of `center`."""

    center: Triple
    radius: float


@dataclass(frozen=True)
class ZoneBox:
    """An axis-aligned box."""

    min: Triple
    max: Triple


@dataclass(frozen=True)
class ZoneCapsule:
    """All points within `radius` of the segment between two points."""

    start: Triple
    end: Triple
    radius: float


@dataclass(frozen=True)
class Zone:
    """A part of space in which E or D is smaller than elsewhere.

    Every point of the union of the spheres that lies in the zone is at most `max_error` from S; a
    sphere of diameter `min_external_diameter` is small enough to be external where its centre lies in
    the zone. None: as elsewhere.
    """

    shape: Union[ZoneSphere, ZoneBox, ZoneCapsule]
    max_error: Optional[float] = None
    min_external_diameter: Optional[float] = None
