// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/checkers/flat_scan/kernel.h"
#include "bench/checkers/sphere_checkers.h"
#include "tests/support/turn_between.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace spherule {
namespace {

struct alignas(64) Line {
  float numbers[16];
};

// Memory on the boundaries that the widest vectors need.
class Floats {
 public:
  explicit Floats(std::size_t count) : lines_((count + 15) / 16) {}
  float* data() { return reinterpret_cast<float*>(lines_.data()); }
  const float* data() const { return reinterpret_cast<const float*>(lines_.data()); }

 private:
  std::vector<Line> lines_;
};

// Above the double; the promise is that no sphere shrinks.
float rounded_up(double x) {
  const auto rounded = static_cast<float>(x);
  return static_cast<double>(rounded) < x ? std::nextafter(rounded, 2.0F * rounded) : rounded;
}

class SphereArrays {
 public:
  SphereArrays(std::span<const Sphere> spheres, const Pose& pose, double pad)
      : count_((spheres.size() + flat_scan::kPadding - 1) / flat_scan::kPadding *
               flat_scan::kPadding),
        unique_(spheres.size()),
        numbers_(4 * count_) {
    for (std::size_t i = 0; i < count_; ++i) {
      const Sphere& sphere = spheres[std::min(i, spheres.size() - 1)];
      const Eigen::Vector3d center = pose * sphere.center;
      for (std::size_t k = 0; k < 3; ++k) {
        numbers_.data()[k * count_ + i] = static_cast<float>(center[static_cast<int>(k)]);
      }
      numbers_.data()[3 * count_ + i] = rounded_up(sphere.radius + pad);
    }
  }

  flat_scan::Spheres spheres() const {
    const float* const x = numbers_.data();
    return {x,
            x + count_,
            x + 2 * count_,
            x + 3 * count_,
            static_cast<std::int32_t>(count_),
            static_cast<std::int32_t>(unique_)};
  }

 private:
  std::size_t count_;
  std::size_t unique_;
  Floats numbers_;
};

// A rotation that takes the z axis to the joint's.
Pose link_from_frame(const RobotModel& robot, const Link& link) {
  if (link.parent_joint < 0) return Pose();
  const Joint& joint = robot.joints()[static_cast<std::size_t>(link.parent_joint)];
  if (joint.type == JointType::kPrismatic || robot.variable_count() > flat_scan::kMaxVariables) {
    throw Error(joint.name, "the flat scan takes up to 8 joints that turn");
  }
  return Pose(turn_between(Eigen::Vector3d::UnitZ(), joint.axis), Eigen::Vector3d::Zero());
}

flat_scan::Frame frame_of(const RobotModel& robot, const Link& link,
                          const std::vector<Pose>& link_from_frame) {
  flat_scan::Frame frame{};
  frame.parent = -1;
  frame.variable = -1;
  Pose pose;
  if (link.parent_joint >= 0) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(link.parent_joint)];
    frame.parent = joint.parent_link;
    frame.variable = joint.variable;
    pose = link_from_frame[static_cast<std::size_t>(joint.parent_link)].inverse() *
           joint.parent_from_joint * link_from_frame[static_cast<std::size_t>(joint.child_link)];
  }
  for (int k = 0; k < 3; ++k) {
    for (int column = 0; column < 3; ++column) frame.columns[column][k] = pose.matrix()(k, column);
    frame.columns[3][k] = pose.translation()[k];
  }
  return frame;
}

flat_scan::Check kernel_for(InstructionSet instructions) {
  if (!is_available(instructions)) throw Error("flat scan", "this machine lacks the instructions");
#if defined(SPHERULE_X86_KERNELS)
  if (instructions == InstructionSet::kAvx2) return &flat_scan::avx2::check;
  if (instructions == InstructionSet::kAvx512) return &flat_scan::avx512::check;
#endif
  return &flat_scan::portable::check;
}

class FlatScanChecker : public Checker {
 public:
  FlatScanChecker(const Workload& workload, FlatScan scan, InstructionSet instructions)
      : check_(kernel_for(instructions)), pad_(single_precision_pad(scene_reach(workload))) {
    if (workload.obstacles.size() > flat_scan::kMaxObstacles) {
      throw Error(workload.name, "the flat scan takes up to 32 obstacles");
    }
    std::vector<Pose> from_frame;
    for (const Link& link : workload.robot.links()) {
      from_frame.push_back(link_from_frame(workload.robot, link));
    }
    for (const Link& link : workload.robot.links()) {
      frames_.push_back(frame_of(workload.robot, link, from_frame));
    }
    for (const Obstacle& obstacle : workload.obstacles) {
      obstacles_.push_back(add(*obstacle.part.tree, obstacle.world_from_part));
    }
    std::int32_t largest = 0;
    for (const Body& body : workload.bodies) {
      const Pose frame_from_link = from_frame[static_cast<std::size_t>(body.link)].inverse();
      flat_scan::Body moving{add(*body.part.tree, frame_from_link), body.link, 0};
      for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
        if (is_tested(body, workload.obstacles[i])) moving.against |= 1U << i;
      }
      largest = std::max(largest, moving.group.spheres.count);
      bodies_.push_back(moving);
    }
    const auto room = static_cast<std::size_t>(largest);
    placed_ = std::make_unique<Floats>(3 * room);
    poses_.resize(frames_.size());
    scratch_ = {poses_.data(), placed_->data(), placed_->data() + room, placed_->data() + 2 * room};
    problem_ = {frames_.data(),
                static_cast<std::int32_t>(frames_.size()),
                workload.robot.variable_count(),
                bodies_.data(),
                static_cast<std::int32_t>(bodies_.size()),
                obstacles_.data(),
                static_cast<std::int32_t>(obstacles_.size()),
                scan == FlatScan::kSpheresInFront};
  }

  void check(std::span<const ArmPositions> configurations,
             std::span<std::uint8_t> verdicts) override {
    for (std::size_t i = 0; i < configurations.size(); ++i) {
      verdicts[i] = check_(problem_, configurations[i].data(), scratch_) ? 1 : 0;
    }
  }

 private:
  flat_scan::Group add(const SphereTree& tree, const Pose& pose) {
    arrays_.push_back(std::make_unique<SphereArrays>(tree.spheres(), pose, pad_));
    const Eigen::Vector3d center = pose * tree.sphere(0).center;
    return {arrays_.back()->spheres(),
            {center.x(), center.y(), center.z()},
            rounded_up(tree.sphere(0).radius + pad_)};
  }

  flat_scan::Check check_;
  double pad_;
  std::vector<flat_scan::Frame> frames_;
  std::vector<std::unique_ptr<SphereArrays>> arrays_;
  std::vector<flat_scan::Group> obstacles_;
  std::vector<flat_scan::Body> bodies_;
  std::unique_ptr<Floats> placed_;
  std::vector<flat_scan::LinkPose> poses_;
  flat_scan::Problem problem_{};
  flat_scan::Scratch scratch_{};
};

}  // namespace

std::unique_ptr<Checker> make_flat_scan_checker(const Workload& workload, FlatScan scan,
                                                InstructionSet instructions) {
  return std::make_unique<FlatScanChecker>(workload, scan, instructions);
}

}  // namespace spherule
