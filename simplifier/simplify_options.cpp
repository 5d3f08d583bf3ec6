// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify_options.h"

#include "mesh/geometry/mesh_box.h"
#include "spheretree/error.h"

#include <algorithm>
#include <limits>

namespace spherule {
namespace {

constexpr double kDefaultError = 0.01;    // of the box diagonal
constexpr double kDefaultDiameter = 4.0;  // of E: 90-degree edges need spheres of radius 2 E

}  // namespace

void complete_lengths(SimplifyOptions& options, const TriangleMesh& mesh) {
  if (options.max_error == 0.0) {
    options.max_error = kDefaultError * internal::box_of(mesh).diagonal().norm();
  }
  if (options.min_external_diameter == 0.0) {
    options.min_external_diameter = kDefaultDiameter * options.max_error;
  }
}

double tool_diameter(std::span<const Sphere> tool) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& sphere : tool) {
    if (!is_usable(sphere)) throw Error("tool", "a sphere is not usable");
    least = std::min(least, sphere.radius);
  }
  if (tool.empty()) throw Error("tool", "holds no sphere");
  if (least == 0.0) throw Error("tool", "has a sphere of radius 0: nothing is small enough for it");
  return 2.0 * least;
}

ExternalOptions external_options(const SimplifyOptions& options) {
  return {.placement = options.external,
          .min_external_diameter = options.min_external_diameter,
          .padding = options.padding,
          .max_error = options.max_error > 0.0 ? options.max_error
                                               : options.min_external_diameter / kDefaultDiameter,
          .tightness = options.tightness,
          .zones = options.zones,
          .keep_concave_edges = options.keep_concave_edges,
          .limit = options.external_limit,
          .seed = options.seed,
          .threads = options.threads,
          .progress = options.progress};
}

}  // namespace spherule
