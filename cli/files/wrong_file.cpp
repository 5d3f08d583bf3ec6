// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/wrong_file.h"

#include "base/error.h"
#include "cli/files/recognize.h"
#include "cli/help/usage_error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

namespace spherule {
namespace {

using Kinds = std::vector<FileKind>;

const Kinds kModel = {FileKind::kMesh, FileKind::kCad};
const Kinds kRobotSets = {FileKind::kRobotSpheres, FileKind::kUrdf, FileKind::kSrdf,
                          FileKind::kSpheres};

// What each command takes, by the names of its arguments and options. `view` and `info` take
// everything.
const std::map<std::string, std::map<std::string, Kinds>, std::less<>> kTakes = {
    {"fit", {{"mesh", kModel}, {"--tool", {FileKind::kSpheres}}, {"--zones", {FileKind::kZones}}}},
    {"audit", {{"mesh", kModel}, {"spheres", {FileKind::kSpheres}}}},
    {"tree", {{"spheres", {FileKind::kSpheres}}}},
    {"collide", {{"a", {FileKind::kTree}}, {"b", {FileKind::kTree}}}},
    {"robot",
     {{"urdf", {FileKind::kUrdf}},
      {"--srdf", {FileKind::kSrdf}},
      {"--curobo", {FileKind::kRobotSpheres}},
      {"--xrdf", {FileKind::kRobotSpheres}},
      {"--poses", {FileKind::kTable}}}},
    {"audit-robot",
     {{"urdf", {FileKind::kUrdf}},
      {"spheres", kRobotSets},
      {"--srdf", {FileKind::kSrdf}},
      {"--pairs", {FileKind::kPairs}},
      {"--poses", {FileKind::kTable}}}},
    {"check-srdf", {{"urdf", {FileKind::kUrdf}}, {"srdf", {FileKind::kSrdf}}}},
    {"check",
     {{"urdf", {FileKind::kUrdf}},
      {"scene", {FileKind::kScene}},
      {"trajectory", {FileKind::kTable}},
      {"--spheres", kRobotSets},
      {"--pairs", {FileKind::kPairs}}}},
};

const std::map<std::string, Kinds>* taken_by(const CLI::App& command) {
  for (const CLI::App* at = &command; at != nullptr; at = at->get_parent()) {
    const auto found = kTakes.find(at->get_name());
    if (found != kTakes.end()) return &found->second;
  }
  return nullptr;
}

FileKind kind_of(const std::string& file) {
  try {
    return recognize(file);
  } catch (const Error&) {
    return FileKind::kUnknown;
  }
}

}  // namespace

std::string wrong_file_hint(const CLI::App& app, const std::string& message) {
  const CLI::App& command = command_reached(app);
  const std::map<std::string, Kinds>* taken = taken_by(command);
  if (taken == nullptr) return {};
  for (const auto& [argument, kinds] : *taken) {
    const CLI::Option* option = command.get_option_no_throw(argument);
    if (option == nullptr) continue;
    for (const std::string& file : option->results()) {
      if (message.find(file) == std::string::npos) continue;
      const FileKind kind = kind_of(file);
      if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) continue;
      const std::string offer = offer_for(kind, file);
      if (!offer.empty()) return "; it is " + offer;
    }
  }
  return {};
}

}  // namespace spherule
