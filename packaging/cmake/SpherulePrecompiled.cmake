# SPDX-License-Identifier: BSD-3-Clause
# Headers of the standard library and of dependencies that most sources include, compiled once: parsing
# them takes two thirds of the time of most sources. CMAKE_DISABLE_PRECOMPILE_HEADERS turns it off; then a
# missing include shows. GCC shares such a header only between sources of the same code model and the
# same macros that the header tests, hence one for each KIND: library, program, test, and the command.

function(spherule_declare_precompiled kind)
  set(headers <algorithm> <array> <cmath> <cstddef> <cstdint> <filesystem> <functional> <limits>
              <map> <memory> <optional> <set> <span> <sstream> <string> <string_view> <utility>
              <vector> <Eigen/Core> <Eigen/Geometry>)
  set(links Eigen3::Eigen)
  if(NOT kind STREQUAL library)
    find_package(nlohmann_json REQUIRED)
    list(APPEND headers <nlohmann/json.hpp>)
    list(APPEND links nlohmann_json::nlohmann_json)
  endif()
  if(kind STREQUAL command)
    list(APPEND headers <CLI/CLI.hpp>)
    list(APPEND links CLI11::CLI11)
  endif()
  if(kind STREQUAL test)
    find_package(Boost REQUIRED)
    find_package(GTest REQUIRED)
    list(APPEND headers <boost/multiprecision/cpp_bin_float.hpp> <boost/multiprecision/cpp_int.hpp>
                        <gtest/gtest.h>)
    list(APPEND links Boost::headers GTest::gtest)
  endif()
  set(source ${PROJECT_BINARY_DIR}/precompiled/${kind}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  set(target spherule_precompiled_${kind})
  add_library(${target} OBJECT ${source})
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE -fno-fast-math -ffp-contract=off)
  spherule_program_options(${target} ${kind})
  target_link_libraries(${target} PRIVATE ${links})
  target_precompile_headers(${target} PRIVATE ${headers})
  if(kind STREQUAL library)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
endfunction()

# Lets the sources of TARGET use the precompiled headers of KIND.
function(spherule_precompile target kind)
  if(NOT TARGET spherule_precompiled_${kind})
    spherule_declare_precompiled(${kind})
  endif()
  target_precompile_headers(${target} REUSE_FROM spherule_precompiled_${kind})
  if(kind STREQUAL test)
    # What Boost::headers defines, so that tests without it have the same macros.
    target_compile_definitions(${target} PRIVATE BOOST_ALL_NO_LIB)
  endif()
endfunction()
