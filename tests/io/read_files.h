// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "io/mesh_io.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::test {

// Reads files that tests make, each by read_mesh() from a folder of the test.
class ReadFiles : public ::testing::Test {
 protected:
  TriangleMesh read(const std::string& extension, std::string_view bytes) {
    return read_mesh(dir_.write("part." + extension, bytes));
  }
  // The message of the error that reading throws; of a file, its subject is the file.
  std::string error(const std::filesystem::path& file, double scale = 1.0) {
    try {
      read_mesh(file, {.scale = scale});
    } catch (const Error& e) {
      EXPECT_TRUE(e.subject() == file.string() || e.subject() == "scale") << e.subject();
      return e.what();
    }
    return "";
  }
  std::string error(const std::string& extension, std::string_view bytes) {
    return error(dir_.write("part." + extension, bytes));
  }
  ::testing::AssertionResult refused(const std::filesystem::path& file, const std::string& why,
                                     double scale = 1.0) {
    const std::string message = error(file, scale);
    if (message.find(why) != std::string::npos) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "'" << message << "' lacks '" << why << "'";
  }
  ::testing::AssertionResult refused(const std::string& extension, std::string_view bytes,
                                     const std::string& why) {
    return refused(dir_.write("part." + extension, bytes), why);
  }

  // Files that differ from a good one by a replacement, and a part of what is said of each.
  struct Refusal {
    std::string from, to, why;
  };
  void expect_refused(const std::string& extension, const std::string& good,
                      const std::vector<Refusal>& refusals,
                      const std::function<std::string(const std::string&)>& file_of = {}) {
    for (const auto& [from, to, why] : refusals) {
      const std::string text = replaced(good, from, to);
      EXPECT_TRUE(refused(extension, file_of ? file_of(text) : text, why)) << from << " -> " << to;
    }
  }
  // The text with its first `from`, which has to be there, replaced.
  static std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  TriangleMesh cube_ = cube_mesh();
  TempDir dir_;
};

}  // namespace spherule::test
