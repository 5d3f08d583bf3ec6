// SPDX-License-Identifier: BSD-3-Clause
// The scan, compiled once for each instruction set: the build defines SPHERULE_FLAT_KERNEL, a
// namespace of its own. Nothing here comes from a header with inline
// functions, which the linker could share between files that were compiled for different machines.

#include "bench/checkers/flat_scan/kernel.h"

// Every function with vectors is inlined: none crosses a boundary between files.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace spherule::flat_scan::SPHERULE_FLAT_KERNEL {
namespace {

#if defined(__AVX512F__)
constexpr int kBytes = 64;
#elif defined(__AVX2__)
constexpr int kBytes = 32;
#else
constexpr int kBytes = 16;
#endif
constexpr std::int32_t kWidth = kBytes / 4;
typedef float Floats __attribute__((vector_size(kBytes), may_alias));

inline __attribute__((always_inline)) const Floats& load(const float* p) {
  return *reinterpret_cast<const Floats*>(p);
}

// The lanes that are at most zero: their bytes are set.
class Lanes {
 public:
  explicit inline __attribute__((always_inline)) Lanes(Floats a) {
    typedef std::int8_t Bytes __attribute__((vector_size(kWidth)));
    const Bytes set = __builtin_convertvector(a <= 0.0F, Bytes);
    __builtin_memcpy(words_, &set, sizeof set);
  }

  bool any() const { return (words_[0] | words_[1]) != 0; }

  // Takes the first one out; there must be one.
  int next() {
    const int word = words_[0] != 0 ? 0 : 1;
    const int byte = __builtin_ctzll(words_[word]) / 8;
    words_[word] &= ~(std::uint64_t{0xff} << (8 * byte));
    return 8 * word + byte;
  }

