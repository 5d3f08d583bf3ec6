# SPDX-License-Identifier: BSD-3-Clause
"""The methods of comparison."""

import inspect
import os
import subprocess
import sys

import numpy as np
import pytest
import spherule

baselines = pytest.importorskip("spherule.baselines")


def covers(spheres, seed=1):
    samples = np.random.default_rng(seed).uniform(0, 1, (2000, 3))
    gaps = np.linalg.norm(samples[:, None] - spheres[None, :, :3], axis=2) - spheres[:, 3]
    return bool(np.all(gaps.min(axis=1) <= 0))


def test_conservative_ones_cover(cube):
    assert covers(baselines.voxelise(cube, step=0.25))
    assert not covers(baselines.voxelise(cube, step=0.25, sphere="inscribed"))
    assert covers(baselines.octree_spheres(cube, depth=3).spheres)
    packing, inflated = baselines.pack_spheres(cube, max_error=0.2)
    assert len(packing) == len(inflated) and covers(inflated)


def test_others_are_made_to(cube):
    filled = baselines.level_set_packing(cube, step=0.05, max_spheres=50)
    assert filled.shape[1] == 4 and not covers(filled)
    medial = baselines.medial_axis(cube, spheres=20, reduction="merge")
    levels = baselines.hubbard_spheres(cube, counts=[1, 8])
    assert 0 < len(medial) <= 20 and [len(level) for level in levels] == [1, 8]
    assert covers(baselines.made_conservative(cube, levels[1]))


def test_meshes(cube):
    hull = baselines.convex_hull(cube)
    assert spherule.mesh_report(hull).volume == pytest.approx(1.0)
    lost, extra = baselines.measure_deviation(cube, hull)
    assert lost.lower < 0.01 and extra.lower < 0.01
    assert len(baselines.decompose(cube)) == 1
    assert len(baselines.decimate(cube, target_triangles=6).triangles) <= 12
    with pytest.raises(spherule.Error, match="sphere"):
        baselines.voxelise(cube, step=0.2, sphere="round")


def test_every_one_has_help():
    for name in dir(baselines):
        if not name.startswith("_"):
            assert inspect.getdoc(getattr(baselines, name)) and inspect.signature(getattr(baselines, name))


def test_the_module_alone_does_not_load_them():
    code = "import spherule, sys; sys.exit('spherule._baselines' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, env=os.environ)
