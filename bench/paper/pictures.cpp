// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/pictures.h"

#include "bench/baseline/convex_hull.h"
#include "bench/baseline/voxelisation.h"
#include "bench/paper/picture.h"
#include "bench/placed_cell.h"
#include "tests/support/solids.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

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

void write_pictures(const Workload& workload, const PaperResults& results,
                    const std::filesystem::path& folder) {
  write_figure_2(results.figure_2, folder);
  write_figure_4(results.courses, folder);
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
