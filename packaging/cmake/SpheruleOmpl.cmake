# SPDX-License-Identifier: BSD-3-Clause
# Finds OMPL. Its package before 1.6 has no target: then ompl::ompl is made of what it says. Installed
# beside the package configuration, which includes it.
if(NOT TARGET ompl::ompl)
  find_package(ompl REQUIRED)
endif()
if(NOT TARGET ompl::ompl)
  add_library(ompl::ompl INTERFACE IMPORTED)
  set_target_properties(ompl::ompl PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${OMPL_INCLUDE_DIRS}"
    INTERFACE_LINK_LIBRARIES "${OMPL_LIBRARIES}")
endif()
