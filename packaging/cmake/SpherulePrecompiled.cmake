# SPDX-License-Identifier: BSD-3-Clause
# Headers of others that most sources include, compiled once, and the sources of a target
# joined to few (option SPHERULE_PRECOMPILE). Both hide a missing include; tests/structure looks for those
# by the names that a source uses (own_headers.cpp, standard_headers.cpp). GCC lets sources share such a
# header only where they have the same code model and the same macros that it looks at, hence one for
# each KIND: library, program, test. What defines objects in each source stays out (CLI11).

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

# Lets the sources of TARGET use the precompiled headers of KIND, and joins them: they share the code of
# templates. Sources of a target that have local names in common are kept apart (SKIP_UNITY_BUILD_INCLUSION).
function(spherule_precompile target kind)
  if(NOT TARGET spherule_precompiled_${kind})
    spherule_declare_precompiled(${kind})
  endif()
  target_precompile_headers(${target} REUSE_FROM spherule_precompiled_${kind})
  # Four times the default: the command's sources compile in a sixth (clang) to a quarter (g++) less time than
  # with twice the default, which saved a fifth of all.
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 32)
  if(kind STREQUAL library)
    # In Clang a local name of one source hides that of a header which only another one includes; g++ takes
    # classes of joined sources for those of headers.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>
                           $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  if(kind STREQUAL test)
    # What Boost::headers defines, so that tests without it have the same macros.
    target_compile_definitions(${target} PRIVATE BOOST_ALL_NO_LIB)
  endif()
endfunction()