 private:
  std::uint64_t words_[2] = {0, 0};
};

typedef double Double4 __attribute__((vector_size(32), may_alias));

struct Sphere {
  float x, y, z, radius;
};

// Squared distance of the centres less the square of the sum of the radii: not positive where the
// spheres touch.
inline __attribute__((always_inline)) Floats excess(const Floats& x, const Floats& y,
                                                    const Floats& z, const Floats& radius,
                                                    const Sphere& sphere) {
  const Floats dx = x - sphere.x;
  const Floats dy = y - sphere.y;
  const Floats dz = z - sphere.z;
  const Floats reach = radius + sphere.radius;
  return dx * dx + dy * dy + dz * dz - reach * reach;
}

inline bool are_apart(const Sphere& a, const Sphere& b) {
  const float dx = a.x - b.x;
  const float dy = a.y - b.y;
  const float dz = a.z - b.z;
  const float reach = a.radius + b.radius;
  return dx * dx + dy * dy + dz * dz > reach * reach;
}

// Sine and cosine of all positions: reduced by multiples of pi / 2 (in two parts; positions are at
// most some turns), then series whose first neglected terms are below 4e-13 for |r| <= pi / 4.
// Plain loops of a fixed length, which become vectors.
inline void sines_and_cosines(const double* angles, double* sines, double* cosines) {
  constexpr double kRound = 0x1.8p52;  // adding it rounds to an integer
  for (int i = 0; i < kMaxVariables; ++i) {
    const double k = (angles[i] * 0x1.45f306dc9c883p-1 + kRound) - kRound;
    const double r = (angles[i] - k * 0x1.921fb544p0) - k * 0x1.0b4611a626331p-34;
    const auto quarter = static_cast<std::int32_t>(k);
    const double r2 = r * r;
    const double sine =
        r + r * r2 *
                (-1.0 / 6 +
                 r2 * (1.0 / 120 +
                       r2 * (-1.0 / 5040 + r2 * (1.0 / 362880 + r2 * (-1.0 / 39916800 +
                                                                      r2 * (1.0 / 6227020800))))));
    const double cosine =
        1.0 - 0.5 * r2 +
        r2 * r2 *
            (1.0 / 24 + r2 * (-1.0 / 720 +
                              r2 * (1.0 / 40320 + r2 * (-1.0 / 3628800 + r2 * (1.0 / 479001600)))));
    const bool odd = (quarter & 1) != 0;
    const double s = odd ? cosine : sine;
    const double c = odd ? sine : cosine;
    sines[i] = (quarter & 2) != 0 ? -s : s;
    cosines[i] = ((quarter + 1) & 2) != 0 ? -c : c;
  }
}

inline __attribute__((always_inline)) void place_links(const Problem& problem,
                                                       const double* configuration,
                                                       LinkPose* poses) {
  alignas(64) double angles[kMaxVariables];
  alignas(64) double sines[kMaxVariables];
  alignas(64) double cosines[kMaxVariables];
  for (std::int32_t i = 0; i < kMaxVariables; ++i) {
    angles[i] = i < problem.variable_count ? configuration[i] : 0.0;
  }
  sines_and_cosines(angles, sines, cosines);
  for (std::int32_t i = 0; i < problem.frame_count; ++i) {
    const Frame& frame = problem.frames[i];
    const auto* const at_zero = reinterpret_cast<const Double4*>(frame.columns);
    const double sine = frame.variable < 0 ? 0.0 : sines[frame.variable];
    const double cosine = frame.variable < 0 ? 1.0 : cosines[frame.variable];
    const Double4 x = cosine * at_zero[0] + sine * at_zero[1];
    const Double4 y = cosine * at_zero[1] - sine * at_zero[0];
    const Double4 z = at_zero[2];
    const Double4 origin = at_zero[3];
    auto* const pose = reinterpret_cast<Double4*>(poses[i].columns);
    if (frame.parent < 0) {
      pose[0] = x;
      pose[1] = y;
      pose[2] = z;
      pose[3] = origin;
      continue;
    }
    const auto* const parent = reinterpret_cast<const Double4*>(poses[frame.parent].columns);
    pose[0] = parent[0] * x[0] + parent[1] * x[1] + parent[2] * x[2];
    pose[1] = parent[0] * y[0] + parent[1] * y[1] + parent[2] * y[2];
    pose[2] = parent[0] * z[0] + parent[1] * z[1] + parent[2] * z[2];
    pose[3] = parent[0] * origin[0] + parent[1] * origin[1] + parent[2] * origin[2] + parent[3];
  }
}

// The sphere around the group, which is drawn in the link's frame.
inline __attribute__((always_inline)) Sphere placed_root(const LinkPose& pose, const Group& group) {
  const auto* const at = reinterpret_cast<const Double4*>(pose.columns);
  const Double4 center =
      at[0] * group.center[0] + at[1] * group.center[1] + at[2] * group.center[2] + at[3];
  return {static_cast<float>(center[0]), static_cast<float>(center[1]),
          static_cast<float>(center[2]), group.radius};
}

struct Placement {
  float columns[4][3];

  explicit Placement(const LinkPose& pose) {
    for (int column = 0; column < 4; ++column) {
      for (int k = 0; k < 3; ++k) columns[column][k] = static_cast<float>(pose.columns[column][k]);
    }
  }
};

// Coordinate k of points of the link.
template <class T>
inline __attribute__((always_inline)) T image(const Placement& at, int k, const T& x, const T& y,
                                              const T& z) {
  return at.columns[0][k] * x + at.columns[1][k] * y + at.columns[2][k] * z + at.columns[3][k];
}

inline void place_spheres(const Spheres& spheres, const Placement& at, const Scratch& scratch) {
  for (std::int32_t i = 0; i < spheres.count; i += kWidth) {
    const Floats x = load(spheres.x + i);
    const Floats y = load(spheres.y + i);
    const Floats z = load(spheres.z + i);
    *reinterpret_cast<Floats*>(scratch.x + i) = image(at, 0, x, y, z);
    *reinterpret_cast<Floats*>(scratch.y + i) = image(at, 1, x, y, z);
    *reinterpret_cast<Floats*>(scratch.z + i) = image(at, 2, x, y, z);
  }
}

// Spheres against all placed spheres of a body: some at a time, since finding out whether any lane
// touches takes longer than a vector of tests.
class Waiting {
 public:
  Waiting(const Spheres& spheres, const Scratch& scratch) : spheres_(spheres), scratch_(scratch) {}

