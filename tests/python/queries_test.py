# SPDX-License-Identifier: BSD-3-Clause
"""Trees and queries of two bodies."""

import numpy as np
import pytest
import spherule
from conftest import random_spheres
from spherule import Pose, Verdict

A, B = random_spheres(80, 1, 3.0), random_spheres(50, 2, 3.0)


@pytest.fixture(scope="module")
def trees():
    return spherule.build_tree(A), spherule.build_tree(B)


def gaps(pose):
    """Of all pairs, by NumPy."""
    moved = B[:, :3] @ pose.matrix[:3, :3].T + pose.translation
    return np.linalg.norm(A[:, None, :3] - moved[None], axis=2) - A[:, None, 3] - B[None, :, 3]


def poses(count):
    rng = np.random.default_rng(3)
    return [Pose(rng.normal(size=3) * 6, rng.normal(size=4)) for _ in range(count)]


def test_pose():
    pose = Pose((1, 2, 3), (0, 0, 1, 1))
    assert np.allclose(pose * [1, 0, 0], [1, 3, 3])
    assert np.allclose((pose * pose.inverse()).matrix, np.eye(4))
    assert np.allclose(Pose.from_isometry(pose.matrix).matrix, pose.matrix)
    assert Pose.from_translation([1, 2, 3]) == Pose((1, 2, 3)) != pose
    assert pose.translation.tolist() == [1, 2, 3] and pose.rotation.tolist() == [0, 0, 1, 1]
    assert (pose @ np.zeros((5, 3))).shape == (5, 3)
    assert eval(repr(pose)) == pose


def test_trees_are_what_they_were_made_of(trees, tmp_path):
    tree, _ = trees
    assert tree.spheres.base is tree and np.array_equal(tree.spheres, A)
    assert not tree.spheres.flags.writeable
    assert tree.node_count == len(tree.radius) == len(tree.first_child) == len(tree.x)
    assert np.count_nonzero(tree.child_count == 0) == len(tree) == 80
    assert tree.level(0).shape == (1, 4) and len(tree.level(tree.depth)) == 80
    assert len(spherule.cut(tree, 10)) <= 10 and tree.branching <= 8
    assert np.all(tree.box[0] <= (A[:, :3] - A[:, 3:]).min(axis=0) + 1e-9)
    assert tree.reach >= np.linalg.norm(A[:, :3], axis=1).max() and tree.root[3] > 0
    path = tmp_path / "a.tree"
    spherule.save_tree(tree, path)
    assert spherule.load_tree(path) == tree
    assert spherule.refit(tree, A + [1, 0, 0, 0]).spheres[0, 0] == A[0, 0] + 1
    assert spherule.check(tree).valid and "80 spheres" in repr(tree)


def test_queries_agree_with_all_pairs(trees):
    a, b = trees
    for pose in poses(300):
        gap = gaps(pose)
        assert spherule.collides(a, None, b, pose) == (gap.min() <= 0)
        found = spherule.collide(a, None, b, pose)
        assert {tuple(p) for p in found.pairs.tolist()} == set(zip(*np.nonzero(gap <= 0)))
        distance = spherule.distance(a, None, b, pose)
        assert distance.lower - 1e-9 <= max(gap.min(), 0) <= distance.upper + 1e-9
        assert spherule.within(a, None, b, pose, 1.0) == (gap.min() <= 1)
        contact = spherule.deepest_contact(a, None, b, pose)
        assert (contact is None) == (gap.min() > 0)
        if contact is not None:
            assert contact.overlap_depth == pytest.approx(-gap.min()) and contact.kind == "spheres"
    assert 0 <= spherule.collision_slack(a, None, b, None) < 1e-9


def test_limits(trees):
    a, b = trees
    assert len(spherule.collide(a, None, b, None, max_pairs=1).pairs) == 1
    ended = spherule.collide(a, None, b, Pose((20, 0, 0)), max_node_tests=0)
    assert ended.verdict in (Verdict.UNKNOWN, Verdict.FREE)
    assert spherule.distance(a, None, b, Pose((50, 0, 0)), enough=1.0).lower > 1.0


def test_solids(trees, cube, fit):
    a, _ = trees
    solid = spherule.SolidMesh(cube)
    assert solid.is_closed and solid.has_inside and solid.inflation == 0
    away, near = Pose((30, 0, 0)), Pose((0, 0, 0))
    for body in (solid, spherule.Box((1, 1, 1)), spherule.SolidSphere(1), spherule.Cylinder(1, 2), spherule.Capsule(1, 2)):
        assert spherule.collides(a, None, body, near) and not spherule.collides(a, None, body, away)
        assert spherule.distance(a, None, body, away).lower > 10
        assert spherule.within(a, None, body, away, 100.0)
        assert spherule.deepest_contact(a, None, body, near).sphere >= 0
    assert spherule.collides(a, None, spherule.HalfSpace(), None)
    assert spherule.within(solid, None, solid, Pose((1.5, 0, 0)), 0.6)
    assert not spherule.within(solid, None, spherule.Box((1, 1, 1)), Pose((2, 0.5, 0.5)), 0.4)


def test_covered_meshes_are_exact(cube, fit):
    covered = spherule.CoveredMesh(cube, spherule.sphere_tree(fit))
    assert covered.is_closed and "12 triangles" in repr(covered)
    assert spherule.collides(covered, None, covered, Pose((0.99, 0, 0)))
    assert not spherule.collides(covered, None, covered, Pose((1.01, 0, 0)))
    assert spherule.collides(covered.cover, None, covered.cover, Pose((1.01, 0, 0)))
    assert spherule.deepest_contact(covered, None, covered, Pose((0.99, 0, 0))).kind == "triangles"


def test_sweeps(trees):
    a, b = trees
    start, end = Pose((30, 0, 0)), Pose((-30, 0, 0))
    motion = spherule.Motion.between(start, end)
    through = spherule.sweep(a, spherule.Motion.still(None), b, motion)
    assert through.verdict == Verdict.COLLISION and 0 < through.free_until < through.contact_at < 1
    assert spherule.collides(a, None, b, motion.pose_at(through.contact_at))
    turn = spherule.Motion.turning(start, (0, 0, 1), 3.0, displacement=(0, 1, 0))
    assert spherule.sweep(a, spherule.Motion.still(None), b, turn).verdict == Verdict.FREE
    assert turn.angle == 3.0 and turn.axis.tolist() == [0, 0, 1] and turn.start == start
    assert turn.displacement.tolist() == [0, 1, 0]
