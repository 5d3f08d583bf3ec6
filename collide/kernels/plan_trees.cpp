// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/plan_trees.h"

#include "collide/meshes/spheres_inside.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

// What search trees are made of, and whether kept ones are of this: an object may have been
// assigned to since, and then holds something else in the same place.
struct ContentOfTree {
  const SphereTree& tree;

  std::span<const Sphere> spheres() const { return tree.spheres(); }
  std::weak_ptr<const void> identity() const { return {}; }
  bool is_that_of(const auto& kept) const {
    return std::ranges::equal(kept.trees->narrow.spheres(), tree.spheres());
  }
};

// The spheres around the triangles do not tell: the same ones may be around a surface that is open,
// which has no inside.
struct ContentOfSolid {
  const SolidMesh& solid;

  std::vector<Sphere> spheres() const { return spheres_around(solid); }
  std::weak_ptr<const void> identity() const { return solid.shared_inside(); }
  bool is_that_of(const auto& kept) const { return kept.identity.lock() == solid.shared_inside(); }
};

}  // namespace

SearchTrees::SearchTrees(std::span<const Sphere> spheres)
    : narrow(build_tree(spheres, {.branching = kNarrow})),
      narrow_spheres(narrow),
      wide(build_tree(spheres)),
      wide_spheres(wide) {}

template <class Content>
std::shared_ptr<const SearchTrees> SearchTreeCache::find(const std::shared_ptr<const void>& owner,
                                                         const Content& content) {
  Entry kept;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const auto& entry) { return entry.second.owner.expired(); });
    const auto found = entries_.find(owner.get());
    if (found != entries_.end()) kept = found->second;
  }
  if (kept.trees != nullptr && content.is_that_of(kept)) return kept.trees;
  auto trees = std::make_shared<const SearchTrees>(content.spheres());
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[owner.get()];
  // Unless another thread was faster.
  if (entry.trees == kept.trees) entry = {owner, content.identity(), std::move(trees)};
  return entry.trees;
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SphereTree>& tree) {
  return find(tree, ContentOfTree{*tree});
}

std::shared_ptr<const SearchTrees> SearchTreeCache::of(
    const std::shared_ptr<const SolidMesh>& solid) {
  return find(solid, ContentOfSolid{*solid});
}

}  // namespace spherule::internal

// Boxes of positions are halved down to the cells; a box is free if its spheres are, by a search
// over both trees with the joints at the middle of the box.
//
// The bound. Let joint j be at most h_j from its middle, and take it there from the middle one
// joint after the other, seen from the link behind joint s of the path from the first body to the
// second: first those nearest to that link. A sphere of the first body is moved by joints s to 1,
// one of the second by s + 1 to n. When joint j is moved, all that is beyond it is still placed as
// in the middle, up to one rigid motion of its axis and the sphere together: the distance d_j of
// the centre from the axis is that of the middle. So the centre moves by at most 2 sin(h_j / 2) d_j
// (2 d_j if h_j is above pi), or by h_j if the joint slides, and the distance of two centres
// changes by at most
//     the sum over j <= s of these for the first, and over j > s for the second:
// the smallest over s counts. A node's sphere holds all leaves below it in every position, so that
// nodes that are apart settle these.
//
// Rounding. Of chains of n joints that reach W, poses in double err by less than 100 (n + 2) u W,
// distances from axes by 4 times that, sums less: kSlack W is added to the margin. Positions of
// cells err by less than 1e-13 of a cell and 1e-13, half-widths are enlarged by far more.

namespace spherule::internal {
namespace {

constexpr double kSlack = 1e-10;
constexpr double kWider = 1.0 + 1e-9;
constexpr double kWiderBy = 1e-11;
// Wider intervals have no cells: their positions are hardly ever near each other.
constexpr double kWidest = 1e3;
// Pairs of nodes that are tested for a pair of bodies; what is not settled then is not free. About
// 10 ms.
constexpr int kMostTests = 1'000'000;

struct Axis {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
  bool turns;
  double way;  // 2 sin(h / 2), or h
};

// One body with the joints at their middles, as seen from the frame that carries both.
struct Placed {
  const SearchTrees* trees;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;

