// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/cad/internal/surface_bounds.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace spherule::internal {

using Parameters = Eigen::Vector2d;  // (u, v)

struct ParametricSurface {
  std::function<Eigen::Vector3d(const Parameters&)> point;
  SurfaceBound bound;  // empty where no bound is known
  // Where the surface is defined; infinite along directions without end.
  Interval u;
  Interval v;
};

// A curve in the parameters of a surface, with the third coordinate zero in its bounds.
struct ParameterCurve {
  std::function<Parameters(double)> point;
  CurveBound bound;  // empty where no bound is known
};

// A piece of the boundary of a face, from one node of the triangulation to another, with the face
// on its left.
struct BoundaryArc {
  int start = 0;
  int end = 0;
  std::size_t curve = 0;
  double from = 0.0;  // parameters of the curve at `start` and `end`
  double to = 0.0;
};

// A piece of a surface cut out by curves, and the triangles put in its place. Triangles turn in the
// parameters as u to v.
struct TessellatedFace {
  ParametricSurface surface;
  std::vector<ParameterCurve> curves;
  std::vector<BoundaryArc> boundary;
  std::vector<Parameters> parameters;  // of each node
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::array<int, 3>> triangles;
};

// How far points of faces are from the triangles in their place, over all faces added.
//
// bound(): proved, for every point S(u, v) of every face for which add() gave no reason, (u, v)
// being enclosed by the boundary of the face: the distance to the nearest triangle of that face is
// at most this, if S is computed exactly. (docs/cad.md has the proof.)
// reached(): the distance from the triangles of the face that was found at some point of it, or of
// its surface beside its boundary: a bound below it cannot be proved in this way.
// The search stops when the bound is within 2 % of what was reached, or below `floor`, or when it
// has taken too many steps.
class SurfaceDeviation {
 public:
  // Lengths below `floor` > 0 are not told apart.
  explicit SurfaceDeviation(double floor) : floor_(floor) {}

  // An empty text, or why no bound is proved for the face; that face then does not count.
  std::string add(const TessellatedFace& face);

  double bound() const { return bound_; }
  double reached() const { return reached_; }

 private:
  struct Piece {
    std::array<Parameters, 3> parameters;
    std::array<Eigen::Vector3d, 3> points;  // of the surface at these
    std::size_t triangle;                   // the one it is compared with
  };
  struct Target {
    const TessellatedFace& face;
    MeshDistance distance;
  };

  // `extra` is to be added to what is found.
  void cover(const Target& target, const std::array<Parameters, 3>& parameters,
             std::size_t triangle, double extra);
  void cover(const Target& target, Piece piece, double extra, int depth);
  void cover_arc(const Target& target, const BoundaryArc& arc, std::size_t triangle);
  bool is_done(double value) const;

  double floor_;
  double bound_ = 0.0;
  double reached_ = 0.0;
  std::size_t steps_ = 0;
};

// The largest distance found at samples of the face, those beyond the chords of its boundary among
// them, from its triangles. No bound.
double sampled_deviation(const TessellatedFace& face);

}  // namespace spherule::internal
