// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/polygon.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3i;

// Twice the signed area of the triangle; positive if counter-clockwise.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Whether the segments touch in more than a shared end.
bool cross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  if (a == c || a == d || b == c || b == d) return false;
  const auto separated = [](double s, double t) { return (s > 0 && t > 0) || (s < 0 && t < 0); };
  return !separated(turn(a, b, c), turn(a, b, d)) && !separated(turn(c, d, a), turn(c, d, b));
}

// Corners are multiples of 2^-32 of the unit: the last bits of the library's sine, which differ by
// machine, must not decide which ear is cut.
Vector2d on_grid(const Vector2d& p) {
  return {std::nearbyint(p.x() * 0x1p32) * 0x1p-32, std::nearbyint(p.y() * 0x1p32) * 0x1p-32};
}

void append_arc(Loop& loop, const Vector2d& center, double radius, double from, double to,
                int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    loop.push_back(on_grid(center + radius * Vector2d(std::cos(angle), std::sin(angle))));
  }
}

// One closed chain of corner indices that runs along the outer loop and, over bridges walked both
// ways, around every hole (Eberly, "Triangulation by Ear Clipping"; the bridge is sought among all
// corners by distance, which is simpler and fast enough here).
class BridgedChain {
 public:
  BridgedChain(const Loop& outer, const std::vector<Loop>& holes) {
    points_ = outer;
    for (int i = 0; i < static_cast<int>(outer.size()); ++i) chain_.push_back(i);
    std::vector<std::vector<int>> open;
    for (const Loop& hole : holes) {
      std::vector<int> indices;
      for (const Vector2d& corner : hole) {
        indices.push_back(static_cast<int>(points_.size()));
        points_.push_back(corner);
      }
      std::reverse(indices.begin(), indices.end());  // holes are walked clockwise
      std::rotate(indices.begin(),
                  std::max_element(indices.begin(), indices.end(),
                                   [&](int a, int b) { return point(a).x() < point(b).x(); }),
                  indices.end());
      open.push_back(std::move(indices));
    }
    // Rightmost first: then its bridge cannot be blocked by a hole that has no bridge yet for ever.
    std::sort(open.begin(), open.end(),
              [&](const auto& a, const auto& b) { return point(a[0]).x() > point(b[0]).x(); });
    for (std::size_t h = 0; h < open.size(); ++h) bridge(open, h);
  }

  const Vector2d& point(int index) const { return points_[static_cast<std::size_t>(index)]; }
  std::vector<int>& chain() { return chain_; }

 private:
  bool blocked(const Vector2d& from, const Vector2d& to, const std::vector<int>& ring) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (cross(from, to, point(ring[i]), point(ring[(i + 1) % ring.size()]))) return true;
    }
    return false;
  }

  // Whether the direction to `target` points into the polygon at place `i` of the chain.
  bool inside_corner(std::size_t i, const Vector2d& target) const {
    const std::size_t n = chain_.size();
    const Vector2d& before = point(chain_[(i + n - 1) % n]);
    const Vector2d& here = point(chain_[i]);
    const Vector2d& after = point(chain_[(i + 1) % n]);
    const bool left_of_in = turn(before, here, target) > 0;
    const bool left_of_out = turn(here, after, target) > 0;
    return turn(before, here, after) > 0 ? left_of_in && left_of_out : left_of_in || left_of_out;
  }

  void bridge(const std::vector<std::vector<int>>& open, std::size_t h) {
    const std::vector<int>& hole = open[h];
    const Vector2d start = point(hole[0]);
    std::vector<std::size_t> places(chain_.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
    std::stable_sort(places.begin(), places.end(), [&](std::size_t a, std::size_t b) {
      return (point(chain_[a]) - start).squaredNorm() < (point(chain_[b]) - start).squaredNorm();
    });
    for (const std::size_t place : places) {
      const Vector2d end = point(chain_[place]);
      bool free = inside_corner(place, start) && !blocked(start, end, chain_);
      for (std::size_t other = h; free && other < open.size(); ++other) {
        free = !blocked(start, end, open[other]);
      }
      if (!free) continue;
      std::vector<int> detour(hole);
      detour.push_back(hole[0]);
      detour.push_back(chain_[place]);
      chain_.insert(chain_.begin() + static_cast<std::ptrdiff_t>(place) + 1, detour.begin(),
                    detour.end());
      return;
    }
    throw Error("polygon", "a hole is not strictly inside, or holes meet");
  }

  std::vector<Vector2d> points_;
  std::vector<int> chain_;
};

