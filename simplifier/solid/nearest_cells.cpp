// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/nearest_cells.h"

#include "base/rounding.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Looking through a sphere of a list costs a tenth of what it costs to decide whether a half needs
// it, and most cells get few queries, so that long lists pay.
constexpr std::size_t kShort = 128;     // lists that are not made shorter
constexpr std::size_t kMedium = 768;    // longer ones are, as soon as a query comes
constexpr std::size_t kLongest = 4096;  // what a list holds at most
constexpr int kFirstPatience = 24;      // searches in a cell before its halves get the first lists
constexpr int kPatience = 64;           // uses of a medium list before its cell is halved
constexpr int kPerCell = 64;            // spheres for each of the first cells that have a list
constexpr int kDeepest = 36;            // halvings

// Bytes.
constexpr std::size_t kPerSphere = 256;
constexpr std::size_t kLeastMemory = std::size_t{1} << 26;
constexpr std::size_t kMostMemory = std::size_t{1} << 32;

// A sphere as seen from the middle of a cell.
struct Seen {
  std::int32_t index;
  double radius;
  Vector3d from_center;
  double distance;
  double gap;
  Vector3d direction;  // a subgradient of the distance
  double excess;       // at most so much more than by the subgradient does it grow within the cell

  Seen(const BoxCell& cell, double reach, std::int32_t i, const Sphere& sphere)
      : index(i),
        radius(sphere.radius),
        from_center(cell.center - sphere.center),
        distance(from_center.norm()),
        gap(distance - radius),
        direction(distance > kLeastNorm ? Vector3d(from_center / distance) : Vector3d::Zero()),
        excess(std::min(2.0 * reach, 0.5 * reach * reach / distance)) {}
};

// At c + x, let s be the sum of the distances to the centres of two spheres, k the first radius
// less the second, and f the first gap less the second. The difference of the squared distances is
// linear in x, and f s = that difference - k s. The distances are convex and so at least what their
// subgradients at c say; and at most that and the excess, as sqrt(1 + t) <= 1 + t / 2. Hence f s is
// at least its value at c, plus slope x, less, if k > 0, k times the sum of the excesses.
Vector3d slope_between(const Seen& one, const Seen& other) {
  return 2.0 * (one.from_center - other.from_center) -
         (one.radius - other.radius) * (one.direction + other.direction);
}

// Whether the other gap is less by more than rounding in all of the cell. With L no less than the
// sum of |c|, the half diagonal, the largest radius and the largest norm of a centre, gaps err by 8
// u L, those that LeastGap computes at c + x, too, s is at most 2 L, and components of the slope
// err by 32 u L: 1024 u L^2 covers what these come to, and is the `slack`.
bool is_beaten(const Seen& one, const Seen& other, const Vector3d& slope, const BoxCell& cell,
               double slack) {
  const double at_middle = (one.distance + other.distance) * (one.gap - other.gap);
  const double excess = std::max(0.0, one.radius - other.radius) * (one.excess + other.excess);
  return at_middle - excess - slope.cwiseAbs().dot(cell.half) > slack;
}

// The number of the corner in the direction in which the components are negative.
std::size_t corner_against(const Vector3d& v) {
  return (v.x() < 0.0 ? 1U : 0U) + (v.y() < 0.0 ? 2U : 0U) + (v.z() < 0.0 ? 4U : 0U);
}

// Of the spheres, those that are nearest at the corners, by the subgradients at the middle: nearly.
std::array<std::size_t, 8> nearest_at_corners(const BoxCell& cell,
                                              const std::vector<Seen>& spheres) {
  std::array<std::size_t, 8> nearest{};
  std::array<double, 8> least;
  least.fill(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector3d rise = spheres[i].direction.cwiseProduct(cell.half);
    for (std::size_t k = 0; k < nearest.size(); ++k) {
      const double gap = spheres[i].gap + ((k & 1U) != 0 ? rise.x() : -rise.x()) +
                         ((k & 2U) != 0 ? rise.y() : -rise.y()) +
                         ((k & 4U) != 0 ? rise.z() : -rise.z());
      if (gap < least[k]) nearest[k] = i;
      least[k] = std::min(least[k], gap);
    }
  }
  return nearest;
}

}  // namespace

struct NearestCells::Cell {
  BoxCell box;
  int depth = 0;
  bool listed = false;  // else more spheres than a list holds may be nearest
  std::vector<std::int32_t> list;
  mutable std::array<std::atomic<const Cell*>, 2> halves{};
  mutable std::atomic<int> queries{0};

  ~Cell() {
    for (const std::atomic<const Cell*>& half : halves) delete half.load();
  }

  // Whether a query should go on to a half that has not been made. Counts it where that depends on
  // how many there were, in either half. A search in the hierarchy costs about a twentieth of what
  // making a first list costs. To shorten lists, only half of the memory is used: lists that are
  // missing cost each query more.
  bool counts_and_is_to_be_halved(int first_listed, bool is_room_left) const {
    const auto is_beyond = [&](int patience) {
      return queries.fetch_add(1, std::memory_order_relaxed) >= patience;
    };
    if (depth == kDeepest) return false;
    if (!listed) return depth + 1 < first_listed || is_beyond(kFirstPatience);
    if (!is_room_left) return false;
    if (list.size() > kMedium) return true;
    return list.size() > kShort && is_beyond(kPatience);
  }
  std::size_t bytes() const { return sizeof(Cell) + list.size() * sizeof(list[0]); }
};

