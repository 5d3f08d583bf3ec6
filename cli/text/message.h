// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace spherule {

// The text on one line that a terminal shows as it is: control characters, which names of files and
// links may hold, and what is not UTF-8 as "\n", "\t", "\r" or "\x1b".
std::string one_line(std::string_view text);

// A line of its own on standard error: "spherule: MESSAGE", and "spherule: warning: MESSAGE". Of a
// message of more than 4000 bytes the middle is left out.
void tell(std::string_view message);
void warn(std::string_view message);

// "SUBJECT: WARNING" of each.
void warn_each(const std::string& subject, std::span<const std::string> warnings);

}  // namespace spherule
