// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which name may have been meant, for messages about one that is not known.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// "; did you mean NAME?" with the one of `known` that differs least from `word`, if only a few
// letters do: one in three, one of two in a name of two, neighbours that are swapped counting as
// one; or with one that `word` begins. Otherwise nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

// did_you_mean() with the names of things as what is known: did_you_mean(name, links, &Link::name).
template <class Things, class Name>
std::string did_you_mean(std::string_view word, const Things& things, Name name_of) {
  std::vector<std::string> known;
  for (const auto& thing : things) known.push_back(std::invoke(name_of, thing));
  return did_you_mean(word, known);
}

}  // namespace spherule::internal
