// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/packed_mesh.h"

#include "collide/search/box_gap.h"
#include "collide/search/packed_tree.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace spherule::internal {
namespace {

using Box = Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr int kWidth = MeshNode::kWidth;
static_assert(kWidth == MeshBlock::kWidth);
// Far from everything, with a square that does not overflow.
constexpr float kNowhere = 3e18F;
// Of a longest edge, squared: below it products may underflow.
constexpr double kShortest = 0x1p-200;
// What was rounded in double cannot make up for this.
constexpr double kSure = 1.0 - 0x1p-20;

float rounded_down(double x) {
  return -rounded_up_to_single(-x);
}

Vector3d each_in_single_precision(const Vector3d& x) {
  return {in_single_precision(x.x()), in_single_precision(x.y()), in_single_precision(x.z())};
}

// The plane and the edges of a triangle, as packed_mesh.h has them.
struct Sides {
  Vector3d normal;
  double offset;
  std::array<Vector3d, 3> side;
  std::array<double, 3> side_offset;
  bool hold = false;
};

bool nearly_unit(const Vector3d& x) {
  return x.squaredNorm() <= 1.0 + 8.0 * kFloatRoundoff * kSure;
}

bool is_high(const Triangle& t) {
  const std::array<Vector3d, 3> edges = edges_of(t);
  const double longest =
      std::max({edges[0].squaredNorm(), edges[1].squaredNorm(), edges[2].squaredNorm()});
  // The longest edge times the height on it.
  const double product = edges[0].cross(edges[1]).norm();
  return longest >= kShortest && product * kSure >= PackedMesh::kLowest * longest;
}

Sides sides_of(const Triangle& t, double bound) {
  Sides result;
  const std::array<Vector3d, 3> edges = edges_of(t);
  const Vector3d normal = edges[0].cross(edges[1]).normalized();
  result.normal = each_in_single_precision(normal);
  const auto along_normal = [&](int i) {
    return result.normal.dot(t[static_cast<std::size_t>(i)]);
  };
  const auto [low, high] = std::minmax({along_normal(0), along_normal(1), along_normal(2)});
  result.offset = in_single_precision(0.5 * (low + high));
  bool hold = nearly_unit(result.normal) && std::max(high - result.offset, result.offset - low) <=
                                                4.0 * kFloatRoundoff * kSure * bound;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d side = each_in_single_precision(edges[i].cross(normal).normalized());
    result.side[i] = side;
    const double most = std::max({side.dot(t[0]), side.dot(t[1]), side.dot(t[2])});
    // The dot products err by less than 4 u of the bound.
    result.side_offset[i] = most + 0x1p-50 * bound;
    hold = hold && nearly_unit(side) &&
           std::abs(side.dot(result.normal)) <= 8.0 * kFloatRoundoff * kSure;
  }
  result.hold = hold;
  return result;
}

MeshBox packed(const Box& box) {
  MeshBox result;
  for (int k = 0; k < 3; ++k) {
    result.low[k] = rounded_down(box.min()[k]);
    result.high[k] = rounded_up_to_single(box.max()[k]);
  }
  result.size = static_cast<float>(0.5 * box.diagonal().norm());
  return result;
}

