// SPDX-License-Identifier: BSD-3-Clause
#include "tests/collide_truth/near_contact.h"

namespace spherule::test {
namespace {

// The search ends at this distance from the border. On the way it passes 2 mm and 0.1 mm; each
// halving judges one pose, so that poses at all of these distances are among the results.
constexpr double kNearest = 1e-3;
// Share of the poses that are random without a search.
constexpr double kRandomShare = 0.1;

Pose centered_pose(const FittedModel& model, const Eigen::Quaterniond& rotation,
                   const Eigen::Vector3d& center) {
  return Pose(rotation, center - rotation * model.center);
}

// On a random triangle.
Eigen::Vector3d surface_point(const TriangleMesh& mesh, Random& random) {
  const Eigen::Vector3i& t = mesh.triangles[random.index(mesh.triangles.size())];
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  const double s = random.unit(), r = random.unit() * (1.0 - s);
  return corner(0) + s * (corner(1) - corner(0)) + r * (corner(2) - corner(0));
}

class Search {
 public:
  Search(const FittedModel& a, const FittedModel& b, std::vector<JudgedPose>& poses)
      : a_(a), b_(b), poses_(poses) {}

  bool judge(const Pose& world_from_a, const Pose& world_from_b) {
    const bool touching = touch(a_.mesh, world_from_a, b_.mesh, world_from_b);
    poses_.push_back({world_from_a, world_from_b, touching});
    return touching;
  }

  void random_pose(Random& random) {
    const Eigen::Vector3d offset =
        random.direction() * (a_.radius + b_.radius) * random.between(0.0, 1.1);
    judge(centered_pose(a_, random.rotation(), Eigen::Vector3d::Zero()),
          centered_pose(b_, random.rotation(), offset));
  }

  // Sets a point of b's surface on one of a's and halves the way from there to far outside.
  void bisect(Random& random) {
    const Pose world_from_a = centered_pose(a_, random.rotation(), 500.0 * random.direction());
    const Eigen::Quaterniond rotation = random.rotation();
    const Eigen::Vector3d start = world_from_a * surface_point(a_.triangles, random) -
                                  rotation * surface_point(b_.triangles, random);
    const Eigen::Vector3d direction = random.direction();
    const auto at = [&](double s) -> Pose { return Pose(rotation, start + s * direction); };
    double near = 0.0, far = 2.0 * (a_.radius + b_.radius) + 1.0;
    if (!judge(world_from_a, at(near))) return;
    while (far - near > kNearest) {
      const double middle = 0.5 * (near + far);
      (judge(world_from_a, at(middle)) ? near : far) = middle;
    }
  }

 private:
  const FittedModel& a_;
  const FittedModel& b_;
  std::vector<JudgedPose>& poses_;
};

}  // namespace

std::vector<JudgedPose> judged_poses(const FittedModel& a, const FittedModel& b, std::size_t count,
                                     Random& random) {
  std::vector<JudgedPose> poses;
  Search search(a, b, poses);
  while (static_cast<double>(poses.size()) < kRandomShare * static_cast<double>(count)) {
    search.random_pose(random);
  }
  while (poses.size() < count) search.bisect(random);
  return poses;
}

}  // namespace spherule::test
