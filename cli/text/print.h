// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

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

// The parts one after the other, as streams write them.
template <class... Parts>
std::string concat(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

// A number with so many significant digits.
std::string number(double value, int digits = 6);

// A number with so many digits behind the point.
std::string decimal(double value, int digits);

// A share in per cent.
std::string percent(double share, int digits = 2);

// A number with three digits, a bound of it in that direction.
enum class Rounding { kDown, kUp };
std::string three_digits(double value, Rounding rounding);

// A table of rows of as many cells each, of which there is one at least: columns as wide as their
// widest cell, no blanks at the ends of lines; each cell as one_line() says.
std::string aligned(std::vector<std::vector<std::string>> rows);

// A command that a user is likely to want next, and what for. What is not known of it, another
// part's tree say, stands there as a placeholder in capitals, or as its form ("x y z qx qy qz qw").
struct NextStep {
  std::vector<std::string> words;
  std::string purpose;
};

// A line for each, to be copied into a shell: names of files are quoted where they need it.
std::string describe(const std::vector<NextStep>& steps);

// The name of a file beside `path`: with another ending, ".html" say, in the place of its own.
std::string beside(const std::string& path, const std::string& ending);
// The same name in the current folder, where what is made of others' files goes.
std::string here(const std::string& path, const std::string& ending);

// Robots are stored in metres; people are told millimetres.
inline constexpr double kMillimetresPerMetre = 1000.0;

// Exit codes of every command. What "no" means stands with each command: what is not
// proved (fit, robot), a leak (audit, audit-robot), a collision (collide, check).
inline constexpr int kYes = 0;
inline constexpr int kNo = 1;
inline constexpr int kBadInput = 2;

// Whether a code point is a control character, which a terminal obeys: C0, DEL and C1 (U+0080 to
// U+009F, two bytes in UTF-8).
constexpr bool is_control_character(unsigned code_point) {
  return code_point < 0x20U || (code_point >= 0x7FU && code_point < 0xA0U);
}

// Two hexadecimal digits.
inline std::string hex(unsigned byte) {
  constexpr const char* kDigits = "0123456789abcdef";
  return {kDigits[byte >> 4U & 15U], kDigits[byte & 15U]};
}

}  // namespace spherule
