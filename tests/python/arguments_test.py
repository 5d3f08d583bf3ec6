# SPDX-License-Identifier: BSD-3-Clause
"""What cannot be used is refused, and the message names it."""

import os
from types import SimpleNamespace

import numpy as np
import pytest
import spherule
from conftest import make_cube, random_spheres

TREE = spherule.build_tree(random_spheres(5, 1))
CUBE = make_cube()


def level_with(parent):
    """A sphere, and a level of one that holds it, whose number the parent is meant to be."""
    sphere = np.array([[0.0, 0.0, 0.0, 1.0]])
    return sphere, [SimpleNamespace(spheres=2 * sphere, parent_of=np.array([parent]))]


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: spherule.build_tree(np.zeros((3, 3))), r"spheres: .*\(3, 3\), not \(n, 4\)"),
        (lambda: spherule.build_tree(np.zeros((2, 3, 4))), r"spheres: .*\(2, 3, 4\)"),
        (lambda: spherule.build_tree(np.zeros((0, 4))), "sphere"),
        (lambda: spherule.build_tree([[0, 0, np.nan, 1]]), "sphere 0"),
        (lambda: spherule.build_tree([[0, 0, np.inf, 1]]), "sphere 0"),
        (lambda: spherule.build_tree([[0, 0, 0, -1]]), "sphere 0"),
        (lambda: spherule.TriangleMesh([[0, 0, 0]], [[0, 0, 1]]), "mesh"),
        (lambda: spherule.TriangleMesh([[0, 0]], [[0, 0, 0]]), r"vertices: .*\(1, 2\)"),
        (lambda: spherule.TriangleMesh([[0, 0, 0]], [[0, 0]]), r"triangles: .*\(1, 2\)"),
        (lambda: spherule.TriangleMesh([[0, 0, 0]], [[0, 0, -1]]), "triangles: row 0"),
        (lambda: spherule.TriangleMesh([[0, 0, 0]], [[0, 0, 2**40]]), "triangles: row 0"),
        (lambda: spherule.Pose((1, 2)), r"translation: .*\(2,\), not \(3,\)"),
        (lambda: spherule.Pose((1, 2, np.nan)), "pose"),
        (lambda: spherule.Pose(rotation=(0, 0, 0, 0)), "pose"),
        (lambda: spherule.collides(TREE, np.eye(3), TREE, None), r"world_from_a: .*\(3, 3\)"),
        (lambda: spherule.collides(TREE, None, TREE, np.ones((4, 4))), "world_from_b"),
        (lambda: spherule.simplify(CUBE, max_error=-1.0), "max error"),
        (lambda: spherule.simplify(CUBE, method="best"), "method: .*cover, paper"),
        (lambda: spherule.certify(CUBE, np.zeros((4, 5))), r"spheres: .*\(4, 5\)"),
        (lambda: spherule.read_mesh("no such file.stl"), "no such file.stl"),
        (lambda: spherule.load_tree("no such.tree"), "no such.tree"),
        (lambda: spherule.build_tree(np.ma.masked_equal([[0, 0, 0, 1.0], [0, 0, 0, 9.0]], 9.0)), "spheres: .*masked"),
        (lambda: spherule.spheres_of(np.zeros((2, 3)), [1.0]), r"radii: .*\(1,\), not \(2,\)"),
        (lambda: spherule.spheres_of(np.zeros((2, 4)), [1.0, 1.0]), r"centers: .*\(2, 4\), not \(n, 3\)"),
        (lambda: TREE.level(99), "level"),
        (lambda: spherule.mesh_distance(CUBE, [[0, 0, 0], [0, np.nan, 0]]), "points: row 1"),
        (lambda: spherule.mesh_distance(CUBE, [[1e300, 0, 0]]), "points: row 0"),
        (lambda: spherule.simplify(CUBE, threads=2**31), "threads: 2147483648 is out of range"),
        (lambda: spherule.simplify(CUBE, seed=-1), "seed: -1 is out of range"),
        (lambda: spherule.build_tree_from_levels(*level_with(2**32)), "parent_of: row 0"),
        (lambda: spherule.sweep(TREE, spherule.Motion.still(None), TREE, spherule.Motion.still(None), resolution=-1.0), "resolution"),
    ],
)
def test_bad_values(call, text):
    with pytest.raises(spherule.Error, match=text) as caught:
        call()
    assert isinstance(caught.value, ValueError)
    assert str(caught.value) == f"{caught.value.subject}: {caught.value.reason}"


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: spherule.build_tree("spheres"), "spheres"),
        (lambda: spherule.build_tree(np.zeros((2, 4), complex)), "spheres: .*complex128"),
        (lambda: spherule.build_tree(np.array([[None] * 4])), "spheres: .*object"),
        (lambda: spherule.build_tree(np.zeros((2, 4), bool)), "spheres: .*bool, not float64"),
        (lambda: spherule.spheres_of(["abc"], [1.0]), "centers: "),
        (lambda: spherule.TriangleMesh([[0.0, 0, 0]], [[0.5, 0, 0]]), "triangles: .* is float64, not that of whole numbers"),
        (lambda: spherule.simplify(3), "mesh"),
        (lambda: spherule.simplify(CUBE, max_error="thin"), "max_error"),
        (lambda: spherule.simplify(CUBE, no_such_option=1), "no_such_option"),
        (lambda: spherule.collides(TREE, None, CUBE, None), "b: "),
        (lambda: spherule.collide(TREE, None, TREE, None, max_pairs=1.5), "max_pairs"),
        (lambda: spherule.read_mesh(3), "path"),
        (lambda: spherule.with_spheres(TREE, {}), "robot"),
        (lambda: spherule.repair(CUBE, None, np.zeros((1, 4))), "external"),
        (lambda: spherule.simplify(CUBE, zones=[1]), "zones"),
        (lambda: spherule.simplify(CUBE, zones=[spherule.Zone(spherule.ZoneSphere((0, 0, 0), "a"))]), "radius"),
        (lambda: spherule.simplify(CUBE, zones=[spherule.Zone(spherule.ZoneSphere((0, 0, 0), 1.0), "a")]), "max_error"),
        (lambda: spherule.collides(TREE, None, spherule.SolidSphere("a"), None), "radius"),
        (lambda: spherule.RobotModel().add_link("a", "base_link", spherule.Joint("j", "revolute", lower="a")), "lower"),
        (lambda: spherule.build_tree_from_levels(*level_with(0.7)), "parent_of: .*float64"),
        (lambda: spherule.RobotScene(spherule.RobotModel()).add("wall", 3), "shape: .* Box, .* TriangleMesh"),
    ],
)
def test_wrong_types(call, text):
    with pytest.raises(TypeError, match=text):
        call()


