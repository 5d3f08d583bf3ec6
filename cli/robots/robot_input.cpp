// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/robot_input.h"

#include "base/error.h"
#include "base/text.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/text/print.h"
#include "robot/model/robot_model.h"
#include "simplifier/types/zones.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

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

std::string only_link(const RobotDescription& robot, LinkGeometry geometry,
                      const std::string& file) {
  std::vector<std::string> names;
  for (const LinkDescription& link : robot.links) {
    if (!link_shapes(link, geometry).empty()) names.push_back(link.name);
  }
  if (names.size() != 1) throw Error(file, kNameItsLink);
  return names.front();
}

// Whether there are none: links that have a shape and no sphere, which would be free everywhere.
bool has_no_bare_links(const RobotDescription& robot, const RobotModel& model,
                       LinkGeometry geometry) {
  bool none = true;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (model.links()[i].trees.empty() && !link_shapes(robot.links[i], geometry).empty()) {
      warn("link " + robot.links[i].name + " has a shape but no spheres: it is not checked");
      none = false;
    }
  }
  return none;
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

RobotDescription read_urdf_with_warnings(const std::string& urdf,
                                         const std::vector<std::string>& packages,
                                         std::span<const LinkGeometry> needed) {
  RobotDescription robot = read_urdf(urdf, urdf_options(packages, needed));
  for (const std::string& warning : robot.warnings) warn(warning);
  return robot;
}

RobotDescription read_robot(const std::string& urdf, const std::vector<std::string>& packages,
                            LinkGeometry geometry) {
  RobotDescription robot = read_urdf_with_warnings(urdf, packages, {&geometry, 1});
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

void add_unknown_links_flag(CLI::App& command, bool& ignores) {
  command.add_flag("--ignore-unknown-links", ignores,
                   "Leave out spheres of links that the robot has not got, with a warning "
                   "(default: refuse the file)");
}

void require_known_links(const RobotModel& robot, const std::string& file,
                         const RobotSpheres& spheres, bool ignores) {
  constexpr std::size_t kMostNamed = 5;
  std::size_t known = 0;
  std::size_t unknown = 0;
  std::string names;
  for (const LinkSpheres& link : spheres.links) {
    if (link.spheres.empty()) continue;
    if (robot.find_link(link.link) >= 0) {
      ++known;
    } else if (++unknown <= kMostNamed) {
      names += (unknown == 1 ? " " : ", ") + internal::in_quotes(link.link);
    }
  }
  if (unknown == 0) return;
  if (unknown > kMostNamed) names += " and " + std::to_string(unknown - kMostNamed) + " more";
  const std::string what = "has spheres of " + std::to_string(unknown) +
                           (unknown == 1 ? " link" : " links") +
                           " that the robot has not got:" + names;
  if (known == 0) throw Error(file, what + ", and of no other");
  if (!ignores) throw Error(file, what + "; --ignore-unknown-links leaves them out");
  warn(file + ": " + what + "; they are left out");
}

void warn_of_other_geometry(const std::string& file, const RobotSpheres& spheres) {
  if (spheres.self_collision_geometry.empty()) return;
  warn(file + ": the geometry " + internal::in_quotes(spheres.self_collision_geometry) +
       " that it names for self-collisions is not read: these are checked with the spheres of the "
       "geometry for collisions, too");
}

SphereInput read_spheres_of(const RobotDescription& robot, LinkGeometry geometry,
                            const std::string& file, const SphereReadOptions& options) {
  SphereInput input{read_robot_spheres(file, options)};
  warn_of_other_geometry(file, input.file.spheres);
  if (is_of_one_mesh(input.file)) {
    input.file.spheres.links.front().link = only_link(robot, geometry, file);
    input.names_links = false;
  }
  return input;
}

SphereRobot read_sphere_robot(const std::string& file, const RobotDescription& robot,
                              LinkGeometry geometry, bool ignores_unknown_links) {
  SphereFormatFile spheres = read_robot_spheres(file);
  // In which frame they are nobody says, and here nothing proves that they cover.
  if (is_of_one_mesh(spheres)) throw Error(file, kNameItsLink);
  RobotSpheres read = std::move(spheres.spheres);
  require_known_links(robot.model, file, read, ignores_unknown_links);
  warn_of_other_geometry(file, read);
  const auto is_unknown = [&](const std::string& link) { return robot.model.find_link(link) < 0; };
  std::erase_if(read.links, [&](const LinkSpheres& link) { return is_unknown(link.link); });
  std::erase_if(read.self_collision_ignore, [&](const DisabledPair& pair) {
    return is_unknown(pair.link_a) || is_unknown(pair.link_b);
  });
  const auto warn_of = [&](std::size_t count, const char* what) {
    if (count > 0) warn(file + ": " + std::to_string(count) + what);
  };
  warn_of(read.other_shapes, " shapes are no spheres: they are not checked");
  warn_of(read.switched_off, " spheres are switched off: they are not checked");
  if (!read.self_collision_ignore.empty()) {
    tell(file + ": " + std::to_string(read.self_collision_ignore.size()) +
         " of the pairs of links are ignored, as the file says");
  }
  if (read.collision_buffer != 0.0 || !read.collision_buffers.empty() ||
      !read.self_collision_buffer.empty()) {
    warn(file + ": its buffers are not added; name them as padding in the scene");
  }
  SphereRobot result{in_file(file, [&] { return with_spheres(robot.model, read.links); }),
                     std::move(read.self_collision_ignore)};
  result.is_whole = has_no_bare_links(robot, result.model, geometry) && read.other_shapes == 0;
  return result;
}

SphereRobot cover_sphere_robot(const std::string& urdf, const RobotDescription& robot,
                               RobotCoverOptions options) {
  LinkWarnings warnings;
  const RobotCover covered = [&] {
    ProgressBar bar;
    options.progress = bar.callback();
    options.on_doubt = warnings.on_doubt(bar);
    return in_file(urdf, [&] { return cover_robot(robot, options); });
  }();
  std::vector<LinkSpheres> spheres;
  for (const LinkCover& link : covered.links) {
    if (link.fit && !link.fit->certificate.covered) {
      throw Error(urdf, "link " + link.link + ": its spheres are not proved to cover all of it");
    }
    warnings.print(link.link, link.warnings);
    spheres.push_back({link.link, link.spheres});
  }
  SphereRobot result{with_spheres(robot.model, spheres), {}};
  result.is_whole = has_no_bare_links(robot, result.model, options.geometry);
  return result;
}

decltype(RobotCoverOptions::on_doubt) LinkWarnings::on_doubt(ProgressBar& bar) {
  return [this, &bar](const std::string& link, const std::string& doubt) {
    bar.clear();
    print(link, doubt);
  };
}

void LinkWarnings::print(const std::string& link, std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) print(link, warning);
}

void LinkWarnings::print(const std::string& link, const std::string& warning) {
  const std::string subject = "link " + link + ": ";
  if (!printed_.insert(subject + warning).second) return;
  const std::size_t end_of_figures = warning.find("): ");
  const bool is_explained = end_of_figures != std::string::npos &&
                            !explained_.insert(warning.substr(0, warning.find(" ("))).second;
  warn(subject + (is_explained ? warning.substr(0, end_of_figures + 1) : warning));
}

}  // namespace spherule
