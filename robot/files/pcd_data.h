// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

struct PcdPoints {
  std::vector<Eigen::Vector3d> points{};  // also those with coordinates that are not finite
  bool is_rounded = false;                // from text, or whole numbers of 8 bytes
};

// The points of a PCD file (pointclouds.org, "The PCD (Point Cloud Data) file format"): text,
// binary, or binary and compressed, by their fields x, y and z, of any type and order. Of the other
// fields only the sizes matter. VIEWPOINT says where the sensor stood and, as with PCL, moves no
// point. Throws Error, naming the file and the line or the byte, for what is malformed, cut short
// or longer than it says, and for what unpacks to more than 2^29 bytes or 2^26 points.
PcdPoints read_pcd(std::string_view bytes, const std::string& file);

}  // namespace spherule::internal
