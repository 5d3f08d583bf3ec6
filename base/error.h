// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The exception for input that cannot be used.
//
// @code{.cpp}
// #include <spherule/spheretree/sphere_tree.h>
// #include <spherule/base/error.h>
// #include <cassert>
//
// bool is_refused = false;
// try {
//   spherule::build_tree({}, {.branching = 8});  // no spheres
// } catch (const spherule::Error& error) {
//   is_refused = error.what() == error.subject() + ": " + error.reason();
// }
// assert(is_refused);
// @endcode

#include <stdexcept>
#include <string>

namespace spherule {

// Bad input: a file, a mesh, an option, a pose or another argument that cannot be used. Thrown by
// readers, option checks, constructors, and by queries for arguments that they cannot take (a
// negative clearance, a configuration of the wrong size, an object that was moved from), never for
// what a query finds. `what()` is "subject: reason", where the subject names the file, the option
// or the argument.
class Error : public std::runtime_error {
 public:
  // What cannot be used, and why.
  Error(const std::string& subject, const std::string& reason)
      : std::runtime_error(subject + ": " + reason), subject_(subject), reason_(reason) {}

  // The two parts of what().
  const std::string& subject() const noexcept { return subject_; }
  const std::string& reason() const noexcept { return reason_; }

 private:
  std::string subject_;
  std::string reason_;
};

}  // namespace spherule
