// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/files.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/help/help.h"
#include "cli/text/progress.h"
#include "io/mesh_io.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

namespace spherule {
namespace {

// What the binary formats of the project begin with (docs/tree-file.md, docs/link-pairs-file.md).
constexpr std::string_view kTreeStart = "\x89SPT";
constexpr std::string_view kPairsStart = "\x89SLP";

// What only files of a kind hold, as far as is known.
struct Mark {
  std::string_view text;
  FileKind kind;
};
constexpr std::array kJsonMarks = {
    Mark{"\"spherule-report\"", FileKind::kReport},
    Mark{"\"spherule-bodies-report\"", FileKind::kReport},
    Mark{"\"spherule-robot-report\"", FileKind::kReport},
    Mark{"\"spherule-spheres\"", FileKind::kSpheres},
    Mark{"\"spherule-scene\"", FileKind::kScene},
    Mark{"\"spherule-zones\"", FileKind::kZones},
    Mark{"\"spherule-robot-spheres\"", FileKind::kRobotSpheres},
    Mark{"\"deepest_leak\"", FileKind::kReport},
    Mark{"\"collision_spheres\"", FileKind::kRobotSpheres},
    Mark{"\"SubSpheres\"", FileKind::kRobotSpheres},
    Mark{"\"radii\"", FileKind::kRobotSpheres},
    Mark{"\"spheres\"", FileKind::kRobotSpheres},
};
constexpr std::string_view kPageMark = "name=\"generator\" content=\"spherule\"";
// Both describe a robot; a group of an SRDF has links, too.
constexpr std::array kRobotMarks = {
    Mark{"<link_sphere_approximation", FileKind::kSrdf},
    Mark{"<disable_collisions", FileKind::kSrdf},
    Mark{"<group", FileKind::kSrdf},
    Mark{"<link", FileKind::kUrdf},
    Mark{"<robot", FileKind::kSrdf},
};
constexpr std::array kYamlMarks = {
    Mark{"collision_spheres", FileKind::kRobotSpheres},
    Mark{"geometry", FileKind::kRobotSpheres},
};
constexpr std::array<std::string_view, 5> kTableEndings = {".csv", ".txt", ".xyz", ".asc", ".pts"};

// Whether one of the first two lines begins with a number: the first may have names.
bool is_table(std::string_view text) {
  for (int line = 0; line < 2 && !text.empty(); ++line) {
    const std::size_t at = text.find_first_not_of(" \t\r\n");
    if (at == std::string_view::npos) return false;
    text.remove_prefix(at);
    const std::size_t sign = text.front() == '-' || text.front() == '+' ? 1 : 0;
    if (sign < text.size() && (std::isdigit(static_cast<unsigned char>(text[sign])) != 0))
      return true;
    text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
  }
  return false;
}

template <std::size_t Count>
FileKind first_of(const std::array<Mark, Count>& marks, std::string_view text) {
  const auto found = std::find_if(marks.begin(), marks.end(), [&](const Mark& mark) {
    return text.find(mark.text) != std::string_view::npos;
  });
  return found == marks.end() ? FileKind::kUnknown : found->kind;
}

std::size_t after_mark_of_utf8(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? kMark.size() : 0;
}

std::string without_comments(std::string_view text) {
  std::string result;
  for (;;) {
    const std::size_t begin = text.find("<!--");
    result += text.substr(0, begin);
    if (begin == std::string_view::npos) return result;
    text.remove_prefix(begin + 4);
    const std::size_t end = text.find("-->");
    if (end == std::string_view::npos) return result;
    text.remove_prefix(end + 3);
  }
}

// The name of the first element, without a prefix; before it come declarations ("<?", "<!").
std::string_view root_of(std::string_view text) {
  std::size_t at = text.find('<');
  while (at < text.size() && text.substr(at + 1, 1).find_first_of("?!") == 0) {
    at = text.find('<', at + 1);
  }
  if (at == std::string_view::npos) return {};
  const std::string_view name = text.substr(at + 1);
  const std::string_view whole = name.substr(0, name.find_first_of(" \t\r\n/>"));
  return whole.substr(whole.rfind(':') + 1);
}

FileKind kind_of_markup(std::string_view bytes) {
  const std::string text = without_comments(bytes);
  const std::string_view root = root_of(text);
  if (root == "COLLADA") return FileKind::kMesh;
  if (root == "robot") return first_of(kRobotMarks, text);
  return text.find(kPageMark) != std::string::npos ? FileKind::kPage : FileKind::kUnknown;
}

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

namespace fs = std::filesystem;

fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = absolute_path(path);
  const fs::path place = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : place;
}

}  // namespace

