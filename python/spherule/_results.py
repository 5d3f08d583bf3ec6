# SPDX-License-Identifier: BSD-3-Clause
"""What the functions return about meshes, spheres and queries.

Lengths are in the unit of the mesh or the trees. Arrays of spheres have shape (n, 4): x, y, z,
radius.
"""

import enum
from dataclasses import dataclass, field
from typing import Dict, NamedTuple, Optional, Tuple, Union


from ._core import ExternalSpheres, Pose
from ._record import Floats, Ints, Record

__all__ = [
    "Verdict",
    "Bounds",
    "MeshReport",
    "TreeReport",
    "CertificateRecord",
    "Certificate",
    "BodyRecord",
    "SphereFile",
    "CoverHistoryEntry",
    "SphereCover",
    "CoverLevel",
    "Simplification",
    "Repair",
    "CollisionResult",
    "DistanceResult",
    "SweepResult",
    "Contact",
    "SolidContact",
]

OptionValue = Union[bool, int, float, str]


class Verdict(enum.IntEnum):
    """What a query found; UNKNOWN where a limit ended it: to be taken for a collision."""

    FREE = 0
    COLLISION = 1
    UNKNOWN = 2


class Bounds(NamedTuple):
    """A stretch between two proved bounds."""

    lower: float
    upper: float


@dataclass(frozen=True, repr=False, eq=False)
class MeshReport(Record):
    """What is unusual about a mesh. `str()` of it is a few lines for a person."""

    vertices: int
    triangles: int
    degenerate_triangles: int
    duplicate_triangles: int
    boundary_edges: int
    non_manifold_edges: int
    misoriented_edges: int
    components: int
    inverted_components: int
    self_intersections: int
    self_intersections_stopped: bool
    """Whether counting stopped, so that there may be more."""
    closed: bool
    box: Floats
    """Low and high corner, shape (2, 3)."""
    area: float
    volume: float
    """Of the inside, whichever way triangles are turned."""
    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, repr=False, eq=False)
class TreeReport(Record):
    """What check() found. `problems` names the invariant and the node."""

    valid: bool
    problems: Tuple[str, ...]
    sphere_count: int
    node_count: int
    leaf_count: int
    depth: int
    branching: int
    root_radius: float
    mean_inflation: float
    """Mean over inner nodes of radius / largest child radius."""


@dataclass(frozen=True, repr=False, eq=False)
class CertificateRecord(Record):
    """What a certificate says, as stored beside the spheres."""

    covered: bool
    uncovered_depth_lower: float
    uncovered_depth_upper: float
    protrusion_over_simplified_max: Optional[float]
    protrusion_over_mesh_max: Optional[float]
    sphere_count: int
    volume_ratio: Optional[float]
    filled_volume: Optional[float]
    filled_volume_error: Optional[float]
    closing_slack: Optional[float]


@dataclass(frozen=True, repr=False, eq=False)
class Certificate(Record):
    """What is proved about a set of spheres, with outward rounding, on the numbers as given."""

    covered: bool
    """Proved: the mesh grown by the padding, and S (or the inside), lie in the spheres."""
    surface_depth: Bounds
    """Uncovered depth: the largest distance from a point of the surface to the spheres."""
    solid_depth: Bounds
    """The same of the solid."""
    uncovered_depth: Bounds
    """The larger of the two; `lower` is witnessed by a point, `upper` proved."""
    deepest_leak: Floats
    """The point that witnesses uncovered_depth.lower, if that is positive. Shape (3,)."""
    protrusion_over_simplified_max: Optional[float]
    """Proved upper bound of the protrusion over S; None without external spheres."""
    protrusion_in_zones: Tuple[float, ...]
    protrusion_over_mesh: Optional[Bounds]
    volume_ratio: Optional[float]
    filled_volume: Optional[float]
    filled_volume_error: Optional[float]
    closing_slack: Optional[float]
    sphere_count: int
    pieces: int
    cells: int
    record: CertificateRecord
    """The part that is stored beside the spheres."""


@dataclass(frozen=True, repr=False, eq=False)
class BodyRecord(Record):
    """One of several bodies in a file. Its spheres follow those of the bodies before it."""

    name: str
    sphere_count: int
    certificate: Optional[CertificateRecord] = None
    options: Dict[str, OptionValue] = field(default_factory=dict)
    copy_of: Optional[int] = None
    pose: Optional[Pose] = None
    interrupted: bool = False
    """The search for few spheres was interrupted: what is proved holds, of perhaps too many."""


