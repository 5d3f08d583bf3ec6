// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Proofs about pairs of links in files (docs/link-pairs-file.md).
//
// @code{.cpp}
// #include <spherule/robot/pairs/link_pairs_file.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// const std::vector<spherule::LinkBody> bodies{{.link = 0, .spheres = sphere},
//                                              {.link = 1, .spheres = sphere}};
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.pairs";
// spherule::save_link_pairs(spherule::prove_link_pairs(robot, bodies), path);
// const spherule::LinkPairs pairs = spherule::load_link_pairs(path, robot, bodies);
// assert(pairs.find(0, 1)->verdict == spherule::PairVerdict::kTouching);
// @endcode

#include "robot/pairs/link_pairs.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace spherule {

// Writes proofs to a file, at once or not at all (spheretree/atomic_file.h): little-endian bytes,
// one for each node of a tree of boxes, and a checksum. Throws Error naming the file.
void save_link_pairs(const LinkPairs& pairs, const std::filesystem::path& path);

// Reads them for the robot and the bodies they were made for. Limits that are tighter than those of
// the proofs leave them valid; a witness may then be beyond them. Throws Error naming the file: for
// one that cannot be read, is damaged, is no such file or of a later version; for another robot,
// that is, another mechanism, mesh, sphere or attached body; and for limits of a joint that are
// wider than those the proofs were made with.
LinkPairs load_link_pairs(const std::filesystem::path& path, const RobotModel& robot,
                          std::span<const LinkBody> bodies);

namespace internal {

// The content apart from the file system, for tests; `name` becomes the subject of an Error.
std::string encode_link_pairs(const LinkPairs& pairs);
LinkPairs decode_link_pairs(std::string_view bytes, const std::string& name);

}  // namespace internal

}  // namespace spherule
