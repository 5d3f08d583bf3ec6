// SPDX-License-Identifier: BSD-3-Clause
// The module spherule._baselines: the methods of comparison, which stand on large libraries, so
// that it is loaded when spherule.baselines is imported.

#include "python/bindings/support.h"
#include "simplifier/baseline/convex_decomposition.h"
#include "simplifier/baseline/convex_hull.h"
#include "simplifier/baseline/decimation.h"
#include "simplifier/baseline/hubbard_spheres.h"
#include "simplifier/baseline/level_set_packing.h"
#include "simplifier/baseline/made_conservative.h"
#include "simplifier/baseline/medial_axis.h"
#include "simplifier/baseline/octree_spheres.h"
#include "simplifier/baseline/sphere_packing.h"
#include "simplifier/baseline/voxelisation.h"

#include <pybind11/stl.h>

namespace spherule::python {
namespace {

Filling filling_of(py::handle filling) {
  return static_cast<Filling>(choice(filling, {"solid", "surface"}, "filling"));
}

py::object mesh_object(TriangleMesh mesh) {
  return py::cast(std::make_shared<TriangleMesh>(std::move(mesh)));
}

py::array voxels(const py::object& mesh, double step, double max_error, const py::object& sphere,
                 const py::object& filling, double padding) {
  VoxelisationOptions options;
  options.step = step;
  options.max_error = max_error;
  options.sphere =
      static_cast<VoxelSphere>(choice(sphere, {"circumscribed", "inscribed"}, "sphere"));
  options.filling = filling_of(filling);
  options.padding = padding;
  return array_of(run_long(py::none(), [kept = mesh_of(mesh, "mesh"), options](const LongRun&) {
                    return voxelise(*kept, options);
                  }).spheres);
}

py::tuple packed(const py::object& mesh, double max_error, double padding, std::uint64_t seed,
                 int threads, const py::object& progress) {
  SpherePackingOptions options;
  options.max_error = max_error;
  options.padding = padding;
  options.seed = seed;
  options.threads = threads;
  SpherePacking made =
      run_long(progress, [kept = mesh_of(mesh, "mesh"), options](const LongRun& run) mutable {
        options.progress = run.progress;
        return pack_spheres(*kept, options);
      });
  return py::make_tuple(array_of(std::move(made.spheres)), array_of(std::move(made.inflated)));
}

py::array filled(const py::object& mesh, double step, double min_radius, std::size_t max_spheres,
                 int threads) {
  LevelSetPackingOptions options;
  options.step = step;
  options.min_radius = min_radius;
  options.max_spheres = max_spheres;
  options.threads = threads;
  return array_of(run_long(py::none(), [kept = mesh_of(mesh, "mesh"), options](const LongRun&) {
    return level_set_packing(*kept, options);
  }));
}

py::array medial(const py::object& mesh, std::size_t spheres, double max_protrusion,
                 const py::object& reduction, std::uint64_t seed, int threads) {
  MedialAxisOptions options;
  options.spheres = spheres;
  options.max_protrusion = max_protrusion;
  options.reduction = static_cast<SphereReduction>(
      choice(reduction, {"merge", "burst", "expand", "best"}, "reduction"));
  options.sampling.seed = seed;
  options.threads = threads;
  return array_of(run_long(py::none(), [kept = mesh_of(mesh, "mesh"), options](const LongRun&) {
                    return medial_axis(*kept, options);
                  }).spheres);
}

py::object octree(const py::object& mesh, int depth, double max_error, const py::object& filling,
                  double padding) {
  OctreeSpheresOptions options;
  options.depth = depth;
  options.max_error = max_error;
  options.filling = filling_of(filling);
  options.padding = padding;
  return py::cast(run_long(py::none(), [kept = mesh_of(mesh, "mesh"), options](const LongRun&) {
    return std::make_shared<SphereTree>(octree_spheres(*kept, options).tree);
  }));
}

py::tuple hubbard(const py::object& mesh, const std::vector<std::size_t>& counts,
                  std::uint64_t seed, int threads) {
  HubbardOptions options;
  options.counts = counts;
  options.seed = seed;
  options.threads = threads;
  SphereLevels made = run_long(py::none(), [kept = mesh_of(mesh, "mesh"), options](const LongRun&) {
    return hubbard_spheres(*kept, options);
  });
  py::list levels;
  for (std::vector<Sphere>& level : made.levels) levels.append(array_of(std::move(level)));
  return py::tuple(levels);
}

py::array grown(const py::object& mesh, const py::object& spheres_in, double padding, int threads,
                const py::object& progress) {
  return array_of(
      run_long(progress, [kept = mesh_of(mesh, "mesh"), all = spheres(spheres_in, "spheres").copy(),
                          padding, threads](const LongRun& run) {
        return made_conservative(*kept, all, padding, threads, run.progress);
      }).spheres);
}

py::object hull(const py::object& mesh, double padding) {
  return mesh_object(run_long(py::none(), [kept = mesh_of(mesh, "mesh"), padding](const LongRun&) {
                       return convex_hull(*kept, {.padding = padding});
                     }).mesh);
}

py::object decimated(const py::object& mesh, std::size_t target_triangles, double max_error) {
  DecimationOptions options;
  options.target_triangles = target_triangles;
  options.max_error = max_error;
  options.measure = std::nullopt;
  return mesh_object(run_long(py::none(), [kept = mesh_of(mesh, "mesh"), options](const LongRun&) {
                       return decimate(*kept, options);
                     }).mesh);
}

py::tuple decomposed(const py::object& mesh, double max_concavity, int min_parts) {
  ConvexDecompositionOptions options;
  options.max_concavity = max_concavity;
  options.min_parts = min_parts;
  options.measure = std::nullopt;
  ConvexDecomposition made =
      run_long(py::none(), [kept = mesh_of(mesh, "mesh"), options](const LongRun&) {
        return decompose(*kept, options);
      });
  py::list parts;
  for (TriangleMesh& part : made.parts) parts.append(mesh_object(std::move(part)));
  return py::tuple(parts);
}

py::tuple deviation(const py::object& original, const py::object& other, double tolerance) {
  const MeshDeviation found =
      run_long(py::none(),
               [a = mesh_of(original, "original"), b = mesh_of(other, "other"), tolerance](
                   const LongRun&) { return measure_deviation(*a, *b, {.tolerance = tolerance}); });
  const auto bounds = [](const Bounds& b) { return make_result("Bounds", b.lower, b.upper); };
  return py::make_tuple(bounds(found.loss), bounds(found.excess));
}

void bind_sphere_methods(py::module_& module) {
  module.def("voxelise", &voxels, py::arg("mesh"), py::kw_only(), py::arg("step") = 0.0,
             py::arg("max_error") = 0.0, py::arg("sphere") = "circumscribed",
             py::arg("filling") = "solid", py::arg("padding") = 0.0,
             Help("voxelise(mesh, *, step=0.0, max_error=0.0, sphere='circumscribed', "
                  "filling='solid', padding=0.0)",
                  "A sphere for every voxel of edge `step`, or of the edge for `max_error`, shape "
                  "(n, 4). Conservative with 'circumscribed' spheres; 'inscribed' ones leak.")
                 .c_str());
  module.def(
      "pack_spheres", &packed, py::arg("mesh"), py::kw_only(), py::arg("max_error"),
      py::arg("padding") = 0.0, py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      Help("pack_spheres(mesh, *, max_error, padding=0.0, seed=1, threads=0, progress=None)",
           "The paper's sphere packing: the packing, not conservative, and the same inflated, "
           "which is; shapes (n, 4).")
          .c_str());
  module.def("level_set_packing", &filled, py::arg("mesh"), py::kw_only(), py::arg("step"),
             py::arg("min_radius") = 0.0, py::arg("max_spheres") = 10000, py::arg("threads") = 0,
             Help("level_set_packing(mesh, *, step, min_radius=0.0, max_spheres=10000, threads=0)",
                  "Sphere packing by OpenVDB, shape (n, 4). Not conservative.")
                 .c_str());
  module.def(
      "medial_axis", &medial, py::arg("mesh"), py::kw_only(), py::arg("spheres") = 512,
      py::arg("max_protrusion") = 0.0, py::arg("reduction") = "best", py::arg("seed") = 1,
      py::arg("threads") = 0,
      Help("medial_axis(mesh, *, spheres=512, max_protrusion=0.0, reduction='best', seed=1, "
           "threads=0)",
           "The adaptive medial-axis approximation (Bradshaw and O'Sullivan), shape (n, 4). Not "
           "conservative. `reduction` is 'merge', 'burst', 'expand' or 'best'.")
          .c_str());
  module.def("octree_spheres", &octree, py::arg("mesh"), py::kw_only(), py::arg("depth") = 0,
             py::arg("max_error") = 0.0, py::arg("filling") = "solid", py::arg("padding") = 0.0,
             Help("octree_spheres(mesh, *, depth=0, max_error=0.0, filling='solid', padding=0.0)",
                  "The spheres around the cubes of an octree, a SphereTree. Conservative.")
                 .c_str());
  module.def("hubbard_spheres", &hubbard, py::arg("mesh"), py::kw_only(),
             py::arg("counts") = py::make_tuple(1, 8, 64, 512), py::arg("seed") = 1,
             py::arg("threads") = 0,
             Help("hubbard_spheres(mesh, *, counts=(1, 8, 64, 512), seed=1, threads=0)",
                  "Hubbard's spheres in levels, the coarsest first, each of shape (n, 4). Not "
                  "conservative.")
                 .c_str());
  module.def("made_conservative", &grown, py::arg("mesh"), py::arg("spheres"), py::kw_only(),
             py::arg("padding") = 0.0, py::arg("threads") = 0, py::arg("progress") = py::none(),
             Help("made_conservative(mesh, spheres, *, padding=0.0, threads=0, progress=None)",
                  "The spheres, shape (n, 4), all grown by what is proved to make them cover.")
                 .c_str());
}

void bind_mesh_methods(py::module_& module) {
  module.def(
      "convex_hull", &hull, py::arg("mesh"), py::kw_only(), py::arg("padding") = 0.0,
      Help("convex_hull(mesh, *, padding=0.0)",
           "A TriangleMesh that contains the mesh, and spheres of radius `padding` about its "
           "vertices: proved.")
          .c_str());
  module.def(
      "decimate", &decimated, py::arg("mesh"), py::kw_only(), py::arg("target_triangles"),
      py::arg("max_error") = std::numeric_limits<double>::infinity(),
      Help("decimate(mesh, *, target_triangles, max_error=1e999)",
           "Decimation by quadric error: a TriangleMesh. Not conservative; measure_deviation() "
           "tells by how much.")
          .c_str());
  module.def("decompose", &decomposed, py::arg("mesh"), py::kw_only(),
             py::arg("max_concavity") = 0.0, py::arg("min_parts") = 1,
             Help("decompose(mesh, *, max_concavity=0.0, min_parts=1)",
                  "Approximate convex decomposition by HACD: a tuple of TriangleMesh. Not "
                  "conservative.")
                 .c_str());
  module.def(
      "measure_deviation", &deviation, py::arg("original"), py::arg("other"), py::kw_only(),
      py::arg("tolerance") = DeviationOptions{}.tolerance,
      Help("measure_deviation(original, other, *, tolerance=0.001)",
           "How far a mesh is from the original, as two Bounds: what is lost, and what sticks "
           "out. `tolerance` is a share of the box diagonal.")
          .c_str());
}

}  // namespace

PYBIND11_MODULE(_baselines, module) {
  py::options options;
  options.disable_function_signatures();
  bind_sphere_methods(module);
  bind_mesh_methods(module);
}

}  // namespace spherule::python
