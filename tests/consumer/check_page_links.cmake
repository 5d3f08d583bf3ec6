# SPDX-License-Identifier: BSD-3-Clause
# Installs PROJECT_BUILD below WORK and fails where a link of an installed page leads to a file or a
# folder that is not installed.
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/run_command.cmake)

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${PROJECT_BUILD} --prefix ${WORK})

file(GLOB_RECURSE pages ${WORK}/*.md)
set(links 0)
set(dead "")
foreach(page IN LISTS pages)
  get_filename_component(folder ${page} DIRECTORY)
  file(STRINGS ${page} lines REGEX "\\]\\([^)]*\\)")
  string(REGEX MATCHALL "\\]\\([^)#]*[#)]" targets "${lines}")
  # A list with brackets that do not match is one element.
  string(REPLACE "](" "" targets "${targets}")
  foreach(target IN LISTS targets)
    string(REGEX REPLACE "[#)]$" "" target "${target}")
    if(target MATCHES "^[a-z]+:" OR target STREQUAL "")
      continue()
    endif()
    math(EXPR links "${links} + 1")
    if(NOT EXISTS ${folder}/${target})
      string(APPEND dead "  ${page}: ${target}\n")
    endif()
  endforeach()
endforeach()
if(dead)
  message(FATAL_ERROR "links that lead nowhere:\n${dead}")
endif()
# Of the first page, the pages of docs/ and the folders'.
if(links LESS 50)
  message(FATAL_ERROR "only ${links} links found below ${WORK}")
endif()
