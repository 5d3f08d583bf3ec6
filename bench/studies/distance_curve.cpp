// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/measure.h"
#include "bench/studies/refined_cover.h"
#include "bench/studies/study.h"
#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "tests/support/fcl_solid.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace spherule {
namespace {

constexpr double kRelative[] = {1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001};
constexpr std::size_t kLevels = std::size(kRelative);
constexpr std::size_t kPoses = 41;  // at each distance
constexpr std::uint64_t kSeed = 11;
constexpr double kCloseEnough = 1e-3;  // relative error of a distance that is set

class SphereTreePair : public PairEngine {
 public:
  SphereTreePair(const Part& a, const Part& b) : a_(a.tree), b_(b.tree) {}

  void set_poses(std::span<const Pose> world_from_a) override {
    poses_.assign(world_from_a.begin(), world_from_a.end());
  }
  bool collides(std::size_t pose) override {
    return spherule::collides(*a_, poses_[pose], *b_, Pose());
  }
  double distance(std::size_t pose) override { return full_distance(pose).upper; }

  DistanceResult full_distance(std::size_t pose) const {
    return spherule::distance(*a_, poses_[pose], *b_, Pose());
  }
  std::uint64_t node_tests(std::size_t pose) const {
    return collide(*a_, poses_[pose], *b_, Pose(), {.max_pairs = 1}).cost.node_tests;
  }

 private:
  std::shared_ptr<const SphereTree> a_, b_;
  std::vector<Pose> poses_;
};

class ConfirmedPair : public PairEngine {
 public:
  ConfirmedPair(const Part& a, const Part& b) : a_(a.mesh, a.tree), b_(b.mesh, b.tree) {}

  void set_poses(std::span<const Pose> world_from_a) override {
    poses_.assign(world_from_a.begin(), world_from_a.end());
  }
  bool collides(std::size_t pose) override {
    return spherule::collides(a_, poses_[pose], b_, Pose());
  }
  double distance(std::size_t) override { return 0.0; }

 private:
  CoveredMesh a_, b_;
  std::vector<Pose> poses_;
};

// A body turned about the middle of its spheres, which comes in along a line to those of the other.
struct Approach {
  Eigen::Quaterniond turn;
  Eigen::Vector3d direction;  // where it comes from
  Sphere a, b;                // around all spheres, in the frames of the bodies

  Pose at(double way) const { return Pose(turn, b.center + way * direction - turn * a.center); }
};

// The first places on the way in at which the distance has come down to kRelative times `size`; not
// one if the body goes past. A step by the distance that is left can not pass the place.
std::optional<std::vector<Pose>> places(const Approach& approach, double size,
                                        const std::function<double(const Pose&)>& distance) {
  std::vector<Pose> result;
  double way = approach.a.radius + approach.b.radius + 1.1 * size;
  for (const double relative : kRelative) {
    const double wanted = relative * size;
    for (;;) {
      const Pose pose = approach.at(way);
      const double beyond = distance(pose) - wanted;
      if (beyond <= kCloseEnough * wanted) {
        result.push_back(pose);
        break;
      }
      way -= beyond;
      if (way < 0.0) return std::nullopt;
    }
  }
  return result;
}

struct Places {
  std::vector<Pose> by_mesh[kLevels];
  std::vector<Pose> by_spheres[kLevels];
};

Places random_places(const Part& a, const Part& b, double size) {
  const FclSolid solid_a(a.mesh);
  const FclSolid solid_b(b.mesh);
  RandomNumbers random(kSeed);
  Places result;
  while (result.by_mesh[0].size() < kPoses) {
    const Approach approach{random.rotation(), random.direction(), a.tree->sphere(0),
                            b.tree->sphere(0)};
    const auto by_mesh = places(approach, size, [&](const Pose& pose) {
      return surface_distance(solid_a, pose, solid_b, Pose());
    });
    const auto by_spheres = places(approach, size, [&](const Pose& pose) {
      return distance(*a.tree, pose, *b.tree, Pose()).upper;
    });
    if (!by_mesh || !by_spheres) continue;
    for (std::size_t level = 0; level < kLevels; ++level) {
      result.by_mesh[level].push_back((*by_mesh)[level]);
      result.by_spheres[level].push_back((*by_spheres)[level]);
    }
  }
  return result;
}

// The engines on one set of poses in turn: of each pose the median over the rounds, of these the
// median.
template <class Query>
std::vector<double> time_engines(std::span<PairEngine* const> engines, std::size_t poses,
                                 int rounds, const Query& query) {
  const double cost = clock_cost();
  std::vector<std::vector<std::vector<double>>> times(engines.size(),
                                                      std::vector<std::vector<double>>(poses));
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t e = 0; e < engines.size(); ++e) {
      for (std::size_t pose = 0; pose < poses; ++pose) query(*engines[e], pose);  // warms up
      for (std::size_t pose = 0; pose < poses; ++pose) {
        const auto start = Clock::now();
        query(*engines[e], pose);
        times[e][pose].push_back(std::max(0.0, nanoseconds(Clock::now() - start) - cost));
      }
    }
  }
  std::vector<double> result;
  for (auto& of_engine : times) {
    std::vector<double> of_poses;
    for (auto& of_pose : of_engine) of_poses.push_back(median(of_pose));
    result.push_back(median(of_poses));
  }
  return result;
}

