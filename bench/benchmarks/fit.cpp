// SPDX-License-Identifier: BSD-3-Clause
// How long does the fit take, and how many spheres does it need? By shape and method; counters:
// triangles, external spheres, spheres, seconds of both stages and of the certificate, and whether
// the certificate holds.

#include "bench/scenes/work_cell_parts.h"
#include "simplifier/simplify.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <benchmark/benchmark.h>

#include <string>

namespace spherule {
namespace {

void fit(benchmark::State& state, const TriangleMesh& mesh, const SimplifyOptions& options) {
  Simplification result;
  for (auto _ : state) {
    result = simplify(mesh, options);
    benchmark::DoNotOptimize(result.cover.spheres.data());
  }
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
  state.counters["external"] = static_cast<double>(result.external.spheres.size());
  state.counters["spheres"] = static_cast<double>(result.cover.spheres.size());
  state.counters["stage1_s"] = result.times.external;
  state.counters["stage2_s"] = result.times.cover;
  state.counters["certify_s"] = result.times.certify;
  state.counters["covered"] = result.certificate.covered ? 1.0 : 0.0;
}

void add(const std::string& name, const TriangleMesh& mesh, const SimplifyOptions& options) {
  benchmark::RegisterBenchmark(name.c_str(), fit, mesh, options)->Unit(benchmark::kMillisecond);
}

void add(const std::string& name, const TriangleMesh& mesh, double max_error,
         double min_external_diameter) {
  SimplifyOptions options{.max_error = max_error, .min_external_diameter = min_external_diameter};
  options.method = CoverMethod::kCover;
  add(name + "/cover", mesh, options);
  options.method = CoverMethod::kPaper;
  add(name + "/paper", mesh, options);
}

// A square tube of 60 mm, walls of 3 mm, the first answer: time and spheres grow with the length,
// from 2000 mm on in blocks.
void add_tube(int length) {
  const auto square = [](double edge) {
    return Loop{
        {-edge / 2, -edge / 2}, {edge / 2, -edge / 2}, {edge / 2, edge / 2}, {-edge / 2, edge / 2}};
  };
  add("square_tube_" + std::to_string(length) + "/E1/first",
      extrude(square(60.0), {square(54.0)}, 0.0, length),
      {.max_error = 1.0, .min_external_diameter = 100.0, .effort = 0});
}

// Millimetres for the plain shapes, metres for the parts of the work cell.
const bool kRegistered = [] {
  add("cube_100/E2", make_cube(100.0), 2.0, 8.0);
  add("pipe_40_34_300/E1", make_pipe(40.0, 34.0, 300.0, 81), 1.0, 100.0);
  add("l_bracket/E2", make_l_bracket(100.0, 60.0, 8.0), 2.0, 30.0);
  add("plate_with_holes/E2", make_plate_with_holes({200.0, 120.0, 10.0}, 4, 3, 16.0, 24), 2.0, 8.0);
  add("forearm/E20", make_robot_links()[4], 0.02, 0.1);
  add("torch/E3", make_torch(), 0.003, 0.012);
  add("workpiece/E1", make_workpiece(), 0.001, 0.1);
  for (const int length : {1000, 2000, 4000}) add_tube(length);
  return true;
}();

}  // namespace
}  // namespace spherule
