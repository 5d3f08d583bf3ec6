// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_formats.h"

#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "base/text.h"
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

struct FormatFacts {
  SphereFormat format;
  std::string_view name;
  std::string_view option;  // of the command; empty where the format is not written
  std::string_view ending;  // of the file's name, after the robot's
};

constexpr FormatFacts kFacts[] = {
    {SphereFormat::kUrdf, "spherized URDF", "urdf", ".spheres.urdf"},
    {SphereFormat::kSrdf, "SRDF", "srdf", ".srdf"},
    {SphereFormat::kCurobo, "cuRobo yml", "curobo", ".curobo.yml"},
    {SphereFormat::kXrdf, "XRDF", "xrdf", ".xrdf"},
    {SphereFormat::kFoam, "foam JSON", "foam", ".foam.json"},
    {SphereFormat::kSpherule, "spherule JSON", "json", ".spheres.json"},
    {SphereFormat::kBallpark, "ballpark JSON", "", ""},
    {SphereFormat::kMorphit, "MorphIt JSON", "", ""},
    {SphereFormat::kIrmv, "IRMV JSON", "", ""},
    {SphereFormat::kBradshaw, "sphere tree (.sph)", "", ""},
    {SphereFormat::kSphereFile, "spherule JSON of one mesh", "", ""},
};

const FormatFacts& facts(SphereFormat format) {
  return *std::find_if(std::begin(kFacts), std::end(kFacts),
                       [&](const FormatFacts& row) { return row.format == format; });
}

void check_name(const std::string& name, const std::string& what, const std::string& file) {
  const std::string fault = internal::fault_of_name(name);
  if (!fault.empty()) throw Error(file, what + ", " + internal::in_quotes(name) + ", " + fault);
}

void check_writable(const RobotSpheres& spheres, SphereFormat format, const std::string& file) {
  if (spheres.links.empty()) throw Error(file, "there are no links to be written");
  if (!spheres.robot.empty()) check_name(spheres.robot, "the robot's name", file);
  std::set<std::string> names;
  for (const LinkSpheres& link : spheres.links) {
    check_name(link.link, "the name of a link", file);
    if (link.link.size() > internal::kLongestName) {
      throw Error(file, "the name of a link is too long: \"" + link.link + "\"");
    }
    const std::string subject = "link \"" + link.link + "\"";
    if (!names.insert(link.link).second) throw Error(file, subject + " is there twice");
    for (const Sphere& sphere : link.spheres) {
      if (!is_usable(sphere)) throw Error(file, subject + " has a sphere that is not usable");
      if (format != SphereFormat::kSpherule && sphere.radius == 0.0) {
        throw Error(file, subject + " has a sphere of radius 0, which means none in this format");
      }
    }
  }
  for (const DisabledPair& pair : spheres.self_collision_ignore) {
    check_name(pair.link_a, "the name of an ignored link", file);
    check_name(pair.link_b, "the name of an ignored link", file);
    if (!pair.reason.empty()) check_name(pair.reason, "a reason", file);
  }
  bool finite = std::isfinite(spheres.collision_buffer);
  for (const auto* buffers : {&spheres.self_collision_buffer, &spheres.collision_buffers}) {
    for (const auto& [link, length] : *buffers) {
      check_name(link, "the name of a link with a buffer", file);
      finite = finite && std::isfinite(length);
    }
  }
  if (!finite) throw Error(file, "a buffer is not finite");
}

void check_context(const SphereFileContext& context, SphereFormat format, const std::string& file) {
  if (format != SphereFormat::kCurobo && format != SphereFormat::kXrdf) return;
  for (const std::string& name : context.joint_names) check_name(name, "a joint's name", file);
  for (const std::string& name : {context.base_link, context.tool_link}) {
    if (!name.empty()) check_name(name, "the name of a link", file);
  }
  for (const double position : context.joint_positions) {
    if (!std::isfinite(position)) throw Error(file, "a joint's position is not finite");
  }
}

std::string written(const RobotSpheres& spheres, SphereFormat format,
                    const SphereFileContext& context, const fs::path& path) {
  const fs::path& original = context.original;
  switch (format) {
    case SphereFormat::kUrdf:
      return internal::sphere_urdf(spheres, context, path);
    case SphereFormat::kSrdf:
      return internal::sphere_srdf(spheres, context);
    case SphereFormat::kFoam:
      return internal::sphere_foam(spheres);
    case SphereFormat::kSpherule:
      return internal::sphere_json(spheres);
    case SphereFormat::kCurobo:
      return original.empty()
                 ? internal::sphere_curobo(spheres, context)
                 : internal::with_spheres(read_file(original), original, spheres, format);
    case SphereFormat::kXrdf:
      return original.empty()
                 ? internal::sphere_xrdf(spheres, context)
                 : internal::with_spheres(read_file(original), original, spheres, format);
    default:
      throw Error(path.string(), std::string(name_of(format)) + " is read only");
  }
}