  // True if one that waited touches.
  inline __attribute__((always_inline)) bool add(const Sphere& sphere) {
    waiting_[count_++] = sphere;
    return count_ == kMost && flush();
  }

  inline __attribute__((always_inline)) bool flush() {
    Floats least = 1.0F - Floats{};
    for (std::int32_t first = 0; first < spheres_.count; first += kWidth) {
      const Floats x = load(scratch_.x + first);
      const Floats y = load(scratch_.y + first);
      const Floats z = load(scratch_.z + first);
      const Floats radius = load(spheres_.radius + first);
      for (int i = 0; i < count_; ++i) {
        const Floats here = excess(x, y, z, radius, waiting_[i]);
        least = here < least ? here : least;
      }
    }
    count_ = 0;
    return Lanes(least).any();
  }

 private:
  static constexpr int kMost = 8;

  const Spheres& spheres_;
  const Scratch& scratch_;
  Sphere waiting_[kMost];
  int count_ = 0;
};

inline Sphere sphere_at(const Spheres& spheres, std::int32_t i) {
  return {spheres.x[i], spheres.y[i], spheres.z[i], spheres.radius[i]};
}

bool touches_all_pairs(const Spheres& body, const Spheres& obstacle, const Scratch& scratch) {
  Waiting waiting(body, scratch);
  for (std::int32_t i = 0; i < obstacle.unique; ++i) {
    if (waiting.add(sphere_at(obstacle, i))) return true;
  }
  return waiting.flush();
}

// Places the body's spheres when the first sphere of the obstacle touches `root`.
bool touches_behind_root(const Spheres& body, const Placement& at, const Sphere& root,
                         const Spheres& obstacle, bool& is_placed, const Scratch& scratch) {
  Waiting waiting(body, scratch);
  bool any = false;
  for (std::int32_t first = 0; first < obstacle.count; first += kWidth) {
    Lanes near(excess(load(obstacle.x + first), load(obstacle.y + first), load(obstacle.z + first),
                      load(obstacle.radius + first), root));
    while (near.any()) {
      if (!is_placed) place_spheres(body, at, scratch);
      is_placed = any = true;
      if (waiting.add(sphere_at(obstacle, first + near.next()))) return true;
    }
  }
  return any && waiting.flush();
}

// A bit for every obstacle that the body has to be examined against.
inline std::uint32_t near_obstacles(const Problem& problem, const Body& body, const Sphere& root) {
  if (!problem.spheres_in_front) return body.against;
  std::uint32_t near = 0;
  for (std::int32_t i = 0; i < problem.obstacle_count; ++i) {
    const Group& obstacle = problem.obstacles[i];
    const Sphere around{static_cast<float>(obstacle.center[0]),
                        static_cast<float>(obstacle.center[1]),
                        static_cast<float>(obstacle.center[2]), obstacle.radius};
    if (!are_apart(root, around)) near |= 1U << i;
  }
  return near & body.against;
}

}  // namespace

bool check(const Problem& problem, const double* configuration, const Scratch& scratch) {
  place_links(problem, configuration, scratch.poses);
  for (std::int32_t b = 0; b < problem.body_count; ++b) {
    const Body& body = problem.bodies[b];
    const LinkPose& pose = scratch.poses[body.link];
    const Sphere root = placed_root(pose, body.group);
    std::uint32_t near = near_obstacles(problem, body, root);
    if (near == 0) continue;
    const Placement at(pose);
    bool is_placed = !problem.spheres_in_front;
    if (is_placed) place_spheres(body.group.spheres, at, scratch);
    for (; near != 0; near &= near - 1) {
      const Spheres& obstacle = problem.obstacles[__builtin_ctz(near)].spheres;
      const bool touches =
          problem.spheres_in_front
              ? touches_behind_root(body.group.spheres, at, root, obstacle, is_placed, scratch)
              : touches_all_pairs(body.group.spheres, obstacle, scratch);
      if (touches) return true;
    }
  }
  return false;
}

}  // namespace spherule::flat_scan::SPHERULE_FLAT_KERNEL
