// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Points from files.
//
// @code{.cpp}
// #include <spherule/robot/files/point_cloud_file.h>
// #include <spherule/base/files.h>
// #include <cassert>
// #include <cmath>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.xyz";
// spherule::write_file_atomically(path, "# millimetres\n0 0 0\n1000 0 500\n");
// const spherule::PointCloudFile cloud = spherule::read_point_cloud(path, 0.001);
// assert(cloud.points.size() == 2 && std::abs(cloud.points[1].z() - 0.5) <= cloud.point_error);
// @endcode

#include <Eigen/Core>

#include <filesystem>
#include <vector>

namespace spherule {

// The points of a file, and how exactly they are held.
struct PointCloudFile {
  std::vector<Eigen::Vector3d> points{};
  // Bound of the distance between a point as stored here and as written in the file, scaled exactly
  // by any number that rounds to `scale`; a scale of 1 is meant as such.
  double point_error = 0.0;
};

// Reads the points of a file as PCL, Open3D and CloudCompare write them: PLY (the vertices; text or
// binary, whatever else it has), PCD (text, binary or compressed; VIEWPOINT moves no point, as with
// PCL), or text: the files of the extensions xyz, txt, csv, asc and pts, with x, y and z at the
// beginning of each line, or in the columns that a first line of names calls x, y and z (X, Y and
// Z), separated by blanks, commas or semicolons; what follows a # is passed over. A file pts may
// begin with a line of the number of its points. Decimals are after a point. A point with a
// coordinate that is not finite (nan) is none: so clouds mark what was not measured. Numbers are
// multiplied by `scale`.
//
// Throws Error, whose subject is the file and whose reason names the line, the byte or the point:
// for a file that cannot be read, another extension, a header that is malformed or has no x, y and
// z, a file that is cut short or longer than it says, what is no number or beyond kMaxCoordinate, a
// line with commas beside semicolons or beside blanks that separate (they may be those of
// decimals), a number of points that is not theirs, a compressed file that unpacks to more than
// 2^29 bytes or 2^26 points, a file without points, and a scale that is not from 1e-300 to 1e15.
PointCloudFile read_point_cloud(const std::filesystem::path& path, double scale = 1.0);

}  // namespace spherule
