// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/solid/best_first.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {

// What a subdivision proved about a set of points X and the union of a set of spheres.
struct CoverageProof {
  // Bounds of the uncovered depth of X; upper is 0 exactly if X is proved to be covered.
  double lower = 0.0;
  double upper = 0.0;
  Eigen::Vector3d deepest = Eigen::Vector3d::Zero();  // witness of `lower`, if that is positive
  std::size_t examined = 0;

  // Joins the proofs of two parts of X. The first of equal witnesses is kept.
  void join(const CoverageProof& other) {
    if (other.lower > lower) {
      lower = other.lower;
      deepest = other.deepest;
    }
    upper = std::max(upper, other.upper);
    examined += other.examined;
  }
};

// The spheres with their search structure.
struct SpheresToProve {
  std::span<const Sphere> spheres;
  const SphereHierarchy& hierarchy;
};

// X = the triangles. They are halved at their longest edge until a piece
// lies in a single sphere (a sphere is convex: corners in it, piece in it) or is smaller than
// `finest`, at least 2^-40 of the largest coordinate.
CoverageProof prove_surface(const TriangleMesh& mesh, const SpheresToProve& spheres, double finest);

// A point of X outside of the spheres; none if the depth is 0.
struct KnownLeak {
  double depth = 0.0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

// X = S. Cells of its box are halved until one, as far as it is in S, lies in a single sphere, or
// is smaller than `finest`; where its centre is outside of S, than a share of `finest` that
// solid_query.h states. The part of S in a cell is bounded by the external sphere that is nearest
// to its centre. `is_witness` tells whether a point, of S or of the mesh, may be reported as a
// leak; it is called by several threads. The search starts from the leak that is known.
CoverageProof prove_solid(const Clearance& clearance, const MeshDistance& distance,
                          const SpheresToProve& spheres, double finest,
                          const std::function<bool(const Eigen::Vector3d&)>& is_witness,
                          const KnownLeak& known = {});

// A triangle, or a part of one.
struct SurfacePiece {
  std::array<Eigen::Vector3d, 3> corner;
};

struct FurthestCorner {
  Eigen::Vector3d corner;
  double distance;  // no point of the piece is further: a distance is convex
};

inline FurthestCorner furthest_corner(const SurfacePiece& piece, const Eigen::Vector3d& point) {
  FurthestCorner furthest{piece.corner[0], distance_upper(point, piece.corner[0])};
  for (std::size_t k = 1; k < 3; ++k) {
    const double distance = distance_upper(point, piece.corner[k]);
    if (distance > furthest.distance) furthest = {piece.corner[k], distance};
  }
  return furthest;
}

// The edge from this corner to the next is as long as any.
inline std::size_t longest_edge(const SurfacePiece& piece) {
  const auto& p = piece.corner;
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double l = (p[(k + 1) % 3] - p[k]).squaredNorm();
    if (l > length) {
      length = l;
      longest = k;
    }
  }
  return longest;
}

// Appends the halves of a piece, which is cut at the middle of its longest edge.
inline void halve(const SurfacePiece& piece, std::vector<SurfacePiece>& parts) {
  const std::size_t longest = longest_edge(piece);
  const auto& p = piece.corner;
  const Eigen::Vector3d& from = p[longest];
  const Eigen::Vector3d& to = p[(longest + 1) % 3];
  const Eigen::Vector3d& apex = p[(longest + 2) % 3];
  const Eigen::Vector3d middle = (from + to) / 2.0;
  parts.push_back({{from, middle, apex}});
  parts.push_back({{middle, to, apex}});
}

// What was found out about a piece of the set X to be covered.
struct Finding {
  bool settled = false;   // what X is in it is in a single sphere: nothing remains to be proved
  bool smallest = false;  // not to be split further
  double upper = 0.0;     // no point of X in the piece is further from the spheres
  double depth = -std::numeric_limits<double>::infinity();  // of `point`, if that is in X
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

// Proves the coverage of X (G1), given as pieces, by splitting what `examine` leaves open with
// `split` (which appends the parts of a piece to a list). Only points for which `is_witness` is
// true are reported. All three are called by several threads. A piece that is proved not to be
// deeper than the deepest point found, within `finest` or kDepthTolerance of that depth, is left as
// it is: it does not change the verdict, nor the depth by more than that. The first kCloserPieces
// are split on to a tenth of these tolerances, which leaks of simple shapes reach.
//
// The deepest pieces are examined first, so that a leak is soon known; what remains after
// kBestFirst pieces is divided into fixed blocks for the threads, so that the result does not
// depend on their number.
template <typename Piece, typename Examine, typename Split, typename IsWitness>
class Subdivision {
 public:
  Subdivision(std::vector<Piece> pieces, double finest, Examine examine, Split split,
              IsWitness is_witness)
      : pieces_(std::move(pieces)),
        finest_(finest),
        examine_(std::move(examine)),
        split_(std::move(split)),
        is_witness_(std::move(is_witness)) {}

