// SPDX-License-Identifier: BSD-3-Clause
#include "cli/modules/module.h"

extern "C" {
extern const spherule::CadModule spherule_module;
const spherule::CadModule spherule_module = {.read = &spherule::read_cad,
                                             .read_bodies = &spherule::read_cad_bodies};
}
