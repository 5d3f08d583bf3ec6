// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which name may have been meant, for messages about one that is not known.
//
// @code{.cpp}
// #include <spherule/spheretree/nearest_name.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<std::string> links{"base", "hand"};
// assert(spherule::internal::did_you_mean("hnad", links) == "; did you mean hand?");
// assert(spherule::internal::did_you_mean("torch", links).empty());
// @endcode

#include <span>
#include <string>
#include <string_view>

namespace spherule::internal {

// The one of `known` that differs least from `word`, if only a few letters do: one in three, one
// of two in a name of two, neighbours that are swapped counting as one; or if `word` begins it.
// Otherwise empty.
std::string nearest_name(std::string_view word, std::span<const std::string> known);

// "; did you mean NAME?" with that name, or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace spherule::internal
