// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sphere trees in files.
//
// @code{.cpp}
// #include <spherule/spheretree/sphere_tree.h>
// #include <spherule/spheretree/tree_file.h>
// #include <cassert>
// #include <filesystem>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}};
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.tree";
// spherule::save_tree(spherule::build_tree(spheres), path);
// assert(spherule::load_tree(path).spheres()[1] == spheres[1]);
// @endcode

#include "spheretree/sphere_tree.h"

#include <filesystem>

namespace spherule {

// Writes the tree in the binary format of docs/tree-file.md: magic, format version, counts, the
// arrays as little-endian IEEE doubles and 32-bit integers, and a checksum of all of it. The file
// appears whole or not at all. Equal trees give equal bytes. Throws Error, naming
// the file, if it cannot be written.
void save_tree(const SphereTree& tree, const std::filesystem::path& path);

// Reads it back: the same numbers bit for bit. Throws Error, naming file and reason, if it is not
// such a file, is cut short or too long, has a newer version or a wrong checksum, or if the tree in
// it breaks an invariant of SphereTree.
SphereTree load_tree(const std::filesystem::path& path);

}  // namespace spherule