bool is_ear(const BridgedChain& polygon, const std::vector<int>& chain, std::size_t i) {
  const std::size_t n = chain.size();
  const Vector2d& a = polygon.point(chain[(i + n - 1) % n]);
  const Vector2d& b = polygon.point(chain[i]);
  const Vector2d& c = polygon.point(chain[(i + 1) % n]);
  if (turn(a, b, c) <= 0) return false;
  for (const int index : chain) {
    const Vector2d& p = polygon.point(index);
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

Loop circle(const Vector2d& center, double radius, int sides, double phase) {
  Loop loop;
  append_arc(loop, center, radius, phase, phase + 2.0 * std::numbers::pi, sides);
  loop.pop_back();
  return loop;
}

Loop rectangle(const Vector2d& center, const Vector2d& size, double radius, int steps) {
  const Vector2d half = 0.5 * size;
  constexpr double kSigns[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  Loop loop;
  for (int corner = 0; corner < 4; ++corner) {
    const Vector2d sign(kSigns[corner][0], kSigns[corner][1]);
    if (radius <= 0.0) {
      loop.push_back(center + sign.cwiseProduct(half));
      continue;
    }
    const Vector2d middle = center + sign.cwiseProduct(half - Vector2d(radius, radius));
    const double start = 0.5 * std::numbers::pi * corner;
    append_arc(loop, middle, radius, start, start + 0.5 * std::numbers::pi, steps);
  }
  return loop;
}

Loop belt(const Vector2d& a, double radius_a, const Vector2d& b, double radius_b, int steps) {
  const Vector2d along = b - a;
  const double direction = std::atan2(along.y(), along.x());
  // The outer tangents touch both circles at this angle from the line of centres.
  const double touch = std::acos((radius_a - radius_b) / along.norm());
  Loop loop;
  append_arc(loop, b, radius_b, direction - touch, direction + touch, steps);
  append_arc(loop, a, radius_a, direction + touch, direction + 2.0 * std::numbers::pi - touch,
             steps);
  return loop;
}

std::vector<Loop> screw_holes(const Vector2d& center, double ring_radius, int count,
                              double hole_radius, int sides, double phase) {
  std::vector<Loop> holes;
  if (count == 0) return holes;
  for (const Vector2d& place : circle(center, ring_radius, count, phase)) {
    holes.push_back(circle(place, hole_radius, sides));
  }
  return holes;
}

std::vector<Vector3i> triangulate(const Loop& outer, const std::vector<Loop>& holes) {
  BridgedChain polygon(outer, holes);
  std::vector<int>& chain = polygon.chain();
  std::vector<Vector3i> triangles;
  std::size_t i = 0;
  std::size_t tried = 0;
  while (chain.size() > 2) {
    if (tried > chain.size()) throw Error("polygon", "not simple, or not counter-clockwise");
    i %= chain.size();
    if (!is_ear(polygon, chain, i)) {
      ++i;
      ++tried;
      continue;
    }
    const std::size_t n = chain.size();
    triangles.emplace_back(chain[(i + n - 1) % n], chain[i], chain[(i + 1) % n]);
    chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(i));
    ++i;  // leave the neighbour for later: avoids fans of slivers
    tried = 0;
  }
  return triangles;
}

}  // namespace spherule
