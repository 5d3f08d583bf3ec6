// SPDX-License-Identifier: BSD-3-Clause

// Is a pair of bodies free all along a part of a straight motion in joint space?
//
// Let the part be all times within h of its middle, v the velocity of a point of the first body
// there, as seen from a link in whose directions a vector n of unit length is fixed, and let the
// bounds of path_reach.cpp hold over the whole motion: speed, and bend for half of an acceleration.
//
// A solid that stands still. Let a plane with the normal n have the solid behind it and the ball
// (c, r) before it, at a distance g of c in the middle. Then c is, by Taylor's theorem, anywhere in
// the part at least g - |n . v| h - bend h^2 from it, and at least g - speed h: as long as one of
// these exceeds r the ball is apart from the solid. What is inside of the ball on the body is so,
// too: nodes of a tree speak for their leaves.
//
// Two balls whose centres are at the offset w in the middle, |w| = g, n = w / g. The distance is at
// least n . (offset), so that the same holds with the sum of the radii, the velocity of the offset
// and the bounds of both bodies together. What the one who looks turns with adds to the velocity of
// the offset a vector at right angles to w: as seen from the world n . v is the same.
//
// A mesh is tested with all spheres grown by speed h.
//
// Rounding. Let e be pose_error(): it bounds how far a point of a link is from where the exact
// mechanism has it, and 360 u (n + 2) W of it are left besides, W bounding all lengths involved and
// n >= 1 being the number of joints. From the poses that are looked at to the exact mechanism, and
// from there to the poses computed for any other configuration of the part, are e for each body:
// 4 e cover these, with the slack of the canonical test there, of less than 1700 u W, and the
// distance from the plane, of less than 250 u W (solid_fields.h, and 200 u W for the image of c).
// Velocities are sums of rate times (axis x offset), where axes err by 60 u (n + 2) and offsets by
// 2 e, both taken from the world's origin, at most W away: by less than 3 e times the rate for each
// joint. And where w is off by 2 e, what the world turns with is not quite at right angles to it: 2
// e times the rate. For both bodies, times h <= 1/2, 4 e.
//
// The middle itself, made of rounded fractions of positions up to 100, errs by less than 9 u times
// 100 < kMiddleError / 9 for each variable. So what is looked at is the exact middle of a motion
// beside the one that is asked for, with the same rates. At no time is a point further from where
// it is on that one than the sum over the joints of this error times its distance from the axis,
// which is below 2 W: pad_ has more than twice that, for both bodies. Velocities are those of the
// motion beside, so that they err by nothing more, and the bounds hold for it as well: prismatic
// joints, with which W is above 100, are beyond `shifts` on it by less than e, which PathReach
// allows. (Of joints that mimic others e has all errors of positions.) Sums err by less than
// kRelativeSlack of themselves (path_reach.h).

#include "collide/edge_halving.h"
#include "collide/robot/internal/body_pairs.h"
#include "collide/robot/internal/link_paths.h"
#include "collide/solid_fields.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace spherule::internal {
namespace {

constexpr double kMiddleError = 1e-12;

// With all joints at zero; the root at the origin.
std::vector<Pose> poses_at_zero(const RobotModel& robot) {
  std::vector<Pose> poses(robot.links().size());
  for (const Joint& joint : robot.joints()) {
    poses[static_cast<std::size_t>(joint.child_link)] =
        poses[static_cast<std::size_t>(joint.parent_link)] * joint.parent_from_joint;
  }
  return poses;
}

}  // namespace

void BodyPairs::make_paths() {
  const std::vector<Pose> poses = poses_at_zero(robot_);
  std::map<int, std::size_t> to_root;  // of pieces
  for (std::size_t i = 0; i < tested_; ++i) {
    const CheckedPair& pair = pairs_[i];
    path_of_.push_back(paths_.size());
    if (pair.is_obstacle) {
      const auto [known, is_new] = to_root.try_emplace(pair.piece, paths_.size());
      path_of_.back() = known->second;
      if (!is_new) continue;
    }
    const CheckedPiece& first = pieces_[static_cast<std::size_t>(pair.piece)];
    const CheckedPiece* const second =
        pair.is_obstacle ? nullptr : &pieces_[static_cast<std::size_t>(pair.other)];
    std::vector<int> joints;
    for (const int j : joints_between(robot_, first.link, second == nullptr ? 0 : second->link)) {
      if (robot_.joints()[static_cast<std::size_t>(j)].moves()) joints.push_back(j);
    }
    if (second == nullptr) {
      paths_.emplace_back(robot_, poses, pose_error_, joints, first.link, first.tree->ball(0));
    } else {
      paths_.emplace_back(robot_, poses, pose_error_, joints, first.link, first.tree->ball(0),
                          second->link, second->tree->ball(0));
    }
  }
}

