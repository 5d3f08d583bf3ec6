// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The old name of this header.
#include "tests/collide/scene_random.h"
#include "tests/support/random_scene.h"
