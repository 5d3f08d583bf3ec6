// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/scenes/work_cell.h"
#include "robot/model/kinematics.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kSteps = 200;
// Metres and radians, before rounding to the grid: far below the grid, so that the result does not
// depend on the way there.
constexpr double kSolved = 1e-12;
constexpr double kAccepted = 5e-6;
constexpr double kDamping = 1e-3;
constexpr double kLongestStep = 0.2;  // radians

// Shift and rotation vector that are lacking from `from` to `to`, in the world's frame.
Vector6d difference(const Pose& from, const Pose& to) {
  Eigen::Quaterniond turn = to.rotation().normalized() * from.rotation().normalized().conjugate();
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;
  const double sine = turn.vec().norm();
  const double scale = sine > 1e-12 ? 2.0 * std::atan2(sine, turn.w()) / sine : 2.0;
  Vector6d result;
  result << to.translation() - from.translation(), scale * turn.vec();
  return result;
}

Matrix6d jacobian(const RobotModel& robot, const std::vector<Pose>& world_from_link,
                  const Eigen::Vector3d& tip) {
  Matrix6d result;
  for (int i = 0; i < kJoints; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Pose& link = world_from_link[index + 1];
    const Eigen::Vector3d axis = link.matrix() * robot.joints()[index].axis;
    result.col(i) << axis.cross(tip - link.translation()), axis;
  }
  return result;
}

// Damped least squares (Wampler 1986) from a start, so that a sequence of near targets gives a
// continuous motion: positions on the grid that bring the flange within 5 micrometres and 5e-6
// radians of the target, joint limits kept; nothing where 200 steps do not get there.
std::optional<ArmPositions> solve_inverse_kinematics(const RobotModel& robot,
                                                     const Pose& world_from_flange,
                                                     const ArmPositions& start) {
  ArmPositions positions = start;
  std::vector<Pose> world_from_link;
  const auto lacking = [&] {
    forward_kinematics(robot, positions, world_from_link);
    return difference(world_from_link.back() * link6_from_flange(), world_from_flange);
  };
  for (int step = 0; step < kSteps; ++step) {
    const Vector6d error = lacking();
    if (error.cwiseAbs().maxCoeff() < kSolved) break;
    const Matrix6d j = jacobian(robot, world_from_link,
                                (world_from_link.back() * link6_from_flange()).translation());
    const Matrix6d damped = j * j.transpose() + kDamping * kDamping * Matrix6d::Identity();
    Vector6d move = j.transpose() * damped.ldlt().solve(error);
    move *= std::min(1.0, kLongestStep / std::max(move.cwiseAbs().maxCoeff(), 1e-30));
    for (int i = 0; i < kJoints; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const Joint& joint = robot.joints()[index];
      positions[index] = std::clamp(positions[index] + move[i], joint.lower, joint.upper);
    }
  }
  positions = on_joint_grid(positions);
  if (lacking().cwiseAbs().maxCoeff() > kAccepted) return std::nullopt;
  return positions;
}

// A place and a direction for the wire's end, in the workpiece's frame.
struct WireTarget {
  Vector3d position;
  Vector3d direction;  // unit, into the metal
};

// Lengths in metres, angles in radians.
constexpr double kLowestSeamAngle = 0.35;  // of a seam that is welded: there the nozzle has room
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

