// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace spherule {

enum class FileKind {
  kMesh,
  kCad,
  kSpheres,       // of one mesh (SPHERES.json)
  kTree,          //
  kUrdf,          // with or without spheres
  kSrdf,          //
  kRobotSpheres,  // any format of several links, but URDF and SRDF
  kPairs,         // of links
  kScene,         //
  kZones,         // of `fit`
  kTable,         // of numbers: a trajectory, or a cloud of points
  kReport,        // of `fit` or `robot`, or what `audit --json` printed
  kPage,          // of `view`
  kUnknown,
};

// What a file is, by its content; meshes also by the ending of their name. Nothing is checked but
// what tells the kinds apart. Throws Error if the file cannot be read.
FileKind recognize(const std::filesystem::path& path);

// The ending of a file's name, ".stl" say, in small letters.
std::string lower_ending(const std::filesystem::path& path);
// Whether the name ends as those of mesh files do.
bool has_mesh_ending(const std::filesystem::path& path);

// What a file of this kind is and which command takes it, for a message: "a sphere tree (spherule
// collide FILE OTHER.tree checks it)". Empty if it is not known.
std::string offer_for(FileKind kind, const std::string& file);

}  // namespace spherule
