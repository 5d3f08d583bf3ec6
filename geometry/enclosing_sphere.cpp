// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/sphere.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

// The smallest enclosing ball of spheres is an LP-type problem (Fischer and Gaertner, "The smallest
// enclosing ball of balls", 2003): it is determined by a basis of at most four spheres whose
// centres are affinely independent, and it touches each of them from inside. We keep such a basis
// and exchange it for one of a larger sphere while some sphere sticks out, taking the farthest each
// time. Departure from the paper: which of the at most 15 subsets is the new basis is not decided
// by signs of coordinates, which rounding can turn over, but by the value that we want to minimise,
// max |c - c_i| + r_i over the at most five spheres at hand. A degenerate subset (nested,
// coincident, collinear, coplanar spheres) yields no centre or a poor one and simply loses.
namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr int kMaxBasis = 4;

// Each exchange makes the sphere of the basis strictly larger, so the loop ends by itself; a dozen
// exchanges are usual. The cap only bounds the time if rounding made it creep; the result encloses
// all spheres in any case (G3).
constexpr int kMaxExchanges = 1000;

// The basis has settled when no sphere sticks out by more than this factor: rounding of `reach`.
constexpr double kSettled = 1.0 + 8.0 * kUnitRoundoff;

// Lengths below two to the power of this are as good as none beside kUnderflow. The powers of two
// that the others are scaled by, and their inverses, are ordinary numbers.
constexpr int kMinExponent = -1000;

struct Basis {
  std::array<Sphere, kMaxBasis> spheres;
  std::size_t size = 0;
};

struct Solution {
  Basis basis;
  Vector3d center = Vector3d::Zero();
  double radius = 0.0;
};

