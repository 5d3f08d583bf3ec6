# SPDX-License-Identifier: BSD-3-Clause
"""What the functions return and take about robots. Metres and radians.

Spheres of links are in the frame of their link, arrays of shape (n, 4): x, y, z, radius.
"""

from dataclasses import dataclass, field
from typing import Dict, Mapping, Optional, Tuple, Union

from ._core import Pose, SphereTree
from ._record import Bools, Floats, Ints, Record
from ._results import Bounds, Certificate, Repair, Simplification, Verdict
from ._shapes import Primitive, Zone

__all__ = [
    "Joint",
    "Link",
    "MeshFile",
    "LinkShape",
    "LinkDescription",
    "DisabledPair",
    "JointGroup",
    "GroupState",
    "EndEffector",
    "SemanticDescription",
    "RobotSpheres",
    "LinkCoverOptions",
    "LinkCover",
    "RobotCover",
    "LinkAudit",
    "ConfigurationAudit",
    "RobotAudit",
    "LinkRepair",
    "RobotRepair",
    "LinkPair",
    "EdgeResult",
    "EdgeResults",
    "CheckedBody",
    "CheckedContact",
    "RobotClearance",
]


@dataclass(frozen=True, repr=False, eq=False)
class Joint(Record):
    """A joint between a parent link and its child.

    The child's frame is `parent_from_joint`, then the motion about or along `axis`. The position is
    multiplier * variable + offset, of the variable of a configuration that moves it.
    """

    name: str = ""
    type: str = "fixed"
    """'fixed', 'revolute', 'prismatic' or 'continuous'."""
    parent_from_joint: Pose = field(default_factory=Pose)
    axis: Tuple[float, float, float] = (0.0, 0.0, 1.0)
    lower: float = 0.0
    upper: float = 0.0
    parent_link: str = ""
    child_link: str = ""
    variable: int = -1
    """Index into a configuration; -1 if fixed."""
    multiplier: float = 1.0
    offset: float = 0.0
    mimics: str = ""
    """The joint that it was told to follow; empty if none."""


@dataclass(frozen=True, repr=False, eq=False)
class Link(Record):
    """A link with the sphere trees that are attached to it, in its frame."""

    name: str
    parent_joint: str
    """Empty for the root, and for a joint without a name."""
    trees: Tuple[SphereTree, ...]


@dataclass(frozen=True)
class MeshFile:
    """A mesh in a file: times `scale`, coordinate by coordinate, it is in metres."""

    path: str
    scale: Tuple[float, float, float] = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class LinkShape:
    """A shape that is rigidly attached to a link."""

    name: str
    link_from_shape: Pose
    geometry: Union[MeshFile, Primitive]


@dataclass(frozen=True)
class LinkDescription:
    """What a link looks like and what stands for it in collision checks."""

    name: str
    visual: Tuple[LinkShape, ...] = ()
    collision: Tuple[LinkShape, ...] = ()


@dataclass(frozen=True)
class DisabledPair:
    """Two links that are not tested against each other, and why; empty if no reason is given."""

    link_a: str
    link_b: str
    reason: str = ""


@dataclass(frozen=True)
class JointGroup:
    """A named set of joints; `chains` are pairs of a base link and a tip link."""

    name: str
    links: Tuple[str, ...] = ()
    joints: Tuple[str, ...] = ()
    chains: Tuple[Tuple[str, str], ...] = ()
    subgroups: Tuple[str, ...] = ()


