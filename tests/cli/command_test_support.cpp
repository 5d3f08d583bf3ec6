// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

#include "tests/support/child_process.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

namespace spherule {
namespace {

namespace fs = std::filesystem;

// Where the streams of a run are recorded, hidden from files().
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

void CommandTest::SetUp() {
  std::string pattern = (fs::temp_directory_path() / "spherule-cli-XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  folder_ = pattern;
}

void CommandTest::TearDown() {
  fs::remove_all(folder_);
}

pid_t CommandTest::start(const std::vector<std::string>& arguments) {
  return start_process(SPHERULE_COMMAND, arguments,
                       {.folder = folder_, .out = kOut, .error = kErr});
}

Outcome CommandTest::finish(pid_t process) {
  return {.exit_code = wait_for(process),
          // A run that is killed at once has recorded nothing.
          .out = exists(kOut) ? read(kOut) : "",
          .err = exists(kErr) ? without_progress(read(kErr)) : ""};
}

Outcome CommandTest::run(const std::vector<std::string>& arguments) {
  return finish(start(arguments));
}

void CommandTest::expect_refusal(const std::vector<std::string>& arguments,
                                 const std::string& reason) {
  const Outcome result = run(arguments);
  std::string line;
  for (const std::string& argument : arguments) line += argument + " ";
  EXPECT_EQ(result.exit_code, 2) << line;
  EXPECT_EQ(result.out, "") << line;
  EXPECT_TRUE(result.err.starts_with("spherule: ")) << line << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << line << result.err;
  EXPECT_NE(result.err.find(reason), std::string::npos) << line << result.err;
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
    if (name != kOut && name != kErr) names.push_back(name);
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
