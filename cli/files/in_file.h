// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"

#include <string>
#include <string_view>
#include <utility>

namespace spherule {

// Whether the subject of an error is a file or an option, so that a person knows where to look.
bool names_its_place(const Error& error);

// What `action` returns. An exception of the type, for which `is_of_file` holds, becomes an Error
// that has the file it comes from in front.
template <class Exception = Error, class IsOfFile, class Action>
auto blame_file_if(IsOfFile is_of_file, const std::string& file, Action action) {
  try {
    return action();
  } catch (const Exception& error) {
    if (!is_of_file(error)) throw;
    throw Error(file, error.what());
  }
}

// For what depends on nothing but the file.
template <class Exception = Error, class Action>
auto blame_file(const std::string& file, Action action) {
  return blame_file_if<Exception>([](const Exception&) { return true; }, file, std::move(action));
}

// For a file that an option names, if there is one: for errors whose subject begins like this.
template <class Action>
auto blame_named_file(const std::string& file, std::string_view subject, Action action) {
  return blame_file_if(
      [&](const Error& error) { return !file.empty() && error.subject().starts_with(subject); },
      file, std::move(action));
}

// For errors that do not name their place, but a link, say.
template <class Action>
auto in_file(const std::string& file, Action action) {
  return blame_file_if([](const Error& error) { return !names_its_place(error); }, file,
                       std::move(action));
}

}  // namespace spherule
