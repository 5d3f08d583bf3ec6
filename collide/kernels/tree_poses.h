// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Kinematics of one configuration in double precision. Part of the kernels, see
// tree_block.h.

#include "collide/kernels/tree_search.h"
#include "collide/search/vectors.h"

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

// Sixteen configurations side by side, in as many vectors of the machine as that takes: numbers,
// and the kinematics in single precision. Part of the kernels, see tree_block.h.
//
// Error budget, v = 2^-24. A pair of sine and cosine errs by less than 6 v (vectors.h).
// Of a frame in its parent's, over all nine entries of a rotation (Frobenius):
//   the frame's rotation rounded           2 v
//   product with the parent's              9 v   three terms an entry, 3 v by Cauchy, nine entries
//   turn by the variable                   4 v   two terms an entry, 2 v, of two columns
//   sine and cosine                        6 v
// and of its origin, where W bounds the lengths of the chain together: rounded v W (twice for a
// shift, the variable rounded v W more), product and sum 7 v W. A point that the frame carries, at
// no more than W from it, moves by less than 21 v W and 10 v W: 31 v W a frame, and a fifth more
// for what the norms of rounded rotations grow by in chains of up to kLongestLaneChain frames.

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

#if defined(__AVX512F__)
constexpr int kPartBytes = 64;
#elif defined(__AVX__)
constexpr int kPartBytes = 32;
#else
constexpr int kPartBytes = 16;
#endif
constexpr int kParts = kLanes * 4 / kPartBytes;
constexpr unsigned kAllLanes = (1U << kLanes) - 1;

typedef float FloatPart __attribute__((vector_size(kPartBytes), may_alias));
typedef std::int32_t IntPart __attribute__((vector_size(kPartBytes), may_alias));
typedef std::int32_t HalfIntPart __attribute__((vector_size(kPartBytes / 2), may_alias));
typedef float HalfFloatPart __attribute__((vector_size(kPartBytes / 2), may_alias));
typedef double DoublePart __attribute__((vector_size(kPartBytes), may_alias));

#define SPHERULE_EACH_PART _Pragma("GCC unroll 4") for (int i = 0; i < kParts; ++i)

struct Floats {
  FloatPart part[kParts];

  static SPHERULE_INLINE Floats all(float x) {
    Floats result;
    SPHERULE_EACH_PART result.part[i] = x - FloatPart{};
    return result;
  }
  static SPHERULE_INLINE Floats at(const float* p) {
    Floats result;
    SPHERULE_EACH_PART result.part[i] = reinterpret_cast<const FloatPart*>(p)[i];
    return result;
  }
  SPHERULE_INLINE void put(float* p) const {
    SPHERULE_EACH_PART reinterpret_cast<FloatPart*>(p)[i] = part[i];
  }
};

SPHERULE_INLINE Floats operator+(const Floats& a, const Floats& b) {
  Floats result;
  SPHERULE_EACH_PART result.part[i] = a.part[i] + b.part[i];
  return result;
}
SPHERULE_INLINE Floats operator-(const Floats& a, const Floats& b) {
  Floats result;
  SPHERULE_EACH_PART result.part[i] = a.part[i] - b.part[i];
  return result;
}
SPHERULE_INLINE Floats operator*(const Floats& a, const Floats& b) {
  Floats result;
  SPHERULE_EACH_PART result.part[i] = a.part[i] * b.part[i];
  return result;
}
SPHERULE_INLINE Floats operator-(const Floats& a, float b) {
  Floats result;
  SPHERULE_EACH_PART result.part[i] = a.part[i] - b;
  return result;
}
SPHERULE_INLINE Floats operator+(const Floats& a, float b) {
  Floats result;
  SPHERULE_EACH_PART result.part[i] = a.part[i] + b;
  return result;
}
SPHERULE_INLINE Floats operator*(float a, const Floats& b) {
  Floats result;
  SPHERULE_EACH_PART result.part[i] = a * b.part[i];
  return result;
}

// A bit for every lane of a that is at most b.
SPHERULE_INLINE unsigned at_most(const Floats& a, float b) {
#if defined(__AVX512F__)
  return _mm512_cmp_ps_mask(reinterpret_cast<__m512>(a.part[0]), _mm512_set1_ps(b), _CMP_LE_OQ);
#elif defined(__AVX__)
  return mask_of(a.part[0] <= b) | mask_of(a.part[1] <= b) << 8;
#else
  Int8 low, high;
  const IntPart set[4] = {a.part[0] <= b, a.part[1] <= b, a.part[2] <= b, a.part[3] <= b};
  __builtin_memcpy(&low, set, sizeof low);
  __builtin_memcpy(&high, set + 2, sizeof high);
  return mask_of(low) | mask_of(high) << 8;
#endif
}

