// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "base/text.h"
#include "io/ply_data.h"
#include "robot/files/format_text.h"
#include "robot/files/scene_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace spherule {
namespace {

using Eigen::Vector3d;

// So that the scale is off by no more than u = 2^-53 of itself: no subnormal number.
constexpr double kLeastScale = 1e-300;

// Reading a coordinate from decimals rounds it once. Scaling rounds twice: the scale itself, which
// was decimals, too, and the product. Each is by u of what comes out, so n of them move a
// coordinate as stored by no more than n u (1 + 4 u) `largest`, and the point by sqrt(3) times
// that, which is less than 2 n u `largest`; that product is exact. What underflows is off by
// 2^-1075, times a scale of up to 1e15.
double point_error(bool is_rounded, bool is_scaled, double largest) {
  const int roundings = (is_rounded ? 1 : 0) + (is_scaled ? 2 : 0);
  return roundings == 0 ? 0.0 : 2.0 * roundings * kUnitRoundoff * largest + kUnderflow;
}

// Files named .pts may begin with the number of their points, as scanners write them; others do
// not.
enum class FirstLine { kPoint, kPointOrCount };

Vector3d point_of(const internal::TextLines& lines) {
  if (lines.words().size() < 3) lines.refuse("has no x, y and z");
  Vector3d point;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<double> number = internal::finite_number(lines.words()[k]);
    if (!number) lines.refuse(internal::in_quotes(lines.words()[k]) + " is not a finite number");
    point[static_cast<Eigen::Index>(k)] = *number;
  }
  return point;
}

std::vector<Vector3d> text_points(std::string_view text, const std::string& file,
                                  FirstLine first_line) {
  std::vector<Vector3d> points;
  std::optional<std::int64_t> count;
  internal::TextLines lines(text, file, 3);
  for (bool is_first = true; lines.next(); is_first = false) {
    if (is_first && first_line == FirstLine::kPointOrCount && lines.words().size() == 1) {
      count = internal::whole_number(lines.words()[0]);
      if (count) continue;
    }
    points.push_back(point_of(lines));
  }
  if (count && *count != static_cast<std::int64_t>(points.size())) {
    throw Error(file, "its first line says " + std::to_string(*count) + " points, but it has " +
                          std::to_string(points.size()));
  }
  return points;
}

// The vertices, by their properties x, y and z; other properties and elements are passed over.
std::vector<Vector3d> ply_points(internal::PlyData& data) {
  std::vector<Vector3d> points;
  bool has_vertices = false;
  for (const internal::PlyElement& element : data.elements()) {
    if (element.name != "vertex") {
      data.skip(element);
      continue;
    }
    has_vertices = true;
    points = data.read_points(element);
  }
  data.expect_end();
  if (!has_vertices) throw Error(data.subject(), "it has no vertices");
  return points;
}

}  // namespace

PointCloudFile read_point_cloud(const std::filesystem::path& path, double scale) {
  static constexpr std::array<std::string_view, 5> kTextExtensions = {"xyz", "txt", "csv", "asc",
                                                                      "pts"};
  const std::string file = path.string();
  if (!(scale >= kLeastScale && scale <= kMaxCoordinate)) {
    throw Error(file, "the scale is not a number from 1e-300 to 1e15");
  }
  const std::string extension = internal::lower_extension(path);
  const bool is_ply = extension == "ply";
  if (!is_ply && std::ranges::find(kTextExtensions, extension) == kTextExtensions.end()) {
    throw Error(file, "points are read from files named .ply, .xyz, .txt, .csv, .asc or .pts");
  }
  const std::string content = read_file(path);
  PointCloudFile cloud;
  bool is_rounded = true;
  if (is_ply) {
    internal::PlyData data(content, file);
    cloud.points = ply_points(data);
    is_rounded = data.is_text();
  } else {
    cloud.points = text_points(content, file,
                               extension == "pts" ? FirstLine::kPointOrCount : FirstLine::kPoint);
  }
  if (cloud.points.empty()) throw Error(file, "it has no points");
  double largest = 0.0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    Vector3d& point = cloud.points[i];
    point *= scale;
    if (!is_usable_point(point)) {
      throw Error(file, "point " + std::to_string(i) + " is beyond 1e15 or not finite");
    }
    largest = std::max(largest, point.lpNorm<Eigen::Infinity>());
  }
  cloud.point_error = point_error(is_rounded, scale != 1.0, largest);
  return cloud;
}

}  // namespace spherule