FileKind recognize(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  if (bytes.starts_with(kTreeStart)) return FileKind::kTree;
  if (bytes.starts_with(kPairsStart)) return FileKind::kPairs;
  if (is_cad_file(path) || bytes.starts_with("ISO-10303-21")) return FileKind::kCad;
  const std::string ending = lower_ending(path);
  const std::size_t start = bytes.find_first_not_of(" \t\r\n", after_mark_of_utf8(bytes));
  const char first = start == std::string::npos ? '\0' : bytes[start];
  FileKind kind = FileKind::kUnknown;
  if (first == '{' || first == '[') {
    // The names of what is in a scene are anything.
    const bool is_gltf = ending == ".gltf" && bytes.find("\"asset\"") != std::string::npos;
    kind = is_gltf ? FileKind::kMesh : first_of(kJsonMarks, bytes);
  }
  if (first == '<') kind = ending == ".xacro" ? FileKind::kUrdf : kind_of_markup(bytes);
  if (ending == ".yml" || ending == ".yaml" || ending == ".xrdf") {
    kind = first_of(kYamlMarks, bytes);
  }
  if (kind != FileKind::kUnknown) return kind;
  const bool may_be_table =
      std::find(kTableEndings.begin(), kTableEndings.end(), ending) != kTableEndings.end();
  const bool is_cloud = ending == ".pcd" && bytes.find("FIELDS") != std::string::npos;
  if (is_cloud || (may_be_table && is_table(bytes))) return FileKind::kTable;
  return has_mesh_ending(path) ? FileKind::kMesh : FileKind::kUnknown;
}

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

bool has_mesh_ending(const std::filesystem::path& path) {
  const std::string ending = lower_ending(path);
  return std::ranges::any_of(mesh_endings(),
                             [&](const std::string& one) { return ending == "." + one; });
}

std::string offer_for(FileKind kind, const std::string& file) {
  static const std::map<FileKind, std::string> kOffers = {
      {FileKind::kMesh, "a mesh (spherule fit FILE covers it with spheres)"},
      {FileKind::kCad, "a CAD part (spherule fit FILE covers it with spheres)"},
      {FileKind::kSpheres, "a set of spheres (spherule tree FILE builds its tree)"},
      {FileKind::kTree, "a sphere tree (spherule collide FILE OTHER.tree checks it)"},
      {FileKind::kUrdf, "a robot (spherule robot FILE covers it with spheres)"},
      {FileKind::kSrdf, "an SRDF (spherule check-srdf ROBOT.urdf FILE judges its pairs)"},
      {FileKind::kRobotSpheres,
       "a file of a robot's spheres (spherule audit-robot ROBOT.urdf FILE proves whether they "
       "cover)"},
      {FileKind::kPairs, "a file of proofs of pairs of links (spherule check ... --pairs FILE)"},
      {FileKind::kScene, "a scene (spherule check ROBOT.urdf FILE PATH.csv checks a robot in it)"},
      {FileKind::kZones, "a file of zones (spherule fit MESH --zones FILE)"},
      {FileKind::kTable,
       "a table of numbers (spherule check ROBOT.urdf SCENE.json FILE checks it as a trajectory; a "
       "scene takes clouds of points)"},
      {FileKind::kReport, "a report (spherule view FILE shows what it has)"},
      {FileKind::kPage, "a page of spherule view (a browser shows it)"}};
  const auto found = kOffers.find(kind);
  if (found == kOffers.end()) return {};
  std::string offer = found->second;
  const std::size_t at = offer.find("FILE");
  return at == offer.npos ? offer : offer.replace(at, 4, file);
}

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

bool names_its_place(const Error& error) {
  const std::string& subject = error.subject();
  std::error_code fault;
  return subject.starts_with("--") || subject.find('/') != std::string::npos ||
         std::filesystem::exists(subject, fault);
}

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  std::set<fs::path> taken;
  for (const fs::path& input : inputs) {
    if (!input.empty()) taken.insert(place_of(input));
  }
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    std::error_code error;
    const fs::path folder = absolute_path(output).parent_path();
    if (!fs::is_directory(folder, error))
      throw Error(output.string(), "no such folder; make it first");
    if (fs::is_directory(output, error)) throw Error(output.string(), "is a folder");
    write_uninterrupted([&] { check_writable(output); });
    if (!taken.insert(place_of(written_file(output))).second) {
      throw Error(output.string(), "is named twice, as input or output");
    }
  }
}

std::string default_output(const fs::path& input, const char* ending, FileKind kind) {
  std::string output = input.filename().replace_extension(ending).string();
  std::error_code error;
  if (fs::exists(output, error) && recognize(output) != kind) {
    throw Error(output, "is there already, and is something else; name another place (--output)");
  }
  return output;
}

}  // namespace spherule
