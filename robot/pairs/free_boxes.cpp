// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "robot/pairs/link_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace spherule {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
// What a query on an edge recurses to. Searches end far above it: each halving of a range of 100
// beyond the 60th is below 1e-16.
constexpr int kDeepest = 1200;

// Joins halves that are equal leaves.
std::string joined(std::string_view nodes) {
  std::string result;
  result.reserve(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    result.push_back(nodes[i]);
    // Reversed, so that a node follows its second and then its first half, both complete.
    const std::size_t n = result.size();
    if (n >= 3 && static_cast<std::uint8_t>(result[n - 1]) >= FreeBoxes::kFirstHalving &&
        static_cast<std::uint8_t>(result[n - 2]) < FreeBoxes::kFirstHalving &&
        result[n - 2] == result[n - 3]) {
      result.resize(n - 2);
    }
  }
  return {result.rbegin(), result.rend()};
}

}  // namespace

FreeBoxes::FreeBoxes(std::vector<Variable> variables, std::string_view nodes)
    : variables_(std::move(variables)) {
  if (variables_.size() > kMostVariables) throw Error("free boxes", "too many variables");
  struct Open {
    std::int32_t parent;  // whose second half comes next
    int depth;
    Values lower, upper;
  };
  Open box{-1, 0, {}, {}};
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const Variable& variable = variables_[i];
    const bool is_turn = variable.lower == -std::numbers::pi && variable.upper == std::numbers::pi;
    if (!(std::abs(variable.lower) <= kLargestPosition) ||
        !(std::abs(variable.upper) <= kLargestPosition) || variable.lower > variable.upper ||
        variable.index < 0 || (variable.wraps && !is_turn)) {
      throw Error("free boxes", "the range of a variable is not usable");
    }
    const auto before = variables_.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(variables_.begin(), before,
                    [&](const Variable& other) { return other.index == variable.index; })) {
      throw Error("free boxes", "a variable is there twice");
    }
    box.lower[i] = variable.lower;
    box.upper[i] = variable.upper;
  }
  if (nodes.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw Error("free boxes", "the tree is too large");
  }
  const std::string bytes = joined(nodes);
  std::vector<Open> open;
  bool complete = false;
  for (const char byte : bytes) {
    const int state = static_cast<std::uint8_t>(byte);
    if (complete || state - kFirstHalving >= static_cast<int>(variables_.size())) {
      throw Error("free boxes", "the nodes are no tree");
    }
    Node node{0.0, state, 0};
    const auto index = static_cast<std::int32_t>(nodes_.size());
    if (state >= kFirstHalving) {
      const auto v = static_cast<std::size_t>(state - kFirstHalving);
      node.at = 0.5 * (box.lower[v] + box.upper[v]);
      if (++box.depth > kDeepest) throw Error("free boxes", "the tree is too deep");
      Open second = box;
      second.parent = index;
      second.lower[v] = node.at;
      box.upper[v] = node.at;
      open.push_back(second);
      nodes_.push_back(node);
      continue;
    }
    nodes_.push_back(node);
    if (open.empty()) {
      complete = true;
      continue;
    }
    box = open.back();
    open.pop_back();
    nodes_[static_cast<std::size_t>(box.parent)].second = index + 1;
  }
  if (!complete) throw Error("free boxes", "the nodes are no tree");
  bytes_ = bytes;
}

// The values of the variables, turns taken off where they wrap: as many as `turns` says, if given.
// They may be beyond the ranges by so much.
bool FreeBoxes::take(std::span<const double> configuration, double beyond, const Values* turns,
                     Values& values, Values& turns_taken) const noexcept {
  if (nodes_.empty()) return false;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const Variable& variable = variables_[i];
    const auto index = static_cast<std::size_t>(variable.index);
    if (index >= configuration.size()) return false;
    double value = configuration[index];
    if (!(std::abs(value) <= kLargestPosition + beyond)) return false;
    if (variable.wraps) {
      turns_taken[i] = turns != nullptr ? (*turns)[i] : std::round(value / kTurn);
      value -= turns_taken[i] * kTurn;
    }
    if (value < variable.lower - beyond || value > variable.upper + beyond) return false;
    values[i] = value;
  }
  return true;
}

