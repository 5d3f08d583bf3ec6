// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/help_pages.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace spherule {
namespace {

using Words = std::vector<std::string>;

class CompletionTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    for (const char* shell : {"bash", "fish", "zsh"}) {
      const Outcome script = run({"completion", shell});
      ASSERT_EQ(script.exit_code, 0) << script.err;
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

  // What bash offers for the last of the words of a command line, which it splits at "=".
  Words offered(const Words& words) {
    std::string script = "source ./.completion.bash\nCOMP_WORDS=(";
    for (const std::string& word : words) script += " '" + word + "'";
    script += ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
              "\n_spherule\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
    Words replies = shell("bash --norc --noprofile", script);
    std::erase(replies, "");
    std::sort(replies.begin(), replies.end());
    return replies;
  }

  bool has(const std::string& program) const {
    return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
  }
};

TEST_F(CompletionTest, BashCompletesCommandsAndTheirOptions) {
  const auto pages = help_pages([this](const auto& line) { return run(line); });
  for (const auto& [command, help] : pages) {
    Words line = {"spherule"};
    for (std::size_t at = 0; at < command.size();) {
      const std::size_t end = std::min(command.find(' ', at), command.size());
      line.push_back(command.substr(at, end - at));
      at = end + 1;
    }
    const Words commands = names_below(help, "Commands:");
    line.emplace_back();
    if (!commands.empty()) {
      Words sorted = commands;
      std::sort(sorted.begin(), sorted.end());
      EXPECT_EQ(offered(line), sorted) << command;
    }
    line.back() = "--";
    const Words options = offered(line);
    EXPECT_FALSE(options.empty()) << command;
    for (const std::string& option : options) {
      EXPECT_NE(help.find(option), std::string::npos) << command << " " << option;
    }
    for (const std::string& name : names_below(help, "Options:")) {
      const std::size_t dashes = name.find("--");
      if (dashes == std::string::npos) continue;  // the head of a group
      EXPECT_NE(std::find(options.begin(), options.end(), name.substr(dashes)), options.end())
          << command << " " << name;
    }
  }
}

TEST_F(CompletionTest, BashCompletesValuesAndFiles) {
  const Words methods = {"cover", "paper"};
  const Words files = {"paper.txt", "part.stl", "parts"};
  EXPECT_EQ(offered({"spherule", "fi"}), Words{"fit"});
  EXPECT_EQ(offered({"spherule", "fit", "part.stl", "--method", ""}), methods);
  EXPECT_EQ(offered({"spherule", "fit", "part.stl", "--method", "="}), methods);
  EXPECT_EQ(offered({"spherule", "fit", "--method", "=", "pap"}), Words{"paper"});
  EXPECT_EQ(offered({"spherule", "fit", "pa"}), (Words{"part.stl", "parts"}));
  EXPECT_EQ(offered({"spherule", "fit", "pap"}), Words{"paper.txt"});  // no mesh begins like that
  EXPECT_EQ(offered({"spherule", "info", "pa"}), files);
  EXPECT_EQ(offered({"spherule", "tree", "pa"}), Words{"parts"});
  EXPECT_EQ(offered({"spherule", "fit", "part.stl", "-o", "pa"}), files);
  EXPECT_EQ(offered({"spherule", "fit", "--report", "=", "pa"}), files);
  EXPECT_EQ(offered({"spherule", "fit", "--seed", ""}), Words{});
  EXPECT_EQ(offered({"spherule", "fit", "--keep-concave-edges", "pa"}),
            offered({"spherule", "fit", "pa"}));
  EXPECT_EQ(offered({"spherule", "completion", ""}), (Words{"bash", "fish", "zsh"}));
  EXPECT_EQ(offered({"spherule", "manual", "fi"}), Words{"fit"});
#ifdef SPHERULE_HAS_ROBOT
  EXPECT_EQ(offered({"spherule", "robot", "r.urdf", "--format", "urdf,cu"}), Words{"urdf,curobo"});
  EXPECT_EQ(offered({"spherule", "robot", "r.urdf", "-o", "pa"}), Words{"parts"});
  EXPECT_EQ(offered({"spherule", "robot", "--package", "x", "=", "pa"}), Words{"parts"});
  EXPECT_EQ(offered({"spherule", "robot", "--package", "x", "="}), Words{"parts"});
  EXPECT_EQ(offered({"spherule", "robot", "--package", "pa"}), Words{});
#endif
}

TEST_F(CompletionTest, FishCompletes) {
  if (!has("fish")) GTEST_SKIP() << "fish is not installed";
  const auto offers = [this](const std::string& line) {
    Words words =
        shell("fish --no-config", "source ./.completion.fish\ncomplete -C '" + line + "'\n");
    for (std::string& word : words) word = word.substr(0, word.find('\t'));
    std::sort(words.begin(), words.end());
    return words;
  };
  EXPECT_EQ(offers("spherule fi"), Words{"fit"});
  EXPECT_EQ(offers("spherule fit --meth"), Words{"--method"});
  EXPECT_EQ(offers("spherule fit --method "), (Words{"cover", "paper"}));
  EXPECT_EQ(offers("spherule fit --zones pa"), (Words{"paper.txt", "part.stl", "parts/"}));
  EXPECT_EQ(offers("spherule fit pa"), (Words{"part.stl", "parts/"}));
  EXPECT_EQ(offers("spherule fit pap"), Words{"paper.txt"});
  EXPECT_EQ(offers("spherule completion "), (Words{"bash", "fish", "zsh"}));
  EXPECT_EQ(offers("spherule manual fi"), Words{"fit"});
  EXPECT_EQ(offers("spherule manual fit --meth"), Words{});
}

TEST_F(CompletionTest, ZshReadsItsScript) {
  if (!has("zsh")) GTEST_SKIP() << "zsh is not installed";
  EXPECT_EQ(shell("zsh -f -n", read(".completion.zsh")), Words{});
  EXPECT_NE(read(".completion.zsh").find("'*:command:(fit audit "), std::string::npos);
  EXPECT_NE(read(".completion.zsh").find(R"(_files -g "*.(#i)(stl|obj|)"), std::string::npos);
}

}  // namespace
}  // namespace spherule
