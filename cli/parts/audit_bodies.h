// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model_unit.h"
#include "cli/options/length_options.h"

#include <optional>
#include <string>
#include <vector>

namespace spherule {

struct SphereFile;

// What the command line of `audit` says.
struct AuditArguments {
  std::vector<std::string> models = {""};
  std::string spheres;
  std::vector<std::string> more;  // as written: further models, and then the spheres
  UnitArguments unit;
  std::optional<double> min_external;
  std::optional<double> max_error;
  LengthOptions lengths;
  std::string repaired;
  int threads = 0;
  bool json = false;
};

// `audit` of a file of several bodies, each by itself: of one that is no copy the proof of its
// spheres, of a copy that its spheres are those of the other, moved. Returns the exit code: kNo if
// any is not proved. Throws Error, also where the models have other bodies.
int audit_bodies(const AuditArguments& arguments, const SphereFile& file);

}  // namespace spherule
