# SPDX-License-Identifier: BSD-3-Clause
# What test programs have in common, of the project as of bench/.
find_package(GTest REQUIRED)
include(GoogleTest)

# A test program of SOURCES in tests/FOLDER/. Each test case becomes a ctest entry of its own.
# Cases of a COST start before those of less, so that no long one is left to run alone.
# Where SPHERULE_MODELS names a folder of real models (environment), tests use those too.
function(spherule_test name)
  cmake_parse_arguments(ARG "" "COST" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gtest GTest::gtest_main)
  spherule_compile_settings(${name} test)
  target_include_directories(${name} PRIVATE ${spherule_SOURCE_DIR})
  if(NOT ARG_COST)
    set(ARG_COST 0)
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 2400 COST ${ARG_COST})
endfunction()
