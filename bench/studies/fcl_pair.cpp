// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/fcl_pair.h"

#include "bench/checkers/fcl_meshes.h"
#include "tests/support/fcl_models.h"

#include <memory>

namespace spherule {
namespace {

template <class Volume>
class FclPair : public PairEngine {
 public:
  FclPair(const TriangleMesh& a, const TriangleMesh& b, bool boxes_in_front)
      : a_(a), b_(b), box_(b_.world_box(world_from_b_)), boxes_in_front_(boxes_in_front) {}

  void set_poses(std::span<const Pose> world_from_a) override {
    poses_.clear();
    for (const Pose& pose : world_from_a) poses_.push_back(fcl_pose<S>(pose));
  }

  bool collides(std::size_t pose) override {
    if (boxes_in_front_ && !a_.world_box(poses_[pose]).intersects(box_)) return false;
    return fcl_meshes_touch<Volume>(*a_.geometry, poses_[pose], *b_.geometry, world_from_b_);
  }

  double distance(std::size_t pose) override {
    return static_cast<double>(
        fcl_mesh_distance<Volume>(*a_.geometry, poses_[pose], *b_.geometry, world_from_b_));
  }

 private:
  using S = typename Volume::S;

  const fcl::Transform3<S> world_from_b_ = fcl::Transform3<S>::Identity();
  FclModel<Volume> a_;
  FclModel<Volume> b_;
  Eigen::AlignedBox<S, 3> box_;
  bool boxes_in_front_;
  std::vector<fcl::Transform3<S>> poses_;
};

template <class Volume>
NamedPairEngine named(const char* name, const TriangleMesh& a, const TriangleMesh& b,
                      bool boxes_in_front) {
  return {name, std::make_unique<FclPair<Volume>>(a, b, boxes_in_front)};
}

std::vector<NamedPairEngine> collide_engines(const TriangleMesh& a, const TriangleMesh& b,
                                             bool boxes_in_front) {
  std::vector<NamedPairEngine> engines;
  engines.push_back(named<fcl::OBB<double>>("OBB double", a, b, boxes_in_front));
  engines.push_back(named<fcl::OBB<float>>("OBB float", a, b, boxes_in_front));
  engines.push_back(named<fcl::OBBRSS<double>>("OBBRSS double", a, b, boxes_in_front));
  engines.push_back(named<fcl::OBBRSS<float>>("OBBRSS float", a, b, boxes_in_front));
  return engines;
}

}  // namespace

std::vector<NamedPairEngine> fcl_collide_engines(const TriangleMesh& a, const TriangleMesh& b) {
  return collide_engines(a, b, false);
}

std::vector<NamedPairEngine> fcl_boxed_collide_engines(const TriangleMesh& a,
                                                       const TriangleMesh& b) {
  return collide_engines(a, b, true);
}

std::vector<NamedPairEngine> fcl_distance_engines(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<NamedPairEngine> engines;
  engines.push_back(named<fcl::OBBRSS<double>>("OBBRSS double", a, b, false));
  engines.push_back(named<fcl::OBBRSS<float>>("OBBRSS float", a, b, false));
  engines.push_back(named<fcl::RSS<double>>("RSS double", a, b, false));
  return engines;
}

}  // namespace spherule
