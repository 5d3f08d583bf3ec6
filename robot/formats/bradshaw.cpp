// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"

#include <vector>

namespace spherule::internal {
namespace {

constexpr std::size_t kMostNodes = 100'000'000;

bool is_count(double value) {
  return value >= 1.0 && value <= 64.0 && value == static_cast<double>(static_cast<int>(value));
}

// How many levels and children a node, or nothing.
std::optional<std::pair<std::size_t, std::size_t>> heading(std::string_view line) {
  const auto numbers = numbers_of(line);
  if (!numbers || numbers->size() != 2) return std::nullopt;
  if (!is_count((*numbers)[0]) || !is_count((*numbers)[1])) return std::nullopt;
  return std::pair(static_cast<std::size_t>((*numbers)[0]),
                   static_cast<std::size_t>((*numbers)[1]));
}

}  // namespace

bool is_bradshaw(std::string_view text) {
  return heading(take_line(text)).has_value();
}

RobotSpheres read_bradshaw(std::string_view text, const std::string& file,
                           const SphereReadOptions& options) {
  SphereGatherer gathered(file);
  const auto [levels, branch] = *heading(take_line(text));
  const std::size_t level = options.level.value_or(levels - 1);
  gathered.unless(level < levels, {}, "has only " + std::to_string(levels) + " levels");
  gathered.begin_link(options.link, {});
  // Nodes breadth first: those of level l are branch^l after all of the levels above.
  std::size_t width = 1;
  std::size_t line = 2;
  for (std::size_t here = 0; here < levels; ++here) {
    for (std::size_t node = 0; node < width; ++node, ++line) {
      const std::string place = "line " + std::to_string(line);
      gathered.unless(!text.empty(), place, "a node is missing");
      const auto row = numbers_of(take_line(text));
      gathered.unless(row && row->size() >= 5, place, "is not \"x y z r occupancy\"");
      // A node that is not used has a negative radius; it is none that is switched off.
      if (here != level || (*row)[3] < 0.0) continue;
      gathered.add({(*row)[0], (*row)[1], (*row)[2]}, (*row)[3], place);
    }
    width *= branch;
    gathered.unless(width <= kMostNodes, {}, "has too many nodes");
  }
  return std::move(gathered.spheres);
}

}  // namespace spherule::internal