bool FreeBoxes::contains(std::span<const double> configuration) const noexcept {
  Values values;
  Values turns;
  if (!take(configuration, kTolerance, nullptr, values, turns)) return false;
  return point_is_free(0, values) || seam_is_free(values, 0);
}

// On both sides of what it is near.
bool FreeBoxes::point_is_free(std::size_t node, const Values& values) const noexcept {
  while (nodes_[node].state >= kFirstHalving) {
    const double beyond =
        values[static_cast<std::size_t>(nodes_[node].state - kFirstHalving)] - nodes_[node].at;
    const auto second = static_cast<std::size_t>(nodes_[node].second);
    if (std::abs(beyond) <= kTolerance && point_is_free(second, values)) return true;
    node = beyond > kTolerance ? second : node + 1;
  }
  return nodes_[node].state == kFree;
}

// From the other end of the range of variables that wrap and are near one end: the same
// configuration.
bool FreeBoxes::seam_is_free(Values& values, std::size_t first) const noexcept {
  for (std::size_t i = first; i < variables_.size(); ++i) {
    if (!variables_[i].wraps || std::abs(values[i]) < 0.5 * kTurn - kTolerance) continue;
    const double value = values[i];
    values[i] -= std::copysign(kTurn, value);
    if (point_is_free(0, values) || seam_is_free(values, i + 1)) return true;
    values[i] = value;
  }
  return false;
}

bool FreeBoxes::contains_edge(std::span<const double> from,
                              std::span<const double> to) const noexcept {
  Values first;
  Values last;
  Values turns{};
  // Its points are rounded, and are to be within the tolerance.
  constexpr double kBeyond = 0.5 * kTolerance;
  if (!take(from, kBeyond, nullptr, first, turns)) return false;
  Values same;
  if (!take(to, kBeyond, &turns, last, same)) return false;
  return edge_is_free(0, first, last, 0.0, 1.0);
}

bool FreeBoxes::edge_is_free(std::size_t index, const Values& from, const Values& to, double first,
                             double last) const noexcept {
  const Node& node = nodes_[index];
  if (node.state < kFirstHalving) return node.state == kFree;
  const auto v = static_cast<std::size_t>(node.state - kFirstHalving);
  const auto second = static_cast<std::size_t>(node.second);
  const double step = to[v] - from[v];
  const double at_first = from[v] + first * step;
  const double at_last = from[v] + last * step;
  if (at_first <= node.at && at_last <= node.at) {
    return edge_is_free(index + 1, from, to, first, last);
  }
  if (at_first >= node.at && at_last >= node.at) {
    return edge_is_free(second, from, to, first, last);
  }
  // Both ends are on different sides, so that the step is not zero.
  const double crossing = std::min(std::max((node.at - from[v]) / step, first), last);
  const bool upwards = step > 0.0;
  return edge_is_free(upwards ? index + 1 : second, from, to, first, crossing) &&
         edge_is_free(upwards ? second : index + 1, from, to, crossing, last);
}

void FreeBoxes::for_each_leaf(
    const std::function<void(bool is_free, std::span<const double> lower,
                             std::span<const double> upper)>& visit) const {
  Values lower{};
  Values upper{};
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    lower[i] = variables_[i].lower;
    upper[i] = variables_[i].upper;
  }
  const auto descend = [&](const auto& self, std::size_t index) -> void {
    const Node& node = nodes_[index];
    if (node.state < kFirstHalving) {
      visit(node.state == kFree, {lower.data(), variables_.size()},
            {upper.data(), variables_.size()});
      return;
    }
    const auto v = static_cast<std::size_t>(node.state - kFirstHalving);
    const double end = std::exchange(upper[v], node.at);
    self(self, index + 1);
    upper[v] = end;
    const double begin = std::exchange(lower[v], node.at);
    self(self, static_cast<std::size_t>(node.second));
    lower[v] = begin;
  };
  descend(descend, 0);
}

double FreeBoxes::free_share() const {
  double share = 0.0;
  std::vector<double> open{1.0};
  for (const Node& node : nodes_) {
    const double part = open.back();
    open.pop_back();
    if (node.state >= kFirstHalving) {
      open.insert(open.end(), 2, 0.5 * part);
    } else if (node.state == kFree) {
      share += part;
    }
  }
  return share;
}

}  // namespace spherule
