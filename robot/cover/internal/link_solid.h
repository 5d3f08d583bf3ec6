// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/certificate.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <string>
#include <vector>

namespace spherule::internal {

// For a person: D was to be chosen for a link, and is more than 4 E.
std::string link_diameter_warning(double min_external_diameter);

// S of a link's mesh, by the rule of simplify() for lengths that are 0, and how a cover of it is
// examined. Not copied: the options refer to it.
class LinkSolid {
 public:
  // Throws Error as simplified_solid().
  LinkSolid(const TriangleMesh& mesh, const SimplifyOptions& lengths,
            std::size_t max_cells = ExternalOptions::kMostCells);
  LinkSolid(const LinkSolid&) = delete;
  LinkSolid& operator=(const LinkSolid&) = delete;

  const ExternalSpheres& external() const { return solid_.external; }
  const CertifyOptions& certify_options() const { return certify_options_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  SimplifiedSolid solid_;
  CertifyOptions certify_options_;
  std::vector<std::string> warnings_;
};

}  // namespace spherule::internal