  CoverageProof prove(const KnownLeak& known = {}) const {
    State state{{.lower = known.depth, .deepest = known.point}, known.depth};
    std::vector<Open> heap;
    std::uint64_t made = 0;
    for (const Piece& piece : pieces_) {
      heap.push_back({piece, std::numeric_limits<double>::infinity(), made++});
    }
    std::make_heap(heap.begin(), heap.end(), BestFirst());
    std::vector<Piece> parts;
    while (!heap.empty() && state.proof.examined < std::max(kBestFirst, 2 * pieces_.size())) {
      std::pop_heap(heap.begin(), heap.end(), BestFirst());
      const Open open = std::move(heap.back());
      heap.pop_back();
      double upper = open.upper;
      const bool is_early = state.proof.examined < kCloserPieces + pieces_.size();
      if (!step(open.piece, state, is_early ? kCloserShare : 1.0, upper, parts)) continue;
      for (const Piece& part : parts) {
        heap.push_back({part, upper, made++});
        std::push_heap(heap.begin(), heap.end(), BestFirst());
      }
    }
    std::sort(heap.begin(), heap.end(), BestFirst());
    prove_in_blocks(heap, state);
    return state.proof;
  }

 private:
  static constexpr std::size_t kBestFirst = 20'000;
  static constexpr std::size_t kBlocks = 64;
  static constexpr double kDepthTolerance = 0.02;
  static constexpr double kCloserShare = 0.1;
  static constexpr std::size_t kCloserPieces = 4'000;

  struct Open {
    Piece piece;
    double upper;
    std::uint64_t order;
  };
  struct State {
    CoverageProof proof;
    double seen = 0.0;  // greatest depth met, whether or not its point may be reported
  };

  // Examines one piece; true if it was split into `parts`. `share` multiplies the tolerances.
  bool step(const Piece& piece, State& state, double share, double& upper,
            std::vector<Piece>& parts) const {
    ++state.proof.examined;
    Piece open = piece;
    const Finding found = examine_(open);
    if (found.settled) return false;
    if (found.depth > state.seen) state.seen = found.depth;
    if (found.depth > state.proof.lower && is_witness_(found.point)) {
      state.proof.lower = found.depth;
      state.proof.deepest = found.point;
    }
    upper = std::min(upper, std::max(0.0, found.upper));
    const double close = share * std::max(finest_, kDepthTolerance * state.seen);
    if (found.smallest || (state.seen > 0.0 && upper <= state.seen + close)) {
      state.proof.upper = std::max({state.proof.upper, upper, kUnderflow});
      return false;
    }
    parts.clear();
    split_(open, parts);
    return true;
  }

  void prove_in_blocks(const std::vector<Open>& open, State& state) const {
    State start = state;
    start.proof.examined = 0;
    std::vector<State> states(std::min(kBlocks, open.size()), start);
    parallel_for(0, states.size(), [&](std::size_t block) {
      std::vector<std::pair<Piece, double>> waiting;
      std::vector<Piece> parts;
      for (std::size_t i = block; i < open.size(); i += states.size()) {
        waiting.assign(1, {open[i].piece, open[i].upper});
        while (!waiting.empty()) {
          auto [piece, upper] = std::move(waiting.back());
          waiting.pop_back();
          if (!step(piece, states[block], 1.0, upper, parts)) continue;
          for (const Piece& part : parts) waiting.emplace_back(part, upper);
        }
      }
    });
    for (const State& s : states) state.proof.join(s.proof);
  }

  std::vector<Piece> pieces_;
  double finest_;
  Examine examine_;
  Split split_;
  IsWitness is_witness_;
};

}  // namespace spherule::internal
