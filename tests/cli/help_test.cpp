// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <system_error>
#include <utility>

namespace spherule {
namespace {

// The help of every command by its words, the list of all commands last.
using Pages = std::vector<std::pair<Words, std::string>>;
using RunCommand = std::function<Outcome(const Words&)>;

// The lines below a heading that ends like this, whatever its letters' case, up to an empty line.
std::vector<std::string> lines_below(const std::string& help, const std::string& heading) {
  std::vector<std::string> lines;
  bool below = false;
  for (const std::string& line : lines_of(help)) {
    if (below && line.empty()) break;
    if (below) lines.push_back(line);
    std::string lower = line;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    below = below || lower.ends_with(heading);
  }
  return lines;
}

// The first words of these lines; further lines of a description are further to the right.
Words names_below(const std::string& help, const std::string& heading) {
  Words names;
  for (const std::string& line : lines_below(help, heading)) {
    if (line.size() > 2 && line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return names;
}

// The command lines under "Examples:".
std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> examples;
  for (const std::string& line : lines_below(help, "examples:")) {
    if (line.starts_with("  spherule ")) examples.push_back(line.substr(2));
  }
  return examples;
}

Pages help_pages(const RunCommand& run, const Words& command = {}) {
  Pages pages;
  const Outcome outcome = run(joined(command, "--help"));
  EXPECT_EQ(outcome.exit_code, 0);
  for (const std::string& inner : names_below(outcome.out, "commands:")) {
    const Pages below = help_pages(run, joined(command, inner));
    pages.insert(pages.end(), below.begin(), below.end());
  }
  pages.emplace_back(command, outcome.out);
  return pages;
}

bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

// A robot of one finger with what the examples name.
constexpr const char* kRobot = R"(<?xml version="1.0"?>
<robot name="robot">
  <link name="base">
    <visual><geometry><box size="0.008 0.001 0.001"/></geometry></visual>
    <collision><geometry><box size="0.008 0.001 0.001"/></geometry></collision>
  </link>
  <link name="hand">
    <visual><geometry><box size="0.008 0.001 0.001"/></geometry></visual>
    <collision><geometry><box size="0.008 0.001 0.001"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
</robot>
)";

class HelpTest : public CommandTest {
 protected:
  // A line as a user types it, in the folder, with the built command as `spherule`.
  Outcome type(const std::string& line) {
    std::filesystem::create_directories(folder_ / ".bin");
    std::error_code there;
    std::filesystem::create_symlink(SPHERULE_COMMAND, folder_ / ".bin/spherule", there);
    write(".line",
          "cd '" + folder_.string() + "'\nHOME=$PWD\nPATH=\"$PWD/.bin:$PATH\"\n" + line + "\n");
    const int status = std::system(
        ("sh '" + (folder_ / ".line").string() + "' >'" + (folder_ / ".typed").string() + "' 2>&1")
            .c_str());
    return {.exit_code = WEXITSTATUS(status), .out = read(".typed"), .err = ""};
  }

  // All files that the examples start from.
  void write_files() {
    // Without external spheres what is inside is found by a flood: quick in a bar.
    write_box("part.stl", {2, 0.1, 0.1});
    write_box("tool.stl", {0.1, 0.1, 3});
    write_spheres("tool.json", {{0, 0, 0, 2}});
    write_spheres("others.json", {{1, 0.05, 0.05, 0.9}});
    write("robot.urdf", kRobot);
    write("path.csv", "0.2\n0.3\n");
    write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
      {"name": "floor", "half_space": {}, "pose": {"position": [0, 0, -1]}}]})");
    for (const char* folder :
         {".zfunc", ".config/fish/completions", ".local/share/bash-completion/completions"}) {
      std::filesystem::create_directories(folder_ / folder);
    }
    ASSERT_EQ(type("spherule tree tool.json -o tool.tree").exit_code, 0);
#ifdef SPHERULE_HAS_ROBOT
    ASSERT_EQ(type("spherule robot robot.urdf -o . --effort 0").exit_code, 0);
#endif
  }
};

