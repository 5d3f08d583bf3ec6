// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solids/convex.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// How far a core reaches along a direction, and a point of it that does, up to rounding.
struct Extreme {
  double along;
  Vector3d point;
};

// The unit vector of the disc's plane nearest to `d`; zero if that is nearly perpendicular to it,
// as rounding would then take the vector out of the plane.
Vector3d in_plane(const Vector3d& d, const Vector3d& axis) {
  Vector3d e = d - d.dot(axis) * axis;
  e -= e.dot(axis) * axis;
  const double length = e.norm();
  return length > 0x1p-40 * d.norm() ? Vector3d(e / length) : Vector3d(Vector3d::Zero());
}

Extreme extreme(const Convex& core, const Vector3d& d) {
  Extreme result{d.dot(core.points[0]), core.points[0]};
  for (int i = 1; i < core.point_count; ++i) {
    const Vector3d& point = core.points[static_cast<std::size_t>(i)];
    const double along = d.dot(point);
    if (along > result.along) result = {along, point};
  }
  for (int i = 0; i < core.axis_count; ++i) {
    const Vector3d& axis = core.axes[static_cast<std::size_t>(i)];
    const double along = d.dot(axis);
    result.along += std::abs(along);
    result.point += along < 0.0 ? Vector3d(-axis) : axis;
  }
  if (core.disc_radius > 0.0) {
    result.along += core.disc_radius * d.cross(core.disc_axis).norm();
    result.point += core.disc_radius * in_plane(d, core.disc_axis);
  }
  return result;
}

// A point of the difference of two cores, with the points that make it.
struct Corner {
  Vector3d p;
  Vector3d a;
  Vector3d b;
};

// Up to four corners, of which the last is the newest, with the weights of the point of their hull
// that is nearest to the origin.
struct Simplex {
  int count = 0;
  std::array<Corner, 4> corners;
  std::array<double, 4> weights{};

  const Vector3d& p(int i) const { return corners[static_cast<std::size_t>(i)].p; }
  bool holds(const Vector3d& q) const {
    for (int i = 0; i < count; ++i) {
      if (p(i) == q) return true;
    }
    return false;
  }

  // Reduces to the corners of the nearest point of those parts that have the newest corner. Each
  // part with a nearest point inside of it is tried: no test has to be right.
  void reduce() {
    const int last = count - 1;
    best_ = p(last).squaredNorm();
    Choice choice{{last, 0, 0, 0}, {1.0, 0.0, 0.0, 0.0}, 1};
    for (int i = 0; i < last; ++i) try_edge(i, last, choice);
    for (int i = 0; i < last; ++i) {
      for (int j = i + 1; j < last; ++j) try_face(i, j, last, choice);
    }
    if (count == 4) try_whole(choice);
    std::array<Corner, 4> kept;
    for (int k = 0; k < choice.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      kept[at] = corners[static_cast<std::size_t>(choice.index[at])];
      weights[at] = choice.weight[at];
    }
    corners = kept;
    count = choice.count;
  }

