// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/spheres_in_metres.h"

#include "spheretree/error.h"
#include "spheretree/sphere_file.h"
#include "spheretree/text/text.h"

#include <string>
#include <utility>
#include <variant>

namespace spherule::internal {

std::vector<Sphere> load_spheres_in_metres(const std::filesystem::path& path) {
  SphereFile file = load_spheres(path);
  const auto units = file.options.find("units");
  if (units != file.options.end()) {
    const auto* name = std::get_if<std::string>(&units->second);
    if (name == nullptr || *name != "m") {
      throw Error(path.string(), "has its lengths in " +
                                     (name == nullptr ? "an unknown unit" : in_quotes(*name)) +
                                     ", as its options say; robots and scenes are in metres (see "
                                     "--units and --scale of fit)");
    }
  }
  return std::move(file.spheres);
}

}  // namespace spherule::internal
