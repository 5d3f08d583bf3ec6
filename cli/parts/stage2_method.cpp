// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/stage2_method.h"

#ifdef SPHERULE_HAS_BASELINES
#include "simplifier/baseline/medial_cover.h"
#include "simplifier/baseline/packing_cover.h"
#endif
#include "base/error.h"

#include <algorithm>

namespace spherule {
namespace {

const std::vector<Stage2Method>& phases_from_baselines() {
#ifdef SPHERULE_HAS_BASELINES
  static const std::vector<Stage2Method> kPhases = {{"medial", medial_cover},
                                                    {"packing", packing_cover}};
#else
  static const std::vector<Stage2Method> kPhases = {{"medial", {}}, {"packing", {}}};
#endif
  return kPhases;
}

}  // namespace

std::vector<std::string> fit_method_names() {
  std::vector<std::string> names = method_names();
  for (const Stage2Method& phase : phases_from_baselines()) names.push_back(phase.name);
  return names;
}

void choose_method(const std::string& name, SimplifyOptions& options) {
  const std::vector<Stage2Method>& phases = phases_from_baselines();
  const auto chosen = std::find_if(phases.begin(), phases.end(),
                                   [&](const Stage2Method& phase) { return phase.name == name; });
  if (chosen == phases.end()) {
    options.method = method_named(name);
    return;
  }
  if (!chosen->run) {
    throw Error("--method", "'" + name + "' needs a build with the option SPHERULE_BASELINES");
  }
  options.stage2_method = *chosen;
}

}  // namespace spherule