  Vector3d sum(Vector3d Corner::*of) const {
    Vector3d result = Vector3d::Zero();
    double weight = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      result += weights[i] * corners[i].*of;
      weight += weights[i];
    }
    return result / weight;
  }

  // From the origin's nearest point to the origin's side, reversed: perpendicular to the part, as
  // exactly as its edges are known.
  Vector3d direction() const {
    Vector3d d = sum(&Corner::p);
    if (count == 2) {
      const Vector3d e = p(1) - p(0);
      const double square = e.squaredNorm();
      for (int pass = 0; pass < 2 && square > 0.0; ++pass) d -= (d.dot(e) / square) * e;
    } else if (count == 3) {
      const Vector3d n = (p(1) - p(0)).cross(p(2) - p(0));
      if (n.squaredNorm() > 0.0) d = n.dot(p(0)) < 0.0 ? Vector3d(-n) : n;
    }
    return d;
  }

 private:
  struct Choice {
    std::array<int, 4> index;
    std::array<double, 4> weight;
    int count;
  };

  void try_edge(int i, int j, Choice& choice) {
    const Vector3d e = p(j) - p(i);
    const double square = e.squaredNorm();
    const double t = -p(i).dot(e), s = p(j).dot(e);
    if (!(square > 0.0 && t > 0.0 && s > 0.0)) return;
    const double nearest = (p(i) + (t / square) * e).squaredNorm();
    if (!(nearest < best_)) return;
    best_ = nearest;
    choice = {{i, j, 0, 0}, {s, t, 0.0, 0.0}, 2};
  }

  void try_face(int i, int j, int k, Choice& choice) {
    const Vector3d n = (p(j) - p(i)).cross(p(k) - p(i));
    const double square = n.squaredNorm();
    const double wi = n.dot(p(j).cross(p(k))), wj = n.dot(p(k).cross(p(i))),
                 wk = n.dot(p(i).cross(p(j)));
    if (!(square > 0.0 && wi > 0.0 && wj > 0.0 && wk > 0.0)) return;
    const double along = n.dot(p(k));
    const double nearest = along * along / square;
    if (!(nearest < best_)) return;
    best_ = nearest;
    choice = {{i, j, k, 0}, {wi, wj, wk, 0.0}, 3};
  }

  void try_whole(Choice& choice) const {
    const double w0 = p(3).dot(p(1).cross(p(2))), w1 = p(3).dot(p(2).cross(p(0))),
                 w2 = p(3).dot(p(0).cross(p(1)));
    const double w3 = -p(0).dot(p(1).cross(p(2)));
    const bool positive = w0 > 0.0 && w1 > 0.0 && w2 > 0.0 && w3 > 0.0;
    const bool negative = w0 < 0.0 && w1 < 0.0 && w2 < 0.0 && w3 < 0.0;
    if (!positive && !negative) return;
    choice = {{0, 1, 2, 3}, {std::abs(w0), std::abs(w1), std::abs(w2), std::abs(w3)}, 4};
  }

  double best_ = 0.0;
};

// The edges of a core, and the axis of its disc.
int edges_of(const Convex& core, std::array<Vector3d, 7>& edges, int count) {
  const auto add = [&](const Vector3d& edge) { edges[static_cast<std::size_t>(count++)] = edge; };
  if (core.point_count > 1) add(core.points[1] - core.points[0]);
  if (core.point_count > 2) {
    add(core.points[2] - core.points[1]);
    add(core.points[0] - core.points[2]);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(core.axis_count); ++i) add(core.axes[i]);
  return count;
}

}  // namespace

Convex Convex::sphere(const Sphere& sphere) {
  Convex result;
  result.points[0] = sphere.center;
  result.radius = sphere.radius;
  return result;
}

Convex Convex::triangle(const std::array<Vector3d, 3>& corners) {
  Convex result;
  result.point_count = 3;
  result.points = corners;
  return result;
}