TEST_F(HelpTest, EveryCommandTellsItsExitCodesAndExamples) {
  const Pages pages = help_pages([this](const Words& line) { return run(line); });
  EXPECT_GE(pages.size(), 8u);
  for (const auto& [command, text] : pages) {
    EXPECT_TRUE(has(text, "xit codes: ")) << text;
    EXPECT_FALSE(examples_in(text).empty()) << text;
  }
}

TEST_F(HelpTest, ExamplesRun) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write_files();
  std::size_t count = 0;
  for (const auto& [command, text] : help_pages([this](const Words& line) { return run(line); })) {
    for (const std::string& example : examples_in(text)) {
      ++count;
      const Outcome outcome = type(example);
      EXPECT_EQ(outcome.exit_code, 0) << example << "\n" << outcome.out;
    }
  }
  EXPECT_GE(count, 15u);
}

class CompletionTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    for (const char* shell : {"bash", "fish", "zsh"}) {
      const Outcome script = expect_exit(0, {"completion", shell});
      write(std::string(".completion.") + shell, script.out);
    }
    write("part.stl", "");
    write("paper.txt", "");
    std::filesystem::create_directory(folder_ / "parts");
  }

  // What a shell prints, line by line, in the folder; without the command's own settings.
  Words shell(const std::string& program, const std::string& script) {
    write(".script", script);
    const std::string line =
        "cd '" + folder_.string() + "' && " + program + " ./.script >.replies 2>.faults </dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << read(".faults");
    return lines_of(read(".replies"));
  }

  // What bash offers for the last word of a command line; those before it are split at "=".
  Words offered(const Words& before, const std::string& last) {
    Words words = joined(SPHERULE_COMMAND, before);
    words.push_back(last);
    std::string script = "source ./.completion.bash\nCOMP_WORDS=(";
    for (const std::string& word : words) script += " '" + word + "'";
    script += ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
              "\n_spherule\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
    Words replies = shell("bash --norc --noprofile", script);
    std::erase(replies, "");
    std::sort(replies.begin(), replies.end());
    return replies;
  }
};

TEST_F(CompletionTest, BashCompletesCommandsAndTheirOptions) {
  for (const auto& [command, help] : help_pages([this](const Words& line) { return run(line); })) {
    SCOPED_TRACE(help);
    Words commands = names_below(help, "commands:");
    std::sort(commands.begin(), commands.end());
    if (!commands.empty()) {
      EXPECT_EQ(offered(command, ""), commands);
    }
    const Words options = offered(command, "--");
    EXPECT_FALSE(options.empty());
    for (const std::string& option : options) EXPECT_TRUE(has(help, option));
    for (const std::string& name : names_below(help, "options:")) {
      const std::size_t dashes = name.find("--");
      if (dashes == std::string::npos) continue;  // the head of a group
      EXPECT_NE(std::find(options.begin(), options.end(), name.substr(dashes)), options.end())
          << name;
    }
  }
}

TEST_F(CompletionTest, BashCompletesValuesAndFiles) {
  struct Case {
    Words before;
    std::string last;
    Words offers;
  };
  std::vector<Case> cases = {{"", "fi", "fit"},
                             {"fit part.stl --method", "", "cover paper"},
                             {"fit part.stl --method", "=", "cover paper"},
                             {"fit --method =", "pap", "paper"},
                             {"fit", "pa", "part.stl parts"},
                             {"fit", "pap", "paper.txt"},  // no mesh begins like that
                             {"fit --keep-concave-edges", "pa", "part.stl parts"},
                             {"info", "pa", "paper.txt part.stl parts"},
                             {"tree", "pa", "parts"},
                             {"fit part.stl -o", "pa", "paper.txt part.stl parts"},
                             {"fit --report =", "pa", "paper.txt part.stl parts"},
                             {"fit --seed", "", ""},
                             {"completion", "", "bash fish zsh"},
                             {"manual", "fi", "fit"}};
#ifdef SPHERULE_HAS_ROBOT
  cases.insert(cases.end(), {{"robot r.urdf --format", "urdf,cu", "urdf,curobo"},
                             {"robot r.urdf -o", "pa", "parts"},
                             {"robot --package x =", "pa", "parts"},
                             {"robot --package x", "=", "parts"},
                             {"robot --package", "pa", ""}});
#endif
  for (const Case& one : cases) {
    EXPECT_EQ(offered(one.before, one.last), one.offers)
        << ::testing::PrintToString(one.before) << one.last;
  }
}

