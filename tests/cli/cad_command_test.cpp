// SPDX-License-Identifier: BSD-3-Clause
// CAD files as the command reads them: in a process of its own, whose end is an error at most.
#include "base/error.h"
#include "base/files.h"
#include "cli/cad/cad_message.h"
#include "tests/cli/command_test_support.h"
#include "tests/simplifier/cad/cad_parts.h"
#include "tests/support/child_process.h"
#include "tests/support/effort.h"

#include <csignal>
#include <cstddef>
#include <exception>
#include <limits>
#include <random>
#include <sys/wait.h>

namespace spherule {
namespace {

namespace fs = std::filesystem;

class CadCommand : public CommandTest {
 protected:
  // `spherule info part.step` with this script in the place of the program that reads it.
  Outcome run_with_reader(const std::string& script) {
    write("part.step", "");
    const fs::path modules = folder_ / SPHERULE_MODULES_FROM_PREFIX;
    fs::create_directories(folder_ / "bin");
    fs::create_directories(modules);
    const fs::path command = folder_ / "bin" / "spherule";
    fs::copy_file(SPHERULE_COMMAND, command, fs::copy_options::skip_existing);
    if (!script.empty()) {
      write((modules / "spherule_cad").string(), "#!/bin/sh\n" + script);
      fs::permissions(modules / "spherule_cad", fs::perms::owner_all);
    }
    return finish(start_process(command, Words("info part.step"),
                                {.folder = folder_, .out = ".out", .error = ".err"}));
  }

  void expect_end(const std::string& script, const std::string& reason) {
    const Outcome outcome = run_with_reader(script);
    EXPECT_EQ(outcome.exit_code, 2) << script;
    EXPECT_EQ(outcome.out, "") << script;
    EXPECT_TRUE(has(outcome.err, reason)) << script;
  }
};

void expect_equal(const CadPart& a, const CadPart& b) {
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.vertex_error, b.mesh.vertex_error);
  EXPECT_EQ(a.chord_error, b.chord_error);
  EXPECT_EQ(a.asked, b.asked);
  EXPECT_EQ(a.reached, b.reached);
  EXPECT_EQ(a.tolerance, b.tolerance);
  EXPECT_EQ(a.proved, b.proved);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.free_edges, b.free_edges);
  EXPECT_EQ(a.stated_unit, b.stated_unit);
  ASSERT_EQ(a.unproved.size(), b.unproved.size());
  for (std::size_t i = 0; i < a.unproved.size(); ++i) {
    EXPECT_EQ(a.unproved[i].name, b.unproved[i].name);
    EXPECT_EQ(a.unproved[i].reason, b.unproved[i].reason);
  }
}

TEST_F(CadCommand, WhatIsReadIsSentExactly) {
  test::write_assembly(test::box_parts(2, 2), folder_ / "all.step");
  std::vector<CadBody> sent = read_cad_bodies(folder_ / "all.step", {.scale = 0.001});
  sent.front().part.unproved = {{"face 1", "a reason with a byte that is not UTF-8: \xff"}};
  sent.front().part.reached = std::numeric_limits<double>::denorm_min();
  const std::string message = packed(sent);
  const std::vector<CadBody> received = unpacked(message);
  ASSERT_EQ(received.size(), sent.size());
  bool has_copy = false;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(received[i].name, sent[i].name);
    expect_equal(received[i].part, sent[i].part);
    ASSERT_EQ(received[i].copy.has_value(), sent[i].copy.has_value());
    if (!sent[i].copy) continue;
    has_copy = true;
    EXPECT_EQ(received[i].copy->of, sent[i].copy->of);
    EXPECT_EQ(received[i].copy->pose.rotation().coeffs(), sent[i].copy->pose.rotation().coeffs());
    EXPECT_EQ(received[i].copy->pose.translation(), sent[i].copy->pose.translation());
  }
  EXPECT_TRUE(has_copy);
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, message.size() - 1}) {
    EXPECT_THROW(unpacked(message.substr(0, size)), std::exception) << size;
  }
  try {
    unpacked(packed_error("the subject", "the reason \xfe"));
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "the subject");
    EXPECT_EQ(error.reason(), "the reason \xfe");
  }
}