Convex Convex::placed(const FrameChange& change) const {
  Convex result = *this;
  const FrameChange turn{{change.r[0], change.r[1], change.r[2], change.r[3], change.r[4],
                          change.r[5], change.r[6], change.r[7], change.r[8]},
                         {0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < static_cast<std::size_t>(point_count); ++i) {
    result.points[i] = change(points[i]);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(axis_count); ++i) {
    result.axes[i] = turn(axes[i]);
  }
  if (disc_radius > 0.0 || is_half_space) result.disc_axis = turn(disc_axis);
  return result;
}

// One search for the distance of two cores.
class ConvexPair::Search {
 public:
  Search(const ConvexPair& pair, double enough, double near)
      : pair_(pair), radii_(pair.a_.radius + pair.b_.radius), enough_(enough), near_(near) {}

  // The corner of the difference that is farthest against `d`, whose length is about 1; and what
  // that proves.
  Corner look(const Vector3d& d) {
    const Extreme of_a = extreme(pair_.a_, -d);
    const Extreme of_b = extreme(pair_.b_, d);
    const double lower = -(of_a.along + of_b.along) / d.norm() - radii_ - pair_.error_;
    if (lower > gap_.lower) {
      gap_.lower = lower;
      gap_.axis = d;
    }
    return {of_a.point - of_b.point, of_a.point, of_b.point};
  }

  void run(const Vector3d& axis) {
    Vector3d d = axis;
    for (int step = 0; step < kMostSteps; ++step) {
      const double length = d.norm();
      if (!(length > 0.0)) return;
      const Corner corner = look(d / length);
      if (is_enough() || simplex_.holds(corner.p)) break;
      simplex_.corners[static_cast<std::size_t>(simplex_.count++)] = corner;
      simplex_.reduce();
      if (!take_points() || simplex_.count == 4 || is_enough()) break;
      d = simplex_.direction();
    }
    if (!is_enough() && simplex_.count < 4) try_edges();
  }

  const ConvexGap& gap() const { return gap_; }
  const Simplex& simplex() const { return simplex_; }

 private:
  static constexpr int kMostSteps = 100;

  bool is_enough() const {
    return gap_.lower > enough_ || gap_.upper <= near_ ||
           gap_.upper - gap_.lower <= 4.0 * pair_.error_ ||
           gap_.upper + radii_ <= 2.0 * pair_.error_;
  }

  // The nearest points of the simplex; false if they are no nearer than those before.
  bool take_points() {
    const Vector3d a = simplex_.sum(&Corner::a);
    const Vector3d b = simplex_.sum(&Corner::b);
    const double upper = (a - b).norm() - radii_ + pair_.error_;
    if (!(upper < gap_.upper)) return false;
    gap_.upper = upper;
    gap_.a = a;
    gap_.b = b;
    return true;
  }

  // Of polyhedra that are apart by so little that no direction between nearest points is exact, a
  // face or two edges decide.
  void try_edges() {
    std::array<Vector3d, 7> edges;
    const int of_a = edges_of(pair_.a_, edges, 0);
    const int all = edges_of(pair_.b_, edges, of_a);
    const auto look_along = [&](const Vector3d& n) {
      const double length = n.norm();
      if (!(length > 0.0)) return;
      look(n / length);
      look(n / -length);
    };
    if (pair_.a_.disc_radius > 0.0) look_along(pair_.a_.disc_axis);
    if (pair_.b_.disc_radius > 0.0) look_along(pair_.b_.disc_axis);
    for (int i = 0; i < all && !is_enough(); ++i) {
      for (int j = i + 1; j < all; ++j) {
        look_along(edges[static_cast<std::size_t>(i)].cross(edges[static_cast<std::size_t>(j)]));
      }
    }
  }

  const ConvexPair& pair_;
  const double radii_;
  const double enough_;
  const double near_;
  ConvexGap gap_;
  Simplex simplex_;
};

// A closed surface of triangles between corners of the difference of two cores, about the origin.
class ConvexPair::Polytope {
 public:
  Polytope(const ConvexPair& pair, const Simplex& simplex) : pair_(pair) {
    for (int i = 0; i < simplex.count; ++i) {
      corners_[corner_count_++] = simplex.corners[static_cast<std::size_t>(i)];
    }
    if (simplex.count == 4) {
      const bool turned =
          simplex.p(0).dot(simplex.p(1).cross(simplex.p(2))) >
          simplex.p(3).dot((simplex.p(1) - simplex.p(0)).cross(simplex.p(2) - simplex.p(0)));
      const std::size_t one = turned ? 1 : 2, two = turned ? 2 : 1;
      add(0, one, two);
      add(0, two, 3);
      add(two, one, 3);
      add(one, 0, 3);
    } else if (simplex.count == 3) {
      const Vector3d n =
          (simplex.p(1) - simplex.p(0)).cross(simplex.p(2) - simplex.p(0)).normalized();
      look(n);
      look(-n);
      span(3, 4, {0, 1, 2});
    } else if (simplex.count == 2) {
      const Vector3d e = (simplex.p(1) - simplex.p(0)).normalized();
      const Vector3d u = e.unitOrthogonal(), v = e.cross(u);
      look(u);
      look(-0.5 * u + 0.8660254 * v);
      look(-0.5 * u - 0.8660254 * v);
      span(1, 0, {2, 3, 4});
    }
  }

  // Expands the face that is nearest to the origin until it is one of the difference.
  void expand() {
    while (face_count_ > 0) {
      const auto end = faces_.begin() + static_cast<std::ptrdiff_t>(face_count_);
      const auto nearest = std::min_element(faces_.begin(), end, [](const Face& f, const Face& g) {
        return f.distance < g.distance;
      });
      const bool proves = std::all_of(faces_.begin(), end, [](const Face& f) { return f.is_seen; });
      if (proves && nearest->distance > depth_) {
        depth_ = nearest->distance;
        face_ = *nearest;
      }
      if (corner_count_ == corners_.size() || !nearest->normal.allFinite()) return;
      const Vector3d normal = nearest->normal;
      const double along = nearest->distance;
      const std::size_t corner = look(normal);
      const double tolerance = pair_.error_ + 1e-13 * std::abs(along);
      if (corners_[corner].p.dot(normal) - along <= tolerance || !replace(corner)) return;
    }
  }

  // What was proved: 0 if nothing.
  double depth() const { return depth_; }
  // The nearest point of the nearest face, with the points that make it; only of a depth.
  Corner nearest() const {
    Simplex simplex;
    simplex.count = 3;
    const Vector3d &p = corners_[face_.corner[0]].p, &q = corners_[face_.corner[1]].p,
                   &r = corners_[face_.corner[2]].p;
    simplex.weights = {std::max(0.0, face_.normal.dot(q.cross(r))),
                       std::max(0.0, face_.normal.dot(r.cross(p))),
                       std::max(0.0, face_.normal.dot(p.cross(q))), 0.0};
    for (std::size_t i = 0; i < 3; ++i) simplex.corners[i] = corners_[face_.corner[i]];
    return {simplex.sum(&Corner::p), simplex.sum(&Corner::a), simplex.sum(&Corner::b)};
  }
  const Vector3d& normal() const { return face_.normal; }

 private:
  struct Face {
    std::array<std::size_t, 3> corner;
    Vector3d normal;
    double distance;  // of its plane from the origin, on the side of the normal
    bool is_seen;     // from the inside, certainly
  };
  struct Edge {
    std::size_t from;
    std::size_t to;
  };

  std::size_t look(const Vector3d& d) {
    const Extreme of_a = extreme(pair_.a_, d);
    const Extreme of_b = extreme(pair_.b_, -d);
    corners_[corner_count_] = {of_a.point - of_b.point, of_a.point, of_b.point};
    return corner_count_++;
  }

  void add(std::size_t i, std::size_t j, std::size_t k) {
    const Vector3d &p = corners_[i].p, &q = corners_[j].p, &r = corners_[k].p;
    const Vector3d cross = (q - p).cross(r - p);
    const double least = std::min({cross.dot(p), cross.dot(q), cross.dot(r)});
    const double length = cross.norm();
    const double lengths =
        (q - p).norm() * (r - p).norm() * std::max({p.norm(), q.norm(), r.norm(), 0x1p-300});
    const bool is_flat = !(length > 0.0);
    faces_[face_count_++] = {{i, j, k},
                             is_flat ? Vector3d(Vector3d::Zero()) : Vector3d(cross / length),
                             is_flat ? 0.0 : least / length * kRelativeDown,
                             least > 64.0 * kUnitRoundoff * lengths};
  }

  // Between two tips and a ring of three corners, which turns to the right as seen from `up`.
  void span(std::size_t up, std::size_t down, const std::array<std::size_t, 3>& ring) {
    for (std::size_t i = 0; i < 3; ++i) {
      add(up, ring[i], ring[(i + 1) % 3]);
      add(down, ring[(i + 1) % 3], ring[i]);
    }
  }

  // Puts triangles to a corner in the place of those that it sees from outside; their edges stay
  // paired, so that the surface stays closed. False if there is no room.
  bool replace(std::size_t corner) {
    std::size_t open = 0;
    for (std::size_t f = 0; f < face_count_;) {
      const Face face = faces_[f];
      if (!(corners_[corner].p.dot(face.normal) > face.distance)) {
        ++f;
        continue;
      }
      faces_[f] = faces_[--face_count_];
      for (std::size_t i = 0; i < 3; ++i) {
        if (!toggle({face.corner[i], face.corner[(i + 1) % 3]}, open)) return false;
      }
    }
    if (open < 3 || face_count_ + open > faces_.size()) return false;
    for (std::size_t i = 0; i < open; ++i) add(edges_[i].from, edges_[i].to, corner);
    return true;
  }

  bool toggle(const Edge& edge, std::size_t& open) {
    for (std::size_t i = 0; i < open; ++i) {
      if (edges_[i].from != edge.to || edges_[i].to != edge.from) continue;
      edges_[i] = edges_[--open];
      return true;
    }
    if (open == edges_.size()) return false;
    edges_[open++] = edge;
    return true;
  }

  const ConvexPair& pair_;
  std::array<Corner, 64> corners_;
  std::size_t corner_count_ = 0;
  std::array<Face, 128> faces_;
  std::size_t face_count_ = 0;
  std::array<Edge, 128> edges_;
  double depth_ = 0.0;
  Face face_{};
};

// The plane of a half-space decides; of two of them that of the second, from the point of the first
// that its frame is given by.
ConvexGap ConvexPair::half_space_gap() const {
  const bool swapped = !b_.is_half_space;
  const Convex& half = swapped ? a_ : b_;
  const Convex& other = swapped ? b_ : a_;
  const Vector3d n = half.disc_axis.normalized();
  const Extreme reach = other.is_half_space ? Extreme{0.0, other.points[0]} : extreme(other, -n);
  const Vector3d& point = reach.point;
  const double gap = n.dot(point - half.points[0]);
  ConvexGap result;
  result.upper = gap - other.radius + 2.0 * error_;
  // By the support, not by the point, which of a disc may be its centre (in_plane()).
  result.lower = other.is_half_space
                     ? -std::numeric_limits<double>::infinity()
                     : -(reach.along + n.dot(half.points[0])) - other.radius - 2.0 * error_;
  result.a = point;
  result.b = point - gap * n;
  result.axis = n;
  if (swapped) {
    std::swap(result.a, result.b);
    result.axis = -n;
  }
  return result;
}

ConvexGap ConvexPair::gap(const Vector3d& axis, double enough, double near) const {
  if (a_.is_half_space || b_.is_half_space) return half_space_gap();
  Search search(*this, enough, near);
  search.run(axis);
  return search.gap();
}

ConvexContact ConvexPair::contact(const ConvexGap& gap, double growth_a, double growth_b) const {
  const bool is_plane = a_.is_half_space || b_.is_half_space;
  const double radius_a = a_.radius + growth_a, radius_b = b_.radius + growth_b;
  ConvexContact result;
  Vector3d on_a = gap.a, on_b = gap.b;
  // Of cores that are apart, from their nearest points. The error of the growths and sums is within
  // what the error leaves.
  result.depth = -gap.upper + growth_a + growth_b;
  const Vector3d apart = gap.b - gap.a;
  result.normal = is_plane || !(apart.norm() > 2.0 * error_) ? Vector3d(-gap.axis)
                                                             : Vector3d(apart.normalized());
  if (!is_plane && !(apart.norm() > 2.0 * error_)) {
    Search search(*this, std::numeric_limits<double>::infinity(),
                  -std::numeric_limits<double>::infinity());
    search.run(gap.axis);
    Polytope polytope(*this, search.simplex());
    polytope.expand();
    if (polytope.depth() > 0.0) {
      const Corner nearest = polytope.nearest();
      result.depth = std::max(result.depth, polytope.depth() - error_ + radius_a + radius_b);
      result.normal = polytope.normal();
      on_a = nearest.a;
      on_b = nearest.b;
    }
  }
  // Between the nearest points, as far as both reach.
  const double length = is_plane ? std::max(0.0, -gap.axis.dot(apart)) : apart.norm();
  const double from = std::max(0.0, length - radius_b), to = std::min(length, radius_a);
  result.common = gap.a + 0.5 * (from + to) * result.normal;
  result.on_a = on_a + radius_a * result.normal;
  result.on_b = on_b - radius_b * result.normal;
  return result;
}

namespace {

struct MakeConvex {
  Convex& result;

  void operator()(const Box& box) const {
    result.axis_count = 3;
    result.axes = {Vector3d(0.5 * box.size.x(), 0.0, 0.0), Vector3d(0.0, 0.5 * box.size.y(), 0.0),
                   Vector3d(0.0, 0.0, 0.5 * box.size.z())};
  }
  void operator()(const SolidSphere& sphere) const { result.radius = sphere.radius; }
  void operator()(const Cylinder& cylinder) const {
    along_z(cylinder.length);
    result.disc_radius = cylinder.radius;
  }
  void operator()(const Capsule& capsule) const {
    along_z(capsule.length);
    result.radius = capsule.radius;
  }
  void operator()(const HalfSpace&) const { result.is_half_space = true; }

 private:
  void along_z(double length) const {
    result.axis_count = 1;
    result.axes[0] = Vector3d(0.0, 0.0, 0.5 * length);
  }
};

}  // namespace

Convex convex_of(const Primitive& solid) {
  Convex result;
  std::visit(MakeConvex{result}, solid);
  return result;
}

Contact placed_contact(const SpherePair& leaves, const ConvexContact& contact,
                       const Pose& world_from) {
  Contact result;
  result.leaves = leaves;
  result.penetration_depth = contact.depth;
  result.normal = world_from.matrix() * contact.normal;
  result.nearest_points = {world_from * contact.on_a, world_from * contact.on_b};
  result.position = world_from * contact.common;
  return result;
}

}  // namespace spherule::internal
