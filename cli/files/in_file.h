// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/error.h"

#include <string>

namespace spherule {

// Whether the subject of an error is a file or an option, so that a person knows where to look.
bool names_its_place(const Error& error);

// What `action` returns. An Error of it that does not name its place, a link's name say, gets that
// of the file it comes from in front.
template <class Action>
auto in_file(const std::string& file, Action action) {
  try {
    return action();
  } catch (const Error& error) {
    if (names_its_place(error)) throw;
    throw Error(file, error.what());
  }
}

}  // namespace spherule
