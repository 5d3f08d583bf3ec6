// SPDX-License-Identifier: BSD-3-Clause
// sweep() of bodies that pass each other closely, and of fast ones through thin walls, against the
// exact motions at many instants.
#include "collide/collide.h"
#include "collide/sweep.h"
#include "spheretree/build.h"
#include "tests/soak/exact_oracle.h"
#include "tests/soak/motion_oracle.h"
#include "tests/soak/random_scene.h"
#include "tests/soak/scale.h"
#include "tests/soak/tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 200;
constexpr int kManySteps = 10000;
constexpr std::uint64_t kManyStepsEvery = 100;
constexpr double kWalls = 0.2;  // share of motions through thin walls

struct Course {
  bool is_between = false;
  Pose start, end;  // the end only if it is between two poses
  Vector3d axis = Vector3d::UnitZ();
  double angle = 0.0;
  Vector3d displacement = Vector3d::Zero();
  Vector3d reference = Vector3d::Zero();

  Course shifted(const Vector3d& way) const {
    Course other = *this;
    other.start = Pose(start.rotation(), start.translation() + way);
    other.end = Pose(end.rotation(), end.translation() + way);
    return other;
  }
  Motion motion() const {
    return is_between ? Motion::between(start, end, reference)
                      : Motion::turning(start, axis, angle, displacement, reference);
  }
  MovingSpheres moving(std::span<const Sphere> spheres) const {
    const double way = is_between
                           ? 2.0 * (start.translation().lpNorm<1>() + end.translation().lpNorm<1>())
                           : start.translation().lpNorm<1>() + displacement.lpNorm<1>();
    return {spheres, exact_motion<double>(), exact_motion<long double>(),
            way + 2.0 * reference.lpNorm<1>(), is_between ? std::numbers::pi : angle};
  }

 private:
  template <class Number>
  ExactMotion<Number> exact_motion() const {
    using Exact = ExactMotion<Number>;
    return is_between ? Exact::between(start, end, reference)
                      : Exact::turning(start, axis, angle, displacement, reference);
  }
};

Course random_course(SoakRandom& random, double size) {
  Course course;
  course.start = Pose(random.rotation(), random.in_cube(size));
  if (random.chance(0.3)) course.reference = random.in_cube(size);
  if (random.chance(0.25)) {
    course.is_between = true;
    course.end = Pose(random.rotation(), random.in_cube(random.magnitude(0.1, 4.0) * size));
    return course;
  }
  course.end = course.start;
  course.axis = random.in_cube(1.0) + Vector3d(0.0, 0.0, 1e-3);
  if (random.chance(0.7)) course.angle = random.between(-8.0, 8.0) * random.magnitude(1e-4, 1.0);
  if (random.chance(0.7)) {
    course.displacement = random.magnitude(1e-2, 10.0) * size * random.direction();
  }
  return course;
}

// Straight and fast, with hardly any turn or some.
Course fast_course(SoakRandom& random, double size) {
  Course course = random_course(random, size);
  course.is_between = false;
  course.end = course.start;
  course.displacement = random.magnitude(10.0, 1000.0) * random.direction();
  if (random.chance(0.5)) course.angle = 0.0;
  return course;
}

// Now and then across `motion`, so that bodies which move that way only graze each other.
Vector3d grazing(SoakRandom& random, const Vector3d& motion) {
  const Vector3d direction = random.direction();
  const Vector3d across = direction.cross(motion);
  const bool is_usable = across.norm() > 1e-3 * motion.norm();
  return is_usable && random.chance(0.7) ? across.normalized() : direction;
}

// Small spheres beside each other.
SphereTree thin_wall(SoakRandom& random) {
  const double radius = random.magnitude(1e-5, 1e-3);
  std::vector<Sphere> wall;
  const int side = random.whole(1, 4);
  for (int i = 0; i < side * side; ++i) {
    wall.push_back({Vector3d(1.8 * radius * (i % side), 1.8 * radius * (i / side), 0.0), radius});
  }
  return build_tree(wall);
}

class SweepCheck {
 public:
  std::uint64_t motions() const { return passes_.cases + clearances_.cases + walls_.cases; }
  void expect_telling() const {
    passes_.expect_telling();
    clearances_.expect_telling();
    walls_.expect_telling(0);
    EXPECT_LT(walls_.free, walls_.cases / 10);
  }

  void run(SoakRandom& random) {
    const bool is_wall = random.chance(kWalls);
    const double size =
        random.chance(0.9) ? random.between(0.05, 2.0) : random.magnitude(1e-3, 1e3);
    const int count = random.chance(0.97) ? random.whole(1, 8) : random.whole(9, 60);
    const SphereTree a = random_tree(random, count, is_wall ? 0.05 : size);
    const SphereTree b =
        is_wall ? thin_wall(random) : random_tree(random, random.whole(1, 8), size);
    // Several motions of each pair.
    for (int i = 0; i < 8; ++i) {
      Course course_a = is_wall ? fast_course(random, 0.05) : random_course(random, size);
      Course course_b = random_course(random, size);
      if (is_wall) {
        course_b.is_between = false;
        course_b.angle = 0.0;
        course_b.displacement.setZero();
      }
      SweepRequest request;
      request.resolution = random.chance(0.8) ? 1e-4 : random.magnitude(1e-9, 0.1);
      if (!is_wall && random.chance(0.2)) request.clearance = random.magnitude(1e-6, 0.1) * size;
      if (random.chance(0.1)) {
        request.max_node_tests = static_cast<std::uint64_t>(random.whole(0, 500));
      }

      const double meeting = random.chance(0.1) ? random.whole(0, 1) : random.unit();
      const double wanted =
          is_wall ? -b.spheres()[0].radius * random.unit() : request.clearance + random.small_gap();
      const auto way =
          way_to_meet({a, course_a}, {b, course_b}, meeting, wanted, is_wall ? 1.0 : 0.8, random);
      const bool is_near = way.has_value();
      course_a = course_a.shifted(is_near ? *way : Vector3d(size * random.direction()));
      judge({a, course_a}, {b, course_b}, request, meeting, is_near,
            is_wall                 ? walls_
            : request.clearance > 0 ? clearances_
                                    : passes_,
            random);
    }
  }