auto largest_sphere(auto& spheres) {
  return std::max_element(spheres.begin(), spheres.end(),
                          [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
}

// Radius of the smallest sphere about `center` that encloses all `spheres`, and the sphere that
// sets it.
struct Reach {
  double radius = -1.0;
  std::size_t farthest = 0;
};

Reach reach(const Vector3d& center, std::span<const Sphere> spheres) {
  Reach result;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double radius = (spheres[i].center - center).norm() + spheres[i].radius;
    if (radius > result.radius) result = {radius, i};
  }
  return result;
}

// Solves rows[i] . x = right[i] for the x of least norm, by orthonormalising the rows (at most
// three). Constructed once and used for several right-hand sides.
template <std::size_t kRows>
class MinimumNormSolver {
 public:
  explicit MinimumNormSolver(const std::array<Vector3d, kRows>& rows) {
    for (std::size_t i = 0; i < kRows; ++i) {
      Vector3d rest = rows[i];
      for (int pass = 0; pass < 2; ++pass) {  // the second pass removes the rounding of the first
        for (std::size_t j = 0; j < i; ++j) {
          const double along = rest.dot(axes_[j]);
          lower_[i][j] += along;
          rest -= along * axes_[j];
        }
      }
      lower_[i][i] = rest.norm();
      if (!(lower_[i][i] > kDegenerate * rows[i].norm())) {
        regular_ = false;
        return;
      }
      axes_[i] = rest / lower_[i][i];
    }
  }

  bool regular() const { return regular_; }

  Vector3d solve(const std::array<double, kRows>& right) const {
    Vector3d x = Vector3d::Zero();
    std::array<double, kRows> y;
    for (std::size_t i = 0; i < kRows; ++i) {
      double rest = right[i];
      for (std::size_t j = 0; j < i; ++j) rest -= lower_[i][j] * y[j];
      y[i] = rest / lower_[i][i];
      x += y[i] * axes_[i];
    }
    return x;
  }

 private:
  // Rows closer to dependent than this give no digit of x; such a subset is never needed, because
  // the centre lies in the convex hull of affinely independent centres (Caratheodory).
  static constexpr double kDegenerate = 1e-14;

  bool regular_ = true;
  std::array<Vector3d, kRows> axes_;
  std::array<std::array<double, kRows>, kRows> lower_{};
};

// One Newton step for |center - c_i| + r_i = R over all spheres, within the affine hull of their
// centres. It restores digits that the squared equations lose for nearly nested spheres.
template <std::size_t kSize>
Vector3d refined(const Vector3d& center, const std::array<Sphere, kSize>& spheres) {
  std::array<Vector3d, kSize> directions;
  std::array<double, kSize> reaches;
  for (std::size_t i = 0; i < kSize; ++i) {
    const Vector3d offset = center - spheres[i].center;
    const double length = offset.norm();
    if (!(length > 0.0)) return center;
    directions[i] = offset / length;
    reaches[i] = length + spheres[i].radius;
  }
  std::array<Vector3d, kSize - 1> rows;
  std::array<double, kSize - 1> right;
  for (std::size_t i = 1; i < kSize; ++i) {
    rows[i - 1] = directions[i] - directions[0];
    right[i - 1] = reaches[0] - reaches[i];
  }
  const MinimumNormSolver<kSize - 1> solver(rows);
  return solver.regular() ? Vector3d(center + solver.solve(right)) : center;
}

// Calls `visit(center)` for each sphere whose centre lies in the affine hull of the centres of
// `spheres` and that is touched by all of them from inside (at most two; none if degenerate), and
// for its refinement.
//
// With x = c - c_0, q_i = c_i - c_0, s_i = r_0 - r_i and rho = R - r_0 the conditions are
// |x| = rho and q_i . x = (|q_i|^2 - s_i^2) / 2 - rho s_i; so x = a + rho b, and rho is a root of
// (|b|^2 - 1) rho^2 + 2 a.b rho + |a|^2. All lengths are first scaled by a power of two.
template <std::size_t kSize, typename Visit>
void tangent_centers(std::array<Sphere, kSize> spheres, const Visit& visit) {
  // Measured from the largest sphere: rho is least there, so that it keeps its digits when the
  // other spheres stick out of this one by a hair only.
  std::iter_swap(spheres.begin(), largest_sphere(spheres));
  const Sphere& origin = spheres[0];
  std::array<Vector3d, kSize - 1> q;
  std::array<double, kSize - 1> s;
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < kSize; ++i) {
    q[i] = spheres[i + 1].center - origin.center;
    s[i] = origin.radius - spheres[i + 1].radius;
    largest = std::max({largest, q[i].cwiseAbs().maxCoeff(), std::abs(s[i])});
  }
  if (!(largest > 0.0)) return;
  int exponent = 0;
  std::frexp(largest, &exponent);
  exponent = std::max(exponent, kMinExponent);
  const double unit = std::ldexp(1.0, exponent);
  const double per_unit = std::ldexp(1.0, -exponent);
  std::array<double, kSize - 1> constant;
  std::array<double, kSize - 1> linear;
  for (std::size_t i = 0; i + 1 < kSize; ++i) {
    q[i] *= per_unit;
    s[i] *= per_unit;
    const double length = q[i].norm();
    constant[i] = 0.5 * (length - s[i]) * (length + s[i]);
    linear[i] = -s[i];
  }
  const MinimumNormSolver<kSize - 1> solver(q);
  if (!solver.regular()) return;
  const Vector3d a = solver.solve(constant);
  const Vector3d b = solver.solve(linear);
  const double b_norm = b.norm();
  const double leading = (b_norm - 1.0) * (b_norm + 1.0);
  const double half = a.dot(b);
  const double root = std::sqrt(std::max(0.0, half * half - leading * a.squaredNorm()));
  const double t = -(half + std::copysign(root, half));
  for (const double rho : {t / leading, a.squaredNorm() / t}) {
    if (!(rho >= 0.0) || !(rho <= kMaxCoordinate)) continue;
    const Vector3d center = origin.center + (a + rho * b) * unit;
    visit(center);
    visit(refined(center, spheres));
  }
}