  Eigen::Vector3d center(std::size_t node) const {
    return rotation * trees->narrow_spheres[node].center + origin;
  }
  double radius(std::size_t node) const { return trees->narrow_spheres[node].radius; }
  bool is_leaf(std::size_t node) const { return trees->narrow.is_leaf(node); }
};

class Search {
 public:
  explicit Search(const FreeCellsSource& source) : source_(source) {
    double reach = 0.0;
    for (const FreeCellsSource::Side* side : {&source.first, &source.second}) {
      reach += (side->frame_from_trees * side->trees->narrow.sphere(0).center).norm() +
               2.0 * side->trees->narrow.sphere(0).radius;
      for (const FreeCellsSource::Joint& joint : side->chain) {
        reach += joint.parent_from_frame.translation().norm() +
                 std::max(std::abs(joint.lower), std::abs(joint.upper));
      }
    }
    margin_ = source.margin + kSlack * reach;
  }

  bool has_tests_left() const { return tests_ < kMostTests; }

  // Whether the two are apart wherever each joint is at most `half` from `middle`, in the order of
  // the path from the first body to the second.
  bool is_free(std::span<const double> middle, std::span<const double> half) {
    axes_.clear();
    place(middle, half);
    const auto is_apart = [&](const Pair& pair) {
      ++tests_;
      const Eigen::Vector3d a = first_.center(pair.a);
      const Eigen::Vector3d b = second_.center(pair.b);
      const double gap = (a - b).norm() - first_.radius(pair.a) - second_.radius(pair.b) - margin_;
      return gap > 0.0 && gap > change_of_distance(a, b);
    };
    // What was near in the box around is likely to be near.
    if (has_last_ && !is_apart(last_)) return false;
    waiting_.assign(1, {0, 0});
    while (!waiting_.empty()) {
      const Pair pair = waiting_.back();
      waiting_.pop_back();
      if (!has_tests_left()) return false;
      if (is_apart(pair)) continue;
      const bool a_is_leaf = first_.is_leaf(pair.a);
      const bool b_is_leaf = second_.is_leaf(pair.b);
      if (a_is_leaf && b_is_leaf) {
        last_ = pair;
        has_last_ = true;
        return false;
      }
      const bool opens_b =
          a_is_leaf || (!b_is_leaf && first_.radius(pair.a) < second_.radius(pair.b));
      const SphereTree& tree = opens_b ? second_.trees->narrow : first_.trees->narrow;
      const std::size_t node = opens_b ? pair.b : pair.a;
      for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
        const auto child = static_cast<std::size_t>(tree.first_child(node) + i);
        waiting_.push_back(opens_b ? Pair{pair.a, child} : Pair{child, pair.b});
      }
    }
    return true;
  }

 private:
  struct Pair {
    std::size_t a;
    std::size_t b;
  };

  // Both bodies, and the axes in the order of the path.
  void place(std::span<const double> middle, std::span<const double> half) {
    const std::size_t firsts = source_.first.chain.size();
    axes_.resize(middle.size());
    first_ = placed(
        source_.first, [&](std::size_t i) { return firsts - 1 - i; }, middle, half);
    second_ = placed(
        source_.second, [&](std::size_t i) { return firsts + i; }, middle, half);
  }

  template <class NumberOf>
  Placed placed(const FreeCellsSource::Side& side, const NumberOf& number_of,
                std::span<const double> middle, std::span<const double> half) {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    const auto append = [&](const Pose& pose) {
      origin += rotation * pose.translation();
      rotation = (rotation * pose.matrix()).eval();
    };
    for (std::size_t i = 0; i < side.chain.size(); ++i) {
      const FreeCellsSource::Joint& joint = side.chain[i];
      const std::size_t number = number_of(i);
      append(joint.parent_from_frame);
      const double h = half[number];
      axes_[number] = {origin, rotation.col(2), joint.turns,
                       !joint.turns    ? h
                       : h < kHalfTurn ? 2.0 * std::sin(0.5 * h)
                                       : 2.0};
      if (joint.turns) {
        const Eigen::AngleAxisd turn(middle[number], Eigen::Vector3d::UnitZ());
        rotation = (rotation * turn.toRotationMatrix()).eval();
      } else {
        origin += middle[number] * rotation.col(2);
      }
    }
    append(side.frame_from_trees);
    return {side.trees.get(), rotation, origin};
  }

  static double way_of(const Axis& axis, const Eigen::Vector3d& p) {
    return axis.turns ? axis.way * (p - axis.point).cross(axis.direction).norm() : axis.way;
  }

  double change_of_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    double sum = 0.0;
    for (const Axis& axis : axes_) sum += way_of(axis, b);
    double least = sum;
    for (const Axis& axis : axes_) {
      sum += way_of(axis, a) - way_of(axis, b);
      least = std::min(least, sum);
    }
    return least * kWider;
  }

