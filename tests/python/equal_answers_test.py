# SPDX-License-Identifier: BSD-3-Clause
"""A hundred thousand random answers are those of C++, bit for bit."""

import os
import subprocess

import numpy as np
import pytest
import spherule
from conftest import ARM, random_configurations, random_spheres

CONFIGURATIONS = 75000
POSES = 10000
CELL = """{"format":"spherule-scene","version":1,"obstacles":[
{"name":"floor","half_space":{},"pose":{"position":[0,0,-0.15]}},
{"name":"box","box":{"size":[0.2,0.3,0.4]},"pose":{"position":[0.45,0,0.6]}},
{"name":"rod","capsule":{"radius":0.03,"length":0.6},"pose":{"position":[-0.4,0.2,0.6]}}]}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory, cover):
    folder = tmp_path_factory.mktemp("answers")
    (folder / "arm.urdf").write_text(ARM)
    (folder / "cell.json").write_text(CELL)
    spherule.write_robot_spheres(cover.spheres, "json", folder / "spheres.json")
    return folder


@pytest.fixture(scope="module")
def asked(folder):
    """Writes what is queried, lets the program answer, and returns both sides' input."""
    robot = spherule.with_spheres(
        spherule.read_urdf(folder / "arm.urdf"), spherule.read_robot_spheres(folder / "spheres.json")
    )
    scene, _ = spherule.prepare_scene(robot, folder / "cell.json")
    configurations = random_configurations(robot, CONFIGURATIONS, 11)
    configurations.tofile(folder / "configurations")
    trees = [spherule.build_tree(random_spheres(40, seed, 2.0)) for seed in (1, 2)]
    for name, tree in zip("ab", trees):
        spherule.save_tree(tree, folder / f"{name}.tree")
    poses = np.random.default_rng(12).normal(size=(POSES, 7)) * ([4] * 3 + [1] * 4)
    poses.tofile(folder / "poses")
    subprocess.run([os.environ["SPHERULE_ANSWERS"], str(folder)], check=True)
    return scene.snapshot(), configurations, trees, poses


def read(folder, name, columns=1):
    return np.fromfile(folder / name).reshape(-1, columns).squeeze()


def test_configurations(folder, asked):
    checker, configurations, _, _ = asked
    free = read(folder, "free").astype(bool)
    assert len(free) == CONFIGURATIONS and 0.1 < free.mean() < 0.9
    assert np.array_equal(checker.check_configs(configurations), free)
    assert np.array_equal(checker.check_configs(configurations, threads=2), free)
    assert [checker.check_config(q) for q in configurations[:5000]] == free[:5000].tolist()


def test_edges_and_clearances(folder, asked):
    checker, configurations, _, _ = asked
    verdicts = read(folder, "verdicts")
    part = configurations[: len(verdicts) + 1]
    assert np.array_equal(checker.check_edges(part[:-1], part[1:]).verdict, verdicts)
    bounds = read(folder, "clearances", 2)
    assert np.array_equal(checker.clearances(configurations[: len(bounds)]), bounds)


def test_trees(folder, asked):
    _, _, (a, b), poses = asked
    answers = read(folder, "trees", 3)
    assert 0.1 < answers[:, 0].mean() < 0.9
    for row, (touches, lower, upper) in zip(poses, answers):
        pose = spherule.Pose(row[:3], row[3:])
        assert spherule.collides(a, None, b, pose) == touches
        found = spherule.distance(a, None, b, pose)
        assert (found.lower, found.upper) == (lower, upper)
