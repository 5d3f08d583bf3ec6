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


def covers(spheres, size=(1, 1, 1), seed=1):
    samples = np.random.default_rng(seed).uniform(0, size, (2000, 3))
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
    assert 0 < len(medial) <= 20
    # What is inside of a bar is found in less time.
    size = (1, 0.02, 0.02)
    bar = spherule.TriangleMesh(cube.vertices * size, cube.triangles)
    levels = baselines.hubbard_spheres(bar, counts=[1, 8])
    assert [len(level) for level in levels] == [1, 8]
    assert not covers(levels[1] * (1, 1, 1, 0.5), size)
    assert covers(baselines.made_conservative(bar, levels[1] * (1, 1, 1, 0.5)), size)


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