std::string checked_text(const RobotSpheres& spheres, SphereFormat format,
                         const SphereFileContext& context, const fs::path& path) {
  check_writable(spheres, format, path.string());
  check_context(context, format, path.string());
  return written(spheres, format, context, path);
}

// Sphere trees of Bradshaw's toolkit.
constexpr std::size_t kMostNodes = 100'000'000;

bool is_count(double value) {
  return value >= 1.0 && value <= 64.0 && value == static_cast<double>(static_cast<int>(value));
}

// The numbers of a line; nothing if a part of it is no number.
std::optional<std::vector<double>> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  for (const std::string_view word : internal::words_of(line)) {
    const std::optional<double> number = internal::finite_number(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

// How many levels and children a node, or nothing.
std::optional<std::pair<std::size_t, std::size_t>> heading(std::string_view line) {
  const auto numbers = numbers_of(line);
  if (!numbers || numbers->size() != 2) return std::nullopt;
  if (!is_count((*numbers)[0]) || !is_count((*numbers)[1])) return std::nullopt;
  return std::pair(static_cast<std::size_t>((*numbers)[0]),
                   static_cast<std::size_t>((*numbers)[1]));
}

bool is_bradshaw(std::string_view text) {
  return heading(internal::take_line(text)).has_value();
}

RobotSpheres read_bradshaw(std::string_view text, const std::string& file,
                           const SphereReadOptions& options) {
  internal::SphereGatherer gathered(file);
  const auto [levels, branch] = *heading(internal::take_line(text));
  const std::size_t level = options.level.value_or(levels - 1);
  gathered.unless(level < levels, {}, "has only " + std::to_string(levels) + " levels");
  gathered.begin_link(options.link, {});
  // Nodes breadth first: those of level l are branch^l after all of the levels above.
  std::size_t width = 1;
  std::size_t line = 2;
  for (std::size_t here = 0; here < levels; ++here) {
    for (std::size_t node = 0; node < width; ++node, ++line) {
      const std::string place = "line " + std::to_string(line);
      gathered.unless(!text.empty(), place, "a node is missing");
      const auto row = numbers_of(internal::take_line(text));
      gathered.unless(row && row->size() >= 5, place, "is not \"x y z r occupancy\"");
      // A node that is not used has a negative radius; it is none that is switched off.
      if (here != level || (*row)[3] < 0.0) continue;
      gathered.add({(*row)[0], (*row)[1], (*row)[2]}, (*row)[3], place);
    }
    width *= branch;
    gathered.unless(width <= kMostNodes, {}, "has too many nodes");
  }
  return std::move(gathered.spheres);
}

}  // namespace

std::string_view name_of(SphereFormat format) {
  return facts(format).name;
}

bool is_written(SphereFormat format) {
  return !facts(format).option.empty();
}

std::optional<SphereFormat> sphere_format_named(std::string_view name) {
  for (const FormatFacts& row : kFacts) {
    if (!name.empty() && row.option == name) return row.format;
  }
  return std::nullopt;
}

std::string sphere_file_name(std::string_view robot, SphereFormat format) {
  std::string fault = internal::fault_of_name(robot);
  if (robot.find_first_of("/\\") != std::string_view::npos) fault = "has a slash";
  if (robot.size() > 200) fault = "is too long";
  if (!fault.empty())
    throw Error("the robot's name", fault + ", so that no file is named after it");
  if (!is_written(format)) throw Error(std::string(name_of(format)), "is read only");
  return std::string(robot) + std::string(facts(format).ending);
}

SphereFormatFile read_robot_spheres(const fs::path& path, const SphereReadOptions& options) {
  const std::string bytes = read_file(path);
  std::string_view text = bytes;
  text.remove_prefix(internal::byte_order_mark(text).size());
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos) throw Error(path.string(), "is empty");
  const std::string file = path.string();
  switch (text[start]) {
    case '<':
      if (internal::is_srdf(path)) return {SphereFormat::kSrdf, internal::read_sphere_srdf(path)};
      return {SphereFormat::kUrdf, internal::read_sphere_urdf(path)};
    case '{':
    case '[':
      return internal::read_sphere_json(text, path, options);
    default:
      break;
  }
  if (is_bradshaw(text)) {
    return {SphereFormat::kBradshaw, read_bradshaw(text, file, options)};
  }
  return internal::read_sphere_yaml(text, path);
}

