// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The formats of robot/formats/sphere_formats.h, a family of syntax each: what is made of the text
// of a file, and the text that is written.

#include "robot/formats/sphere_formats.h"

#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule::internal {

// Messages repeat the name of a link for each of its spheres.
inline constexpr std::size_t kLongestName = 4096;

// Gathers what a reader finds, and refuses what no format may hold. A place is where in the file
// ("line 7", "link arm, sphere 2"); an Error names the file, then the place.
class SphereGatherer {
 public:
  // Of a file of so many bytes: more spheres than that, eight times as many names, or 64 times as
  // many bytes of names of links, are aliases of each other, which a reader would not come to an
  // end with. (Some maps are read several times.)
  explicit SphereGatherer(std::string file,
                          std::size_t bytes = std::numeric_limits<std::size_t>::max() / 64)
      : file_(std::move(file)),
        left_(bytes),
        names_left_(8 * bytes),
        name_bytes_left_(64 * bytes) {}

  [[noreturn]] void refuse(const std::string& place, const std::string& reason) const;
  void unless(bool good, const std::string& place, const std::string& reason) const {
    if (!good) refuse(place, reason);
  }

  // The link to which the next spheres belong.
  void begin_link(const std::string& name, const std::string& place);
  // Before so many names, of members or of links, are read.
  void take(std::size_t count, const std::string& place) const;
  // Before the name of a link is kept.
  void take_name(const std::string& name, const std::string& place) const;
  // Leaves out a sphere that is switched off.
  void add(const Eigen::Vector3d& center, double radius, const std::string& place);
  // Leaves out and counts a sphere of a link.
  void leave_out(const std::string& link, const Sphere& sphere);
  // Once for each two links, in whatever order.
  void ignore(const std::string& link_a, const std::string& link_b, const std::string& place);

  const std::string& file() const { return file_; }
  RobotSpheres spheres;
  std::map<std::string, std::vector<Sphere>> left_out;  // by link

 private:
  std::string file_;
  std::size_t left_;  // how many spheres may still come
  mutable std::size_t names_left_;
  mutable std::size_t name_bytes_left_;
  std::set<std::string> links_;
  std::set<std::pair<std::string, std::string>> ignored_;
};

// A sphere that contains the sphere about `center` moved by the rotation of roll, pitch and yaw
// about the fixed axes x, y, z and then by `translation`.
Sphere moved_sphere(const Sphere& sphere, const Eigen::Vector3d& roll_pitch_yaw,
                    const Eigen::Vector3d& translation);

// XML. The root element's children tell URDF from SRDF, which srdf.h reads.
bool is_srdf(const std::filesystem::path& path);
RobotSpheres read_sphere_urdf(const std::filesystem::path& path);
std::string sphere_urdf(const RobotSpheres& spheres, const SphereFileContext& context,
                        const std::filesystem::path& path);
std::string sphere_srdf(const RobotSpheres& spheres, const SphereFileContext& context);
// An SRDF with other spheres, and with the pairs that it neither disables nor enables yet; all
// other bytes as they are. Throws Error where these do not read back as before, of a text that is
// not well-formed XML.
std::string kept_srdf(const RobotSpheres& spheres, const std::filesystem::path& original);
// Its elements for pairs and spheres, each line indented and ended.
std::string srdf_pairs(std::span<const DisabledPair> pairs, const std::string& indent);
std::string srdf_spheres(std::span<const LinkSpheres> links, const std::string& indent);

// YAML: cuRobo or XRDF.
SphereFormatFile read_sphere_yaml(std::string_view text, const std::filesystem::path& path);
// A file with other spheres of these links, and with the pairs that it does not ignore yet: all
// other bytes as they are or, where its style does not allow that, written anew without its
// comments. What it switches off stays, and so do the spheres of other links; those of a file
// beside come into this one.
std::string with_spheres(std::string_view text, const std::filesystem::path& path,
                         const RobotSpheres& spheres, SphereFormat format);
// A new file.
std::string sphere_curobo(const RobotSpheres& spheres, const SphereFileContext& context);
std::string sphere_xrdf(const RobotSpheres& spheres, const SphereFileContext& context);
// The spheres of all links as a block of YAML, each line indented by `indent` spaces and ended.
std::string yaml_spheres(const RobotSpheres& spheres, int indent);

// Links that are not tested against a first one, with a reason each.
struct IgnoredLinks {
  std::string first;
  std::vector<std::string> others{};
  std::vector<std::string> reasons{};
};
// The first one of a pair is the one that comes first in `order`: cuRobo searches for it there
// only.
std::vector<IgnoredLinks> ignored_links(std::span<const DisabledPair> pairs,
                                        const std::vector<std::string>& order);
// "first: [a, b]", and "# REASON: a, b" for the end of the line.
std::string yaml_ignored(const IgnoredLinks& list);
std::string yaml_reasons(const IgnoredLinks& list);
// A comment without control characters, which readers refuse.
std::string yaml_comment(std::string text);

// JSON: all of the others but Bradshaw's.
SphereFormatFile read_sphere_json(std::string_view text, const std::filesystem::path& path,
                                  const SphereReadOptions& options);
std::string sphere_foam(const RobotSpheres& spheres);
std::string sphere_json(const RobotSpheres& spheres);

// Bradshaw's .sph.
bool is_bradshaw(std::string_view text);
RobotSpheres read_bradshaw(std::string_view text, const std::string& file,
                           const SphereReadOptions& options);

}  // namespace spherule::internal
