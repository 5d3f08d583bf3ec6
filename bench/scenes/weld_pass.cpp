// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/weld_pass.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace spherule {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// Lengths in metres, angles in radians.
constexpr double kStandoff = 0.006;        // of the wire's end from the metal
constexpr double kCrotchStandoff = 0.008;  // more of it at the bottom of a seam, for the nozzle
constexpr double kTackDepth = 0.0015;      // how far a tack pushes the wire into the metal
constexpr double kWeave = 0.002;
constexpr double kTilt = 0.12;
constexpr int kWeaves = 12;  // a pass

// Place on the surface by the share of the way, 0 to 1.
using Path = std::function<SeamPoint(double)>;

// Up one seam to the top of the joint and down another one.
Path across_joint(int up, int down) {
  return [=](double share) {
    const bool rising = share < 0.5;
    const double climb = rising ? 2.0 * share : 2.0 - 2.0 * share;
    return seam_point(rising ? up : down, kLowestSeamAngle + climb * (0.5 * pi - kLowestSeamAngle));
  };
}

Path along_pipe(int pipe, double angle) {
  return [=](double share) { return pipe_point(pipe, 0.05 + 0.18 * share, angle); };
}

// Both normals are turned towards the open end, so that the torch points at the rim.
Path around_rim(int pipe) {
  return [=](double share) {
    SeamPoint point = rim_point(pipe, pi * (0.2 + 0.6 * share));
    point.normal_a = point.normal_b = (point.normal_a + 0.5 * pipe_axis(pipe)).normalized();
    return point;
  };
}

// A slow change of the torch's attitude: two sines with phases of its own.
class Wobble {
 public:
  explicit Wobble(std::mt19937_64& engine) : a_(phase(engine)), b_(phase(engine)) {}
  double operator()(double share) const {
    return 0.5 * (std::sin(2.0 * pi * 2.3 * share + a_) + std::sin(2.0 * pi * 5.1 * share + b_));
  }

 private:
  static double phase(std::mt19937_64& engine) {
    return 2.0 * pi * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
  double a_, b_;
};

// 0 while welding, 1 at the tacks, with ramps that last a hundred and fiftieth of the pass.
double tack(double share, double first, double second) {
  constexpr double kHalf = 0.038;
  constexpr double kRamp = 1.0 / 150.0;
  const auto at = [&](double middle) {
    return std::clamp((kHalf - std::abs(share - middle)) / kRamp + 1.0, 0.0, 1.0);
  };
  return std::max(at(first), at(second));
}

std::vector<WireTarget> follow(const Path& path, std::size_t length, std::mt19937_64& engine) {
  const Wobble tilt_along(engine);
  const Wobble tilt_across(engine);
  const double first = 0.2 + 0.2 * static_cast<double>(engine() >> 11) * 0x1p-53;
  const double second = first + 0.3 + 0.1 * static_cast<double>(engine() >> 11) * 0x1p-53;
  std::vector<WireTarget> targets;
  for (std::size_t i = 0; i < length; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(length - 1);
    const SeamPoint point = path(share);
    const Vector3d normal = (point.normal_a + point.normal_b).normalized();
    const double step = 1e-4;
    const Vector3d along =
        (path(std::min(share + step, 1.0)).point - path(std::max(share - step, 0.0)).point)
            .normalized();
    const Vector3d across = normal.cross(along).normalized();
    // Mostly from above: neither a crotch nor a rim is approached from the side.
    const Vector3d away = (normal + 2.0 * Vector3d::UnitZ() + kTilt * tilt_along(share) * along +
                           kTilt * tilt_across(share) * across)
                              .normalized();
    const double pushed = tack(share, first, second);
    const double height = (1.0 - pushed) * standoff(point) - pushed * kTackDepth;
    const double weave = (1.0 - pushed) * kWeave * std::sin(2.0 * pi * kWeaves * share);
    targets.push_back({point.point + height * normal + weave * across, -away});
  }
  return targets;
}

}  // namespace

double standoff(const SeamPoint& point) {
  // The sharper the corner between the pipes, the smaller the sum of their normals.
  const double sharpness = 1.0 - point.normal_a.dot(point.normal_b);
  return kStandoff + 2.0 * kCrotchStandoff * sharpness;
}

std::vector<std::vector<WireTarget>> make_weld_passes(std::size_t length) {
  std::vector<Path> paths;
  for (int round = 0; round < 3; ++round) {
    for (int pipe = 0; pipe < 3; ++pipe) paths.push_back(across_joint(pipe, (pipe + 1) % 3));
    paths.push_back(along_pipe(round, 0.5 * pi + 0.3 * (round - 1)));
    paths.push_back(around_rim(round));
  }
  std::mt19937_64 engine(20);
  std::vector<std::vector<WireTarget>> passes;
  for (const Path& path : paths) passes.push_back(follow(path, length, engine));
  return passes;
}

}  // namespace spherule
