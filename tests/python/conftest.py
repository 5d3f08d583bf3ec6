# SPDX-License-Identifier: BSD-3-Clause
"""Shapes, a small robot and its scene, as ctest runs the tests: PYTHONPATH leads to the built package."""

import numpy as np
import pytest
import spherule

ARM = """<?xml version="1.0"?>
<robot name="arm">
  <link name="base"><collision><geometry><cylinder radius="0.08" length="0.2"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.1 0.1 0.4"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="0 0 0.15"/><geometry><box size="0.08 0.08 0.3"/></geometry></collision></link>
  <link name="hand"><collision><origin xyz="0 0 0.06"/><geometry><sphere radius="0.06"/></geometry></collision></link>
  <link name="left"><collision><geometry><box size="0.02 0.02 0.06"/></geometry></collision></link>
  <link name="right"><collision><geometry><box size="0.02 0.02 0.06"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.15"/><axis xyz="0 0 1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0 0 0.42"/><axis xyz="0.3 1 0.1"/><limit lower="-2.5" upper="2.5" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="revolute"><parent link="fore"/><child link="hand"/><origin xyz="0 0 0.32"/><axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="grip" type="prismatic"><parent link="hand"/><child link="left"/><origin xyz="0 0.02 0.14"/><axis xyz="0 1 0"/><limit lower="0" upper="0.04" effort="1" velocity="1"/></joint>
  <joint name="other" type="prismatic"><parent link="hand"/><child link="right"/><origin xyz="0 -0.02 0.14"/><axis xyz="0 -1 0"/><limit lower="0" upper="0.04" effort="1" velocity="1"/><mimic joint="grip"/></joint>
</robot>
"""


def make_cube(side: float = 1.0) -> spherule.TriangleMesh:
    """A closed cube with a corner in the origin."""
    corners = [[x, y, z] for x in (0, side) for y in (0, side) for z in (0, side)]
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = [t for a, b, c, d in sides for t in ([a, b, c], [a, c, d])]
    return spherule.TriangleMesh(np.array(corners, dtype=float), np.array(triangles))


def random_spheres(count: int, seed: int, spread: float = 10.0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.uniform(-spread, spread, (count, 3)), rng.uniform(0.1, 1.0, count)])


def random_configurations(robot: spherule.RobotModel, count: int, seed: int) -> np.ndarray:
    lower, upper = robot.limits.T
    return np.random.default_rng(seed).uniform(lower, upper, (count, robot.variable_count))


@pytest.fixture(scope="session")
def cube() -> spherule.TriangleMesh:
    return make_cube()


@pytest.fixture(scope="session")
def fit(cube: spherule.TriangleMesh) -> spherule.Simplification:
    return spherule.simplify(cube, max_error=0.2, levels=[0.2, 0.6], effort=0)


@pytest.fixture(scope="session")
def urdf(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("arm") / "arm.urdf"
    path.write_text(ARM)
    return str(path)


@pytest.fixture(scope="session")
def description(urdf: str) -> spherule.RobotDescription:
    return spherule.read_urdf(urdf)


@pytest.fixture(scope="session")
def cover(description: spherule.RobotDescription) -> spherule.RobotCover:
    return spherule.cover_robot(description, max_error=0.03, effort=0)


@pytest.fixture(scope="session")
def robot(
    description: spherule.RobotDescription, cover: spherule.RobotCover
) -> spherule.RobotModel:
    return spherule.with_spheres(description, cover.spheres)


@pytest.fixture(scope="session")
def scene(robot: spherule.RobotModel) -> spherule.RobotScene:
    """Obstacles of every kind, an attached tool, padding and a contact that is allowed."""
    scene = spherule.RobotScene(robot, spherule.Pose((0.0, 0.0, 0.1)))
    scene.add("floor", spherule.HalfSpace(), spherule.Pose((0.0, 0.0, -0.05)))
    scene.add("box", spherule.Box((0.2, 0.3, 0.4)), spherule.Pose((0.45, 0.0, 0.6)))
    scene.add("cloud", spherule.build_tree(random_spheres(60, 5, 0.2) * [1, 1, 1, 0.05] + [-0.5, 0.3, 0.7, 0]))
    scene.add("part", make_cube(0.25), spherule.Pose((-0.2, -0.6, 0.5)))
    tool = spherule.build_tree([[0, 0, 0, 0.02], [0, 0, 0.03, 0.015]])
    scene.attach("tool", "hand", tool, spherule.Pose((0.0, 0.0, 0.2)))
    scene.set_padding("fore", 0.01)
    scene.set_padding("tool", 0.02, other="box")
    scene.define_region("upper", "low", [0.0, 0.0, 0.0, 0.15])
    scene.allow_contact("upper", "floor", region="low")
    scene.allow_contact("tool", "hand")
    return scene


@pytest.fixture(scope="session")
def checker(scene: spherule.RobotScene) -> spherule.RobotChecker:
    return scene.snapshot()