  static constexpr double kHalfTurn = 3.14159;

  const FreeCellsSource& source_;
  double margin_ = 0.0;
  std::vector<Axis> axes_{};
  Placed first_{};
  Placed second_{};
  std::vector<Pair> waiting_{};
  Pair last_{};
  bool has_last_ = false;
  int tests_ = 0;
};

bool is_same(const Pose& a, const Pose& b) {
  return a.matrix() == b.matrix() && a.translation() == b.translation();
}

bool is_same(const FreeCellsSource::Side& a, const FreeCellsSource::Side& b) {
  return is_same(a.frame_from_trees, b.frame_from_trees) &&
         std::equal(a.chain.begin(), a.chain.end(), b.chain.begin(), b.chain.end(),
                    [](const FreeCellsSource::Joint& x, const FreeCellsSource::Joint& y) {
                      return is_same(x.parent_from_frame, y.parent_from_frame) &&
                             x.turns == y.turns && x.position == y.position && x.lower == y.lower &&
                             x.upper == y.upper;
                    });
}

}  // namespace

bool FreeCellsSource::operator==(const FreeCellsSource& other) const {
  return is_same(first, other.first) && is_same(second, other.second) && margin == other.margin;
}

std::shared_ptr<const FreeCells> FreeCells::of(const FreeCellsSource& source) {
  std::vector<FreeCellsSource::Joint> path(source.first.chain.rbegin(), source.first.chain.rend());
  path.insert(path.end(), source.second.chain.begin(), source.second.chain.end());
  if (path.empty() || path.size() > kMostJoints) return nullptr;
  const std::shared_ptr<FreeCells> result(new FreeCells());
  std::array<double, kMostJoints> widths{};
  for (std::size_t i = 0; i < path.size(); ++i) {
    widths[i] = (path[i].upper - path[i].lower) * kWider + 4.0 * kWiderBy;
    if (!(widths[i] <= kWidest)) return nullptr;
    result->axes_[i] = {path[i].position, path[i].lower - kWiderBy, kCells / widths[i]};
  }
  if (path.size() < kMostJoints) result->axes_[1] = {path[0].position, 0.0, 0.0};

  struct Box {
    std::array<int, kMostJoints> first{};
    std::array<int, kMostJoints> count{};
  };
  Search search(source);
  Box whole;
  whole.count[0] = kCells;
  whole.count[1] = path.size() > 1 ? kCells : 1;
  bool has_any = false;
  const auto prove = [&](const auto& self, const Box& box) -> void {
    if (!search.has_tests_left()) return;
    std::array<double, kMostJoints> middle{};
    std::array<double, kMostJoints> half{};
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double cell = widths[i] / kCells;
      middle[i] = result->axes_[i].lower + cell * (box.first[i] + 0.5 * box.count[i]);
      half[i] = 0.5 * cell * box.count[i] * kWider + kWiderBy;
    }
    const std::size_t joints = path.size();
    if (search.is_free({middle.data(), joints}, {half.data(), joints})) {
      const std::uint64_t bits =
          (box.count[0] == kCells ? ~std::uint64_t{0} : (std::uint64_t{1} << box.count[0]) - 1)
          << box.first[0];
      for (int j = 0; j < box.count[1]; ++j) {
        result->words_[static_cast<std::size_t>(box.first[1] + j)] |= bits;
      }
      has_any = true;
      return;
    }
    const std::size_t longest = box.count[1] > box.count[0] ? 1 : 0;
    if (box.count[longest] == 1) return;
    Box part = box;
    part.count[longest] /= 2;
    self(self, part);
    part.first[longest] += part.count[longest];
    self(self, part);
  };
  prove(prove, whole);
  return has_any ? result : nullptr;
}

std::shared_ptr<const FreeCells> FreeCellsCache::of(const FreeCellsSource& source) {
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const Entry& entry) {
      return entry.first.expired() || entry.second.expired();
    });
    for (const Entry& entry : entries_) {
      if (entry.first.lock() == source.first.trees && entry.second.lock() == source.second.trees &&
          entry.source == source) {
        return entry.cells;
      }
    }
  }
  Entry entry{source, source.first.trees, source.second.trees, FreeCells::of(source)};
  entry.source.first.trees = entry.source.second.trees = nullptr;
  const std::lock_guard lock(mutex_);
  return entries_.emplace_back(std::move(entry)).cells;
}

}  // namespace spherule::internal