@dataclass(frozen=True)
class GroupState:
    """A named configuration of a group: positions by joint."""

    name: str
    group: str
    joints: Mapping[str, Tuple[float, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class EndEffector:
    """A tool of the robot."""

    name: str
    group: str
    parent_link: str
    parent_group: str = ""


@dataclass(frozen=True, repr=False, eq=False)
class SemanticDescription(Record):
    """What an SRDF says of a robot."""

    robot_name: str
    groups: Tuple[JointGroup, ...] = ()
    group_states: Tuple[GroupState, ...] = ()
    end_effectors: Tuple[EndEffector, ...] = ()
    disabled_pairs: Tuple[DisabledPair, ...] = ()
    """Those that are listed; AllowedCollisions.apply() knows the others, too."""
    sphere_approximations: Dict[str, Floats] = field(default_factory=dict)
    links_disabled_by_default: Tuple[str, ...] = ()
    enabled_pairs: Tuple[Tuple[str, str], ...] = ()
    warnings: Tuple[str, ...] = ()


@dataclass(frozen=True, repr=False, eq=False)
class RobotSpheres(Record):
    """The spheres of a robot, and what the formats of other tools say beside them."""

    links: Dict[str, Floats]
    """Spheres by link; none for a link that is stated to have none."""
    robot: str = ""
    self_collision_ignore: Tuple[DisabledPair, ...] = ()
    self_collision_buffer: Dict[str, float] = field(default_factory=dict)
    collision_buffer: float = 0.0
    collision_buffers: Dict[str, float] = field(default_factory=dict)
    switched_off: int = 0
    other_shapes: int = 0
    format: str = ""
    """What the file was found to be; empty if there was none."""
    interrupted: bool = False
    """The search for few spheres was interrupted (in files of spherule's own format)."""

    @property
    def count(self) -> int:
        """How many spheres there are."""
        return sum(len(spheres) for spheres in self.links.values())


@dataclass(frozen=True, repr=False, eq=False)
class LinkCoverOptions(Record):
    """What is other for one link than for the rest; None: as for the rest."""

    max_error: Optional[float] = None
    min_external_diameter: Optional[float] = None
    padding: Optional[float] = None
    zones: Tuple[Zone, ...] = ()


@dataclass(frozen=True, repr=False, eq=False)
class LinkCover(Record):
    """One link's cover and what is proved of it."""

    link: str
    spheres: Floats
    fit: Optional[Simplification]
    """Of the fit and the proof; None for a link without geometry."""
    triangles: int
    vertex_error: float
    seconds: float
    warnings: Tuple[str, ...]


@dataclass(frozen=True, repr=False, eq=False)
class RobotCover(Record):
    """A robot's links with their spheres."""

    robot: str
    links: Tuple[LinkCover, ...]
    links_not_proved: Tuple[str, ...]
    """Those for which not everything promised is proved."""
    spheres: RobotSpheres
    """As with_spheres() and write_robot_spheres() take them."""


@dataclass(frozen=True, repr=False, eq=False)
class LinkAudit(Record):
    """What is proved of a link's spheres against its own mesh."""

    link: str
    spheres: int
    certificate: Optional[Certificate]
    uncovered_share: float
    """Share of the surface that no sphere holds, estimated."""
    warnings: Tuple[str, ...]


@dataclass(frozen=True, repr=False, eq=False)
class ConfigurationAudit(Record):
    """The deepest leak of the robot in a configuration, all spheres of all links counted."""

    uncovered_depth: Bounds
    deepest_link: str
    deepest_leak: Optional[Floats] = None
    """A point of that link that leaks so deep, in the frame of the root."""


@dataclass(frozen=True, repr=False, eq=False)
class RobotAudit(Record):
    """What is proved of a robot's spheres."""

    links: Tuple[LinkAudit, ...]
    configurations: Tuple[ConfigurationAudit, ...]
    unknown_links: Tuple[str, ...]
    links_covered: bool
    configurations_covered: bool


@dataclass(frozen=True, repr=False, eq=False)
class LinkRepair(Record):
    """The repair of one link's spheres."""

    link: str
    repair: Repair
    certificate: Certificate
    warnings: Tuple[str, ...]


@dataclass(frozen=True, repr=False, eq=False)
class RobotRepair(Record):
    """A robot's spheres, repaired."""

    spheres: Dict[str, Floats]
    links: Tuple[LinkRepair, ...]


@dataclass(frozen=True, repr=False, eq=False)
class LinkPair(Record):
    """What is proved of two links, wherever the limits let the joints be."""

    first: str
    second: str
    verdict: str
    """'never', 'touching' or 'unknown'."""
    witness: Floats
    """A configuration in which they touch; empty unless they do."""
    smallest_gap: float
    """An upper bound, in metres; infinite where none was searched, as for 'never'."""
    free_share: float
    """Proved free, of the volume of the joints' ranges."""


@dataclass(frozen=True, repr=False, eq=False)
class EdgeResult(Record):
    """What is proved of a straight motion in joint space."""

    verdict: Verdict
    free_until: float
    """Every point of the motion before this fraction is proved free."""
    contact_at: float
    configurations: int
    """How many were evaluated."""


@dataclass(frozen=True, repr=False, eq=False)
class EdgeResults(Record):
    """The same of many, as arrays of shape (n,). `verdict` compares with Verdict."""

    verdict: Ints
    free_until: Floats
    contact_at: Floats

    @property
    def free(self) -> Bools:
        """Which are proved free at every point."""
        result: Bools = self.verdict == Verdict.FREE
        return result


@dataclass(frozen=True, repr=False, eq=False)
class CheckedBody(Record):
    """One side of a pair that is tested."""

    kind: str
    """'link', 'attached' or 'obstacle'."""
    name: str
    tree: int
    sphere: int
    """Index into the tree's spheres; -1 for a mesh or a primitive."""


@dataclass(frozen=True, repr=False, eq=False)
class CheckedContact(Record):
    """Two bodies, or a body and an obstacle, that touch."""

    first: CheckedBody
    second: CheckedBody
    overlap_depth: float
    padding: float
    world_point: Floats
    is_proved_free: bool


@dataclass(frozen=True, repr=False, eq=False)
class RobotClearance(Record):
    """How far a robot is from the nearest contact, between two bounds."""

    lower: float
    upper: float
    first: CheckedBody
    second: CheckedBody
