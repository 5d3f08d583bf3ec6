# SPDX-License-Identifier: BSD-3-Clause
# Writes and installs the package configuration for find_package(spherule); include it after all
# libraries are declared.
include(CMakePackageConfigHelpers)

# Declared in the order in which they depend on each other.
get_property(SPHERULE_COMPONENTS GLOBAL PROPERTY SPHERULE_COMPONENTS)
set(SPHERULE_COMPONENT_NEEDS "")
foreach(component IN LISTS SPHERULE_COMPONENTS)
  get_property(needs GLOBAL PROPERTY SPHERULE_NEEDS_${component})
  string(APPEND SPHERULE_COMPONENT_NEEDS "set(_spherule_needs_${component} \"${needs}\")\n")
endforeach()

# Private dependencies of a shared library are its own affair; a static one hands them on.
get_target_property(library_type spherule_base TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
  set(SPHERULE_IO_PACKAGES "tinyxml2;ZLIB")
  set(SPHERULE_SIMPLIFIER_PACKAGES "TBB")
  set(SPHERULE_THREADS_PACKAGES "TBB")
  set(SPHERULE_ROBOT_PACKAGES "tinyxml2;yaml-cpp")
else()
  set(SPHERULE_IO_PACKAGES "")
  set(SPHERULE_SIMPLIFIER_PACKAGES "")
  set(SPHERULE_THREADS_PACKAGES "")
  set(SPHERULE_ROBOT_PACKAGES "")
endif()

set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/spherule)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/spheruleConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/spheruleConfig.cmake
                              INSTALL_DESTINATION ${destination}
                              NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/spheruleConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/spheruleConfig.cmake
              ${PROJECT_BINARY_DIR}/spheruleConfigVersion.cmake
        DESTINATION ${destination})
if(TARGET spherule_ompl)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/SpheruleOmpl.cmake DESTINATION ${destination})
endif()

# Where ROS looks for it in a package without ament (REP 136).
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/spherule)

# The pages that helps and messages name, with what their links lead to.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
        FILES_MATCHING PATTERN "*.md" PATTERN "*.png")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN "__pycache__" EXCLUDE)
foreach(folder IN ITEMS adapters base bench cli collide geometry io packaging python robot simplifier spheretree tests)
  file(GLOB_RECURSE readmes RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${folder}/*README.md)
  foreach(readme IN LISTS readmes)
    get_filename_component(place ${readme} DIRECTORY)
    install(FILES ${readme} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${place})
  endforeach()
endforeach()