// The search for the smallest enclosing ball of the spheres of `basis` and of `added`, which sticks
// out of the sphere of `basis` and is therefore part of every new basis.
class Exchange {
 public:
  Exchange(const Basis& basis, const Sphere& added) : basis_(basis), added_(added) {
    consider(added.center);  // the subset 0
    for (subset_ = 1; subset_ < (1U << basis.size); ++subset_) {
      switch (std::popcount(subset_)) {
        case 1:
          consider_subset<2>();
          break;
        case 2:
          consider_subset<3>();
          break;
        case 3:
          consider_subset<4>();
          break;
        default:
          break;  // five spheres are no basis
      }
    }
  }

  Solution result() const {
    Solution solution;
    solution.center = best_center_;
    solution.radius = best_radius_;
    solution.basis.spheres[solution.basis.size++] = added_;
    for (std::size_t i = 0; i < basis_.size; ++i) {
      if ((best_subset_ >> i & 1U) != 0U) {
        solution.basis.spheres[solution.basis.size++] = basis_.spheres[i];
      }
    }
    return solution;
  }

 private:
  template <std::size_t kSize>
  void consider_subset() {
    std::array<Sphere, kSize> spheres;
    spheres[0] = added_;
    std::size_t size = 1;
    for (std::size_t i = 0; i < basis_.size; ++i) {
      if ((subset_ >> i & 1U) != 0U) spheres[size++] = basis_.spheres[i];
    }
    tangent_centers(spheres, [this](const Vector3d& center) { consider(center); });
  }

  // Most centres lose to the best so far before all spheres have been examined.
  void consider(const Vector3d& center) {
    double radius = (added_.center - center).norm() + added_.radius;
    for (std::size_t i = 0; i < basis_.size && radius < best_radius_; ++i) {
      const Sphere& sphere = basis_.spheres[i];
      radius = std::max(radius, (sphere.center - center).norm() + sphere.radius);
    }
    if (radius < best_radius_) {
      best_subset_ = subset_;
      best_center_ = center;
      best_radius_ = radius;
    }
  }

  const Basis& basis_;
  const Sphere& added_;
  unsigned subset_ = 0;  // of the basis, as bits: the one whose centres are being considered
  unsigned best_subset_ = 0;
  Vector3d best_center_ = Vector3d::Zero();
  double best_radius_ = std::numeric_limits<double>::infinity();
};

Vector3d smallest_center(std::span<const Sphere> spheres) {
  const auto largest = largest_sphere(spheres);
  Solution current;
  current.basis.spheres[0] = *largest;
  current.basis.size = 1;
  current.center = largest->center;
  current.radius = largest->radius;
  Vector3d best = current.center;
  double best_radius = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxExchanges; ++i) {
    const Reach out = reach(current.center, spheres);
    if (out.radius < best_radius) {
      best = current.center;
      best_radius = out.radius;
    }
    if (out.radius <= current.radius * kSettled) break;
    const Solution next = Exchange(current.basis, spheres[out.farthest]).result();
    if (!(next.radius > current.radius)) break;
    current = next;
  }
  return best;
}

// The smallest radius for which certainly_encloses() holds for all spheres: the same expression.
double enclosing_radius(const Vector3d& center, std::span<const Sphere> spheres) {
  double radius = 0.0;
  for (const Sphere& sphere : spheres) {
    radius = std::max(radius, add_up(distance_upper(center, sphere.center), sphere.radius));
  }
  return radius;
}

}  // namespace

Sphere enclosing_sphere(std::span<const Sphere> spheres) {
  assert(!spheres.empty());
  const Vector3d center = smallest_center(spheres);
  return {center, enclosing_radius(center, spheres)};
}

Sphere enclosing_sphere(std::span<const Vector3d> points) {
  std::vector<Sphere> spheres;
  spheres.reserve(points.size());
  for (const Vector3d& point : points) spheres.push_back({point, 0.0});
  return enclosing_sphere(spheres);
}

}  // namespace spherule
