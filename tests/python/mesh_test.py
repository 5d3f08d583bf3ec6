# SPDX-License-Identifier: BSD-3-Clause
"""Meshes, and what is made of them."""

from types import SimpleNamespace

import numpy as np
import pytest
import spherule
from conftest import make_cube


def test_arrays_are_views_that_keep_their_owner():
    mesh = make_cube()
    vertices, triangles = mesh.vertices, mesh.triangles
    assert vertices.base is mesh and not vertices.flags.writeable and not vertices.flags.owndata
    assert vertices.shape == (8, 3) and triangles.shape == (12, 3)
    assert triangles.dtype == np.int32 and np.shares_memory(mesh.faces, triangles)
    del mesh
    assert vertices.max() == 1.0


def test_reads_what_it_wrote(tmp_path, cube):
    path = tmp_path / "cube.stl"
    spherule.write_stl(cube, path)
    read = spherule.read_mesh(path, scale=2.0)
    report = spherule.mesh_report(read)
    assert report.closed and report.volume == pytest.approx(8.0)
    assert spherule.mesh_report(str(path)).volume == pytest.approx(1.0)
    assert "12 triangles" in str(report)


def test_takes_what_has_vertices_and_faces(cube):
    lookalike = SimpleNamespace(vertices=cube.vertices.tolist(), faces=cube.faces.astype(np.int64))
    assert spherule.mesh_report(lookalike).triangles == 12
    lookalike.vertices = (cube.vertices * (1, 0.02, 0.02)).tolist()  # the inside of a bar is found quickly
    assert not spherule.certify(lookalike, np.zeros((0, 4)), volume=False).covered


def test_distances_are_bounds(cube):
    points = np.random.default_rng(1).uniform(-1, 2, (200, 3))
    bounds = spherule.mesh_distance(cube, points)
    outside = np.maximum(np.maximum(points - 1, -points), 0)
    exact = np.linalg.norm(outside, axis=1)
    inside = np.all((points >= 0) & (points <= 1), axis=1)
    exact[inside] = np.minimum(points, 1 - points).min(axis=1)[inside]
    assert np.all(bounds[:, 0] <= exact + 1e-12) and np.all(bounds[:, 1] >= exact - 1e-12)


def test_simplify_covers_and_says_what_it_promises(cube, fit):
    assert fit.certificate.covered and fit.broken_promises == ""
    assert fit.spheres.dtype == np.float64 and fit.spheres.shape[1] == 4
    assert fit.certificate.protrusion_over_simplified_max <= 0.2
    samples = np.random.default_rng(2).uniform(0, 1, (2000, 3))
    gaps = np.linalg.norm(samples[:, None] - fit.spheres[None, :, :3], axis=2) - fit.spheres[:, 3]
    assert np.all(gaps.min(axis=1) <= 0)
    assert fit.options["max-error"] == 0.2


def test_levels_enclose_and_make_a_tree(cube, fit):
    (level,) = fit.levels
    parents = level.spheres[level.parent_of]
    reach = np.linalg.norm(parents[:, :3] - fit.spheres[:, :3], axis=1) + fit.spheres[:, 3]
    assert np.all(reach <= parents[:, 3] + 1e-12)
    tree = spherule.sphere_tree(fit)
    assert spherule.check(tree).valid and len(tree) == len(fit.spheres)
    again = spherule.fit_levels(cube, fit.external, fit.spheres, [0.6], effort=0)
    assert np.array_equal(again[0].spheres, level.spheres)


def test_certify_finds_a_leak_and_repair_closes_it(cube, fit):
    leaky = fit.spheres[len(fit.spheres) // 2 :]
    before = spherule.certify(cube, leaky, external=fit.external, volume=False)
    assert not before.covered and before.uncovered_depth.lower > 0
    points, depths = spherule.leak_points(cube, leaky)
    assert len(points) == len(depths) > 0 and depths[0] <= before.surface_depth.upper
    mended = spherule.repair(cube, fit.external, leaky, max_error=0.2, effort=0)
    assert np.array_equal(mended.spheres[: len(leaky), :3], leaky[:, :3])
    assert spherule.certify(cube, mended.spheres, external=fit.external, volume=False).covered
    assert spherule.spheres_in_thin_parts(fit.external, fit.spheres, 0.2) >= 0


def test_zones_bind(cube, tmp_path):
    zone = spherule.Zone(spherule.ZoneBox((0.8, -1, -1), (2, 2, 2)), max_error=0.1)
    fit = spherule.simplify(cube, max_error=0.3, effort=0, zones=[zone])
    assert fit.certificate.covered and fit.certificate.protrusion_in_zones[0] <= 0.1
    path = tmp_path / "zones.json"
    path.write_text(spherule.zones_text([zone]))
    assert spherule.read_zones(path) == (zone,)
    assert spherule.concave_edge_zones(cube, min_external_diameter=0.5, max_error=0.1) == ()


def test_files_of_spheres_keep_every_bit(fit, tmp_path):
    path = tmp_path / "cube.json"
    spherule.save_spheres(fit.file, path)
    assert spherule.load_spheres(path) == fit.file
    spherule.save_spheres(spherule.SphereFile(fit.spheres), path)
    read = spherule.load_spheres(path)
    assert read.certificate is None and not read.interrupted
    spherule.save_spheres(spherule.SphereFile(fit.spheres, interrupted=True), path)
    assert spherule.load_spheres(path).interrupted


def test_a_diameter_that_was_requested_is_no_larger_one(cube, fit):
    assert fit.larger_diameter is False and "larger_diameter=False" in repr(fit)
    chosen = spherule.simplify(cube, max_error=0.3, effort=0)
    assert chosen.larger_diameter is False and chosen.external.min_external_diameter == 4 * 0.3


def test_stage_1_alone(cube, fit):
    external = spherule.place_external_spheres(cube, min_external_diameter=0.8, max_error=0.2)
    assert external == fit.external and external.spheres.base is external
    assert external.spheres.shape == (0, 4) and external.box.shape == (2, 3)  # S is the box
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    tetrahedron = spherule.TriangleMesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    beside = spherule.place_external_spheres(tetrahedron, min_external_diameter=0.8, max_error=0.2)
    assert beside.spheres[:, 3].min() >= 0.4
    assert spherule.tool_diameter([[0, 0, 0, 0.5], [1, 0, 0, 0.25]]) == 0.5
    with pytest.raises(spherule.Error, match="max cells"):
        spherule.place_external_spheres(cube, min_external_diameter=0.8, max_cells=0)


def test_spheres_of_centres_and_radii():
    spheres = spherule.spheres_of([[1, 2, 3]], [4])
    assert spheres.tolist() == [[1, 2, 3, 4]]
    assert spherule.spheres_of([], []).shape == (0, 4)


def test_points_become_spheres():
    points = np.random.default_rng(3).uniform(size=(50, 3))
    assert spherule.point_cloud_spheres(points, 0.1).shape == (50, 4)
    assert len(spherule.point_cloud_spheres(points, 0.1, voxel=0.5)) <= 8
