// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/text/nearest_name.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace spherule::internal {
namespace {

// How many letters have to be put in, taken out, replaced or swapped with their neighbours (optimal
// string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> edits(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        edits[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = edits[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      edits[i][j] = std::min({replaced, edits[i - 1][j] + 1, edits[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
      }
    }
  }
  return edits[a.size()][b.size()];
}

std::string nearest_name(std::string_view word, std::span<const std::string> known) {
  std::string best;
  const bool is_short_name = word.size() == 2 && word.front() != '-';
  std::size_t least = (is_short_name ? 1 : word.size() / 3) + 1;
  for (const std::string& name : known) {
    if (name.size() >= word.size() + least) continue;  // at least as many letters differ
    const std::size_t distance = edit_distance(word, name);
    if (distance < least) {
      least = distance;
      best = name;
    }
  }
  if (!best.empty() || word.size() < 2) return best;
  const auto longer = std::find_if(known.begin(), known.end(), [&](const std::string& name) {
    return word != "--" && name.starts_with(word);
  });
  return longer == known.end() ? std::string() : *longer;
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  // Of long words no one means another, and each pair of letters costs time.
  constexpr std::size_t kLongest = 100;
  if (word.size() > kLongest) return {};
  const std::string name = nearest_name(word, known);
  return name.empty() ? "" : "; did you mean " + name + "?";
}

}  // namespace spherule::internal