class Builder {
 public:
  Builder(std::span<const Triangle> triangles, std::span<const Sphere> spheres,
          std::vector<MeshNode>& nodes, std::vector<MeshBlock>& blocks)
      : triangles_(triangles), nodes_(nodes), blocks_(blocks), order_(triangles.size()) {
    for (const Triangle& t : triangles) {
      for (const Vector3d& corner : t) bound_ = std::max(bound_, corner.norm());
    }
    // Also where norms are rounded down.
    bound_ *= 1.0 + 0x1p-40;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      sides_.push_back(is_high(triangles[i]) ? sides_of(triangles[i], bound_) : Sides());
      Box box;
      if (sides_[i].hold) {
        for (const Vector3d& corner : triangles[i]) box.extend(corner);
      } else {
        const Vector3d reach = Vector3d::Constant(spheres[i].radius * (1.0 + 0x1p-50));
        box = Box(spheres[i].center - reach, spheres[i].center + reach);
      }
      boxes_.push_back(box);
    }
    std::iota(order_.begin(), order_.end(), 0);
  }

  // Returns the depth.
  int build() {
    nodes_.push_back(empty_node());
    nodes_[0].around = packed(box_of(order_));
    if (order_.size() <= kWidth) {
      set_lane(0, 0, box_of(order_), ~add_block(order_));
      return 2;
    }
    return fill(0, order_);
  }

 private:
  using Part = std::span<std::int32_t>;

  const Box& box(std::int32_t triangle) const { return boxes_[static_cast<std::size_t>(triangle)]; }

  Box box_of(Part part) const {
    return box_around(part, [this](std::int32_t triangle) -> const Box& { return box(triangle); });
  }

  // In two along the longest axis, the first a multiple of the width so that blocks are full.
  std::array<Part, 2> halves(Part part) const {
    sort_along_longest_side(
        part, [this](std::int32_t triangle) -> const Box& { return box(triangle); },
        [](std::int32_t triangle) { return triangle; });
    const std::size_t blocks = (part.size() + kWidth - 1) / kWidth;
    const std::size_t first = (blocks + 1) / 2 * kWidth;
    return {part.first(first), part.subspan(first)};
  }

  // Makes node `at` of more than eight triangles; returns the depth below.
  int fill(std::size_t at, Part part) {
    std::vector<Part> parts = {part};
    while (parts.size() < kWidth) {
      const auto largest = std::max_element(parts.begin(), parts.end(),
                                            [](Part a, Part b) { return a.size() < b.size(); });
      if (largest->size() <= kWidth) break;
      const auto [first, second] = halves(*largest);
      *largest = first;
      parts.push_back(second);
    }
    int below = 0;
    for (std::size_t lane = 0; lane < parts.size(); ++lane) {
      const Part child = parts[lane];
      if (child.size() <= kWidth) {
        set_lane(at, lane, box_of(child), ~add_block(child));
        below = std::max(below, 1);
        continue;
      }
      const std::size_t node = nodes_.size();
      nodes_.push_back(empty_node());
      set_lane(at, lane, box_of(child), static_cast<std::int32_t>(node));
      nodes_[node].around = packed(box_of(child));
      below = std::max(below, fill(node, child));
    }
    return below + 1;
  }

  static MeshNode empty_node() {
    MeshNode node = {};
    std::fill_n(&node.low[0][0], 3 * kWidth, kNowhere);
    std::fill_n(&node.high[0][0], 3 * kWidth, kNowhere);
    std::fill_n(node.child, kWidth, -1);
    return node;
  }

  void set_lane(std::size_t at, std::size_t lane, const Box& around, std::int32_t child) {
    MeshNode& node = nodes_[at];
    const MeshBox box = packed(around);
    for (int k = 0; k < 3; ++k) {
      node.low[k][lane] = box.low[k];
      node.high[k][lane] = box.high[k];
    }
    node.child[lane] = child;
  }

  std::int32_t add_block(Part part) {
    MeshBlock block = {};
    std::fill_n(block.offset, kWidth, -kNowhere);
    block.around = packed(box_of(part));
    std::fill_n(&block.corner[0][0][0], 9 * kWidth, kNowhere);
    for (std::size_t lane = 0; lane < part.size(); ++lane) set_triangle(block, lane, part[lane]);
    blocks_.push_back(block);
    return static_cast<std::int32_t>(blocks_.size()) - 1;
  }

  void set_triangle(MeshBlock& block, std::size_t lane, std::int32_t triangle) const {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const auto index = static_cast<std::size_t>(triangle);
    const Sides& sides = sides_[index];
    block.triangle[lane] = triangle;
    block.offset[lane] = sides.hold ? static_cast<float>(sides.offset) : kNone;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      for (std::size_t i = 0; i < 3; ++i) {
        block.corner[i][k][lane] = static_cast<float>(triangles_[index][i][axis]);
        if (sides.hold) block.side[i][k][lane] = static_cast<float>(sides.side[i][axis]);
      }
      if (!sides.hold) continue;
      block.normal[k][lane] = static_cast<float>(sides.normal[axis]);
      block.side_offset[k][lane] = rounded_up_to_single(sides.side_offset[k]);
    }
  }

  std::span<const Triangle> triangles_;
  std::vector<MeshNode>& nodes_;
  std::vector<MeshBlock>& blocks_;
  std::vector<std::int32_t> order_;
  std::vector<Sides> sides_;
  std::vector<Box> boxes_;
  double bound_ = 0.0;
};

}  // namespace

PackedMesh::PackedMesh(std::span<const Triangle> triangles, std::span<const Sphere> spheres) {
  depth_ = Builder(triangles, spheres, nodes_, blocks_).build();
}

}  // namespace spherule::internal
