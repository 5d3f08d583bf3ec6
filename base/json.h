// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// JSON texts, with what nlohmann's parser lets pass refused.

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace spherule::internal {

inline constexpr std::size_t kDeepestJson = 200;
inline constexpr std::size_t kMostOrderedKeys = std::size_t{1} << 13;

// The value of a JSON text; Json is nlohmann::json or nlohmann::ordered_json. What is no JSON is
// refused, so is what is nested deeper than kDeepestJson, a key that an object holds twice, of
// which nlohmann's parser would silently keep the last, and more than kMostOrderedKeys keys of an
// ordered object, as it searches them one after the other: `refuse(reason)` has to throw.
template <class Json>
Json parse_json(std::string_view text, const std::function<void(const std::string&)>& refuse);

}  // namespace spherule::internal
