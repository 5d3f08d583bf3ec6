// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/robot_options.h"

#include "base/error.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/text/print.h"
#include "simplifier/zone_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <optional>

namespace spherule {
namespace {

constexpr const char* kZones = "zones";

// Splits at the first `separator`; nothing where either side is empty.
std::optional<std::pair<std::string, std::string>> split(const std::string& text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos || at == 0 || at + 1 == text.size()) return std::nullopt;
  return std::pair(text.substr(0, at), text.substr(at + 1));
}

std::vector<std::string> parts(const std::string& text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (c == ',') {
      result.emplace_back();
    } else {
      result.back() += c;
    }
  }
  return result;
}

void set(LinkCoverOptions& options, const std::string& setting, const std::string& subject) {
  const auto pair = split(setting, '=');
  if (!pair) throw Error(subject, "'" + setting + "' is not NAME=VALUE");
  const auto& [name, value] = *pair;
  if (name == kZones) {
    if (!options.zones.empty()) throw Error(subject, "zones is given twice");
    options.zones = read_zones(value);
    return;
  }
  std::optional<double>* length = name == "max-error"      ? &options.max_error
                                  : name == "min-external" ? &options.min_external_diameter
                                  : name == "padding"      ? &options.padding
                                                           : nullptr;
  if (length == nullptr) {
    throw Error(subject, "'" + name + "' is none of max-error, min-external, padding and zones");
  }
  if (length->has_value()) throw Error(subject, name + " is given twice");
  *length = lengths_in(value, subject, metres()).front();
  if (name == "padding" && **length < 0.0) {
    throw Error(subject, "'" + setting + "': must be at least 0");
  }
}

}  // namespace

void add_package_option(CLI::App& command, std::vector<std::string>& packages) {
  command.add_option("--package", packages, "Where package://NAME/ leads to; may be repeated")
      ->allow_extra_args(false)
      ->type_name(kNamedFolder);
}

void add_geometry_option(CLI::App& command, const std::string& description, std::string& geometry) {
  command.add_option("--geometry", geometry, description)->check(CLI::IsMember(geometry_names()));
}

void repeat_robot_options(const std::string& geometry, const std::vector<std::string>& packages,
                          std::vector<std::string>& words) {
  repeat("--geometry", geometry, words);
  for (const std::string& package : packages) repeat("--package", package, words);
}

UrdfOptions urdf_options(const std::vector<std::string>& packages,
                         std::span<const LinkGeometry> needed) {
  const auto needs = [&](LinkGeometry geometry) {
    return std::find(needed.begin(), needed.end(), geometry) != needed.end();
  };
  UrdfOptions options{.require_visual_meshes = needs(LinkGeometry::kVisual),
                      .require_collision_meshes = needs(LinkGeometry::kCollision)};
  for (const std::string& text : packages) {
    const auto pair = split(text, '=');
    if (!pair) throw Error("--package", "'" + text + "' is not NAME=DIR");
    if (!options.packages.emplace(pair->first, pair->second).second) {
      throw Error("--package", pair->first + " is given twice");
    }
  }
  return options;
}

RobotDescription read_robot(const std::string& urdf, const std::vector<std::string>& packages,
                            LinkGeometry geometry) {
  RobotDescription robot = read_urdf(urdf, urdf_options(packages, {&geometry, 1}));
  const auto has_any = [&](LinkGeometry which) {
    return std::any_of(robot.links.begin(), robot.links.end(), [&](const LinkDescription& link) {
      return !link_shapes(link, which).empty();
    });
  };
  if (has_any(geometry)) return robot;
  const bool is_visual = geometry == LinkGeometry::kVisual;
  const char* const other = is_visual ? "collision" : "visual";
  const bool has_other = has_any(is_visual ? LinkGeometry::kCollision : LinkGeometry::kVisual);
  throw Error(urdf, std::string("no link has ") + (is_visual ? "visual" : "collision") +
                        " geometry" +
                        (has_other ? std::string("; --geometry ") + other + " takes the other one"
                                   : std::string()));
}

std::vector<std::string> geometry_names() {
  return {"collision", "visual"};
}

LinkGeometry geometry_named(const std::string& name) {
  if (name == "collision") return LinkGeometry::kCollision;
  if (name == "visual") return LinkGeometry::kVisual;
  throw Error("--geometry", "'" + name + "' is neither collision nor visual");
}

std::map<std::string, LinkCoverOptions> link_options(const std::vector<std::string>& texts) {
  std::map<std::string, LinkCoverOptions> links;
  for (const std::string& text : texts) {
    const auto pair = split(text, ':');
    if (!pair) {
      throw Error("--link", "'" + text + "' is not NAME:max-error=E,min-external=D");
    }
    for (const std::string& setting : parts(pair->second)) {
      set(links[pair->first], setting, "--link " + pair->first);
    }
  }
  return links;
}

std::vector<std::filesystem::path> zone_files(const std::vector<std::string>& texts) {
  std::vector<std::filesystem::path> files;
  for (const std::string& text : texts) {
    const auto link = split(text, ':');
    if (!link) continue;
    for (const std::string& setting : parts(link->second)) {
      const auto pair = split(setting, '=');
      if (pair && pair->first == kZones) files.emplace_back(pair->second);
    }
  }
  return files;
}

}  // namespace spherule
