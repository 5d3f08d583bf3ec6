// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/mesh_shells.h"

#include "collide/internal/turned_sets.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>

namespace spherule::internal {
namespace {

using Corners = std::array<int, 3>;

bool is_degenerate(const Corners& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Whether the corners go round in ascending order.
bool ascends(const Corners& t) {
  return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2;
}

struct EdgeUse {
  int low, high;  // corners
  int triangle;
  int turn;  // +1 from low to high, -1 back
};

class ShellFinder {
 public:
  explicit ShellFinder(const std::vector<Corners>& triangles)
      : triangles_(triangles),
        shells_(triangles.size()),
        patches_(triangles.size()),
        is_first_(triangles.size(), 0),
        cancels_(triangles.size(), 0),
        remains_(triangles.size(), 0),
        is_open_shell_(triangles.size(), 0),
        is_open_patch_(triangles.size(), 0) {
    sort_edges();
    for_each_edge([&](std::span<const EdgeUse> uses) {
      for (const EdgeUse& use : uses) shells_.join(use.triangle, uses[0].triangle);
    });
    compare_alike();
    for_each_edge([&](std::span<const EdgeUse> uses) { join_patches(uses); });
    std::vector<int> balance(triangles.size(), 0);
    for_each_edge([&](std::span<const EdgeUse> uses) { weigh(uses, balance); });
  }

  MeshShells run() {
    MeshShells result;
    result.roles.resize(triangles_.size());
    std::vector<std::int32_t> shell_number(triangles_.size(), -1), patch_number = shell_number;
    std::int32_t count = 0;
    const auto number = [&](std::int32_t& of) { return of >= 0 ? of : of = count++; };
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (is_degenerate(triangles_[i])) continue;
      const std::size_t shell = shell_of(static_cast<int>(i));
      TriangleRole& role = result.roles[i];
      if (!is_open_shell_[shell] && remains_[shell]) role.shell = number(shell_number[shell]);
      if (!cancels_[shell]) {
        result.are_closed = result.are_closed && !is_open_shell_[shell];
      } else if (is_first_[i]) {
        const TurnedSets::Place place = patches_.find(static_cast<int>(i));
        const auto patch = static_cast<std::size_t>(place.root);
        role.turn = place.turn;
        if (!is_open_patch_[patch]) role.patch = number(patch_number[patch]);
        result.are_closed = result.are_closed && !is_open_patch_[patch];
      }
    }
    return result;
  }

 private:
  std::size_t shell_of(int triangle) {
    return static_cast<std::size_t>(shells_.find(triangle).root);
  }
  bool is_first(const EdgeUse& use) const {
    return is_first_[static_cast<std::size_t>(use.triangle)] != 0;
  }

  void sort_edges() {
    edges_.reserve(3 * triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Corners& t = triangles_[i];
      if (is_degenerate(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = t[k], to = t[(k + 1) % 3];
        edges_.push_back(
            {std::min(from, to), std::max(from, to), static_cast<int>(i), from < to ? 1 : -1});
      }
    }
    std::sort(edges_.begin(), edges_.end(), [](const EdgeUse& a, const EdgeUse& b) {
      return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
  }

  template <typename Function>
  void for_each_edge(const Function& function) {
    for (std::size_t i = 0, end = 0; i < edges_.size(); i = end) {
      while (end < edges_.size() && edges_[end].low == edges_[i].low &&
             edges_[end].high == edges_[i].high) {
        ++end;
      }
      function(std::span(edges_).subspan(i, end - i));
    }
  }

  // Of triangles with the same corners: which is the first, whether they are turned both ways, and
  // whether one way is more frequent.
  void compare_alike() {
    std::vector<std::pair<Corners, int>> sorted;
    sorted.reserve(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (is_degenerate(triangles_[i])) continue;
      Corners corners = triangles_[i];
      std::sort(corners.begin(), corners.end());
      sorted.emplace_back(corners, static_cast<int>(i));
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0, end = 0; i < sorted.size(); i = end) {
      std::size_t ascending = 0;
      for (; end < sorted.size() && sorted[end].first == sorted[i].first; ++end) {
        ascending += ascends(triangles_[static_cast<std::size_t>(sorted[end].second)]);
      }
      const std::size_t descending = end - i - ascending;
      const std::size_t shell = shell_of(sorted[i].second);
      is_first_[static_cast<std::size_t>(sorted[i].second)] = 1;
      if (ascending > 0 && descending > 0) cancels_[shell] = 1;
      if (ascending != descending) remains_[shell] = 1;
    }
  }

  void join_patches(std::span<const EdgeUse> uses) {
    std::array<const EdgeUse*, 2> firsts{};
    std::size_t count = 0;
    for (const EdgeUse& use : uses) {
      if (!is_first(use)) continue;
      if (count == 2) return;
      firsts[count++] = &use;
    }
    if (count < 2) return;
    patches_.join(firsts[0]->triangle, firsts[1]->triangle, -firsts[0]->turn * firsts[1]->turn);
  }

  // `balance`, of every patch, is zero before and after.
  void weigh(std::span<const EdgeUse> uses, std::vector<int>& balance) {
    int sum = 0;
    for (const EdgeUse& use : uses) sum += use.turn;
    if (sum != 0) is_open_shell_[shell_of(uses[0].triangle)] = 1;
    const auto for_each_patch = [&](const auto& function) {
      for (const EdgeUse& use : uses) {
        if (!is_first(use)) continue;
        const TurnedSets::Place place = patches_.find(use.triangle);
        function(static_cast<std::size_t>(place.root), use.turn * place.turn);
      }
    };
    for_each_patch([&](std::size_t patch, int turn) { balance[patch] += turn; });
    for_each_patch([&](std::size_t patch, int) {
      if (balance[patch] != 0) is_open_patch_[patch] = 1;
      balance[patch] = 0;
    });
  }

  const std::vector<Corners>& triangles_;
  std::vector<EdgeUse> edges_;
  TurnedSets shells_, patches_;  // of triangles
  std::vector<char> is_first_;   // of a triangle: among those with the same corners
  // Of a shell, by the triangle that stands for it: whether triangles are turned both ways, and
  // whether some are left if those are taken away in pairs.
  std::vector<char> cancels_, remains_;
  std::vector<char> is_open_shell_, is_open_patch_;
};

}  // namespace

MeshShells find_shells(const std::vector<std::array<int, 3>>& triangles) {
  return ShellFinder(triangles).run();
}

}  // namespace spherule::internal
