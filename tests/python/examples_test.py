# SPDX-License-Identifier: BSD-3-Clause
"""The scripts of examples/python run and find what they are to show."""

import importlib.util
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

SOURCES = pathlib.Path(os.environ["SPHERULE_SOURCE_DIR"])
MODELS = os.environ.get("SPHERULE_MODELS")


def run(folder, script, *arguments):
    """What the script prints, run in `folder`."""
    path = SOURCES / "examples" / "python" / script
    environment = dict(os.environ)
    environment.pop("PYTHONWARNINGS", None)  # matplotlib's own
    found = subprocess.run(
        [sys.executable, str(path), *arguments], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert found.returncode == 0, found.stdout + found.stderr
    return found.stdout


def test_fit_and_look(tmp_path):
    out = run(tmp_path, "fit_and_look.py")
    assert "lies in one: True (proved)" in out
    assert "60 above: touches" in out and "100 above: free" in out
    assert (tmp_path / "part.json").exists()
    assert (tmp_path / "part.html").exists() or "next: spherule view" in out


def test_certify_a_robot(tmp_path):
    out = run(tmp_path, "certify_robot.py")
    before, after = out.split("mended")
    assert "does not cover" in before and "leaks 1.6 to 1.6 mm deep" in before
    assert after.count(", covered") == 2


@pytest.mark.skipif(MODELS is None, reason="SPHERULE_MODELS is not set")
def test_certify_a_published_robot(tmp_path):
    """A finger of the Panda, with the spheres that cuRobo has for it."""
    panda = pathlib.Path(MODELS) / "robots" / "franka_panda"
    mesh = f'<geometry><mesh filename="{panda}/meshes/collision/finger.obj"/></geometry>'
    link = f'<link name="panda_leftfinger"><collision>{mesh}</collision></link>'
    (tmp_path / "finger.urdf").write_text(f'<robot name="finger">{link}</robot>')
    out = run(tmp_path, "certify_robot.py", "finger.urdf", panda / "peer_spheres" / "curobo_franka.yml")
    assert "leaks 14.2 to 14.2 mm deep" in out and out.endswith("2 spheres, covered\n")


def test_replace_a_sampled_check(tmp_path):
    out = run(tmp_path, "replace_sampled_check.py")
    assert "5 motions touch the rod between samples" in out and "and rod" in out


def test_plan(tmp_path):
    out = run(tmp_path, "plan.py")
    path = np.loadtxt(tmp_path / "path.csv", delimiter=",", skiprows=1)
    assert "straight motion proved free: False" in out
    assert f"{len(path) - 1} of {len(path) - 1} motions proved free" in out


def test_reachability_map(tmp_path):
    out = run(tmp_path, "reachability_map.py", "15")
    free = np.load(tmp_path / "reachability.npy")
    assert free.shape == (225, 12) and 0 < free.sum() and "points reached" in out
    assert (tmp_path / "reachability.png").exists() == (importlib.util.find_spec("matplotlib") is not None)
