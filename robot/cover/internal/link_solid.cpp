// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/link_solid.h"

#include <sstream>

namespace spherule::internal {
std::string link_diameter_warning(double min_external_diameter) {
  std::ostringstream text;
  text << "it is so large for its max error that D is " << min_external_diameter
       << " m instead of 4 E: narrower gaps are filled";
  return text.str();
}

LinkSolid::LinkSolid(const TriangleMesh& mesh, const SimplifyOptions& lengths,
                     std::size_t max_cells)
    : solid_(simplified_solid(mesh, lengths, max_cells)) {
  certify_options_ = {.external = &solid_.external,
                      .resolution = proof_resolution(solid_.options.max_error,
                                                     solid_.external.box.diagonal().norm()),
                      .protrusion_tolerance = 0.0,
                      .volume = false,
                      .threads = lengths.threads};
  if (solid_.larger_diameter) {
    warnings_.push_back(link_diameter_warning(solid_.options.min_external_diameter));
  }
}

}  // namespace spherule::internal
