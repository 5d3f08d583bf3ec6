// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/help_pages.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace spherule::manual_test {
namespace {

class ManualTest : public CommandTest {
 protected:
  // Pages that are made before and after midnight are to be equal.
  void SetUp() override {
    CommandTest::SetUp();
    setenv("SOURCE_DATE_EPOCH", "86400", 1);
  }
  void TearDown() override {
    unsetenv("SOURCE_DATE_EPOCH");
    CommandTest::TearDown();
  }

  // What a program that is not there, or says nothing, prints of all pages.
  std::string said_of_pages(const std::string& program) {
    const std::string line =
        "cd '" + folder_.string() + "' && " + program + " ./*.1 >.said 2>&1 </dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << read(".said");
    return read(".said");
  }
  bool has(const std::string& program) const {
    return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
  }
};

TEST_F(ManualTest, EveryCommandHasAPageWithAllOfItsOptions) {
  ASSERT_EQ(run({"manual", "-o", "."}).exit_code, 0);
  auto pages = help_pages([this](const auto& line) { return run(line); });
  EXPECT_EQ(files().size(), pages.size());
  pages = test::effort(std::move(pages), 5);
  for (const auto& [command, help] : pages) {
    std::string name = "spherule" + std::string(command.empty() ? "" : "-") + command;
    std::replace(name.begin(), name.end(), ' ', '-');
    std::string page = read(name + ".1");
    std::vector<std::string> names;
    for (std::size_t at = 0; at < command.size();) {
      const std::size_t end = std::min(command.find(' ', at), command.size());
      names.push_back(command.substr(at, end - at));
      at = end + 1;
    }
    names.insert(names.begin(), "manual");
    EXPECT_EQ(run(names).out, page);
    std::erase(page, '\\');
    for (const std::string& option : names_below(help, "Options:")) {
      if (option.find("--") == std::string::npos) continue;  // the head of a group
      EXPECT_NE(page.find(option.substr(option.find("--"))), std::string::npos) << name << option;
    }
    for (const std::string& example : examples_in(help)) {
      EXPECT_NE(page.find(example.substr(0, example.find_first_of("~\"'"))), std::string::npos)
          << example;
    }
    EXPECT_NE(page.find(".SH EXIT STATUS\n0 "), std::string::npos) << name;
  }
  expect_refusal({"manual", "frobnicate"}, "there is no command 'frobnicate'");
}

TEST_F(ManualTest, TheDayIsThatOfSourceDateEpoch) {
  EXPECT_NE(run({"manual"}).out.find(" 1 \"1970-01-02\" "), std::string::npos);
  for (const char* epoch : {"", "soon", "12x", "9223372036854775807", "99999999999999999999"}) {
    setenv("SOURCE_DATE_EPOCH", epoch, 1);
    expect_refusal({"manual"}, "SOURCE_DATE_EPOCH: ");
  }
}

TEST_F(ManualTest, PagesSayWhatOptionsNeedAndExclude) {
  std::string page = run({"manual", "fit"}).out;
  std::erase(page, '\\');
  EXPECT_NE(page.find("(not with --tool)"), std::string::npos) << page;
  page = run({"manual", "audit"}).out;
  std::erase(page, '\\');
  EXPECT_NE(page.find("(needs --repair)"), std::string::npos) << page;
}

TEST_F(ManualTest, FormattersFindNoFault) {
  ASSERT_EQ(run({"manual", "-o", "."}).exit_code, 0);
  if (!has("groff") && !has("mandoc")) GTEST_SKIP() << "neither groff nor mandoc is installed";
  if (has("groff")) {
    EXPECT_EQ(said_of_pages("groff -man -ww -Tutf8 -z"), "");
  }
  if (has("mandoc")) {
    EXPECT_EQ(said_of_pages("mandoc -T lint -W warning"), "");
  }
}

}  // namespace
}  // namespace spherule::manual_test
