// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/simplifier/cad/cad_shapes.h"

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace spherule::test {

// Written by OpenCASCADE; `unit` is that of the numbers in the file: "MM", "INCH", "M".
void write_step(const TopoDS_Shape& shape, const std::filesystem::path& path,
                const std::string& unit = "MM");
void write_iges(const TopoDS_Shape& shape, const std::filesystem::path& path);

// Points of the faces, in millimetres: evenly spread in the parameters with seeded jitter, inside
// of the boundary as OpenCASCADE classifies them, some close to it and points of all edges among
// them. About so many for each face.
std::vector<Eigen::Vector3d> points_of(const TopoDS_Shape& shape, int per_face,
                                       std::uint64_t seed = 7);

// Compares the bounds of derivatives with OpenCASCADE's derivatives at random points of random
// rectangles of every face. The first that is broken; `tightest` becomes the largest quotient of
// a derivative of second order and its bound.
std::string broken_bounds(const TopoDS_Shape& shape, int rectangles, double& tightest);

}  // namespace spherule::test
