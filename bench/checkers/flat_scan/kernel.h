// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The flat scan as plain data, and its kernels, one for each instruction set. Lengths are metres,
// in the frame of the robot's root.

#include <cstdint>

namespace spherule::flat_scan {

// Arrays of spheres are filled up with copies of the last sphere to a multiple of this.
inline constexpr std::int32_t kPadding = 16;
inline constexpr std::int32_t kMaxVariables = 8;
inline constexpr std::uint32_t kMaxObstacles = 32;

struct Spheres {
  const float* x;
  const float* y;
  const float* z;
  const float* radius;
  std::int32_t count;   // with the copies
  std::int32_t unique;  // without
};

// A link in its parent's frame. Both frames are turned so that the link's joint turns about its z
// axis: columns of the rotation and origin at position zero, each with a zero at the end.
struct alignas(32) Frame {
  double columns[4][4];
  std::int32_t parent;    // an earlier link, or -1
  std::int32_t variable;  // or -1
};

struct Group {
  Spheres spheres;
  double center[3];  // of the sphere around all
  float radius;
};

struct Body {
  Group group;  // in the link's frame
  std::int32_t link;
  std::uint32_t against;  // bit i: obstacle i
};

struct Problem {
  const Frame* frames;
  std::int32_t frame_count;
  std::int32_t variable_count;
  const Body* bodies;
  std::int32_t body_count;
  const Group* obstacles;
  std::int32_t obstacle_count;
  bool spheres_in_front;
};

struct alignas(32) LinkPose {
  double columns[4][4];  // the last is the origin
};

// Aligned to 64 bytes, with room for the largest body.
struct Scratch {
  LinkPose* poses;
  float* x;
  float* y;
  float* z;
};

// Whether two spheres touch. Radii have to be padded by what single precision costs.
using Check = bool (*)(const Problem& problem, const double* configuration, const Scratch& scratch);

namespace portable {
bool check(const Problem& problem, const double* configuration, const Scratch& scratch);
}
namespace avx2 {
bool check(const Problem& problem, const double* configuration, const Scratch& scratch);
}
namespace avx512 {
bool check(const Problem& problem, const double* configuration, const Scratch& scratch);
}

}  // namespace spherule::flat_scan
