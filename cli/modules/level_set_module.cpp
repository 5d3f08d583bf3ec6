// SPDX-License-Identifier: BSD-3-Clause
#include "cli/modules/module.h"

extern "C" {
extern const spherule::LevelSetModule spherule_module;
const spherule::LevelSetModule spherule_module = {.pack = &spherule::level_set_packing};
}
