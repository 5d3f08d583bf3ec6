// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"
#include "bench/baseline/mesh_methods.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/paper/paper.h"
#include "bench/studies/study.h"
#include "tests/support/solids.h"

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

constexpr double kAngle = 28.0;        // of the view's width, degrees
constexpr double kHeightShare = 0.75;  // of a picture's height to its width

// A mesh or spheres in one colour (red, green, blue from 0 to 1).
struct PictureItem {
  Eigen::Vector3d color;
  TriangleMesh mesh{};
  std::vector<Sphere> spheres{};
};

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

// What POV-Ray makes a picture of, four wide to three high: all items seen from `towards_viewer` of
// their middle, z up.
void write_picture(const std::vector<PictureItem>& items, const Eigen::Vector3d& towards_viewer,
                   const std::filesystem::path& path) {
  const Eigen::AlignedBox3d box = box_around(items);
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

const Eigen::Vector3d kSteel(0.62, 0.66, 0.70);
const Eigen::Vector3d kBlue(0.16, 0.44, 0.59);
const Eigen::Vector3d kOrange(0.93, 0.55, 0.21);
const Eigen::Vector3d kGrey(0.75, 0.75, 0.75);
const Eigen::Vector3d kFromTheSide(1.0, -1.2, 0.7);
const Eigen::Vector3d kFromTheFront(0.35, -1.0, 0.35);

const std::map<std::string, Eigen::Vector3d> kColors = {
    {"robot", kOrange}, {"torch", kSteel}, {"workpiece", kBlue}, {"table", kGrey}};

using Cell = std::map<std::string, PlacedParts>;

PictureItem in_meshes(const Cell& cell, const std::string& name) {
  return {.color = kColors.at(name), .mesh = cell.at(name).mesh};
}

PictureItem in_spheres(const Cell& cell, const std::string& name) {
  return {.color = kColors.at(name), .spheres = cell.at(name).spheres};
}

void write_figure_2(const Figure2& figure, const std::filesystem::path& folder) {
  write_picture({{.color = kSteel, .mesh = figure.part}}, kFromTheFront,
                folder / "paper-figure2-mesh.pov");
  for (const Figure2::Fit& fit : figure.fits) {
    write_picture({{.color = kBlue, .spheres = fit.spheres}}, kFromTheFront,
                  folder / ("paper-figure2-" + fit.method + ".pov"));
  }
}

// The pipe lying, in every way the paper shows it and ours.
void write_figure_4(const std::vector<FitCourse>& courses, const std::filesystem::path& folder) {
  const TriangleMesh pipe = placed(make_paper_pipe(), along_x(), Eigen::Vector3d::Zero());
  const auto write = [&](const std::string& name, PictureItem item) {
    write_picture({std::move(item)}, kFromTheSide, folder / ("paper-figure4-" + name + ".pov"));
  };
  write("mesh", {.color = kSteel, .mesh = pipe});
  write("hull", {.color = kSteel, .mesh = convex_hull(pipe).mesh});
  write("voxels",
        {.color = kBlue,
         .spheres =
             voxelise(pipe, {.step = kPaperVoxel, .sphere = VoxelSphere::kInscribed}).spheres});
  for (const FitCourse& course : courses) {
    PictureItem item{.color = kBlue};
    for (const Sphere& sphere : course.spheres) {
      item.spheres.push_back({along_x() * sphere.center, sphere.radius});
    }
    write(course.method, std::move(item));
  }
}

}  // namespace

void write_pictures(const Workload& workload, const Figure2& figure,
                    const std::vector<FitCourse>& courses, const std::filesystem::path& folder) {
  write_figure_2(figure, folder);
  write_figure_4(courses, folder);
  const Cell cell = place_cell(workload, workload.program[kShownConfiguration]);
  write_picture({in_spheres(cell, "robot"), in_spheres(cell, "torch")}, kFromTheSide,
                folder / "paper-figure5.pov");
  std::vector<PictureItem> meshes, spheres;
  for (const auto& [name, color] : kColors) {
    meshes.push_back(in_meshes(cell, name));
    spheres.push_back(in_spheres(cell, name));
  }
  write_picture(meshes, kFromTheSide, folder / "paper-figure9.pov");
  write_picture(spheres, kFromTheSide, folder / "paper-figure9-spheres.pov");
}

}  // namespace spherule
