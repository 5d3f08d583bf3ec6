// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Kinematics of one configuration in double precision. Part of the kernels, see
// mechanism_kernel_impl.h.

#include "collide/mechanism/kernel_angles.h"
#include "collide/mechanism/kernel_search.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

typedef float Float4 __attribute__((vector_size(16), may_alias));
typedef double Double4 __attribute__((vector_size(32), may_alias));
typedef std::int64_t Long4 __attribute__((vector_size(32), may_alias));

SPHERULE_INLINE Double4 load(const double* p) {
  return *reinterpret_cast<const Double4*>(p);
}

// The first `count` of four numbers at p, the others zero.
SPHERULE_INLINE Double4 load_some(const double* p, std::int32_t count) {
  if (count >= 4) {
    Double4 x;
    __builtin_memcpy(&x, p, sizeof x);
    return x;
  }
  return Double4{p[0], count > 1 ? p[1] : 0.0, count > 2 ? p[2] : 0.0, 0.0};
}

// The series are summed in pairs of terms: a chain of terms would have to wait for each.
SPHERULE_INLINE void sine_and_cosine(Double4 x, double* sines, double* cosines) {
  const auto angle = reduced(x);
  const Double4& r = angle.remainder;
  const Double4 r2 = r * r;
  const Double4 r4 = r2 * r2;
  const Double4 sine =
      r + (r * r2) * ((r2 * (1.0 / 120) - 1.0 / 6) +
                      r4 * ((r2 * (1.0 / 362880) - 1.0 / 5040) + r4 * (-1.0 / 39916800)));
  const Double4 cosine =
      (1.0 - 0.5 * r2) +
      r4 * ((r2 * (-1.0 / 720) + 1.0 / 24) +
            r4 * ((r2 * (-1.0 / 3628800) + 1.0 / 40320) + r4 * (1.0 / 479001600)));
  Long4 quarter;
  __builtin_memcpy(&quarter, &angle.shifted, sizeof quarter);
  const auto turned = turned_by(quarter, sine, cosine);
  __builtin_memcpy(sines, &turned.sine, sizeof turned.sine);
  __builtin_memcpy(cosines, &turned.cosine, sizeof turned.cosine);
}

// Where a variable has its frame in the parent's. To memory, from where one number at a time is
// read again for all lanes: to spread lanes of a vector takes longer.
SPHERULE_INLINE void place_in_parent(const KernelFrame& frame, double position, double sine,
                                     double cosine, KernelPose& pose) {
  const Double4 f0 = load(frame.rotation[0]);
  const Double4 f1 = load(frame.rotation[1]);
  const Double4 f2 = load(frame.rotation[2]);
  const Double4 origin = load(frame.origin);
  auto* const result = reinterpret_cast<Double4*>(pose.columns);
  result[2] = f2;
  if (frame.prismatic) {
    result[0] = f0;
    result[1] = f1;
    result[3] = origin + position * f2;
  } else {
    result[0] = cosine * f0 + sine * f1;
    result[1] = cosine * f1 - sine * f0;
    result[3] = origin;
  }
}

// The poses of all frames. What does not depend on the parent is computed first: the chain from
// frame to frame is what takes the time.
SPHERULE_INLINE void place_frames(const KernelProblem& problem, const double* configuration,
                                  const KernelScratch& scratch) {
  for (std::int32_t i = 0; i < problem.variable_count; i += 4) {
    sine_and_cosine(load_some(configuration + i, problem.variable_count - i), scratch.sines + i,
                    scratch.cosines + i);
  }
  for (std::int32_t i = 0; i < problem.frame_count; ++i) {
    const KernelFrame& frame = problem.frames[i];
    place_in_parent(frame, configuration[frame.variable], scratch.sines[frame.variable],
                    scratch.cosines[frame.variable], scratch.poses[i]);
  }
  Double4 p0 = {};
  Double4 p1 = {};
  Double4 p2 = {};
  Double4 p3 = {};
  for (std::int32_t i = 0; i < problem.frame_count; ++i) {
    const std::int32_t parent = problem.frames[i].parent;
    double(*const at)[4] = scratch.poses[i].columns;
    auto* const result = reinterpret_cast<Double4*>(at);
    if (parent < 0) {
      p0 = result[0];
      p1 = result[1];
      p2 = result[2];
      p3 = result[3];
      continue;
    }
    if (parent != i - 1) {
      const auto* const from = reinterpret_cast<const Double4*>(scratch.poses[parent].columns);
      p0 = from[0];
      p1 = from[1];
      p2 = from[2];
      p3 = from[3];
    }
    const Double4 r0 = p0 * at[0][0] + p1 * at[0][1] + p2 * at[0][2];
    const Double4 r1 = p0 * at[1][0] + p1 * at[1][1] + p2 * at[1][2];
    const Double4 r2 = p0 * at[2][0] + p1 * at[2][1] + p2 * at[2][2];
    const Double4 r3 = p3 + p0 * at[3][0] + p1 * at[3][1] + p2 * at[3][2];
    result[0] = p0 = r0;
    result[1] = p1 = r1;
    result[2] = p2 = r2;
    result[3] = p3 = r3;
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

// The sphere around all of every body.
SPHERULE_INLINE void place_roots(const KernelProblem& problem, const KernelScratch& scratch) {
  for (std::int32_t i = 0; i < problem.body_count; ++i) {
    const KernelBody& body = problem.bodies[i];
    const auto* const at = reinterpret_cast<const Double4*>(scratch.poses[body.frame].columns);
    const Double4 center =
        at[0] * body.center[0] + at[1] * body.center[1] + at[2] * body.center[2] + at[3];
    Float4 sphere = __builtin_convertvector(center, Float4);
    sphere[3] = body.radius;
    KernelTask& root = scratch.roots[i];
    static_assert(__builtin_offsetof(KernelTask, radius) == 12);
    __builtin_memcpy(&root, &sphere, sizeof sphere);
    root.body = 0;
    root.obstacle = 0;
  }
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
