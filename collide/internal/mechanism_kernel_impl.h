// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The check kernel, compiled once for each instruction set: the including file defines
// SPHERULE_KERNEL, a namespace of its own. Vectors are those of the compiler, which makes of them
// what the machine has. Nothing here comes from a header with inline functions, which the linker
// could share between files that were compiled for different machines.
//
// Kinematics. Of an angle x with |x| <= 100 (MechanismCheck::kLargestVariable), k = x 2 / pi
// rounded is at most 64, and x - k pi / 2 in two steps errs by less than 64 (2^-53 + 2^-106 ...) <
// 2e-14; the remainder lies within pi / 4 + 1e-13. The sine's series up to r^11 errs by r^13 / 13!
// < 7.0e-12, the cosine's up to r^12 by r^14 / 14! < 4e-13; a few roundings of numbers below one,
// 1e-15. Together both err by less than 7.1e-12, the pair by less than kSineError = 2e-11.
//
// Which instructions and which order of operations are used changes the rounding, and so what is
// found apart, but not the answer: a pair that is not surely apart or surely in contact is
// confirmed elsewhere.

#ifdef __x86_64__
#include <immintrin.h>
#endif

// Every function with vectors is inlined: none crosses a boundary between files.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

typedef float Float8 __attribute__((vector_size(32), may_alias));
typedef float Float4 __attribute__((vector_size(16), may_alias));
typedef std::int32_t Int8 __attribute__((vector_size(32), may_alias));
typedef double Double4 __attribute__((vector_size(32), may_alias));
typedef std::int64_t Long4 __attribute__((vector_size(32), may_alias));

// The obstacle is opened until its ball is smaller than this part of the body's: opening the body
// costs a change of frame. Measured on the workload of bench/, from 0.35 to 2.
constexpr float kOpenBody = 0.5F;

// Adding 1.5 2^52 rounds to an integer only where double is not computed with more bits.
static_assert(__FLT_EVAL_METHOD__ == 0);

#define SPHERULE_INLINE inline __attribute__((always_inline))

SPHERULE_INLINE Float8 load(const float* p) {
  return *reinterpret_cast<const Float8*>(p);
}

// A bit for every lane that is set.
SPHERULE_INLINE unsigned mask_of(Int8 set) {
#if defined(__AVX__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(set)));
#elif defined(__SSE2__)
  typedef std::int32_t Int4 __attribute__((vector_size(16), may_alias));
  const Int4* const halves = reinterpret_cast<const Int4*>(&set);
  const int low = _mm_movemask_ps(reinterpret_cast<__m128>(halves[0]));
  const int high = _mm_movemask_ps(reinterpret_cast<__m128>(halves[1]));
  return static_cast<unsigned>(low | high << 4);
#else
  unsigned mask = 0;
  for (int lane = 0; lane < 8; ++lane) mask |= (set[lane] != 0 ? 1U : 0U) << lane;
  return mask;
#endif
}

struct Balls {
  Float8 x, y, z, radius;
};

// The same in memory, where single lanes are read.
struct alignas(32) BallLanes {
  float x[8], y[8], z[8], radius[8];

  SPHERULE_INLINE void hold(const Balls& balls) {
    __builtin_memcpy(x, &balls.x, sizeof x);
    __builtin_memcpy(y, &balls.y, sizeof y);
    __builtin_memcpy(z, &balls.z, sizeof z);
    __builtin_memcpy(radius, &balls.radius, sizeof radius);
  }
};

template <class Lanes>
SPHERULE_INLINE Balls balls_of(const Lanes& node) {
  return {load(node.x), load(node.y), load(node.z), load(node.radius)};
}

SPHERULE_INLINE unsigned overlaps(const Balls& balls, float x, float y, float z, float radius) {
  const Float8 dx = balls.x - x;
  const Float8 dy = balls.y - y;
  const Float8 dz = balls.z - z;
  const Float8 limit = balls.radius + radius;
  return mask_of(dx * dx + dy * dy + dz * dz <= limit * limit);
}

// A frame's pose in single precision: three columns and the origin.
struct alignas(16) Placement {
  float columns[4][4];
};

SPHERULE_INLINE Balls placed(const PackedNode& node, const Placement& at) {
  const auto& [x, y, z, t] = at.columns;
  const Balls in = balls_of(node);
  return {x[0] * in.x + y[0] * in.y + z[0] * in.z + t[0],
          x[1] * in.x + y[1] * in.y + z[1] * in.z + t[1],
          x[2] * in.x + y[2] * in.y + z[2] * in.z + t[2], in.radius};
}

SPHERULE_INLINE Double4 load(const double* p) {
  return *reinterpret_cast<const Double4*>(p);
}

