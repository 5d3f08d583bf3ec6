// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::test {

// Why an action throws an Error; "nothing is wrong" if it does not.
template <class Action>
std::string reason_of(const Action& action, const std::string& subject = {}) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_TRUE(subject.empty() || error.subject() == subject) << error.what();
    return error.reason();
  }
  return "nothing is wrong";
}

// All that the Error says, with its subject.
template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing is wrong";
}

// Why read(file) refuses a file of this text; the subject has to be the file.
template <class Read>
std::string refusal_of(std::string_view text, const Read& read) {
  const TempDir folder;
  const std::filesystem::path file = folder.write("input", text);
  return reason_of([&] { read(file); }, file.string());
}

// A text that is refused, and parts of the reason.
struct BadText {
  std::string text;
  std::vector<std::string> reasons;
};

template <class Read>
void expect_refusals(const std::vector<BadText>& texts, const Read& read) {
  for (const auto& [text, reasons] : texts) {
    const std::string refusal = refusal_of(text, read);
    for (const std::string& reason : reasons) {
      EXPECT_NE(refusal.find(reason), std::string::npos)
          << text << "\nis refused because: " << refusal << "\nand not: " << reason;
    }
  }
}

}  // namespace spherule::test
