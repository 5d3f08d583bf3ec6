// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

struct PlyPoints {
  std::vector<Eigen::Vector3d> points;
  bool is_text = false;
};

// The vertices of a PLY file (Turk, "The PLY Polygon File Format", 1994), by their properties x, y
// and z; other properties and elements are passed over. `file` becomes the subject of an Error.
PlyPoints read_ply_points(std::string_view content, const std::string& file);

}  // namespace spherule::internal