// The engines of a kind, and the fastest of them.
class Contest {
 public:
  explicit Contest(std::vector<NamedPairEngine> engines) : engines_(std::move(engines)) {}

  void join(std::vector<PairEngine*>& all) const {
    for (const NamedPairEngine& named : engines_) all.push_back(named.engine.get());
  }
  // Takes its engines' times from the front.
  void judge(std::span<const double>& times, double& best, std::string& name) const {
    const auto own = times.first(engines_.size());
    const auto least = std::min_element(own.begin(), own.end());
    best = *least;
    name = engines_[static_cast<std::size_t>(least - own.begin())].name;
    times = times.subspan(engines_.size());
  }

 private:
  std::vector<NamedPairEngine> engines_;
};

// Times the queries on the bodies, distance by distance.
class Curve {
 public:
  Curve(const Part& moving, const Part& standing)
      : fcl_(fcl_collide_engines(moving.mesh, standing.mesh)),
        fcl_boxed_(fcl_boxed_collide_engines(moving.mesh, standing.mesh)),
        fcl_distance_(fcl_distance_engines(moving.mesh, standing.mesh)),
        ours_(moving, standing),
        ours_same_poses_(moving, standing),
        confirmed_(moving, standing) {
    fcl_.join(colliding_);
    fcl_boxed_.join(colliding_);
    colliding_.insert(colliding_.end(), {&ours_same_poses_, &confirmed_, &ours_});
    fcl_distance_.join(measuring_);
    measuring_.push_back(&ours_);
  }

  void set_poses(std::span<const Pose> by_mesh, std::span<const Pose> by_spheres) {
    for (PairEngine* engine : colliding_) engine->set_poses(by_mesh);
    for (PairEngine* engine : measuring_) engine->set_poses(by_mesh);
    ours_.set_poses(by_spheres);
  }

  void time(int rounds, DistanceRow& row) {
    const auto booleans =
        time_engines(colliding_, kPoses, rounds, [this](PairEngine& engine, std::size_t pose) {
          answer_ = engine.collides(pose) ? 1.0 : 0.0;
        });
    std::span<const double> left = booleans;
    fcl_.judge(left, row.fcl_collide_ns, row.fcl_collide_setting);
    fcl_boxed_.judge(left, row.fcl_boxed_collide_ns, row.fcl_boxed_collide_setting);
    row.collides_same_poses_ns = left[0];
    row.confirmed_ns = left[1];
    row.collides_ns = left[2];
    const auto distances = time_engines(
        measuring_, kPoses, rounds,
        [this](PairEngine& engine, std::size_t pose) { answer_ = engine.distance(pose); });
    left = distances;
    fcl_distance_.judge(left, row.fcl_distance_ns, row.fcl_distance_setting);
    row.distance_ns = left[0];
  }

  void count(DistanceRow& row) {
    std::vector<double> tests;
    std::vector<double> distance_tests;
    std::size_t overlaps = 0;
    for (std::size_t pose = 0; pose < kPoses; ++pose) {
      tests.push_back(static_cast<double>(ours_.node_tests(pose)));
      distance_tests.push_back(static_cast<double>(ours_.full_distance(pose).cost.node_tests));
      overlaps += ours_same_poses_.collides(pose) ? 1 : 0;
    }
    row.node_tests = median(tests);
    row.distance_node_tests = median(distance_tests);
    row.overlap_percent = 100.0 * static_cast<double>(overlaps) / static_cast<double>(kPoses);
  }

 private:
  const Contest fcl_;
  const Contest fcl_boxed_;
  const Contest fcl_distance_;
  SphereTreePair ours_;
  SphereTreePair ours_same_poses_;
  ConfirmedPair confirmed_;
  std::vector<PairEngine*> colliding_;
  std::vector<PairEngine*> measuring_;
  volatile double answer_ = 0.0;  // what is timed must happen though nobody reads it
};

}  // namespace

std::vector<DistanceRow> study_distances(const Part& moving, const Part& standing,
                                         const StudyOptions& options) {
  const double size = moving.tree->sphere(0).radius + standing.tree->sphere(0).radius;
  const Places poses = random_places(moving, standing, size);
  Curve curve(moving, standing);
  std::vector<DistanceRow> rows;
  for (std::size_t level = kLevels; level-- > 0;) {
    curve.set_poses(poses.by_mesh[level], poses.by_spheres[level]);
    DistanceRow row;
    row.relative = kRelative[level];
    row.distance_m = kRelative[level] * size;
    curve.time(options.rounds, row);
    curve.count(row);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace spherule
