// SPDX-License-Identifier: BSD-3-Clause
#include "io/cad/surface_deviation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

BezierNet transposed(const BezierNet& net) {
  BezierNet result{net.columns, net.rows, {}};
  result.points.reserve(net.points.size());
  for (int j = 0; j < net.columns; ++j) {
    for (int i = 0; i < net.rows; ++i) result.points.push_back(net.at(i, j));
  }
  return result;
}

// The net of the derivative along u over a span of this length.
BezierNet derivative_u(const BezierNet& net, double length) {
  if (net.rows == 1) {
    return {1, net.columns,
            std::vector<Vector4d>(static_cast<std::size_t>(net.columns), Vector4d::Zero())};
  }
  BezierNet result{net.rows - 1, net.columns, {}};
  const double factor = (net.rows - 1) / length;
  for (int i = 0; i + 1 < net.rows; ++i) {
    for (int j = 0; j < net.columns; ++j) {
      result.points.push_back(factor * (net.at(i + 1, j) - net.at(i, j)));
    }
  }
  return result;
}

BezierNet derivative_v(const BezierNet& net, double length) {
  return transposed(derivative_u(transposed(net), length));
}

// The halves along u, by de Casteljau's algorithm.
std::pair<BezierNet, BezierNet> halves_u(const BezierNet& net) {
  BezierNet lower = net;
  BezierNet upper = net;
  const auto at = [](BezierNet& n, int i, int j) -> Vector4d& {
    return n.points[static_cast<std::size_t>(i * n.columns + j)];
  };
  for (int j = 0; j < net.columns; ++j) {
    for (int level = 1; level < net.rows; ++level) {
      for (int i = 0; i + level < net.rows; ++i) {
        at(upper, i, j) = 0.5 * (at(upper, i, j) + at(upper, i + 1, j));
      }
      at(lower, level, j) = at(upper, 0, j);
    }
  }
  return {lower, upper};
}

// Halves all spans along u.
void refine_u(std::vector<double>& knots, std::vector<BezierNet>& patches) {
  const std::size_t columns = patches.size() / (knots.size() - 1);
  std::vector<double> more_knots;
  std::vector<BezierNet> more;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    more_knots.push_back(knots[i]);
    more_knots.push_back(0.5 * (knots[i] + knots[i + 1]));
    std::vector<BezierNet> upper;
    for (std::size_t j = 0; j < columns; ++j) {
      auto [first, second] = halves_u(patches[i * columns + j]);
      more.push_back(std::move(first));
      upper.push_back(std::move(second));
    }
    std::move(upper.begin(), upper.end(), std::back_inserter(more));
  }
  more_knots.push_back(knots.back());
  knots = std::move(more_knots);
  patches = std::move(more);
}

// The same surface with u and v exchanged.
std::vector<BezierNet> transposed(const std::vector<BezierNet>& patches, std::size_t rows) {
  const std::size_t columns = patches.size() / rows;
  std::vector<BezierNet> result;
  for (std::size_t j = 0; j < columns; ++j) {
    for (std::size_t i = 0; i < rows; ++i) result.push_back(transposed(patches[i * columns + j]));
  }
  return result;
}

bool is_rational(const std::vector<BezierNet>& patches) {
  return std::any_of(patches.begin(), patches.end(), [](const BezierNet& net) {
    return std::any_of(net.points.begin(), net.points.end(),
                       [&](const Vector4d& p) { return p[3] != net.points[0][3]; });
  });
}

// Largest norm of the first three numbers, and of the last.
struct Largest {
  double vector = 0.0;
  double weight = 0.0;
};

Largest largest(const BezierNet& net) {
  Largest result;
  for (const Vector4d& p : net.points) {
    result.vector = std::max(result.vector, p.head<3>().norm());
    result.weight = std::max(result.weight, std::abs(p[3]));
  }
  return result;
}

double least_weight(const BezierNet& net) {
  const auto lighter = [](const Vector4d& a, const Vector4d& b) { return a[3] < b[3]; };
  return (*std::min_element(net.points.begin(), net.points.end(), lighter))[3];
}

