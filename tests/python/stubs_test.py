# SPDX-License-Identifier: BSD-3-Clause
"""The stubs are those of the module, and a checker accepts a program that uses it."""

import importlib.util
import inspect
import os
import pathlib
import pickle
import subprocess
import sys

import pytest
import spherule
from spherule import studies

PROGRAM = """
import numpy as np
import numpy.typing as npt
import spherule
from spherule import studies

mesh = spherule.read_mesh("part.stl", scale=1000.0)
fit = spherule.simplify(mesh, max_error=1.0, progress=lambda share, what: print(share, what))
spheres: npt.NDArray[np.float64] = fit.spheres
tree: spherule.SphereTree = spherule.sphere_tree(fit)
hit: bool = spherule.collides(tree, None, spherule.Box((1.0, 1.0, 1.0)), np.eye(4))
robot = spherule.read_urdf("robot.urdf")
cover = spherule.cover_robot(robot, max_error=0.02)
scene = spherule.RobotScene(spherule.with_spheres(robot, cover.spheres))
scene.add("table", spherule.Box((1.0, 1.0, 0.1)), spherule.Pose((0.0, 0.0, -0.1)))
free: npt.NDArray[np.bool_] = scene.snapshot().check_configs(np.zeros((10, 6)))
edges = scene.snapshot().check_edges(np.zeros((9, 6)), np.zeros((9, 6)))
share: float = edges.free_until.min()
study = studies.check_configs(scene.snapshot(), studies.uniform_configurations(robot, 10, seed=1), threads=2)
count: int = study.free_count
motions: spherule.EdgeResults = studies.check_edges(scene.snapshot(), (np.zeros((9, 6)), "ends.npy")).results
reached: npt.NDArray[np.bool_] = studies.reachability(scene.snapshot(), None, np.zeros((9, 2, 4, 6)), turns=[0, 1]).reachable
covers = studies.cover_parts(["a.stl"], max_error=1.0, progress=lambda share, what: None)
"""
WRONG = 'import spherule\nspherule.build_tree(3, branching="wide")\n'

needs_mypy = pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is missing")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """With the cache of mypy, so that it reads NumPy's types once."""
    return tmp_path_factory.mktemp("types")


def run_mypy(folder, text):
    (folder / "program.py").write_text(text)
    environment = dict(os.environ, MYPYPATH=os.environ["PYTHONPATH"])
    environment.pop("PYTHONWARNINGS", None)
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", "cache", "program.py"]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


@needs_mypy
def test_a_checker_accepts_a_program(folder):
    found = run_mypy(folder, PROGRAM)
    assert found.returncode == 0, found.stdout


@needs_mypy
def test_and_refuses_a_wrong_one(folder):
    found = run_mypy(folder, WRONG)
    assert found.returncode == 1 and "branching" in found.stdout


@needs_mypy
def test_stubs_equal_the_module(tmp_path):
    environment = dict(os.environ)
    environment.pop("PYTHONWARNINGS", None)
    found = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "--concise", "--ignore-missing-stub", "spherule._core"],
        cwd=tmp_path, env=environment, capture_output=True, text=True,
    )  # fmt: skip
    problems = [line for line in found.stdout.splitlines() if is_a_problem(line)]
    assert not problems, "\n".join(problems)


def is_a_problem(line):
    """Metaclasses, and makers of what functions make, are pybind11's own."""
    own = ("metaclass differs", "__init__ is inconsistent, stub does not have *args", "__setstate__", "__getstate__")
    return bool(line) and not line.startswith("Found") and not any(word in line for word in own)


PUBLIC = [name for name in dir(spherule) if not name.startswith("_")]


@pytest.mark.parametrize("name", [n for n in PUBLIC if callable(getattr(spherule, n))])
def test_everything_has_help(name):
    thing = getattr(spherule, name)
    if thing.__module__ == "spherule":
        require_help(thing)


@pytest.mark.parametrize("name", studies.__all__)
def test_studies_have_help(name):
    require_help(getattr(studies, name))


def require_help(thing):
    assert inspect.getdoc(thing)
    if inspect.isclass(thing):
        members = [m for n, m in vars(thing).items() if not n.startswith("_") and callable(m)]
        assert all(inspect.getdoc(m) for m in members)
    else:
        inspect.signature(thing)


def test_what_is_public_is_meant_to_be():
    foreign = [n for n in PUBLIC if getattr(getattr(spherule, n), "__module__", "spherule") != "spherule"]
    assert set(foreign) <= {"Primitive"}, foreign
    assert all(pickle.loads(pickle.dumps(getattr(spherule, n))) for n in PUBLIC if inspect.isclass(getattr(spherule, n)))


def test_the_version_is_the_projects():
    root = pathlib.Path(os.environ["SPHERULE_SOURCE_DIR"])
    for file, text in {
        "CMakeLists.txt": "project(spherule VERSION {} ",
        "package.xml": "<version>{}</version>",
        "packaging/vcpkg/spherule/vcpkg.json": '"version": "{}"',
        "packaging/debian/changelog": "spherule ({}) ",
    }.items():
        assert text.format(spherule.__version__) in (root / file).read_text(), file
