// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Parts of a YAML document, and complaints that name their lines.

#include "robot/formats/sphere_documents.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace spherule::internal {

// "line 7", or nothing where that is not known.
std::string place_of(const YAML::Node& node);

// The one document of a file.
YAML::Node yaml_document(std::string_view text, const SphereGatherer& gathered);

// A text, a number or a truth value; `what` is the subject of the complaint about other nodes.
std::string yaml_scalar(const YAML::Node& node, const std::string& what,
                        const SphereGatherer& gathered);

struct YamlMember {
  std::string key;
  YAML::Node written_key;
  YAML::Node value;
};
using YamlMembers = std::vector<YamlMember>;

// The members of a map in their order. Merge keys are refused: what they bring in would be missed.
YamlMembers yaml_members(const YAML::Node& node, const std::string& what,
                         const SphereGatherer& gathered);

// The value of a key, if there is one that is not null.
std::optional<YAML::Node> find_member(const YamlMembers& members, std::string_view key);

// The members of the map at a key; none without it.
YamlMembers members_if_there(const YamlMembers& parent, const std::string& key,
                             const SphereGatherer& gathered);

// The name of the geometry that collision checks of an XRDF use.
std::string xrdf_geometry(const YamlMembers& root, const SphereGatherer& gathered);

// Gathers the spheres and pairs of a file with these members, and of one beside it that it names.
SphereFormat gather_spheres(const YamlMembers& root, const std::filesystem::path& path,
                            SphereGatherer& gathered);

}  // namespace spherule::internal
