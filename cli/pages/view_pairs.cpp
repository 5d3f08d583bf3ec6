// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_pairs.h"

#include "base/files.h"

#include <filesystem>

namespace spherule {
namespace {

Json json_of(const FreeBoxes& boxes) {
  Json json{{"variables", Json::array()}};
  for (const FreeBoxes::Variable& variable : boxes.variables()) {
    json["variables"].push_back({{"index", variable.index},
                                 {"wraps", variable.wraps},
                                 {"lower", variable.lower},
                                 {"upper", variable.upper}});
  }
  std::string nodes;
  for (const char node : boxes.nodes()) nodes += static_cast<char>('A' + node);
  json["nodes"] = nodes;
  return json;
}

}  // namespace

bool is_of_pairs_alone(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".pairs") return true;
  const std::string text = read_file(file);
  const auto has = [&](const char* mark) { return text.find(mark) != std::string::npos; };
  return has("<robot") && has("<disable_collisions") && !has("<link_sphere_approximation");
}

Json view_pairs(const PairKinds& kinds) {
  Json json = Json::array();
  for (const PairStatus& pair : kinds.pairs) {
    Json& written =
        json.emplace_back(Json{{"links", {pair.first, pair.second}}, {"kind", kind_of(pair)}});
    if (pair.verdict) written["verdict"] = name_of(*pair.verdict);
    if (pair.reason == AllowedReason::kFreeInBoxes) {
      written["boxes"] = json_of(kinds.proofs->find(pair.first, pair.second)->boxes);
    }
  }
  return json;
}

}  // namespace spherule
