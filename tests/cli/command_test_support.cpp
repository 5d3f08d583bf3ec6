// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

#include "tests/support/child_process.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <thread>

namespace spherule {
namespace {

namespace fs = std::filesystem;

// Where the streams of a run are recorded.
constexpr const char* kOut = ".out";
constexpr const char* kErr = ".err";

// Long work logs its progress every ten seconds: how many lines that are depends on the machine.
std::string without_progress(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("spherule: progress: ")) continue;
    result += line;
    if (!lines.eof()) result += '\n';
  }
  return result;
}

}  // namespace

Words::Words(const char* line) {
  std::istringstream stream(line);
  for (std::string word; stream >> word;) push_back(word);
}

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

::testing::AssertionResult has(const std::string& text, const std::string& part) {
  const bool found = text.find(part) != std::string::npos;
  return (found ? ::testing::AssertionSuccess() : ::testing::AssertionFailure())
         << "\"" << part << "\" in:\n"
         << text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

nlohmann::json scene_of(const std::string& page) {
  const std::string start = "<script id=\"scene\" type=\"application/json\">";
  const std::size_t begin = page.find(start);
  const std::size_t end = page.find("</script>", begin);
  EXPECT_NE(begin, std::string::npos);
  EXPECT_NE(end, std::string::npos);
  return nlohmann::json::parse(page.substr(begin + start.size(), end - begin - start.size()));
}

std::vector<float> floats_of(const std::string& text) {
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255u);
  }
  std::vector<float> numbers(bytes.size() / 4);
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * 4);
  return numbers;
}

void CommandTest::SetUp() {
  std::string pattern = (fs::temp_directory_path() / "spherule-cli-XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  folder_ = pattern;
}

void CommandTest::TearDown() {
  fs::remove_all(folder_);
  fs::remove_all(folder_.string() + "-bin");
}

pid_t CommandTest::start(const Words& arguments) {
  return start_process(
      SPHERULE_COMMAND, arguments,
      {.folder = folder_, .out = kOut, .error = kErr, .environment = environment_});
}

Outcome CommandTest::finish(pid_t process) {
  return {.exit_code = wait_for(process),
          // A run that is killed at once has recorded nothing.
          .out = exists(kOut) ? read(kOut) : "",
          .err = exists(kErr) ? without_progress(read(kErr)) : ""};
}

Outcome CommandTest::run(const Words& arguments) {
  return finish(start(arguments));
}

Outcome CommandTest::interrupted(const Words& arguments, int signal, const std::string& file) {
  for (int milliseconds = 500; milliseconds < 100000; milliseconds *= 2) {
    const pid_t process = start(arguments);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(process, signal);
    Outcome outcome = finish(process);
    EXPECT_EQ(outcome.exit_code, -signal) << outcome.out << outcome.err;
    if (exists(file)) return outcome;
  }
  ADD_FAILURE() << "no answer";
  return {};
}

void CommandTest::expect_refusal(const Words& arguments, const std::string& reason) {
  const std::string line = ::testing::PrintToString(arguments);
  const Outcome result = run(arguments);
  EXPECT_EQ(result.exit_code, 2) << line;
  EXPECT_EQ(result.out, "") << line;
  EXPECT_TRUE(result.err.starts_with("spherule: ")) << line << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << line << result.err;
  EXPECT_TRUE(has(result.err, reason)) << line;
}

void CommandTest::expect_refusals(const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) expect_refusal(refusal.arguments, refusal.reason);
}

Outcome CommandTest::expect_exit(int exit_code, const Words& arguments) {
  Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit_code, exit_code)
      << ::testing::PrintToString(arguments) << outcome.out << outcome.err;
  return outcome;
}

void CommandTest::expect_said(int exit_code, const Words& arguments, const std::string& part) {
  const Outcome outcome = expect_exit(exit_code, arguments);
  EXPECT_TRUE(has(outcome.out + outcome.err, part));
}

nlohmann::json CommandTest::expect_json(int exit_code, const Words& arguments) {
  return nlohmann::json::parse(expect_exit(exit_code, joined(arguments, "--json")).out);
}

Outcome CommandTest::type(const std::string& line) {
  std::error_code there;
  const std::string home = folder_.string();
  fs::create_directory(home + "-bin", there);
  fs::create_symlink(SPHERULE_COMMAND, home + "-bin/spherule", there);
  return finish(start_process(
      "/bin/sh", {"-c", line},
      {.folder = folder_,
       .out = kOut,
       .error = kErr,
       .environment = {"HOME=" + home, "PATH=" + home + "-bin:" + std::getenv("PATH")}}));
}

void CommandTest::write(const std::string& file, const std::string& bytes) {
  std::ofstream stream(folder_ / file, std::ios::binary);
  stream << bytes;
  ASSERT_TRUE(stream.flush());
}

std::string CommandTest::read(const std::string& file) const {
  std::ifstream stream(folder_ / file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

nlohmann::json CommandTest::read_json(const std::string& file) const {
  return nlohmann::json::parse(read(file));
}

bool CommandTest::exists(const std::string& file) const {
  return fs::exists(folder_ / file);
}

std::vector<std::string> CommandTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with('.')) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

void CommandTest::write_box(const std::string& file, const std::array<double, 3>& size) {
  // Corner k has the coordinates of its bits; two triangles a side, seen from outside.
  static constexpr int kTriangles[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                            {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                            {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  std::ostringstream text;
  text << "solid box\n";
  for (const auto& triangle : kTriangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int corner : triangle) {
      text << "vertex";
      for (std::size_t axis = 0; axis < 3; ++axis) text << " " << (corner >> axis & 1) * size[axis];
      text << "\n";
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid box\n";
  write(file, text.str());
}

void CommandTest::write_spheres(const std::string& file,
                                const std::vector<std::array<double, 4>>& spheres) {
  nlohmann::json json = {{"format", "spherule-spheres"},
                         {"version", 1},
                         {"spheres", nlohmann::json::array()},
                         {"options", nlohmann::json::object()}};
  for (const auto& [x, y, z, radius] : spheres) {
    json["spheres"].push_back({{"center", {x, y, z}}, {"radius", radius}});
  }
  write(file, json.dump());
}

}  // namespace spherule
