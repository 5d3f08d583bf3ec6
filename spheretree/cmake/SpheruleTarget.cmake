# SPDX-License-Identifier: BSD-3-Clause
# What every target of the project shares: the include root, the warnings, the floating-point model.

# Applies the project's compile settings to TARGET. The guarantees rest on `-ffp-contract=off` in our
# own sources (see spheretree/rounding.h); inline code in headers is valid with and without contraction.
function(spherule_compile_settings target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off
                         $<$<BOOL:${SPHERULE_STRICT}>:-Werror>)
endfunction()

# Declares the library spherule::NAME from HEADERS (public), SOURCES (everything else) and LINKS
# (public dependencies). Headers are reached as "spheretree/sphere.h" from inside the repository and
# as <spherule/spheretree/sphere.h> by users.
function(spherule_library name)
  cmake_parse_arguments(ARG "" "" "HEADERS;SOURCES;LINKS" ${ARGN})
  set(target spherule_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(spherule::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
                 FILES ${ARG_HEADERS})
  target_link_libraries(${target} PUBLIC ${ARG_LINKS})
  spherule_compile_settings(${target})
endfunction()