@dataclass(frozen=True, repr=False, eq=False)
class SphereFile(Record):
    """The content of a SPHERES.json file."""

    spheres: Floats
    certificate: Optional[CertificateRecord] = None
    options: Dict[str, OptionValue] = field(default_factory=dict)
    """Those of the fit under their command-line names without dashes."""
    bodies: Tuple[BodyRecord, ...] = ()
    interrupted: bool = False
    """The search for few spheres of the body, or of one of the bodies, was interrupted."""


@dataclass(frozen=True, repr=False, eq=False)
class CoverHistoryEntry(Record):
    """One step of the paper's loop, for its figures 6 to 8."""

    sphere_count: int
    max_error_lower: float
    max_error_upper: float
    surface_error_before: float
    surface_error_after: float
    coverage_before: float
    coverage_after: float
    excess_before: float
    excess_after: float


@dataclass(frozen=True, repr=False, eq=False)
class SphereCover(Record):
    """Stage 2's result."""

    spheres: Floats
    lower_bound: int
    """No cover of S that protrudes by at most E has fewer spheres, as proved; 0: not known."""
    spheres_before_inflation: Floats
    inflation: float
    history: Tuple[CoverHistoryEntry, ...]
    seeds_rejected: int


@dataclass(frozen=True, repr=False, eq=False)
class CoverLevel(Record):
    """A coarser cover that was fitted to the solid and encloses a finer one."""

    max_error: float
    spheres: Floats
    parent_of: Ints
    """For every sphere of the next finer level the sphere that encloses it."""
    protrusion: float
    clustering_protrusion: float
    clustering_count: int


@dataclass(frozen=True, repr=False, eq=False)
class Simplification(Record):
    """What simplify() returns."""

    cover: SphereCover
    external: ExternalSpheres
    levels: Tuple[CoverLevel, ...]
    certificate: Certificate
    file: SphereFile
    """Spheres, certificate and options in one, for save_spheres()."""
    times: Dict[str, float]
    """Wall-clock seconds of the parts."""
    broken_promises: str
    """What was promised and is not proved, as a sentence; empty where all is proved."""
    larger_diameter: bool
    """D was left to be chosen, and is more than 4 E: the part is very large for its E."""

    @property
    def spheres(self) -> Floats:
        """The spheres of the cover, shape (n, 4)."""
        return self.cover.spheres

    @property
    def options(self) -> Dict[str, OptionValue]:
        """As used, under their command-line names."""
        return self.file.options


@dataclass(frozen=True, repr=False, eq=False)
class Repair(Record):
    """The spheres, repaired, and what that took."""

    spheres: Floats
    """Those of the input in their order; then those added."""
    inflated: int
    added: int
    max_error: float
    protrusion_before: float
    protrusion_after: float
    largest_inflation: float
    total_inflation: float


@dataclass(frozen=True, repr=False, eq=False)
class CollisionResult(Record):
    """What collide() found."""

    verdict: Verdict
    pairs: Ints
    """Indices of overlapping spheres of a and b, sorted, shape (n, 2)."""
    complete: bool
    distance_lower_bound: float
    node_tests: int
    leaf_tests: int


@dataclass(frozen=True, repr=False, eq=False)
class DistanceResult(Record):
    """What distance() found: bounds of the separation distance, both 0 where the bodies overlap."""

    lower: float
    upper: float
    nearest: Tuple[int, int]
    """The pair that gives `upper`: a sphere of a, and a sphere of b, a triangle, or 0."""
    node_tests: int
    leaf_tests: int


@dataclass(frozen=True, repr=False, eq=False)
class SweepResult(Record):
    """What is proved of a motion over t in [0, 1]."""

    verdict: Verdict
    free_until: float
    """If positive, every t up to it is proved free."""
    contact_at: float
    """A t at which contact is proved; infinite unless the verdict is COLLISION."""
    contact: Tuple[int, int]
    evaluations: int
    node_tests: int
    leaf_tests: int


@dataclass(frozen=True, repr=False, eq=False)
class Contact(Record):
    """One contact of two bodies."""

    kind: str
    """'spheres', 'triangles' or 'inside'."""
    spheres: Tuple[int, int]
    overlap_depth: float
    """At least this is missing for these two spheres to part."""
    world_point: Floats
    triangles: Optional[Tuple[int, int]]


@dataclass(frozen=True, repr=False, eq=False)
class SolidContact(Record):
    """Where a set of spheres touches a solid, and how deep."""

    sphere: int
    overlap_depth: float
    world_point: Floats


