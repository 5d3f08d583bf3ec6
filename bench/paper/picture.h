// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <filesystem>
#include <vector>

namespace spherule {

// A mesh or spheres in one colour (red, green, blue from 0 to 1).
struct PictureItem {
  Eigen::Vector3d color;
  TriangleMesh mesh{};
  std::vector<Sphere> spheres{};
};

// What POV-Ray makes a picture of, four wide to three high: all items seen from `towards_viewer` of
// their middle, z up.
// Throws Error for a picture without anything in it, and where it cannot be written.
void write_picture(const std::vector<PictureItem>& items, const Eigen::Vector3d& towards_viewer,
                   const std::filesystem::path& path);

}  // namespace spherule