TEST_F(CompletionTest, FishCompletes) {
  if (!is_installed("fish")) GTEST_SKIP() << "fish is not installed";
  const std::vector<std::pair<std::string, Words>> cases = {
      {"fi", "fit"},
      {"fit --meth", "--method"},
      {"fit --method ", "cover paper"},
      {"fit --zones pa", "paper.txt part.stl parts/"},
      {"fit pa", "part.stl parts/"},
      {"fit pap", "paper.txt"},
      {"completion ", "bash fish zsh"},
      {"manual fi", "fit"},
      {"manual fit --meth", ""}};
  for (const auto& [line, offers] : cases) {
    const std::string folder = std::filesystem::path(SPHERULE_COMMAND).parent_path().string();
    Words words =
        shell("fish --no-config", "set PATH " + folder + " $PATH\nsource ./.completion.fish\n" +
                                      "complete -C 'spherule " + line + "'\n");
    for (std::string& word : words) word = word.substr(0, word.find('\t'));
    std::sort(words.begin(), words.end());
    EXPECT_EQ(words, offers) << line;
  }
}

TEST_F(CompletionTest, ZshReadsItsScript) {
  if (!is_installed("zsh")) GTEST_SKIP() << "zsh is not installed";
  EXPECT_EQ(shell("zsh -f -n", read(".completion.zsh")), Words{});
  // What it asks for.
  EXPECT_EQ(run("completion zsh -- manual fi").out, "words\nfit\n");
  EXPECT_TRUE(has(run("completion zsh -- fi").out, "words\nfit:Cover a mesh"));
  EXPECT_EQ(run("completion zsh -- fit --method=pa").out, "words\n--method=paper\n");
}

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
};

TEST_F(ManualTest, EveryCommandHasAPageWithAllOfItsOptions) {
  expect_exit(0, "manual -o .");
  Pages pages = help_pages([this](const Words& line) { return run(line); });
  EXPECT_EQ(files().size(), pages.size());
  for (const auto& [command, help] : test::effort(std::move(pages), 5)) {
    std::string name = "spherule";
    for (const std::string& word : command) name += "-" + word;
    SCOPED_TRACE(name);
    std::string page = read(name + ".1");
    EXPECT_EQ(run(joined("manual", command)).out, page);
    std::erase(page, '\\');
    for (const std::string& option : names_below(help, "options:")) {
      if (option.find("--") == std::string::npos) continue;  // the head of a group
      EXPECT_TRUE(has(page, option.substr(option.find("--"))));
    }
  }
}

TEST_F(ManualTest, TheDayIsThatOfSourceDateEpoch) {
  EXPECT_TRUE(has(run("manual").out, "1970-01-02"));
  for (const char* epoch : {"", "soon", "12x", "9223372036854775807", "99999999999999999999"}) {
    setenv("SOURCE_DATE_EPOCH", epoch, 1);
    expect_refusal("manual", "SOURCE_DATE_EPOCH: ");
  }
}

TEST_F(ManualTest, FormattersFindNoFault) {
  expect_exit(0, "manual -o .");
  const std::vector<std::pair<std::string, std::string>> formatters = {
      {"groff", "groff -man -ww -Tutf8 -z"}, {"mandoc", "mandoc -T lint -W warning"}};
  for (const auto& [program, check] : formatters) {
    if (!is_installed(program)) continue;
    const std::string line = "cd '" + folder_.string() + "' && " + check + " ./*.1 >.said 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0);
    EXPECT_EQ(read(".said"), "");
  }
}

}  // namespace
}  // namespace spherule
