// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/next_step.h"

#include "base/text.h"
#include "cli/text/message.h"

#include <cctype>
#include <filesystem>
#include <string_view>

namespace spherule {
namespace {

constexpr std::string_view kPlain = "-_./=,:+@%";

std::string shell_word(const std::string& word) {
  bool is_plain = !word.empty();
  std::string quoted = "'";
  for (const char c : word) {
    is_plain = is_plain && (std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                            kPlain.find(c) != std::string_view::npos);
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return is_plain ? word : quoted + "'";
}

// A word with control characters, which a terminal must not see, as bash and zsh read it back.
std::string escaped_word(const std::string& word) {
  std::string result = "$'";
  for (const char c : word) {
    if (c == '\\' || c == '\'') result += '\\';
    result += c;
  }
  return one_line(result) + "'";
}

}  // namespace

std::string describe(const std::vector<NextStep>& steps) {
  std::string text;
  for (const NextStep& step : steps) {
    text += text.empty() ? "next: spherule" : "      spherule";
    for (const std::string& word : step.words) {
      text.append(" ").append(one_line(word) == word ? shell_word(word) : escaped_word(word));
    }
    text.append("    # ").append(step.purpose).append("\n");
  }
  return text;
}

std::string beside(const std::string& path, const std::string& ending) {
  return std::filesystem::path(path).replace_extension(ending).string();
}

std::string here(const std::string& path, const std::string& ending) {
  return beside(std::filesystem::path(path).filename().string(), ending);
}

void repeat(const std::string& option, const std::string& value, std::vector<std::string>& words) {
  if (!value.empty()) words.insert(words.end(), {option, value});
}

void repeat(const std::string& option, std::optional<double> value,
            std::vector<std::string>& words) {
  if (value) repeat(option, internal::number_text(*value), words);
}

}  // namespace spherule
