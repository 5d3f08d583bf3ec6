// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/picture.h"
#include "bench/paper/report.h"
#include "bench/scenes/solids.h"
#include "collide/robot/kinematics.h"

#include <string>
#include <utility>

namespace spherule {
namespace {

const Eigen::Vector3d kSteel(0.62, 0.66, 0.70);
const Eigen::Vector3d kBlue(0.16, 0.44, 0.59);
const Eigen::Vector3d kOrange(0.93, 0.55, 0.21);
const Eigen::Vector3d kGrey(0.75, 0.75, 0.75);
const Eigen::Vector3d kFromTheSide(1.0, -1.2, 0.7);

// A configuration of the first weld.
constexpr std::size_t kShownConfiguration = 300;

// The parts in their places, as meshes or as spheres.
PictureItem& add(const Part& part, const Pose& pose, bool in_spheres, PictureItem& item) {
  if (in_spheres) {
    for (const Sphere& sphere : part.tree->spheres()) {
      item.spheres.push_back({pose * sphere.center, sphere.radius});
    }
  } else {
    append(item.mesh, placed(part.mesh, pose.matrix(), pose.translation()));
  }
  return item;
}

void draw_cell(const Workload& workload, bool in_spheres, bool only_robot,
               const std::filesystem::path& path) {
  std::vector<Pose> world_from_link;
  forward_kinematics(workload.robot, workload.program[kShownConfiguration], world_from_link);
  PictureItem robot{.color = kOrange};
  PictureItem torch{.color = kSteel};
  for (const Body& body : workload.bodies) {
    add(body.part, world_from_link[static_cast<std::size_t>(body.link)], in_spheres,
        body.part.name == "torch" ? torch : robot);
  }
  std::vector<PictureItem> items = {std::move(robot), std::move(torch)};
  if (!only_robot) {
    for (const Obstacle& obstacle : workload.obstacles) {
      PictureItem item{.color = obstacle.part.name == "workpiece" ? kBlue : kGrey};
      items.push_back(add(obstacle.part, obstacle.world_from_part, in_spheres, item));
    }
  }
  write_picture(items, kFromTheSide, path);
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
  draw_cell(workload, true, true, folder / "paper-figure5.pov");
  draw_cell(workload, false, false, folder / "paper-figure9.pov");
  draw_cell(workload, true, false, folder / "paper-figure9-spheres.pov");
}

}  // namespace spherule