// The motion as EdgeHalving asks for it.
class BodyPairs::EdgeMotion {
 public:
  EdgeMotion(const BodyPairs& pairs, std::span<const double> from, std::span<const double> to,
             const EdgeRequest& request, Memory& memory)
      : pairs_(pairs),
        from_(from),
        to_(to),
        enough_(0.5 * request.resolution),
        to_the_end_(request.first),
        memory_(memory) {
    const std::vector<Joint>& joints = pairs_.robot_.joints();
    memory_.rates.assign(joints.size(), 0.0);
    memory_.speeds.assign(joints.size(), 0.0);
    memory_.shifts.assign(joints.size(), 0.0);
    double rates = 0.0;
    double factors = 0.0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!joints[j].moves()) continue;
      const auto variable = static_cast<std::size_t>(joints[j].variable);
      memory_.rates[j] = joints[j].multiplier * (to_[variable] - from_[variable]);
      memory_.speeds[j] = std::abs(memory_.rates[j]) * (1.0 + kRelativeSlack);
      memory_.shifts[j] =
          std::max(std::abs(joints[j].position(from_)), std::abs(joints[j].position(to_))) *
          (1.0 + kRelativeSlack);
      rates += memory_.speeds[j];
      factors += std::abs(joints[j].multiplier);
    }
    pad_ = (4.0 + 4.0 * rates) * pairs_.pose_error_ +
           factors * kMiddleError * std::max(2.0 * pairs_.size_, 1.0);
    memory_.bounds.resize(pairs_.paths_.size());
    for (std::size_t i = 0; i < pairs_.paths_.size(); ++i) {
      memory_.bounds[i] = pairs_.paths_[i].bounds(memory_.speeds, memory_.shifts, memory_.work);
    }
    memory_.variables.resize(from.size());
    memory_.twists.resize(pairs_.robot_.links().size());
    memory_.balls.resize(pairs_.pieces_.size());
    memory_.balls_of.assign(pairs_.pieces_.size(), 0);
    memory_.stack.resize(pairs_.stack_size_);
    for (std::size_t i = 0; i < pairs_.pieces_.size(); ++i) {
      memory_.balls[i].resize(pairs_.pieces_[i].tree->node_count());
    }
  }

  void set(double at, std::uint64_t number) {
    for (std::size_t i = 0; i < from_.size(); ++i) {
      memory_.variables[i] = (1.0 - at) * from_[i] + at * to_[i];
    }
    pairs_.place(memory_.variables, memory_);
    const std::vector<Joint>& joints = pairs_.robot_.joints();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const Pose& child = memory_.world_from_link[static_cast<std::size_t>(joints[j].child_link)];
      Twist twist = memory_.twists[static_cast<std::size_t>(joints[j].parent_link)];
      if (memory_.rates[j] != 0.0) {
        const Eigen::Vector3d rate = memory_.rates[j] * (child.matrix() * joints[j].axis);
        if (joints[j].turns()) {
          twist.turning += rate;
          twist.at_origin += child.translation().cross(rate);
        } else {
          twist.at_origin += rate;
        }
      }
      memory_.twists[static_cast<std::size_t>(joints[j].child_link)] = twist;
    }
    for (std::size_t i = 0; i < pairs_.pieces_.size(); ++i) {
      const Sphere& root = memory_.placed[i];
      memory_.balls[i][0] = {root.center, twist_of(i).of(root.center), root.radius};
    }
    number_ = number;
  }

  PartFinding look(std::int32_t open, double half, double& growth) {
    const auto index = static_cast<std::size_t>(open);
    const CheckedPair& pair = pairs_.pairs_[index];
    const PathBounds& bounds = memory_.bounds[pairs_.path_of_[index]];
    const PartBounds part{half, bounds.speed * half, bounds.bend * (half * half), pad_, enough_};
    if (!pair.is_obstacle) return look_at_bodies(index, part, growth);
    const auto other = static_cast<std::size_t>(pair.other);
    const MovingBall& root = memory_.balls[static_cast<std::size_t>(pair.piece)].front();
    if (pairs_.is_beyond(other, root.center, root.radius + part.way + part.pad)) {
      return PartFinding::kApart;
    }
    const PlacedShape& obstacle = pairs_.obstacles_[other];
    const Primitive* const solid = std::get_if<Primitive>(&obstacle.shape);
    if (solid != nullptr) {
      return std::visit(
          [&](const auto& shape) {
            return look_at_solid(field_of(shape), obstacle.world_from_shape, index, part, growth);
          },
          *solid);
    }
    growth = part.way + part.pad;
    if (!pairs_.is_near(pair, growth, memory_)) return PartFinding::kApart;
    return pairs_.touches(index, memory_) ? PartFinding::kTouch : PartFinding::kNear;
  }

  bool touches() { return pairs_.any_touches(memory_); }

 private:
  const Twist& twist_of(std::size_t piece) const {
    return memory_.twists[static_cast<std::size_t>(pairs_.pieces_[piece].link)];
  }

  // Of all nodes of the tree of a piece.
  std::span<const MovingBall> balls_of(std::size_t piece) {
    std::vector<MovingBall>& balls = memory_.balls[piece];
    if (memory_.balls_of[piece] == number_) return balls;
    memory_.balls_of[piece] = number_;
    const SphereTree& tree = *pairs_.pieces_[piece].tree;
    const Pose& pose = pairs_.pose_of(pairs_.pieces_[piece], memory_);
    const Twist& twist = twist_of(piece);
    for (std::size_t i = 1; i < balls.size(); ++i) {
      const Sphere ball = tree.ball(i);
      balls[i].center = pose * ball.center;
      balls[i].velocity = twist.of(balls[i].center);
      balls[i].radius = ball.radius;
    }
    return balls;
  }

  template <class Field>
  PartFinding look_at_solid(const Field& field, const Pose& world_from_solid, std::size_t index,
                            const PartBounds& part, double& growth) {
    const auto piece = static_cast<std::size_t>(pairs_.pairs_[index].piece);
    const SphereTree& tree = *pairs_.pieces_[piece].tree;
    const auto plane = [&](const MovingBall& ball) {
      const Eigen::Matrix3d& turn = world_from_solid.matrix();
      const Eigen::Vector3d center =
          turn.transpose() * (ball.center - world_from_solid.translation());
      const Eigen::Vector3d normal = field.outward(center);
      return SeparatingPlane{normal.dot(center) - field.support(normal), normal.norm(),
                             (turn * normal).dot(ball.velocity)};
    };
    const MovingBall& root = memory_.balls[piece].front();
    PartSearch search(part);
    if (search.opens(plane(root), root.radius, root.radius, tree.is_leaf(0))) {
      search.run(tree, balls_of(piece), plane, memory_.stack);
    }
    return concluded(search, index, part, growth);
  }

  PartFinding look_at_bodies(std::size_t index, const PartBounds& part, double& growth) {
    const auto first = static_cast<std::size_t>(pairs_.pairs_[index].piece);
    const auto second = static_cast<std::size_t>(pairs_.pairs_[index].other);
    const SphereTree& a = *pairs_.pieces_[first].tree;
    const SphereTree& b = *pairs_.pieces_[second].tree;
    const auto plane = [](const MovingBall& of_a, const MovingBall& of_b) {
      const Eigen::Vector3d offset = of_a.center - of_b.center;
      const double squared = offset.squaredNorm();
      return SeparatingPlane{squared, std::sqrt(squared),
                             offset.dot(of_a.velocity - of_b.velocity)};
    };
    const MovingBall& root_a = memory_.balls[first].front();
    const MovingBall& root_b = memory_.balls[second].front();
    const double reach = root_a.radius + root_b.radius + part.way + part.pad;
    if ((root_a.center - root_b.center).squaredNorm() > reach * reach) return PartFinding::kApart;
    PartSearch search(part);
    if (search.opens(plane(root_a, root_b), root_a.radius + root_b.radius,
                     std::max(root_a.radius, root_b.radius), a.is_leaf(0) && b.is_leaf(0))) {
      search.run(a, balls_of(first), b, balls_of(second), plane, memory_.stack);
    }
    return concluded(search, index, part, growth);
  }

  PartFinding concluded(const PartSearch& search, std::size_t index, const PartBounds& part,
                        double& growth) const {
    growth = to_the_end_ ? part.way : search.growth();
    if (!search.is_near()) return PartFinding::kApart;
    return search.may_touch() && pairs_.touches(index, memory_) ? PartFinding::kTouch
                                                                : PartFinding::kNear;
  }

  const BodyPairs& pairs_;
  std::span<const double> from_;
  std::span<const double> to_;
  const double enough_;
  // Whether pairs that pass each other closely are looked at in parts as short as those that
  // approach, so as to tell where they first come close.
  const bool to_the_end_;
  double pad_ = 0.0;
  Memory& memory_;
  std::uint64_t number_ = 0;
};

EdgeResult BodyPairs::check_edge(std::span<const double> from, std::span<const double> to,
                                 double end, const EdgeRequest& request, Memory& memory) const {
  using Halving = EdgeHalving<EdgeMotion>;
  memory.open_pairs.resize(Halving::list_size(tested_));
  EdgeMotion motion(*this, from, to, request, memory);
  return Halving(motion, memory.open_pairs, request, end).run();
}

}  // namespace spherule::internal
