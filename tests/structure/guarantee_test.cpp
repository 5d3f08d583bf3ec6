// SPDX-License-Identifier: BSD-3-Clause
// docs/guarantee.md: each guarantee names files of its proof, which cite it, and tests that stand
// in the file named.

#include "tests/structure/repository.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

// Whether the source defines the GoogleTest case "Suite.Name".
bool defines_test(const std::string& source, const std::string& name) {
  const std::size_t dot = name.find('.');
  const std::regex definition("\\bTEST(_F|_P)?\\(" + name.substr(0, dot) + ",\\s*" +
                              name.substr(dot + 1) + "\\)");
  return std::regex_search(source, definition);
}

struct Section {
  std::vector<std::string> proofs;
  std::vector<std::pair<std::string, std::string>> tests;  // name, file
};

// By the heading of the guarantee, "G1" and so on.
std::map<std::string, Section> sections_of(const std::string& page) {
  static const std::regex kHeading(R"(^### (G\d+): .*)");
  static const std::regex kQuoted("`([^`]+)`");
  static const std::regex kTest("^- Test: `([^`]+)` in `([^`]+)`$");
  std::map<std::string, Section> sections;
  Section* current = nullptr;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, kHeading)) {
      current = &sections[match[1]];
    } else if (line.starts_with("## ")) {
      current = nullptr;
    } else if (current && line.starts_with("- Proof: ")) {
      for (std::sregex_iterator i(line.begin(), line.end(), kQuoted), end; i != end; ++i) {
        current->proofs.push_back((*i)[1]);
      }
    } else if (current && line.starts_with("- Test: ")) {
      EXPECT_TRUE(std::regex_match(line, match, kTest)) << line;
      if (!match.empty()) current->tests.emplace_back(match[1], match[2]);
    }
  }
  return sections;
}

TEST(Guarantee, NamesProofsAndTestsThatExist) {
  const auto sections = sections_of(text_of(kRoot / "docs/guarantee.md"));
  ASSERT_EQ(sections.size(), 9u);
  for (const auto& [guarantee, section] : sections) {
    EXPECT_FALSE(section.proofs.empty()) << guarantee;
    EXPECT_FALSE(section.tests.empty()) << guarantee;
    for (const std::string& file : section.proofs) {
      ASSERT_TRUE(fs::is_regular_file(kRoot / file)) << guarantee << ": " << file;
      EXPECT_TRUE(std::regex_search(text_of(kRoot / file), std::regex("\\b" + guarantee + "\\b")))
          << file << " does not cite " << guarantee;
    }
    for (const auto& [name, file] : section.tests) {
      EXPECT_TRUE(defines_test(text_of(kRoot / file), name)) << guarantee << ": " << name;
    }
  }
}

// A comment may cite "G4" only if the page defines it.
TEST(Guarantee, CitedNumbersAreDefined) {
  const auto sections = sections_of(text_of(kRoot / "docs/guarantee.md"));
  static const std::regex kCitation(R"(\bG([1-9][0-9]?)\b)");
  std::size_t cited = 0;
  for (const char* folder : {"adapters", "collide", "mesh", "robot", "simplifier", "spheretree"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".h" && file.extension() != ".cpp" && file.extension() != ".md") {
        continue;
      }
      const std::string text = text_of(file);
      for (std::sregex_iterator i(text.begin(), text.end(), kCitation), end; i != end; ++i) {
        EXPECT_TRUE(sections.contains((*i)[0])) << file << ": " << (*i)[0];
        ++cited;
      }
    }
  }
  EXPECT_GT(cited, 20u);
}

TEST(Guarantee, AMissingTestIsNoticed) {
  EXPECT_TRUE(defines_test("TEST(Sweep, KeepsAClearance) {", "Sweep.KeepsAClearance"));
  EXPECT_FALSE(defines_test("TEST(Sweep, KeepsAClearances) {", "Sweep.KeepsAClearance"));
  EXPECT_FALSE(defines_test("// Sweep.KeepsAClearance", "Sweep.KeepsAClearance"));
}

}  // namespace
}  // namespace spherule