template <class Vector>
SPHERULE_INLINE Vector larger(Vector a, Vector b) {
  return a > b ? a : b;
}

// The largest of the lanes that are live; zero if that is less.
SPHERULE_INLINE float largest(const Floats& a, unsigned live) {
  alignas(64) float lanes[kLanes];
#if defined(__AVX512F__)
  _mm512_store_ps(lanes, _mm512_maskz_mov_ps(static_cast<__mmask16>(live),
                                             reinterpret_cast<__m512>(a.part[0])));
#else
  a.put(lanes);
  for (unsigned dead = kAllLanes & ~live; dead != 0; dead &= dead - 1) {
    lanes[__builtin_ctz(dead)] = 0.0F;
  }
#endif
  const Float8 eight = larger(load(lanes), load(lanes + 8));
  __builtin_memcpy(lanes, &eight, sizeof eight);
  const Float4 four =
      larger(*reinterpret_cast<const Float4*>(lanes), *reinterpret_cast<const Float4*>(lanes + 4));
  const float low = four[0] > four[1] ? four[0] : four[1];
  const float high = four[2] > four[3] ? four[2] : four[3];
  const float both = low > high ? low : high;
  return both > 0.0F ? both : 0.0F;
}

// Rounds to single precision; returns the lanes with a number of at most kLargestPosition.
SPHERULE_INLINE unsigned in_range(const double* exact, float* rounded) {
#pragma GCC unroll 8
  for (int i = 0; i < 2 * kParts; ++i) {
    const DoublePart x = reinterpret_cast<const DoublePart*>(exact)[i];
    reinterpret_cast<HalfFloatPart*>(rounded)[i] = __builtin_convertvector(x, HalfFloatPart);
  }
#if defined(__AVX512F__)
  unsigned lanes_in_range = 0;
  for (int i = 0; i < 2; ++i) {
    const __m512d size = _mm512_abs_pd(_mm512_load_pd(exact + 8 * i));
    const __mmask8 set = _mm512_cmp_pd_mask(size, _mm512_set1_pd(kLargestPosition), _CMP_LE_OQ);
    lanes_in_range |= static_cast<unsigned>(set) << (8 * i);
  }
  return lanes_in_range;
#else
  unsigned lanes_in_range = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    const bool is_in_range = __builtin_fabs(exact[lane]) <= kLargestPosition;
    lanes_in_range |= (is_in_range ? 1U : 0U) << lane;
  }
  return lanes_in_range;
#endif
}

// Angles less the nearest multiple of pi / 2, and that multiple. To memory, and read again when
// all are done: vectors of other widths that are read at once would have to wait.
SPHERULE_INLINE void reduce(const double* angles, float* remainders, std::int32_t* quarters) {
#pragma GCC unroll 8
  for (int i = 0; i < 2 * kParts; ++i) {
    const DoublePart x = reinterpret_cast<const DoublePart*>(angles)[i];
    const auto angle = reduced(x);
    reinterpret_cast<HalfFloatPart*>(remainders)[i] =
        __builtin_convertvector(angle.remainder, HalfFloatPart);
    reinterpret_cast<HalfIntPart*>(quarters)[i] =
        __builtin_convertvector(angle.quarters, HalfIntPart);
  }
}

SPHERULE_INLINE void sines_and_cosines(const float* remainders, const std::int32_t* quarters,
                                       Floats& sines, Floats& cosines) {
  SPHERULE_EACH_PART {
    const FloatPart r = reinterpret_cast<const FloatPart*>(remainders)[i];
    const IntPart quarter = reinterpret_cast<const IntPart*>(quarters)[i];
    const FloatPart r2 = r * r;
    const FloatPart sine = sine_series(r, r2);
    const FloatPart cosine = cosine_series(r2);
    const auto turned = turned_by(quarter, sine, cosine);
    __builtin_memcpy(&sines.part[i], &turned.sine, sizeof turned.sine);
    __builtin_memcpy(&cosines.part[i], &turned.cosine, sizeof turned.cosine);
  }
}

struct Vectors {
  Floats x, y, z;
};

// A column or the origin of a pose.
SPHERULE_INLINE Vectors column(const KernelLanePose& pose, int which) {
  const float(*const at)[kLanes] = pose.columns[which];
  return {Floats::at(at[0]), Floats::at(at[1]), Floats::at(at[2])};
}