TEST_F(CadCommand, ReadsAsTheLibraryDoes) {
  test::write_step(test::shape_named("torus"), folder_ / "part.step");
  const CadPart part = read_cad(folder_ / "part.step");
  const Outcome outcome = expect_exit(0, "info part.step");
  EXPECT_TRUE(has(outcome.out, std::to_string(part.mesh.triangles.size()) + " triangles"));
  write("noise.step", "what is this\n");
  try {
    read_cad(folder_ / "noise.step");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    expect_refusal("info noise.step", "noise.step: " + error.reason());
  }
  expect_refusal("info none.step", "none.step: cannot be read: No such file");
}

TEST_F(CadCommand, AReaderThatCrashesOrNeverEndsIsAnError) {
  expect_end("kill -SEGV $$\n", "spherule: part.step: OpenCASCADE cannot read it (Seg");
  expect_end("kill -ABRT $$\n", "spherule: part.step: OpenCASCADE cannot read it (Abort");
  // It is given the limit that the message names.
  expect_end("[ $6 = 30 ] && kill -XCPU $$\n",
             "spherule: part.step: takes more than 30 s of processor time");
  expect_end("kill -INT $$\n", "spherule: part.step: reading was interrupted");
  expect_end("kill -KILL $$\n", "spherule: part.step: reading was killed: is there enough memory");
  expect_end("exit 127\n", "spherule_cad: cannot be run");
  expect_end("exit 1\n", "spherule: part.step: OpenCASCADE ended before it was read");
  expect_end("echo half an answer >&3\n", "spherule: part.step: OpenCASCADE ended before");
}

// The program itself, given a second for what takes it far longer.
TEST_F(CadCommand, TheReaderEndsAtItsLimitOfProcessorTime) {
  test::write_step(test::shape_named("torus"), folder_ / "part.step");
  const auto read_within = [&](const std::string& seconds, const std::string& chord_error) {
    const Words arguments = {"part", (folder_ / "part.step").string(), "1", chord_error, "0.5",
                             seconds};
    EXPECT_EQ(arguments.size(), std::size_t{kCadArguments - 1});
    return internal::run_program(SPHERULE_CAD_READER, arguments, kCadAnswer);
  };
  const internal::ProgramOutput ended = read_within("1", "1e-4");
  ASSERT_TRUE(WIFSIGNALED(ended.status)) << ended.status << ended.not_started;
  EXPECT_EQ(WTERMSIG(ended.status), SIGXCPU);
  EXPECT_EQ(ended.bytes, "");
  const internal::ProgramOutput whole = read_within("60", "1");
  EXPECT_EQ(whole.status, 0);
  EXPECT_EQ(unpacked(whole.bytes).size(), 1U);
}

TEST_F(CadCommand, AMissingReaderIsNamed) {
  expect_end("", "spherule_cad: cannot be run: No such file");
}

// References to other entities, numbers that are far too large, bytes that are missing.
TEST_F(CadCommand, NoBrokenFileEndsIt) {
  test::write_step(test::shape_named("plate"), folder_ / "part.step");
  const std::string whole = read("part.step");
  const std::size_t begin = whole.find("DATA;");
  std::mt19937_64 random(7);
  for (int i = 0; i < test::effort(15, 4); ++i) {
    std::string broken = whole;
    for (int k = 0; k < 3; ++k) {
      const std::size_t place = begin + random() % (broken.size() - begin - 8);
      const std::size_t reference = broken.find('#', place);
      switch (random() % 3) {
        case 0:
          broken.erase(place, random() % 40);
          break;
        case 1:
          broken[place] = static_cast<char>(32 + random() % 95);
          break;
        default:
          if (reference != std::string::npos) broken.insert(reference + 1, "1");
      }
    }
    write("broken.step", broken);
    const Outcome outcome = run("info broken.step");
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 2)
        << outcome.exit_code << ", mutant " << i;
  }
}

}  // namespace
}  // namespace spherule
