// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a CheckPlan is compiled from, in double precision and in the frame of the mechanism's root.

#include "collide/kernels/plan_trees.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <variant>
#include <vector>

namespace spherule::internal {

// Of a position in the middle of a part of a motion: rounded fractions of positions up to
// kLargestPosition err by less than 9 u times that.
inline constexpr double kMiddleError = 1e-12;

struct PlanSource {
  // A frame that a position moves: at zero its pose in the parent frame is `parent_from_frame`;
  // then it turns about its z axis by the position (radians), or is shifted along it.
  struct Frame {
    int parent = -1;  // an earlier frame, or -1 for the root
    Pose parent_from_frame{};
    int position = 0;
    bool prismatic = false;
  };

  // Spheres that move with a frame; -1: with the root.
  struct Body {
    int frame = -1;
    std::shared_ptr<const SearchTrees> trees{};
    Pose frame_from_trees{};
    // Contacts of its spheres are for the caller to confirm: none is certain, and of tests that are
    // not proved apart all along a part of a motion the caller decides whether they are
    // (PlanClient::near).
    bool is_confirmed = false;
  };

  using Shape = std::variant<Primitive, std::shared_ptr<const SearchTrees>>;
  struct Obstacle {
    Shape shape;
    Pose root_from_shape{};
    bool is_confirmed = false;  // as that of a body
  };

  struct Test {
    int body = 0;
    int other = 0;  // an obstacle, or another body
    bool is_obstacle = false;
    std::shared_ptr<const FreeCells> free_cells{};  // of two bodies; null: none is known
    // Two bodies that the caller knows to be free in some configurations, and in those for which it
    // skips what never touches.
    bool is_proved_somewhere = false;
    bool never_touches = false;
  };

  // Of the joints between two bodies, or a body and the root, from the first body on: how far
  // points of the two are at most from its axis (PathReach).
  struct PathStep {
    int position = 0;
    bool turns = false;
    double first = 0.0;
    double second = 0.0;
  };
  using Path = std::vector<PathStep>;

  std::vector<Frame> frames{};
  std::vector<Body> bodies{};
  std::vector<Obstacle> obstacles{};
  // In the order in which they are made, as far as those of one body stay together.
  std::vector<Test> tests{};
  std::vector<Path> body_paths{};  // of each body, to the root
  std::vector<Path> pair_paths{};  // of each test of two bodies, in their order
  // The answers hold for any poses of the bodies that are within this of the exact mechanism's: the
  // largest distance of a point.
  double pose_error = 0.0;
};

// One more than the largest index of a position that the frames name.
int position_count(std::span<const PlanSource::Frame> frames);

// From the root to a frame: the largest distance of its origin, and how many frames it takes.
struct Chain {
  double length = 0.0;
  double frames = 0.0;
};

// Of every frame; throws Error for one of more than kLongestLaneChain frames.
std::vector<Chain> chains_of(std::span<const PlanSource::Frame> frames);

}  // namespace spherule::internal