NearestCells::NearestCells(std::vector<Sphere> spheres, const Eigen::AlignedBox3d& box)
    : NearestCells(std::move(spheres), box, 0) {
  memory_ = std::clamp(kPerSphere * spheres_.size(), kLeastMemory, kMostMemory);
}

NearestCells::NearestCells(std::vector<Sphere> spheres, const Eigen::AlignedBox3d& box,
                           std::size_t memory)
    : spheres_(std::move(spheres)),
      hierarchy_(spheres_),
      box_(box),
      memory_(memory),
      root_(std::make_unique<Cell>()) {
  while (first_listed_ < kDeepest && (spheres_.size() >> first_listed_) > kPerCell) ++first_listed_;
  root_->box = BoxCell::around(box);
  fill(*root_, nullptr);
}

NearestCells::~NearestCells() = default;

NearestSphere NearestCells::nearest(const Vector3d& point, double limit) const {
  if (!box_.contains(point)) return hierarchy_.nearest(point, limit);
  const Cell* cell = root_.get();
  for (;;) {
    const int axis = cell->box.longest();
    const std::size_t side = point[axis] < cell->box.center[axis] ? 0 : 1;
    const Cell* half = cell->halves[side].load(std::memory_order_acquire);
    if (half == nullptr &&
        cell->counts_and_is_to_be_halved(first_listed_, memory_used() < memory_ / 2)) {
      half = make_half(*cell, side);
    }
    if (half == nullptr) break;
    cell = half;
  }
  if (!cell->listed) return hierarchy_.nearest(point, limit);
  LeastGap least(limit);
  for (const std::int32_t i : cell->list) {
    least.examine(point, spheres_[static_cast<std::size_t>(i)], i);
  }
  return least.bounds(0.0, hierarchy_.length_at(point));
}

const NearestCells::Cell* NearestCells::make_half(const Cell& cell, std::size_t side) const {
  const bool has_list = cell.depth + 1 >= first_listed_;
  const std::size_t most = sizeof(Cell) + (has_list ? kLongest * sizeof(std::int32_t) : 0);
  if (memory_used() + most > memory_) return nullptr;
  auto made = std::make_unique<Cell>();
  made->box = cell.box.halves()[side];
  made->depth = cell.depth + 1;
  fill(*made, &cell);
  const std::size_t bytes = made->bytes();
  // Others may have used it up since.
  if (used_.fetch_add(bytes) + bytes > memory_) {
    used_ -= bytes;
    return nullptr;
  }
  const Cell* other = nullptr;
  if (cell.halves[side].compare_exchange_strong(other, made.get(), std::memory_order_acq_rel)) {
    return made.release();
  }
  used_ -= bytes;
  return other;
}

// Spheres are left out that are beaten by the nearest at the middle, or by the one that is nearest
// at the corner where they do best against that.
void NearestCells::fill(Cell& cell, const Cell* parent) const {
  const Vector3d& middle = cell.box.center;
  const double reach = cell.box.reach();
  const double length = hierarchy_.length_at(middle) + reach;
  const double slack = 1024.0 * kUnitRoundoff * length * length + kUnderflow;
  const auto sphere = [&](std::int32_t i) -> const Sphere& {
    return spheres_[static_cast<std::size_t>(i)];
  };
  if (cell.depth < first_listed_) return;
  cell.listed = true;
  const std::int32_t best = nearest_at(cell.box, parent);
  if (best < 0) return;
  const Seen first(cell.box, reach, best, sphere(best));
  // Of what the gap of the first is at most in the cell, and of the values to compare with.
  const double rounding = 64.0 * kUnitRoundoff * length + kUnderflow;
  const double farthest = first.gap + 2.0 * reach + rounding;
  std::vector<Seen> left;
  std::vector<std::size_t> corners;
  const auto consider = [&](std::int32_t i) {
    const Sphere& s = sphere(i);
    const double near = farthest + s.radius;
    if ((middle - s.center).squaredNorm() > near * near) return true;
    const Seen seen(cell.box, reach, i, s);
    const Vector3d slope = slope_between(seen, first);
    if (is_beaten(seen, first, slope, cell.box, slack)) return true;
    left.push_back(seen);
    corners.push_back(corner_against(slope));
    cell.listed = left.size() <= kLongest;
    return cell.listed;
  };
  if (parent == nullptr || !parent->listed) {
    hierarchy_.for_each_below(cell.box, first.gap + first.excess + rounding, first.direction,
                              consider);
  } else {
    for (const std::int32_t i : parent->list) consider(i);
  }
  if (!cell.listed) return;
  const std::array<std::size_t, 8> nearest = nearest_at_corners(cell.box, left);
  for (std::size_t n = 0; n < left.size(); ++n) {
    const Seen& other = left[nearest[corners[n]]];
    if (!is_beaten(left[n], other, slope_between(left[n], other), cell.box, slack)) {
      cell.list.push_back(left[n].index);
    }
  }
  cell.list.shrink_to_fit();
}

std::int32_t NearestCells::nearest_at(const BoxCell& box, const Cell* parent) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNearly = 0.1;  // any sphere will do
  if (parent == nullptr || !parent->listed) {
    return hierarchy_.nearest(box.center, kInfinity, kNearly * box.reach()).index;
  }
  LeastGap least(kInfinity);
  for (const std::int32_t i : parent->list) {
    least.examine(box.center, spheres_[static_cast<std::size_t>(i)], i);
  }
  return least.index();
}

}  // namespace spherule::internal