SPHERULE_INLINE void put(const Vectors& v, float (*at)[kLanes]) {
  v.x.put(at[0]);
  v.y.put(at[1]);
  v.z.put(at[2]);
}

SPHERULE_INLINE Vectors operator*(float a, const Vectors& v) {
  return {a * v.x, a * v.y, a * v.z};
}

SPHERULE_INLINE Vectors operator+(const Vectors& v, const Vectors& w) {
  return {v.x + w.x, v.y + w.y, v.z + w.z};
}

// The image of a point's coordinates under the columns of a pose, without its origin. Most
// coordinates of most frames are zero.
SPHERULE_INLINE Vectors combined(const KernelLanePose& pose, const float* by) {
  Vectors sum;
  bool is_empty = true;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    if (by[i] == 0.0F) continue;
    const Vectors term = by[i] * column(pose, i);
    sum = is_empty ? term : sum + term;
    is_empty = false;
  }
  if (is_empty) sum = {Floats::all(0.0F), Floats::all(0.0F), Floats::all(0.0F)};
  return sum;
}

SPHERULE_INLINE Vectors image(const KernelLanePose& pose, const float* point) {
  return point[0] * column(pose, 0) +
         (point[1] * column(pose, 1) + (point[2] * column(pose, 2) + column(pose, 3)));
}

SPHERULE_INLINE Vectors constant(const float* v) {
  return {Floats::all(v[0]), Floats::all(v[1]), Floats::all(v[2])};
}

// Puts the variables of the configurations side by side, with what the kinematics need of them;
// returns the lanes with a number that is out of range or none. Those have zeros.
SPHERULE_INLINE unsigned gather(const KernelProblem& problem, const double* const* configurations,
                                KernelLaneVariable* variables) {
  for (std::int32_t i = 0; i < problem.variable_count; ++i) {
#pragma GCC unroll 16
    for (int lane = 0; lane < kLanes; ++lane) variables[i].exact[lane] = configurations[lane][i];
  }
  unsigned lanes_in_range = kAllLanes;
  for (std::int32_t i = 0; i < problem.variable_count; ++i) {
    lanes_in_range &= in_range(variables[i].exact, variables[i].rounded);
  }
  for (std::int32_t i = 0; i < problem.variable_count; ++i) {
    for (unsigned refused = kAllLanes & ~lanes_in_range; refused != 0; refused &= refused - 1) {
      variables[i].exact[__builtin_ctz(refused)] = 0.0;
      variables[i].rounded[__builtin_ctz(refused)] = 0.0F;
    }
    reduce(variables[i].exact, variables[i].remainder, variables[i].quarter);
  }
  return kAllLanes & ~lanes_in_range;
}

// The poses of all frames.
SPHERULE_INLINE void place_lane_frames(const KernelProblem& problem,
                                       const KernelLaneVariable* variables, KernelLanePose* poses) {
  for (std::int32_t f = 0; f < problem.frame_count; ++f) {
    const KernelLaneFrame& frame = problem.lane_frames[f];
    const KernelLaneVariable& variable = variables[frame.variable];
    KernelLanePose& pose = poses[f];
    Vectors m0, m1, m2, origin;
    if (frame.parent < 0) {
      m0 = constant(frame.rotation[0]);
      m1 = constant(frame.rotation[1]);
      m2 = constant(frame.rotation[2]);
      origin = constant(frame.origin);
    } else {
      const KernelLanePose& parent = poses[frame.parent];
      m0 = combined(parent, frame.rotation[0]);
      m1 = combined(parent, frame.rotation[1]);
      m2 = combined(parent, frame.rotation[2]);
      origin = combined(parent, frame.origin) + column(parent, 3);
    }
    put(m2, pose.columns[2]);
    if (frame.prismatic) {
      const Floats shift = Floats::at(variable.rounded);
      put(m0, pose.columns[0]);
      put(m1, pose.columns[1]);
      put({origin.x + shift * m2.x, origin.y + shift * m2.y, origin.z + shift * m2.z},
          pose.columns[3]);
      continue;
    }
    Floats s, c;
    sines_and_cosines(variable.remainder, variable.quarter, s, c);
    put({c * m0.x + s * m1.x, c * m0.y + s * m1.y, c * m0.z + s * m1.z}, pose.columns[0]);
    put({c * m1.x - s * m0.x, c * m1.y - s * m0.y, c * m1.z - s * m0.z}, pose.columns[1]);
    put(origin, pose.columns[3]);
  }
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
