# SPDX-License-Identifier: BSD-3-Clause
"""Threads share what is immutable, work does without the interpreter's lock, and Ctrl-C ends it."""

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import spherule
from conftest import make_cube, random_configurations, random_spheres


def test_threads_share_a_checker(checker, robot):
    configurations = random_configurations(robot, 4000, 7)
    free = checker.check_configs(configurations)

    def one_by_one(part):
        return [checker.check_config(q) for q in part]

    with ThreadPoolExecutor(4) as pool:
        found = np.concatenate(list(pool.map(one_by_one, np.array_split(configurations, 8))))
        many = list(pool.map(checker.check_configs, [configurations] * 4))
    assert np.array_equal(found, free)
    assert all(np.array_equal(f, free) for f in many)


def test_scenes_are_edited_while_others_take_snapshots(robot):
    """A snapshot is of the scene as it was when it was called."""
    scene = spherule.RobotScene(robot)
    is_done = threading.Event()

    def edit():
        while not is_done.is_set():
            for k in range(300):
                scene.add(f"box {k}", spherule.Box((0.1, 0.1, 0.1)), spherule.Pose((9.0, 0.0, 0.1 * k)))
            for k in range(300):
                scene.remove(f"box {k}")

    editor = threading.Thread(target=edit)
    editor.start()
    try:
        for _ in range(300):
            assert "variables" in repr(scene.snapshot())
    finally:
        is_done.set()
        editor.join()


def test_others_run_meanwhile():
    """A thread that counts goes on while another one fits: the lock is released."""
    is_done = threading.Event()
    counted = [0]

    def count():
        while not is_done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    try:
        spherule.simplify(make_cube(), max_error=0.1, effort=5)
    finally:
        is_done.set()
        counter.join()
    assert counted[0] > 10


def test_progress_is_told(cube):
    told = []
    spherule.simplify(cube, max_error=0.2, effort=0, progress=lambda share, what: told.append((share, what)))
    assert told and all(share is None or 0 <= share <= 1 for share, _ in told)
    assert all(isinstance(what, str) and what for _, what in told)


def test_progress_may_end_the_work(cube):
    class Enough(Exception):
        pass

    def refuse(share, what):
        raise Enough

    with pytest.raises(Enough):
        spherule.simplify(cube, max_error=0.02, effort=60, progress=refuse)


PRELUDE = """
import numpy as np, spherule
rng = np.random.default_rng(1)
n = 60
u, v = np.meshgrid(np.linspace(0, 2 * np.pi, n, endpoint=False), np.linspace(0, 2 * np.pi, n, endpoint=False))
u, v = u.ravel(), v.ravel()
p = np.column_stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)])
i = np.arange(n * n).reshape(n, n)
a, b, c, d = i, np.roll(i, -1, 1), np.roll(np.roll(i, -1, 1), -1, 0), np.roll(i, -1, 0)
t = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
mesh = spherule.TriangleMesh(p, t)
print("ready", flush=True)
"""
LONG = {
    "simplify": "spherule.simplify(mesh, max_error=0.02, effort=10000)",
    # Spheres around the cells of a lattice, a little too small: they leak at each of its corners.
    "certify": """
axes = [np.arange(-half, half, 0.07) for half in (4.2, 4.2, 1.2)]
lattice = np.stack(np.meshgrid(*axes), -1).reshape(-1, 3)
spherule.certify(mesh, np.column_stack([lattice, np.full(len(lattice), 0.0606217)]), resolution=1e-5)
""",
    "check_configs": """
robot = spherule.RobotModel()
for k in range(6):
    robot.add_link(f"l{k}", robot.links[-1].name, spherule.Joint(f"j{k}", "revolute", spherule.Pose((0.3, 0, 0)), (k % 2, 0, 1), -3.0, 3.0))
    robot.attach(f"l{k}", spherule.build_tree(np.column_stack([rng.uniform(-.1, .1, (2000, 3)), np.full(2000, .002)])))
checker = spherule.RobotScene(robot).snapshot()
q = rng.uniform(-3, 3, (200000, 6))
while True:
    checker.check_configs(q)
""",
}


@pytest.mark.parametrize("what", LONG)
def test_ctrl_c_ends_it_within_a_second(what):
    """The clock only tells that the work was not waited for: it would take far longer."""
    code = PRELUDE + "try:\n" + "".join(f"    {line}\n" for line in LONG[what].splitlines())
    code += "except KeyboardInterrupt:\n    print('interrupted', flush=True)\n"
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    time.sleep(1.0)
    os.kill(process.pid, signal.SIGINT)
    try:
        out, _ = process.communicate(timeout=30)
    finally:
        process.kill()
    assert out == "interrupted\n"
    assert process.returncode == 0
