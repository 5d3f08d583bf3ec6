// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scenes/work_cell.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// Positions of a robot's joints, in the order of its variables.
using Configuration = std::vector<double>;

// Whether a configuration is in contact, by some engine.
using ContactTest = std::function<bool(std::span<const double>)>;

// One rigid thing of a workload with everything the engines need of it. Metres.
struct Part {
  std::string name;
  TriangleMesh mesh;
  double max_error = 0.0;                       // E of its fit
  double min_external_diameter = 0.0;           // D of its fit
  std::shared_ptr<const SphereTree> tree = {};  // of its spheres; absent until fitted
};

// A part that moves with a link of the robot, and is drawn in the link's frame.
struct Body {
  Part part;
  int link = 0;
};

// A part that stands still.
struct Obstacle {
  Part part;
  Pose world_from_part;
};

// The query that every engine answers: for each configuration of the program, does any body touch
// an obstacle? Bodies are tested in their order, the torch first, because it is what usually
// touches.
struct Workload {
  std::string name;
  RobotModel robot;
  std::vector<Body> bodies = {};
  std::vector<Obstacle> obstacles = {};
  std::vector<ArmPositions> program = {};
  std::vector<std::uint8_t> is_critical = {};  // of the program, see scenes/work_cell.h
};

// The base does not move: whether it touches the table that it is bolted beside is no question of
// the program, and no engine is queried. (The workpiece is exchanged, so the base is tested against
// it.)
bool is_tested(const Body& body, const Obstacle& obstacle);

// Of all its parts together.
std::size_t triangle_count(const Workload& workload);
std::size_t sphere_count(const Workload& workload);

// The paper's work cell from bench/scenes: torch, link_6 .. base_link; workpiece, table. E and D as
// in the paper: robot 20 mm and 100 mm, pipes 1 mm and 100 mm.
Workload make_paper_cell();

// A robot in the same cell: links as make_robot().links(), the torch in the flange's frame with the
// place of its wire's end.
Workload make_cell(std::string name, std::span<const TriangleMesh> links, const TriangleMesh& torch,
                   const Pose& flange_from_wire);

// An engine. Verdicts are 0 (free) and 1 (collision), one for each configuration; forward
// kinematics is part of the work. Engines may keep scratch between calls.
class Checker {
 public:
  virtual ~Checker() = default;
  virtual void check(std::span<const ArmPositions> configurations,
                     std::span<std::uint8_t> verdicts) = 0;
};

// For engines that judge one configuration at a time.
class SingleChecker : public Checker {
 public:
  explicit SingleChecker(const RobotModel& robot) : robot_(robot) {}
  void check(std::span<const ArmPositions> configurations,
             std::span<std::uint8_t> verdicts) override;

 protected:
  virtual bool collides(std::span<const Pose> world_from_link) = 0;

 private:
  RobotModel robot_;
  std::vector<Pose> world_from_link_;
};

// Ground truth for the solids themselves (FclSolid).
class Oracle {
 public:
  explicit Oracle(const Workload& workload);
  ~Oracle();

  // Bit i: body i of the workload touches an obstacle. One word for each configuration.
  std::vector<std::uint32_t> touching_bodies(std::span<const ArmPositions> configurations) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace spherule