SPHERULE_INLINE void sine_and_cosine(const double* angles, double* sines, double* cosines) {
  constexpr double kRound = 0x1.8p52;  // added, it leaves an integer in the last bits
  constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
  constexpr double kHalfPi = 0x1.921fb54442d18p+0;
  constexpr double kHalfPiRest = 0x1.1a62633145c07p-54;
  Double4 x;
  __builtin_memcpy(&x, angles, sizeof x);
  const Double4 shifted = x * kTwoOverPi + kRound;
  const Double4 k = shifted - kRound;
  const Double4 r = (x - k * kHalfPi) - k * kHalfPiRest;
  const Double4 r2 = r * r;
  const Double4 sine =
      r + r * r2 *
              (-1.0 / 6 + r2 * (1.0 / 120 +
                                r2 * (-1.0 / 5040 + r2 * (1.0 / 362880 + r2 * (-1.0 / 39916800)))));
  const Double4 cosine =
      1.0 - 0.5 * r2 +
      r2 * r2 *
          (1.0 / 24 +
           r2 * (-1.0 / 720 + r2 * (1.0 / 40320 + r2 * (-1.0 / 3628800 + r2 * (1.0 / 479001600)))));
  Long4 quarter;
  __builtin_memcpy(&quarter, &shifted, sizeof quarter);
  const Long4 odd = -(quarter & 1);
  const Long4 sine_bits = reinterpret_cast<const Long4&>(sine);
  const Long4 cosine_bits = reinterpret_cast<const Long4&>(cosine);
  const Long4 s = ((sine_bits & ~odd) | (cosine_bits & odd)) ^ ((quarter & 2) << 62);
  const Long4 c = ((cosine_bits & ~odd) | (sine_bits & odd)) ^ (((quarter + 1) & 2) << 62);
  __builtin_memcpy(sines, &s, sizeof s);
  __builtin_memcpy(cosines, &c, sizeof c);
}

// The poses of all frames. What does not depend on the parent is computed first: the chain from
// frame to frame is what takes the time.
SPHERULE_INLINE void place_frames(const KernelProblem& problem, const double* configuration,
                                  const KernelScratch& scratch) {
  for (std::int32_t i = 0; i < problem.variable_count; i += 4) {
    sine_and_cosine(configuration + i, scratch.sines + i, scratch.cosines + i);
  }
  for (std::int32_t i = 0; i < problem.frame_count; ++i) {
    const KernelFrame& frame = problem.frames[i];
    const double position = configuration[frame.variable];
    const double sine = frame.prismatic ? 0.0 : scratch.sines[frame.variable];
    const double cosine = frame.prismatic ? 1.0 : scratch.cosines[frame.variable];
    const Double4 f0 = load(frame.rotation[0]);
    const Double4 f1 = load(frame.rotation[1]);
    const Double4 f2 = load(frame.rotation[2]);
    const Double4 g0 = cosine * f0 + sine * f1;
    const Double4 g1 = cosine * f1 - sine * f0;
    const double shift = frame.prismatic ? position : 0.0;
    const double o[3] = {frame.origin[0] + shift * f2[0], frame.origin[1] + shift * f2[1],
                         frame.origin[2] + shift * f2[2]};
    auto* const result = reinterpret_cast<Double4*>(scratch.poses[i].columns);
    if (frame.parent < 0) {
      result[0] = g0;
      result[1] = g1;
      result[2] = f2;
      result[3] = Double4{o[0], o[1], o[2], 0.0};
      continue;
    }
    const auto* const parent =
        reinterpret_cast<const Double4*>(scratch.poses[frame.parent].columns);
    const Double4 p0 = parent[0];
    const Double4 p1 = parent[1];
    const Double4 p2 = parent[2];
    result[0] = p0 * g0[0] + p1 * g0[1] + p2 * g0[2];
    result[1] = p0 * g1[0] + p1 * g1[1] + p2 * g1[2];
    result[2] = p0 * f2[0] + p1 * f2[1] + p2 * f2[2];
    result[3] = p0 * o[0] + p1 * o[1] + p2 * o[2] + parent[3];
  }
}

SPHERULE_INLINE Placement in_single_precision(const KernelPose& pose) {
  Placement at;
  for (int column = 0; column < 4; ++column) {
    const Float4 rounded = __builtin_convertvector(load(pose.columns[column]), Float4);
    __builtin_memcpy(at.columns[column], &rounded, sizeof rounded);
  }
  return at;
}

// The ball around all of every body.
SPHERULE_INLINE void place_roots(const KernelProblem& problem, const KernelScratch& scratch) {
  for (std::int32_t i = 0; i < problem.body_count; ++i) {
    const KernelBody& body = problem.bodies[i];
    const auto* const at = reinterpret_cast<const Double4*>(scratch.poses[body.frame].columns);
    const Double4 center =
        at[0] * body.center[0] + at[1] * body.center[1] + at[2] * body.center[2] + at[3];
    scratch.roots[i] = {static_cast<float>(center[0]),
                        static_cast<float>(center[1]),
                        static_cast<float>(center[2]),
                        body.radius,
                        0,
                        0};
  }
}

// One body against one obstacle, whose balls around all overlap.
class PairCheck {
 public:
  PairCheck(const KernelProblem& problem, KernelPair pair, const KernelScratch& scratch,
            ConfirmContact confirm, void* context)
      : body_(problem.bodies[pair.body]),
        obstacle_(problem.obstacles[pair.obstacle]),
        pair_(pair),
        at_(in_single_precision(scratch.poses[body_.frame])),
        tasks_(scratch.tasks),
        confirm_(confirm),
        context_(context) {}

