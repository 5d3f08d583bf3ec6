// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/model_file.h"
#include "cli/files/model_unit.h"
#include "simplifier/simplify.h"

#include <optional>
#include <string>

namespace spherule {

// What spheres are proved against as they were fitted: the simplified solid, which is made anew,
// where D is known, else the mesh and its inside; or one that was made already. Not copied: the
// options refer to it.
class SolidProof {
 public:
  SolidProof(const TriangleMesh& mesh, const SimplifyOptions& options, bool has_diameter);
  SolidProof(const SimplifyOptions& options, std::optional<ExternalSpheres> external);
  SolidProof(const SolidProof&) = delete;
  SolidProof& operator=(const SolidProof&) = delete;

  const CertifyOptions& options() const { return options_; }
  const std::optional<ExternalSpheres>& external() const { return external_; }

 private:
  std::optional<ExternalSpheres> external_;
  std::vector<Zone> zones_;
  CertifyOptions options_;
};

// Takes D from the command line, if it is there, in the place of that of the file.
bool take_min_external(const std::optional<double>& min_external, SimplifyOptions& options);

// Fills in the unit and the scale that the file of spheres was made with, as `stored` has them,
// where the command line has none. Throws Error where it has another unit.
void take_stored_unit(const std::string& spheres, const SphereFile& file,
                      const ModelReadOptions& stored, UnitArguments& unit);

}  // namespace spherule
