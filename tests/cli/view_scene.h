// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace spherule {

// The scene that a page of `view` carries.
nlohmann::json scene_of(const std::string& page);

// The numbers of a base64 text of 32-bit floats.
std::vector<float> floats_of(const std::string& text);

}  // namespace spherule
