// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/link_size.h"

#include <sstream>

namespace spherule::internal {
namespace {

// Nobody wants the hundred million spheres that such a link requires.
constexpr double kMostErrorsAcross = 1e4;
// A link above the first length is probably in millimetres, as is one above the second that is
// also so many times its E across.
constexpr double kMostMetresAcross = 100.0;
constexpr double kUsualMetresAcross = 10.0;
constexpr double kUsualErrorsAcross = 1e3;
constexpr const char* kScaleOfMillimetres =
    "their scale has to be 0.001 (in a URDF: <mesh scale=\"0.001 0.001 0.001\" .../>)";

}  // namespace

std::string size_fault(double across, double max_error) {
  if (across <= kMostErrorsAcross * max_error) return "";
  std::ostringstream text;
  text << "is " << across << " m across, too much for a max error of " << max_error
       << " m: are its meshes in millimetres? Then " << kScaleOfMillimetres;
  return text.str();
}

std::string size_doubt(double across, double max_error) {
  const bool is_large = across > kUsualMetresAcross && across > kUsualErrorsAcross * max_error;
  if (!is_large && across <= kMostMetresAcross) return "";
  std::ostringstream text;
  text << "it is " << across << " m across: if its meshes are in millimetres, "
       << kScaleOfMillimetres;
  if (is_large) text << "; so many times the max error takes long";
  return text.str();
}

}  // namespace spherule::internal
