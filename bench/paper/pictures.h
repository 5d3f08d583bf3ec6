// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "bench/paper/report.h"
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

// The paper's figures 2 (packing and bounding spheres), 4 (the pipe in each representation), 5 (the
// robot in spheres) and 9 (the work cell), as files that POV-Ray makes pictures of:
// FOLDER/paper-figure4-mesh.pov and so on. Of the results, figure 2 and the courses are shown.
void write_pictures(const Workload& workload, const PaperResults& results,
                    const std::filesystem::path& folder);

}  // namespace spherule