// With S = A / w: S_u = (A_u - w_u S) / w, and the same rule once more for second derivatives.
// About the middle of the patch S is small, which keeps the quotients tight.
SurfaceBounds bound_patch(BezierNet net, double u_length, double v_length, const Vector3d& center,
                          double radius) {
  for (Vector4d& p : net.points) p.head<3>() -= p[3] * center;
  const double w = least_weight(net);
  const BezierNet net_u = derivative_u(net, u_length);
  const BezierNet net_v = derivative_v(net, v_length);
  const Largest u = largest(net_u);
  const Largest v = largest(net_v);
  const Largest uu = largest(derivative_u(net_u, u_length));
  const Largest uv = largest(derivative_v(net_u, v_length));
  const Largest vv = largest(derivative_v(net_v, v_length));
  SurfaceBounds bounds;
  bounds.u = (u.vector + u.weight * radius) / w;
  bounds.v = (v.vector + v.weight * radius) / w;
  bounds.uu = (uu.vector + 2.0 * u.weight * bounds.u + uu.weight * radius) / w;
  bounds.vv = (vv.vector + 2.0 * v.weight * bounds.v + vv.weight * radius) / w;
  bounds.uv = (uv.vector + u.weight * bounds.v + v.weight * bounds.u + uv.weight * radius) / w;
  return bounds;
}

std::vector<double> binomials(int n) {
  std::vector<double> row{1.0};
  for (int k = 1; k <= n; ++k) row.push_back(row.back() * (n - k + 1) / k);
  return row;
}

// How much S_u jumps from the last row of `before` to the first of `after`, which are the same
// curve A / w. The jump is (dA_u w - dw_u A) / w^2, whose numerator is a Bezier curve of twice
// the degree. The two may have weights of different scale.
double jump_u(BezierNet before, double before_length, const BezierNet& after, double after_length) {
  const double scale = after.at(0, 0)[3] / before.at(before.rows - 1, 0)[3];
  for (Vector4d& p : before.points) p *= scale;
  const BezierNet from = derivative_u(before, before_length);
  const BezierNet to = derivative_u(after, after_length);
  const int degree = after.columns - 1;
  const std::vector<double> single = binomials(degree);
  const std::vector<double> twofold = binomials(2 * degree);
  std::vector<Vector3d> numerator(twofold.size(), Vector3d::Zero());
  double w = after.at(0, 0)[3];
  for (int a = 0; a <= degree; ++a) {
    w = std::min(w, after.at(0, a)[3]);
    const Vector4d step = to.at(0, a) - from.at(from.rows - 1, a);
    for (int b = 0; b <= degree; ++b) {
      const Vector4d& side = after.at(0, b);
      const auto k = static_cast<std::size_t>(a + b);
      numerator[k] += single[static_cast<std::size_t>(a)] * single[static_cast<std::size_t>(b)] /
                      twofold[k] * (step.head<3>() * side[3] - step[3] * side.head<3>());
    }
  }
  double jump = 0.0;
  for (const Vector3d& p : numerator) jump = std::max(jump, p.norm());
  return jump / (w * w);
}

// The index before `i` on a ring of `count`.
std::size_t before(std::size_t i, std::size_t count) {
  return i == 0 ? count - 1 : i - 1;
}

}  // namespace