 private:
  struct Body {
    const SphereTree& tree;
    const Course& course;
  };

  static std::string text(const Motion& a, const Motion& b, double t) {
    return ", poses " + to_text(a.pose_at(t)) + " and " + to_text(b.pose_at(t));
  }

  // By how much a has to be shifted for the least gap to be `wanted` at the instant `meeting`;
  // nothing if it passes, and in all but a `share` of the cases.
  static std::optional<Vector3d> way_to_meet(const Body& a, const Body& b, double meeting,
                                             double wanted, double share, SoakRandom& random) {
    std::vector<Sphere> movers, standing;
    MotionOracle(a.course.moving(a.tree.spheres()), b.course.moving(b.tree.spheres()))
        .place(meeting, movers, standing);
    // On to a sphere of b first.
    const Vector3d aim = standing.front().center - movers.front().center;
    for (Sphere& mover : movers) mover.center += aim;
    const Vector3d direction = grazing(random, a.course.displacement - b.course.displacement);
    if (!random.chance(share)) return std::nullopt;
    const auto way = way_to_gap(standing, movers, direction, wanted);
    if (!way) return std::nullopt;
    return aim + *way * direction;
  }

  void judge(const Body& a, const Body& b, const SweepRequest& request, double meeting,
             bool is_near, Tally& tally, SoakRandom& random) {
    const Motion motion_a = a.course.motion(), motion_b = b.course.motion();
    const SweepResult result = sweep(a.tree, motion_a, b.tree, motion_b, request);
    tally.count(result.verdict, is_near);
    const auto is_called_free = [&](double t) {
      return result.verdict == Verdict::kFree ||
             (result.free_until > 0.0 && t <= result.free_until);
    };
    const auto miss = [&](const char* what, double t) {
      tally.add_fault(std::string(what) + " is missed, t = " + to_text(std::span(&t, 1)) +
                      text(motion_a, motion_b, t));
    };

    const MotionOracle oracle(a.course.moving(a.tree.spheres()), b.course.moving(b.tree.spheres()));
    bool touches = false, missed = false;
    const auto sample = [&](double t) {
      const auto contact = oracle.at(t, request.clearance);
      tally.uncertain += contact == MotionOracle::Contact::kUncertain && is_called_free(t) ? 1 : 0;
      if (contact != MotionOracle::Contact::kYes) return;
      touches = true;
      if (is_called_free(t) && !missed) {
        missed = true;
        miss("contact", t);
      }
    };
    const int steps = motions() % kManyStepsEvery == 0 ? kManySteps : kSteps;
    for (int i = 0; i <= steps && !touches; ++i) sample(static_cast<double>(i) / steps);
    // Where it is known to be near, and about it, and at the end of what is called free.
    sample(meeting);
    for (int i = 3; i < 40; i += 3) {
      sample(std::min(1.0, meeting + std::ldexp(1.0, -i)));
      sample(std::max(0.0, meeting - std::ldexp(1.0, -i)));
    }
    sample(result.free_until);

    for (const double t : {meeting, random.unit(), result.free_until}) {
      if (is_called_free(t) &&
          within(a.tree, motion_a.pose_at(t), b.tree, motion_b.pose_at(t), request.clearance)) {
        miss("within() at pose_at()", t);
      }
    }
    if (result.verdict == Verdict::kCollision) {
      check_contact(a, motion_a, b, motion_b, request, result, tally);
    }
  }

  // The contact that was reported is one within the slack.
  void check_contact(const Body& a, const Motion& motion_a, const Body& b, const Motion& motion_b,
                     const SweepRequest& request, const SweepResult& result, Tally& tally) {
    const Pose to_a = motion_a.pose_at(result.contact_at);
    const Pose to_b = motion_b.pose_at(result.contact_at);
    const auto sphere = [](const SphereTree& tree, std::int32_t index) {
      return tree.spheres().subspan(static_cast<std::size_t>(index), 1);
    };
    const GapBounds gap = oracle_.gap({sphere(a.tree, result.contact.a), to_a},
                                      {sphere(b.tree, result.contact.b), to_b});
    const double slack = within_slack(a.tree, to_a, b.tree, to_b, request.clearance);
    if (gap.lower - request.clearance > slack) {
      tally.add_fault("no contact" + text(motion_a, motion_b, result.contact_at));
    }
  }

  ExactOracle oracle_;
  Tally passes_{"sweep"};
  Tally clearances_{"sweep, with clearance"};
  Tally walls_{"sweep, thin walls"};
};

TEST(ManySweeps, AreFreeWhereTheyAreCalledSo) {
  SoakRandom random(seeded(7));
  SweepCheck check;
  const auto motions = static_cast<std::uint64_t>(scaled(1'000));
  while (check.motions() < motions) check.run(random);
  check.expect_telling();
}

}  // namespace
}  // namespace spherule::test
