# SPDX-License-Identifier: BSD-3-Clause
# Fails if one of the shared LIBRARIES exports a symbol that is not of namespace spherule, or none.
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/run_command.cmake)

foreach(library IN LISTS LIBRARIES)
  run(${NM} --dynamic --defined-only --format=just-symbols ${library})
  string(REGEX MATCHALL "[^\n]+" symbols "${output}")
  set(own ${symbols})
  list(FILTER own INCLUDE REGEX "^_Z[A-Z]*N[A-Z]*8spherule")
  list(FILTER symbols EXCLUDE REGEX "^_Z[A-Z]*N[A-Z]*8spherule|^SPHERULE_")
  if(symbols OR NOT own)
    list(LENGTH own count)
    message(FATAL_ERROR "${library} exports ${count} names of spherule, and of others: ${symbols}")
  endif()
endforeach()