  bool run(const KernelTask& roots) {
    tasks_[0] = roots;
    top_ = 1;
    while (top_ > 0) {
      const KernelTask task = tasks_[--top_];
      if (task.obstacle >= 0 ? open_obstacle(task) : open_body(task)) return true;
    }
    return false;
  }

 private:
  // True if a contact was found.
  SPHERULE_INLINE bool open_obstacle(const KernelTask& task) {
    const PackedNode& node = obstacle_.nodes[task.obstacle];
    unsigned mask = overlaps(balls_of(node), task.x, task.y, task.z, task.radius);
    if (mask == 0) return false;
    if (task.body < 0) {
      for (; mask != 0; mask &= mask - 1) {
        const int lane = __builtin_ctz(mask);
        if (node.child[lane] >= 0) {
          tasks_[top_++] = {task.x, task.y, task.z, task.radius, task.body, node.child[lane]};
        } else if (touch(task, node, lane, ~task.body, ~node.child[lane])) {
          return true;
        }
      }
      return false;
    }
    const PackedNode& body = body_.nodes[task.body];
    bool is_placed = false;
    BallLanes children;
    for (; mask != 0; mask &= mask - 1) {
      const int lane = __builtin_ctz(mask);
      const std::int32_t child = node.child[lane];
      if (child >= 0 && node.radius[lane] >= kOpenBody * task.radius) {
        tasks_[top_++] = {task.x, task.y, task.z, task.radius, task.body, child};
        continue;
      }
      if (!is_placed) {
        children.hold(placed(body, at_));
        is_placed = true;
      }
      const float x = node.x[lane];
      const float y = node.y[lane];
      const float z = node.z[lane];
      const float radius = node.radius[lane];
      for (unsigned hits = overlaps(balls_of(children), x, y, z, radius); hits != 0;
           hits &= hits - 1) {
        const int hit = __builtin_ctz(hits);
        const std::int32_t body_child = body.child[hit];
        const KernelTask moved = {children.x[hit],      children.y[hit], children.z[hit],
                                  children.radius[hit], body_child,      child};
        if (child >= 0) {
          tasks_[top_++] = moved;
        } else if (body_child >= 0) {
          tasks_[top_++] = {x, y, z, radius, body_child, child};
        } else if (touch(moved, node, lane, ~body_child, ~child)) {
          return true;
        }
      }
    }
    return false;
  }

  // The ball of the task is a leaf of the obstacle.
  SPHERULE_INLINE bool open_body(const KernelTask& task) {
    const PackedNode& body = body_.nodes[task.body];
    const Balls placed_children = placed(body, at_);
    BallLanes children;
    children.hold(placed_children);
    for (unsigned hits = overlaps(placed_children, task.x, task.y, task.z, task.radius); hits != 0;
         hits &= hits - 1) {
      const int hit = __builtin_ctz(hits);
      const std::int32_t child = body.child[hit];
      if (child >= 0) {
        tasks_[top_++] = {task.x, task.y, task.z, task.radius, child, task.obstacle};
      } else if (touch(task, children, hit, ~child, ~task.obstacle)) {
        return true;
      }
    }
    return false;
  }

  // Two leaves that single precision does not find apart.
  template <class Lanes>
  SPHERULE_INLINE bool touch(const KernelTask& ball, const Lanes& others, int lane,
                             std::int32_t body_sphere, std::int32_t obstacle_sphere) const {
    const float dx = others.x[lane] - ball.x;
    const float dy = others.y[lane] - ball.y;
    const float dz = others.z[lane] - ball.z;
    const float limit = others.radius[lane] + ball.radius - (body_.margin + obstacle_.margin);
    if (limit > 0.0F && dx * dx + dy * dy + dz * dz <= limit * limit) return true;
    return confirm_(context_, pair_, body_sphere, obstacle_sphere);
  }

  const KernelBody& body_;
  const KernelObstacle& obstacle_;
  KernelPair pair_;
  Placement at_;
  KernelTask* tasks_;
  std::size_t top_ = 0;
  ConfirmContact confirm_;
  void* context_;
};

bool check(const KernelProblem& problem, const double* configuration, const KernelScratch& scratch,
           ConfirmContact confirm, void* context) {
  place_frames(problem, configuration, scratch);
  place_roots(problem, scratch);
  for (std::int32_t i = 0; i < problem.pair_count; ++i) {
    const KernelPair pair = problem.pairs[i];
    const KernelTask& root = scratch.roots[pair.body];
    const KernelObstacle& obstacle = problem.obstacles[pair.obstacle];
    const float dx = obstacle.center[0] - root.x;
    const float dy = obstacle.center[1] - root.y;
    const float dz = obstacle.center[2] - root.z;
    const float limit = obstacle.radius + root.radius;
    if (dx * dx + dy * dy + dz * dz > limit * limit) continue;
    if (PairCheck(problem, pair, scratch, confirm, context).run(root)) return true;
  }
  return false;
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
