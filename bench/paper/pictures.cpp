// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/picture.h"
#include "bench/paper/report.h"
#include "bench/placed_cell.h"
#include "bench/scenes/solids.h"

#include <map>
#include <string>
#include <vector>

namespace spherule {
namespace {

const Eigen::Vector3d kSteel(0.62, 0.66, 0.70);
const Eigen::Vector3d kBlue(0.16, 0.44, 0.59);
const Eigen::Vector3d kOrange(0.93, 0.55, 0.21);
const Eigen::Vector3d kGrey(0.75, 0.75, 0.75);
const Eigen::Vector3d kFromTheSide(1.0, -1.2, 0.7);

const std::map<std::string, Eigen::Vector3d> kColors = {
    {"robot", kOrange}, {"torch", kSteel}, {"workpiece", kBlue}, {"table", kGrey}};

using Cell = std::map<std::string, PlacedParts>;

PictureItem in_meshes(const Cell& cell, const std::string& name) {
  return {.color = kColors.at(name), .mesh = cell.at(name).mesh};
}

PictureItem in_spheres(const Cell& cell, const std::string& name) {
  return {.color = kColors.at(name), .spheres = cell.at(name).spheres};
}

}  // namespace

void write_pictures(const Workload& workload, const std::vector<FitCourse>& courses,
                    const std::filesystem::path& folder) {
  const Eigen::Matrix3d lying = along_x();
  write_picture(
      {{.color = kSteel, .mesh = placed(make_paper_pipe(), lying, Eigen::Vector3d::Zero())}},
      kFromTheSide, folder / "paper-figure4-mesh.pov");
  for (const FitCourse& course : courses) {
    PictureItem pipe{.color = kBlue};
    for (const Sphere& sphere : course.spheres) {
      pipe.spheres.push_back({lying * sphere.center, sphere.radius});
    }
    write_picture({pipe}, kFromTheSide, folder / ("paper-figure4-" + course.method + ".pov"));
  }
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
