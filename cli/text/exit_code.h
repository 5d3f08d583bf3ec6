// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule {

// Exit codes of every command. What "no" means stands with each command: what is not
// proved (fit, baseline), a leak (audit, audit-robot), a collision (collide, check).
inline constexpr int kYes = 0;
inline constexpr int kNo = 1;
inline constexpr int kBadInput = 2;

}  // namespace spherule