BezierGrid::BezierGrid(std::vector<double> u_knots, std::vector<double> v_knots,
                       std::vector<BezierNet> patches, bool u_periodic, bool v_periodic)
    : u_knots_(std::move(u_knots)),
      v_knots_(std::move(v_knots)),
      u_periodic_(u_periodic),
      v_periodic_(v_periodic) {
  // Control points are far from the curve where the degree is high, and halving brings them near.
  const bool is_curve = patches.front().columns == 1;
  const bool is_plain =
      !is_rational(patches) && patches.front().rows <= 4 && patches.front().columns <= 4;
  const int refinements = is_plain ? 0 : is_curve ? 4 : patches.size() < 64 ? 3 : 2;
  for (int k = 0; k < refinements; ++k) {
    refine_u(u_knots_, patches);
    if (is_curve) continue;
    patches = transposed(patches, u_knots_.size() - 1);
    refine_u(v_knots_, patches);
    patches = transposed(patches, v_knots_.size() - 1);
  }
  const std::size_t rows = u_knots_.size() - 1;
  const std::size_t columns = v_knots_.size() - 1;
  const auto u_length = [&](std::size_t i) { return u_knots_[i + 1] - u_knots_[i]; };
  const auto v_length = [&](std::size_t j) { return v_knots_[j + 1] - v_knots_[j]; };
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const BezierNet& net = patches[patch(i, j)];
      Eigen::AlignedBox3d box;
      for (const Vector4d& p : net.points) box.extend(Vector3d(p.head<3>() / p[3]));
      double radius = 0.0;
      for (const Vector4d& p : net.points) {
        radius = std::max(radius, (p.head<3>() / p[3] - box.center()).norm());
      }
      spheres_.push_back({box.center(), radius});
      bounds_.push_back(bound_patch(net, u_length(i), v_length(j), box.center(), radius));
      // About the middle of the whole patch again: about the origin far away, the jump would
      // drown in rounding.
      const auto centered = [&](BezierNet moved) {
        for (Vector4d& p : moved.points) p.head<3>() -= p[3] * box.center();
        return moved;
      };
      const BezierNet here = centered(net);
      const std::size_t last_i = before(i, rows);
      const std::size_t last_j = before(j, columns);
      u_jumps_.push_back(i == 0 && !u_periodic ? 0.0
                                               : jump_u(centered(patches[patch(last_i, j)]),
                                                        u_length(last_i), here, u_length(i)));
      v_jumps_.push_back(j == 0 && !v_periodic
                             ? 0.0
                             : jump_u(transposed(centered(patches[patch(i, last_j)])),
                                      v_length(last_j), transposed(here), v_length(j)));
    }
  }
}

BezierGrid::Reach BezierGrid::reach(Interval interval, const std::vector<double>& knots,
                                    bool periodic) {
  Reach result;
  const std::size_t spans = knots.size() - 1;
  const double period = knots.back() - knots.front();
  double shift = periodic ? std::floor((interval.low - knots.front()) / period) * period : 0.0;
  const auto note = [](std::vector<std::size_t>& list, std::size_t index) {
    if (std::find(list.begin(), list.end(), index) == list.end()) list.push_back(index);
  };
  do {
    for (std::size_t i = 0; i < spans; ++i) {
      const double low = knots[i] + shift;
      const double high = knots[i + 1] + shift;
      const bool met = interval.length() > 0.0 ? low < interval.high && high > interval.low
                                               : low <= interval.low && high >= interval.low;
      if (met) note(result.spans, i);
      const bool inside = low > interval.low && low < interval.high;
      if (inside && (i > 0 || periodic)) result.knots.push_back(i);
    }
    shift += period;
  } while (periodic && knots.front() + shift <= interval.high);
  if (result.spans.empty()) result.spans.push_back(interval.low > knots.front() ? spans - 1 : 0);
  return result;
}

SurfaceBounds BezierGrid::bounds(Interval u, Interval v) const {
  const Reach along_u = reach(u, u_knots_, u_periodic_);
  const Reach along_v = reach(v, v_knots_, v_periodic_);
  SurfaceBounds result;
  for (const std::size_t i : along_u.spans) {
    for (const std::size_t j : along_v.spans) {
      const SurfaceBounds& b = bounds_[patch(i, j)];
      result.u = std::max(result.u, b.u);
      result.v = std::max(result.v, b.v);
      result.uu = std::max(result.uu, b.uu);
      result.uv = std::max(result.uv, b.uv);
      result.vv = std::max(result.vv, b.vv);
    }
  }
  for (const std::size_t i : along_u.knots) {
    double jump = 0.0;
    for (const std::size_t j : along_v.spans) jump = std::max(jump, u_jumps_[patch(i, j)]);
    result.jump_u += jump;
  }
  for (const std::size_t j : along_v.knots) {
    double jump = 0.0;
    for (const std::size_t i : along_u.spans) jump = std::max(jump, v_jumps_[patch(i, j)]);
    result.jump_v += jump;
  }
  return result;
}

CurveBounds BezierGrid::curve_bounds(Interval t) const {
  const SurfaceBounds b = bounds(t, {0.0, 1.0});
  Eigen::AlignedBox3d box;
  for (const std::size_t i : reach(t, u_knots_, u_periodic_).spans) {
    box.extend(Vector3d(spheres_[i].center.array() - spheres_[i].radius));
    box.extend(Vector3d(spheres_[i].center.array() + spheres_[i].radius));
  }
  return {.center = box.center(),
          .radius = 0.5 * box.diagonal().norm(),
          .first = b.u,
          .second = b.uu,
          .jump = b.jump_u};
}

}  // namespace spherule::internal