bool is_of_one_mesh(const SphereFormatFile& file) {
  return file.spheres.links.size() == 1 && file.spheres.links.front().link.empty();
}

std::vector<LinkSpheres> shrunk_by_buffers(const RobotSpheres& spheres) {
  std::vector<LinkSpheres> links;
  for (const LinkSpheres& link : spheres.links) {
    const auto own = spheres.collision_buffers.find(link.link);
    const double buffer =
        own == spheres.collision_buffers.end() ? spheres.collision_buffer : own->second;
    links.push_back({link.link, {}});
    for (Sphere sphere : link.spheres) {
      if (buffer < 0.0) sphere.radius = add_down(sphere.radius, buffer);
      if (sphere.radius >= 0.0) links.back().spheres.push_back(sphere);
    }
  }
  return links;
}

void write_robot_spheres(const RobotSpheres& spheres, SphereFormat format,
                         const SphereFileContext& context, const fs::path& path) {
  write_file_atomically(path, checked_text(spheres, format, context, path));
}

void check_robot_spheres(const RobotSpheres& spheres, SphereFormat format,
                         const SphereFileContext& context, const fs::path& path) {
  checked_text(spheres, format, context, path);
}

}  // namespace spherule

namespace spherule::internal {

void SphereGatherer::refuse(const std::string& place, const std::string& reason) const {
  throw Error(file_, place.empty() ? reason : place + ": " + reason);
}

void SphereGatherer::begin_link(const std::string& name, const std::string& place) {
  take_name(name, place);
  unless(links_.insert(name).second, place, "the link \"" + name + "\" is there twice");
  spheres.links.push_back({name, {}});
}

void SphereGatherer::add(const Eigen::Vector3d& center, double radius, const std::string& place) {
  unless(left_ > 0, place, "aliases make more spheres than the file has characters");
  --left_;
  const Sphere sphere{center, radius};
  if (radius <= 0.0) {
    leave_out(spheres.links.back().link, sphere);
    return;
  }
  unless(is_usable(sphere), place, "a number is beyond 1e15");
  spheres.links.back().spheres.push_back(sphere);
}

void SphereGatherer::leave_out(const std::string& link, const Sphere& sphere) {
  ++spheres.switched_off;
  left_out[link].push_back(sphere);
}

void SphereGatherer::take(std::size_t count, const std::string& place) const {
  unless(count <= names_left_, place, "aliases make far more names than the file has characters");
  names_left_ -= count;
}

void SphereGatherer::take_name(const std::string& name, const std::string& place) const {
  // The place may hold the name.
  unless(name.size() <= kLongestName, place.size() <= kLongestName ? place : std::string(),
         "the name of a link has more than " + std::to_string(kLongestName) + " bytes");
  unless(name.size() <= name_bytes_left_, place,
         "aliases make far more names than the file has characters");
  name_bytes_left_ -= name.size();
}

void SphereGatherer::ignore(const std::string& link_a, const std::string& link_b,
                            const std::string& place) {
  take_name(link_a, place);
  take_name(link_b, place);
  if (link_a == link_b || !ignored_.insert(std::minmax(link_a, link_b)).second) return;
  spheres.self_collision_ignore.push_back({link_a, link_b, {}});
}

// With u = 2^-53: sines and cosines are within 1 u of values of at most 1 (2 u for a library that
// rounds less well), so that an entry of the product of three rotations, a sum of two products of
// at most three factors, is within 16 u; a row of it times the centre within 32 u of the centre's
// norm, the three rows within 56 u of it, and the sum with the translation adds 1 u of both. Half a
// dozen more u for the bounds' own rounding.
Sphere moved_sphere(const Sphere& sphere, const Eigen::Vector3d& roll_pitch_yaw,
                    const Eigen::Vector3d& translation) {
  if (sphere.center.isZero(0.0)) return {translation, sphere.radius};  // exact, however it turns
  const Eigen::Vector3d& angles = roll_pitch_yaw;
  const double sr = std::sin(angles.x()), cr = std::cos(angles.x());
  const double sp = std::sin(angles.y()), cp = std::cos(angles.y());
  const double sy = std::sin(angles.z()), cy = std::cos(angles.z());
  Eigen::Matrix3d rotation;
  rotation << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,          //
      -sp, cp * sr, cp * cr;
  const double error =
      64.0 * kUnitRoundoff * (norm_upper(sphere.center) + norm_upper(translation)) + kUnderflow;
  return {rotation * sphere.center + translation, add_up(sphere.radius, error)};
}

}  // namespace spherule::internal