// How far the wire's end is kept off a point of the metal, along the mean of its normals: farther
// in the crotch of a seam, for the nozzle. Metres.
double standoff(const SeamPoint& point) {
  // The sharper the corner between the pipes, the smaller the sum of their normals.
  const double sharpness = 1.0 - point.normal_a.dot(point.normal_b);
  return kStandoff + 2.0 * kCrotchStandoff * sharpness;
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

// Runs of the torch over the workpiece, each with `length` targets: across the joint along two
// seams, along a pipe, around a pipe's rim; with weave, tilt and tack points. Always the same.
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

constexpr double kTableDistance = 1.55;
constexpr double kWorkpieceYaw = 0.2;  // radians

constexpr ArmPositions kHome{0.0, -0.15, 0.1, 0.0, 1.1, 0.0};
// Behind the fixture post, and a clear way round to it.
constexpr ArmPositions kStation{0.52, 0.32, 0.18, 0.0, 0.6, 0.0};
constexpr ArmPositions kAboveStation{0.52, -0.2, -0.2, 0.0, 0.9, 0.0};

// Configurations of one pass: home to above the seam, down, weld, up, home.
constexpr std::size_t kTransfer = 55;
constexpr std::size_t kDescent = 30;
constexpr std::size_t kWeld = 770;
constexpr double kClearHeight = 0.06;  // metres above the seam where a descent starts
// Every so many passes the torch visits the station.
constexpr std::size_t kPassesBetweenVisits = 3;

// The orientation that points z along the wire and puts the torch's body towards the robot.
Pose world_from_wire(const WireTarget& target, const Pose& world_from_piece) {
  const Vector3d position = world_from_piece * target.position;
  const Vector3d z = world_from_piece.matrix() * target.direction;
  const Vector3d to_robot(-position.x(), -position.y(), 0.0);
  const Vector3d x = (to_robot - to_robot.dot(z) * z).normalized();
  Eigen::Matrix3d turn;
  turn << x, z.cross(x), z;
  return Pose(Eigen::Quaterniond(turn), position);
}

class ProgramWriter {
 public:
  explicit ProgramWriter(const Pose& flange_from_wire)
      : robot_(make_robot()), wire_from_flange_(flange_from_wire.inverse()) {
    add(on_joint_grid(kHome));
  }

  ArmPositions solve(const WireTarget& target, const ArmPositions& start) const {
    const auto solution = solve_inverse_kinematics(
        robot_, world_from_wire(target, world_from_workpiece()) * wire_from_flange_, start);
    if (!solution) throw Error("program", "a target is out of the robot's reach");
    return *solution;
  }

  // Straight in joint space, `steps` configurations with the end, without the start.
  void move_to(const ArmPositions& end, std::size_t steps) {
    const ArmPositions start = last();
    for (std::size_t i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(steps);
      ArmPositions between;
      for (std::size_t j = 0; j < between.size(); ++j) {
        between[j] = start[j] + share * (end[j] - start[j]);
      }
      add(on_joint_grid(between));
    }
  }

  void follow(const WireTarget& target, bool is_critical = false) {
    add(solve(target, last()), is_critical);
  }

  std::size_t size() const { return program_.configurations.size(); }
  Program take() { return std::move(program_); }

 private:
  const ArmPositions& last() const { return program_.configurations.back(); }
  void add(const ArmPositions& configuration, bool is_critical = false) {
    program_.configurations.push_back(configuration);
    program_.is_critical.push_back(is_critical ? 1 : 0);
  }

  RobotModel robot_;
  Pose wire_from_flange_;
  Program program_;
};

// Along the wire between the seam's first or last target and the clear height above it.
WireTarget backed_off(WireTarget target, double share) {
  target.position -= share * kClearHeight * target.direction;
  return target;
}

void weld(ProgramWriter& writer, const std::vector<WireTarget>& targets) {
  writer.move_to(writer.solve(backed_off(targets.front(), 1.0), kHome), kTransfer);
  for (std::size_t i = kDescent; i > 0; --i) {
    writer.follow(backed_off(targets.front(), static_cast<double>(i) / kDescent));
  }
  for (const WireTarget& target : targets) writer.follow(target, true);
  for (std::size_t i = 1; i <= kDescent; ++i) {
    writer.follow(backed_off(targets.back(), static_cast<double>(i) / kDescent));
  }
}

}  // namespace

ArmPositions on_joint_grid(const ArmPositions& positions) {
  ArmPositions result;
  std::transform(positions.begin(), positions.end(), result.begin(),
                 [](double q) { return std::nearbyint(q * 0x1p20) * 0x1p-20; });
  return result;
}

Pose world_from_table() {
  return Pose::from_translation({kTableDistance, 0.0, 0.0});
}

Pose world_from_workpiece() {
  return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(kWorkpieceYaw, Vector3d::UnitZ())),
              {kTableDistance, 0.0, kTableHeight + kWorkpieceHeight});
}

Program make_program(const Pose& flange_from_wire) {
  ProgramWriter writer(flange_from_wire);
  const auto passes = make_weld_passes(kWeld);
  for (std::size_t pass = 0; pass < passes.size(); ++pass) {
    weld(writer, passes[pass]);
    if (pass % kPassesBetweenVisits == 0) {
      writer.move_to(kStation, kTransfer);
      writer.move_to(kAboveStation, kTransfer / 2);
    }
    writer.move_to(kHome, kTransfer);
  }
  // The robot waits nowhere: what is left of the program's length is a slow last move.
  if (writer.size() > kProgramSize) throw Error("program", "longer than planned");
  writer.move_to(kAboveStation, kProgramSize - writer.size());
  return writer.take();
}

std::vector<ArmPositions> shuffled(std::vector<ArmPositions> program, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  // Fisher and Yates; the standard library's shuffle differs between implementations.
  for (std::size_t left = program.size(); left > 1; --left) {
    std::swap(program[left - 1], program[engine() % left]);
  }
  return program;
}

}  // namespace spherule
