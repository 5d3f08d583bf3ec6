// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The old name of this header.
#include "tests/support/counting_new.h"
