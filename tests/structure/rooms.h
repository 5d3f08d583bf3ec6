// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace spherule {

using Names = std::vector<std::string_view>;

// A room, the rooms it may include besides itself, and the third parties that all of it may see;
// those that only named files may see stand in `files_that_see`.
struct Room {
  std::string_view folder;
  Names rooms;
  Names third_parties;
  std::vector<std::pair<std::string_view, std::string_view>> files_that_see = {};
  // A private room of a library: none of its headers is for users.
  bool is_private = false;
};

// The arrows of the project's plan: what each room may include.
const std::vector<Room>& rooms();

// Whether headers of `to` may be included by the files of `from`; false if there is no such room.
bool may_include(const Room* from, const Room* to);

// The innermost room that holds `path`, or null.
const Room* room_of(std::string_view path);

// The folder of the library that holds `path`; empty where none does.
std::string_view library_of(std::string_view path);

}  // namespace spherule
