// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
