// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "base/text.h"
#include "io/ply_data.h"
#include "robot/files/format_text.h"
#include "robot/files/pcd_data.h"
#include "robot/files/scene_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

// Which columns of a table of text are x, y and z.
using Columns = std::array<std::size_t, 3>;

// By the names of a first line, as "x,y,z" and, from CloudCompare, "//X Y Z R G B" have them.
std::optional<Columns> named_columns(std::span<const std::string_view> words) {
  Columns columns = {words.size(), words.size(), words.size()};
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string_view name = words[i];
    if (i == 0 && name.starts_with("//")) name.remove_prefix(2);
    if (name.size() == 3 && name.front() == '"' && name.back() == '"') name = name.substr(1, 1);
    if (name.size() != 1) continue;
    const std::size_t axis = std::string_view("xyzXYZ").find(name[0]);
    if (axis == std::string_view::npos) continue;
    if (columns[axis % 3] != words.size()) return std::nullopt;
    columns[axis % 3] = i;
  }
  if (std::ranges::find(columns, words.size()) != columns.end()) return std::nullopt;
  return columns;
}

bool is_number(std::string_view word) {
  return internal::has_form_of_number(word) || internal::is_not_finite(word);
}

Vector3d point_of(const internal::TextLines& lines, const Columns& columns) {
  Vector3d point;
  for (std::size_t k = 0; k < 3; ++k) {
    if (columns[k] >= lines.words().size()) lines.refuse("has no x, y and z");
    const std::string_view word = lines.words()[columns[k]];
    std::optional<double> number = internal::finite_number(word);
    if (!number && internal::is_not_finite(word)) number = std::nan("");
    if (!number) lines.refuse(internal::in_quotes(word) + " is not a number");
    point[static_cast<Eigen::Index>(k)] = *number;
  }
  return point;
}

// Files named .pts may begin with the number of their points, as scanners write them, and so may
// what follows the names that CloudCompare writes; others do not.
std::vector<Vector3d> text_points(std::string_view text, const std::string& file, bool is_pts) {
  std::vector<Vector3d> points;
  std::optional<std::int64_t> count;
  Columns columns = {0, 1, 2};
  internal::TextLines lines(text, file, 3);
  bool may_be_names = true;
  bool may_be_count = is_pts;
  while (lines.next()) {
    const std::string_view first = lines.words()[0];
    if (may_be_names && !first.empty() && !is_number(first)) {
      const bool is_remark = first.starts_with("//");
      if (const std::optional<Columns> named = named_columns(lines.words())) {
        columns = *named;
        lines.look_at(*std::ranges::max_element(columns) + 1);
      } else if (!is_remark) {
        lines.refuse(internal::in_quotes(first) +
                     " is not a number, and the line does not name columns x, y and z");
      }
      may_be_names = false;
      may_be_count = is_pts || is_remark;
      continue;
    }
    may_be_names = false;
    if (may_be_count && lines.words().size() == 1) {
      may_be_count = false;
      count = internal::whole_number(first);
      if (count) continue;
    }
    may_be_count = false;
    points.push_back(point_of(lines, columns));
  }
  if (count && *count != static_cast<std::int64_t>(points.size())) {
    throw Error(file, "it says that it has " + std::to_string(*count) + " points, but it has " +
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
    points = data.read_points(element, internal::NonFinite::kRead);
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
  const bool is_text = std::ranges::find(kTextExtensions, extension) != kTextExtensions.end();
  if (!is_text && extension != "ply" && extension != "pcd") {
    throw Error(file,
                "points are read from files named .ply, .pcd, .xyz, .txt, .csv, .asc or .pts");
  }
  const std::string content = read_file(path);
  PointCloudFile cloud;
  bool is_rounded = true;
  if (extension == "ply") {
    internal::PlyData data(content, file);
    cloud.points = ply_points(data);
    is_rounded = data.is_text();
  } else if (extension == "pcd") {
    internal::PcdPoints read = internal::read_pcd(content, file);
    cloud.points = std::move(read.points);
    is_rounded = read.is_rounded;
  } else {
    cloud.points = text_points(content, file, extension == "pts");
  }
  double largest = 0.0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    const Vector3d point = cloud.points[i] * scale;
    if (!is_usable_point(point)) {
      throw Error(file, "point " + std::to_string(i) + " is beyond 1e15");
    }
    largest = std::max(largest, point.lpNorm<Eigen::Infinity>());
    cloud.points[kept++] = point;
  }
  if (kept == 0) throw Error(file, "it has no points");
  cloud.points.resize(kept);
  cloud.point_error = point_error(is_rounded, scale != 1.0, largest);
  return cloud;
}

}  // namespace spherule
