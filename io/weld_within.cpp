// SPDX-License-Identifier: BSD-3-Clause
#include "io/weld_within.h"

#include "base/rounding.h"
#include "geometry/weld.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

TriangleMesh weld_within(const TriangleMesh& input, double tolerance) {
  TriangleMesh mesh = weld(input);
  if (tolerance == 0.0 || mesh.triangles.empty()) return mesh;
  const std::vector<Eigen::Vector3d> places = mesh.vertices;
  const PointGrid grid(places, tolerance);
  std::vector<char> is_placed(places.size(), 0);
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (is_placed[i] != 0) continue;
    near.clear();
    grid.find(places[i], tolerance, near);
    for (const std::uint32_t k : near) {
      if (is_placed[k] != 0 || distance_upper(places[i], places[k]) > tolerance) continue;
      is_placed[k] = 1;
      mesh.vertices[k] = places[i];
    }
    is_placed[i] = 1;
  }
  mesh.vertex_error = add_up(mesh.vertex_error, tolerance);
  return weld(mesh);
}

}  // namespace spherule::internal
