// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres in a file, with what is proved of them.
//
// @code{.cpp}
// #include <spherule/io/sphere_file.h>
// #include <cassert>
// #include <filesystem>
//
// spherule::SphereFile file;
// file.spheres = {{{0, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}};
// file.options["max-error"] = 0.1;
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.json";
// spherule::save_spheres(file, path);
// assert(spherule::load_spheres(path).spheres == file.spheres);
// @endcode

#include "geometry/pose.h"
#include "geometry/sphere.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace spherule {

// What a Certificate (simplifier/types/simplification.h) says, as stored beside the spheres.
// Lengths in the unit of the spheres.
struct CertificateRecord {
  bool covered = false;
  // Proved bounds on the largest distance from a point of the solid to the union of the spheres.
  double uncovered_depth_lower = 0.0;
  double uncovered_depth_upper = 0.0;
  // Proved upper bounds on the protrusion; absent where it was not requested.
  std::optional<double> protrusion_over_simplified_max = std::nullopt;
  std::optional<double> protrusion_over_mesh_max = std::nullopt;
  // Proved upper bounds of the protrusion over the simplified solid of the points of the spheres in
  // each zone, in the order of the zones in the options; empty without zones.
  std::vector<double> protrusion_in_zones = {};
  std::size_t sphere_count = 0;  // the number of spheres in the file, checked by both functions
  // Volume of the union of the spheres over the volume of the solid mesh, estimated.
  std::optional<double> volume_ratio = std::nullopt;
  // Volume between the solid and the mesh, and its standard error, estimated.
  std::optional<double> filled_volume = std::nullopt;
  std::optional<double> filled_volume_error = std::nullopt;
  // Proved: a way into the solid that is wider than D by more than this has not been filled.
  std::optional<double> closing_slack = std::nullopt;
};

// What an option in a file may be.
using OptionValue = std::variant<bool, std::int64_t, double, std::string>;

// That a body is another one, moved rigidly.
struct BodyCopy {
  std::size_t of = 0;  // index of the other, which comes before it and is no copy itself
  Pose pose;           // from the other's place to its own
};

// One of several bodies in a file. Its spheres follow those of the bodies before it.
struct BodyRecord {
  std::string name;
  std::size_t sphere_count = 0;
  std::optional<CertificateRecord> certificate = std::nullopt;  // of these spheres, about this body
  std::map<std::string, OptionValue> options = {};              // of its fit; empty for a copy
  std::optional<BodyCopy> copy = std::nullopt;
  bool interrupted = false;  // SphereFile::interrupted, of this body
};

// The content of a SPHERES.json file. Infinite values cannot be stored in JSON; they are written as
// the strings "inf" and "-inf", which therefore cannot be the text of an option.
struct SphereFile {
  std::vector<Sphere> spheres;
  std::optional<CertificateRecord> certificate;
  // The options of the fit under their command-line names without dashes ("max-error").
  std::map<std::string, OptionValue> options;
  // Where the file is of several bodies: which spheres are whose. All of them together are
  // `spheres`, in one frame, and `certificate` is about all bodies; `options` are those that all of
  // them have. Programs that know nothing of bodies may pass over them.
  std::vector<BodyRecord> bodies = {};
  // The search for few spheres was interrupted: the certificate holds, but there may be more
  // spheres than a whole search leaves, and bodies that it did not come to have none.
  bool interrupted = false;
};

// Writes {"format":"spherule-spheres","version":1,...}, and for several bodies "bodies":
// [{"name","sphere_count","certificate","options","copy_of","pose":[x,y,z,qx,qy,qz,qw]},...], the
// last two of copies only; "interrupted":true where it is, beside "spheres" and in bodies; doubles
// survive the round trip bit for bit.
// The file appears whole or not at all. Equal content gives equal bytes. Throws Error naming the
// file if it cannot be written or holds something that load_spheres() would refuse.
void save_spheres(const SphereFile& file, const std::filesystem::path& path);

// Throws Error, naming file and reason, for a file that cannot be read, is not JSON, is not of this
// format or a newer version of it, holds a number that is not usable (is_usable), a value of a
// wrong type, a key twice, a certificate for another number of spheres, or bodies whose numbers of
// spheres do not add up, without a name or copies of none before them. Keys that are not known are
// passed over.
SphereFile load_spheres(const std::filesystem::path& path);

}  // namespace spherule