def test_configurations(checker, robot):
    good = np.zeros(checker.dof)
    with pytest.raises(spherule.Error, match=r"configuration: .*\(3,\), not \(4,\)"):
        checker.check_config(good[:3])
    with pytest.raises(spherule.Error, match=r"configurations: .*\(2, 3\), not \(n, 4\)"):
        checker.check_configs(np.zeros((2, 3)))
    with pytest.raises(spherule.Error, match=r"end: "):
        checker.check_edges(np.zeros((2, 4)), np.zeros((3, 4)))
    with pytest.raises(spherule.Error, match="finite"):
        checker.check_config(good + np.nan)
    with pytest.raises(spherule.Error, match="finite"):
        checker.check_configs(np.full((2, 4), np.inf))
    with pytest.raises(TypeError, match="configuration"):
        checker.check_config(["a"] * 4)
    with pytest.raises(spherule.Error, match="resolution"):
        checker.check_edge(good, good, resolution=0.0)
    with pytest.raises(spherule.Error, match="continuous"):
        checker.check_edge(good, good, continuous="around")
    with pytest.raises(spherule.Error, match="floor"):
        spherule.RobotScene(robot).remove("floor")


def test_other_layouts_are_converted(checker):
    good = np.random.default_rng(1).uniform(-1, 1, (40, 2 * checker.dof))
    strided = good[::2, :: 2]
    plain = checker.check_configs(np.ascontiguousarray(strided))
    assert np.array_equal(checker.check_configs(strided), plain)
    assert np.array_equal(checker.check_configs(np.asfortranarray(strided)), plain)
    assert np.array_equal(checker.check_configs(strided.astype(">f8")), plain)
    assert np.array_equal(checker.check_configs(strided.tolist()), plain)
    single = strided.astype(np.float32)
    assert np.array_equal(checker.check_configs(single), checker.check_configs(single.astype(float)))
    assert checker.check_configs(np.zeros((0, checker.dof))).shape == (0,)


def test_robots_that_do_not_move():
    """One answer for each row, though a row has no numbers."""
    robot = spherule.RobotModel()
    robot.attach("base_link", TREE)
    scene = spherule.RobotScene(robot)
    scene.add("other", TREE)
    checker = scene.snapshot()
    rows = np.zeros((3, 0))
    assert not checker.check_config([])
    assert checker.check_configs(rows).tolist() == [False] * 3
    assert checker.clearances(rows).tolist() == [[0.0, 0.0]] * 3
    edges = checker.check_edges(rows, rows)
    assert edges.free.tolist() == [False] * 3 and edges.verdict[0] == checker.check_edge([], []).verdict
    with pytest.raises(spherule.Error, match="end: "):
        checker.check_edges(rows, rows[1:])
    scene.remove("other")
    assert scene.snapshot().check_edges(rows, rows, threads=2).free.tolist() == [True] * 3


def test_more_threads_than_are_of_use(checker):
    configurations = np.random.default_rng(2).uniform(-1, 1, (40, checker.dof))
    free = checker.check_configs(configurations)
    assert np.array_equal(checker.check_configs(configurations, threads=2**31 - 1), free)
    assert spherule.simplify(CUBE, max_error=0.3, effort=0, threads=2**31 - 1).certificate.covered


def test_paths_are_whole(tmp_path):
    """What stands behind a null character is not left out of a name."""
    path = tmp_path / "five.tree"
    spherule.save_tree(TREE, path)
    for call in (spherule.load_tree, lambda name: spherule.save_tree(TREE, name), spherule.read_mesh):
        with pytest.raises(ValueError, match="null"):
            call(str(path) + "\0.tree")


def test_paths_need_not_be_utf_8(tmp_path):
    folder = os.fsencode(tmp_path)
    path = os.fsdecode(folder + b"/\xff.tree")
    spherule.save_tree(TREE, path)
    assert os.listdir(folder) == [b"\xff.tree"]
    assert spherule.load_tree(path) == TREE and spherule.load_tree(os.fsencode(path)) == TREE
    with pytest.raises(spherule.Error, match="fe"):
        spherule.load_tree(os.fsdecode(folder + b"/\xfe.tree"))
