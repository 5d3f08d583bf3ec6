// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/picture.h"

#include "base/error.h"
#include "base/files.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

namespace spherule {
namespace {

constexpr double kAngle = 28.0;        // of the view's width, degrees
constexpr double kHeightShare = 0.75;  // of a picture's height to its width

std::string text(const Eigen::Vector3d& v) {
  std::ostringstream out;
  out.precision(9);
  out << '<' << v.x() << ',' << v.y() << ',' << v.z() << '>';
  return out.str();
}

Eigen::AlignedBox3d box_around(const std::vector<PictureItem>& items) {
  Eigen::AlignedBox3d box;
  for (const PictureItem& item : items) {
    for (const Eigen::Vector3d& vertex : item.mesh.vertices) box.extend(vertex);
    for (const Sphere& sphere : item.spheres) {
      box.extend((sphere.center.array() - sphere.radius).matrix());
      box.extend((sphere.center.array() + sphere.radius).matrix());
    }
  }
  return box;
}

void draw(const PictureItem& item, std::ostringstream& out) {
  out << "#declare Finish = texture { pigment { color rgb " << text(item.color)
      << " } finish { ambient 0.25 diffuse 0.7 specular 0.15 } }\n";
  for (const Sphere& sphere : item.spheres) {
    out << "sphere { " << text(sphere.center) << ", " << sphere.radius << " texture { Finish } }\n";
  }
  if (item.mesh.triangles.empty()) return;
  out << "mesh {\n";
  for (const Eigen::Vector3i& triangle : item.mesh.triangles) {
    const auto [a, b, c] = corners_of(item.mesh, triangle);
    // POV-Ray warns of triangles without an area and leaves them out.
    if ((b - a).cross(c - a).isZero(0.0)) continue;
    out << "triangle { " << text(a) << ", " << text(b) << ", " << text(c) << " }\n";
  }
  out << "texture { Finish } }\n";
}

}  // namespace

void write_picture(const std::vector<PictureItem>& items, const Eigen::Vector3d& towards_viewer,
                   const std::filesystem::path& path) {
  const Eigen::AlignedBox3d box = box_around(items);
  if (box.isEmpty()) throw Error(path.string(), "a picture of nothing");
  const double half_width = std::tan(0.5 * kAngle * std::numbers::pi / 180.0);
  const double away = 0.5 * box.diagonal().norm() / std::sin(std::atan(kHeightShare * half_width));
  const Eigen::Vector3d camera = box.center() + away * towards_viewer.normalized();
  std::ostringstream out;
  out.precision(9);
  // z up in a right-handed frame, unlike POV-Ray's own.
  out << "#version 3.7;\nglobal_settings { assumed_gamma 1 }\nbackground { color rgb 1 }\n"
      << "camera { location " << text(camera) << " sky z up z right -x*image_width/image_height"
      << " look_at " << text(box.center()) << " angle " << kAngle << " }\n"
      << "light_source { " << text(camera + away * Eigen::Vector3d(0.3, -0.4, 1.0))
      << " color rgb 0.9 }\n"
      << "light_source { " << text(camera) << " color rgb 0.35 shadowless }\n";
  for (const PictureItem& item : items) draw(item, out);
  write_file_atomically(path, out.str());
}

}  // namespace spherule
