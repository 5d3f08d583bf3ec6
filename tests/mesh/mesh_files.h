// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The old name of this header.
#include "tests/support/mesh_files.h"
