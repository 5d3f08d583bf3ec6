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

// XML. The root element's children tell URDF from SRDF.
bool is_srdf(const std::filesystem::path& path);
RobotSpheres read_sphere_urdf(const std::filesystem::path& path);
RobotSpheres read_sphere_srdf(const std::filesystem::path& path);
std::string sphere_urdf(const RobotSpheres& spheres, const SphereFileContext& context,
                        const std::filesystem::path& path);
// A new file, or an existing one with other spheres, and with the pairs that it neither disables
// nor enables yet; everything else stays.
std::string sphere_srdf(const RobotSpheres& spheres, const SphereFileContext& context);

// YAML: cuRobo or XRDF.
SphereFormatFile read_sphere_yaml(std::string_view text, const std::filesystem::path& path);
// An existing file with other spheres of these links, and with the pairs that it does not ignore
// yet. Everything else stays as data: comments and layout are lost, aliases are written out. What
// it switches off stays, and so do the spheres of other links; those of a file beside come into
// this one.
std::string with_spheres(std::string_view text, const std::filesystem::path& path,
                         const RobotSpheres& spheres, SphereFormat format);
// A new file.
std::string sphere_curobo(const RobotSpheres& spheres, const SphereFileContext& context);
std::string sphere_xrdf(const RobotSpheres& spheres, const SphereFileContext& context);

// JSON: all of the others but Bradshaw's.
SphereFormatFile read_sphere_json(std::string_view text, const std::filesystem::path& path,
                                  const SphereReadOptions& options);
std::string sphere_foam(const RobotSpheres& spheres);
std::string sphere_json(const RobotSpheres& spheres);

}  // namespace spherule::internal
