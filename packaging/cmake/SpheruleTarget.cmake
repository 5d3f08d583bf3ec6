# SPDX-License-Identifier: BSD-3-Clause
# What every target of the project shares: the include roots, the warnings, the floating-point
# model, and how a library is installed.
include(GNUInstallDirs)
include(SpherulePkgConfig)
include(SpherulePrecompiled)

# Users write <spherule/geometry/sphere.h>. In the build tree this link leads there; installed, the
# headers stand under include/spherule/.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/spherule SYMBOLIC)

# Compile options of a TARGET that is no library (KIND as below): SPHERULE_PROGRAM_OPTIONS, after -O1 for
# bindings, which call the libraries and convert: -O1 makes them as fast, and compiles in half the time.
function(spherule_program_options target kind)
  if("${kind}" MATCHES "^binding$")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  if(NOT "${kind}" STREQUAL "library")
    target_compile_options(${target} PRIVATE ${SPHERULE_PROGRAM_OPTIONS})
  endif()
endfunction()

# Applies the project's compile settings to TARGET, a `library`, `program`, `command`, `test` or
# `binding` (KIND). The
# guarantees, G7 above all, rest on `-ffp-contract=off` in our own sources (see base/rounding.h);
# inline code in headers is valid with and without contraction.
function(spherule_compile_settings target kind)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # A -ffast-math among the flags of a whole build (CMAKE_CXX_FLAGS) is taken back.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion
                         -fno-fast-math -ffp-contract=off
                         $<$<BOOL:${SPHERULE_STRICT}>:-Werror>)
  # A library of others that a program does not use costs it time at each start.
  if(NOT "${kind}" STREQUAL "library" AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    target_link_options(${target} PRIVATE LINKER:--as-needed)
  endif()
  spherule_program_options(${target} ${kind})
  if(NOT "${kind}" STREQUAL "binding")
    spherule_precompile(${target} ${kind})
  endif()
endfunction()

# A shared library exports what exports.map.in says, takes its own functions rather than a program's
# copy of them, and leaves nothing undefined.
configure_file(${CMAKE_CURRENT_LIST_DIR}/exports.map.in ${PROJECT_BINARY_DIR}/exports.map @ONLY)
function(spherule_shared_settings target)
  # Before 1.0 a minor version may change the binary interface.
  set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
                        INSTALL_RPATH "$ORIGIN"
                        LINK_DEPENDS ${PROJECT_BINARY_DIR}/exports.map)
  target_link_options(${target} PRIVATE LINKER:--version-script=${PROJECT_BINARY_DIR}/exports.map
                      LINKER:-Bsymbolic-functions LINKER:-z,defs)
  set_property(GLOBAL APPEND PROPERTY SPHERULE_SHARED_LIBRARIES ${target})
endfunction()

# Declares the library spherule::NAME from HEADERS (public), SHARED (headers that other libraries of the
# project include, too, but that are not installed; all others are private), SOURCES (a library of
# headers has none) and LINKS (public dependencies), and
# installs it as the component NAME of the package. Headers are reached as "geometry/sphere.h" from
# inside the repository and as <spherule/geometry/sphere.h> by users.
function(spherule_library name)
  cmake_parse_arguments(ARG "" "" "HEADERS;SHARED;SOURCES;LINKS" ${ARGN})
  set(target spherule_${name})
  if(ARG_SOURCES)
    set(scope PUBLIC)
    add_library(${target} ${ARG_SOURCES})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    if(BUILD_SHARED_LIBS)
      spherule_shared_settings(${target})
    endif()
    spherule_compile_settings(${target} library)
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
    target_compile_features(${target} INTERFACE cxx_std_20)
  endif()
  add_library(spherule::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
                 FILES ${ARG_HEADERS})
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} ${scope} ${ARG_LINKS})

  # One export per component, so that a user of one does not load the dependencies of another. The
  # components this one links are recorded for the package configuration (SpheruleInstall.cmake).
  set(needs ${ARG_LINKS})
  list(FILTER needs INCLUDE REGEX "^spherule::")
  list(TRANSFORM needs REPLACE "^spherule::" "")
  set_property(GLOBAL APPEND PROPERTY SPHERULE_COMPONENTS ${name})
  set_property(GLOBAL PROPERTY SPHERULE_NEEDS_${name} "${needs}")
  if(SPHERULE_INSTALL)
    install(TARGETS ${target} EXPORT spherule-${name}
            FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/spherule)
    install(EXPORT spherule-${name} NAMESPACE spherule:: FILE spherule-${name}.cmake
            DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/spherule)
    cmake_language(EVAL CODE "cmake_language(DEFER CALL spherule_pkgconfig ${name})")
    if(SPHERULE_TESTS AND ARG_SOURCES AND NOT BUILD_SHARED_LIBS)
      include(SpheruleSharedTwin)
      cmake_language(EVAL CODE "cmake_language(DEFER CALL spherule_shared_twin ${name})")
    endif()
  endif()
endfunction()
