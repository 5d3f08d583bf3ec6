# SPDX-License-Identifier: BSD-3-Clause
"""Everything goes to other processes and comes back the same."""

import concurrent.futures
import copy
import multiprocessing
import pickle

import numpy as np
import pytest
import spherule
from conftest import random_configurations, random_spheres


def again(thing):
    return pickle.loads(pickle.dumps(thing))


def test_values(cube, fit):
    pose = spherule.Pose((1, 2, 3), (0.1, 0.2, 0.3, 2.0))
    assert again(pose) == pose
    assert np.array_equal(again(cube).vertices, cube.vertices)
    assert again(fit) == fit and again(fit.external) == fit.external
    tree = spherule.build_tree(random_spheres(100, 1))
    assert again(tree) == tree and copy.deepcopy(tree) == tree
    solid = again(spherule.SolidMesh(cube))
    assert solid.is_closed and solid.has_inside
    covered = again(spherule.CoveredMesh(cube, spherule.sphere_tree(fit)))
    assert covered.cover == spherule.sphere_tree(fit)
    assert again(spherule.Box((1, 2, 3))) == spherule.Box((1, 2, 3))
    error = again(spherule.Error("what", "why"))
    assert error.subject == "what" and str(error) == "what: why"


def test_motions():
    for motion in (
        spherule.Motion.still(spherule.Pose((1, 0, 0))),
        spherule.Motion.between(spherule.Pose(), spherule.Pose((1, 0, 0), (0, 0, 1, 1)), (1, 2, 3)),
        spherule.Motion.turning(None, (1, 1, 0), 2.0, (0, 0, 1)),
    ):
        assert again(motion).pose_at(0.37) == motion.pose_at(0.37)


def test_robots_bit_for_bit(description, robot, cover):
    assert again(cover) == cover
    copied = again(robot)
    assert again(description).links == description.links
    for mine, theirs in zip(robot.joints, copied.joints):
        assert mine == theirs
    for mine, theirs in zip(robot.links, copied.links):
        assert mine == theirs
    q = [0.3, 0.7, -0.2, 0.01]
    assert spherule.forward_kinematics(copied, q) == spherule.forward_kinematics(robot, q)


def test_proofs_and_allowed_pairs(description, robot):
    pairs = spherule.prove_link_pairs(description, boxes=50, undecided_boxes=50, samples=5)
    assert again(pairs).pairs(robot) == pairs.pairs(robot)
    scene = spherule.RobotScene(again(robot))
    scene.set_link_pairs(again(pairs))
    allowed = spherule.AllowedCollisions(robot)
    allowed.allow("base", "hand")
    allowed.forbid("base", "upper")
    assert again(allowed).pairs() == allowed.pairs()


def test_scenes_and_checkers_answer_alike(scene, checker, robot):
    configurations = random_configurations(robot, 2000, 4)
    free = checker.check_configs(configurations)
    copied = again(scene)
    assert copied.obstacles == scene.obstacles and copied.attached == scene.attached
    assert np.array_equal(copied.snapshot().check_configs(configurations), free)
    assert np.array_equal(again(checker).check_configs(configurations), free)
    assert np.array_equal(again(checker).clearances(configurations), checker.clearances(configurations))
    confined = again(scene.snapshot(enforce_limits=True, instructions="portable"))
    assert not confined.check_config([0, 0, 0, 1.0])


def test_confirmed_checkers_keep_their_meshes(cube, fit):
    tree = spherule.sphere_tree(fit)
    robot = spherule.RobotModel()
    robot.add_link("car", "base_link", spherule.Joint("x", "prismatic", axis=(1, 0, 0), lower=-9.0, upper=9.0))
    robot.attach("car", tree)
    scene = spherule.RobotScene(robot)
    scene.add("other", tree)
    mesh = spherule.CoveredMesh(cube, tree)
    for meshes in ([mesh], iter([mesh])):
        exact = again(scene.snapshot(meshes=meshes))
        assert exact.check_config([1.01]) and not exact.check_config([0.99])


def answers(checker, configurations):
    return checker.check_configs(configurations)


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_between_processes(checker, robot, method):
    parts = np.array_split(random_configurations(robot, 3000, 6), 2)
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        found = list(pool.map(answers, [checker] * 2, parts))
    for part, free in zip(parts, found):
        assert np.array_equal(free, checker.check_configs(part))
