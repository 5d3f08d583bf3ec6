# SPDX-License-Identifier: BSD-3-Clause
# Writes to OUTPUT a test for each of HEADERS (paths with | between them, under ROOT): the example in
# its opening comment, which is what follows "#pragma once" up to the next empty line, from @code{.cpp}
# to @endcode. What it includes, and the header as users include it, goes to the top; assert() is a
# check of the test. A header without an example gets a test that fails.
cmake_minimum_required(VERSION 3.25)
string(REPLACE "|" ";" headers "${HEADERS}")
set(includes "")
set(tests "")
foreach(header IN LISTS headers)
  file(RELATIVE_PATH path ${ROOT} ${header})
  string(APPEND includes "#include <spherule/${path}>\n")
  string(MAKE_C_IDENTIFIER "${path}" name)
  file(READ ${header} text)
  string(REGEX MATCH "^.*\n#pragma once\n\n(//[^\n]*\n)+\n" opening "${text}")
  string(REGEX MATCH "^(.*\n)// @code{\\.cpp}\n((//[^\n]*\n)+)// @endcode\n" example "${opening}")
  if(NOT example)
    string(APPEND tests "\nTEST(Examples, ${name}) {\n  FAIL() << \"${path} has no example\";\n}\n")
    continue()
  endif()
  set(before "${CMAKE_MATCH_1}")
  set(code "\n${CMAKE_MATCH_2}")
  string(REGEX REPLACE "\n// ?" "\n" code "${code}")
  string(REGEX MATCHALL "\n#include <[^>]+>" included "${code}")
  string(REPLACE ";" "" included "${included}")
  string(APPEND includes "${included}\n")
  string(REGEX REPLACE "\n#include <[^>]+>" "\n" code "${code}")
  # Messages of the compiler and of the test name the line of the header.
  string(REGEX MATCHALL "\n" lines "${before}")
  list(LENGTH lines line)
  math(EXPR line "${line} + 1")
  string(APPEND tests "\nTEST(Examples, ${name}) {\n#line ${line} \"${path}\"${code}}\n")
endforeach()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: BSD-3-Clause
// Made by tests/examples/extract.cmake.
${includes}
#include <gtest/gtest.h>

#include <cassert>

#undef assert
#define assert(condition) EXPECT_TRUE(condition)
${tests}
#undef assert
")
