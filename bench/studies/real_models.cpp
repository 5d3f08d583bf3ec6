// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/study.h"
#include "io/mesh_io.h"

#include <Eigen/Geometry>

#include <numbers>
#include <vector>

namespace spherule {
namespace {

// The torch's file is in centimetres, x out of the flange, and ends at the nozzle, whose rim is the
// plane x - z = kRimPlane; the nozzle points along (1, 0, -1).
constexpr double kTorchScale = 0.01;
constexpr double kRimPlane = 0.276;  // metres, a millimetre inside of the rim

// The middle of the nozzle's rim stands for the wire's end, which the file does not have.
Pose middle_of_rim(const TriangleMesh& torch) {
  Eigen::AlignedBox3d rim;
  for (const Eigen::Vector3d& vertex : torch.vertices) {
    if (vertex.x() - vertex.z() > kRimPlane) rim.extend(vertex);
  }
  return Pose(
      Eigen::Quaterniond(Eigen::AngleAxisd(0.75 * std::numbers::pi, Eigen::Vector3d::UnitY())),
      rim.center());
}

}  // namespace

Workload make_real_cell(const std::filesystem::path& models) {
  const auto visual = models / "robots" / "abb_irb4400l" / "meshes" / "irb4400l_30_243" / "visual";
  std::vector<TriangleMesh> links;
  const RobotModel robot = make_robot();
  for (const Link& link : robot.links()) {
    links.push_back(read_mesh(visual / (link.name + ".stl")));
  }
  const TriangleMesh torch = read_mesh(models / "torch" / "torch.stl", {.scale = kTorchScale});
  return make_cell("real-irb4400", links, torch, middle_of_rim(torch));
}

}  // namespace spherule
