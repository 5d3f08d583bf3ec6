# SPDX-License-Identifier: BSD-3-Clause
# Installs a pkg-config file for every library of the project: spherule-collide.pc is for
# spherule::collide, and so on.

# What pkg-config calls the packages of some targets. FCL and OMPL are not among them: theirs ask for
# an older C++, which would take the place of ours. All others are linked by the names of their files.
set(SPHERULE_PKGCONFIG_NAMES
    "Eigen3::Eigen=eigen3" "TBB::tbb=tbb"
    "ZLIB::ZLIB=zlib" "tinyxml2::tinyxml2=tinyxml2" "yaml-cpp=yaml-cpp")

# Adds what linking ITEM takes to `requires`, `cflags` and `libs` of the caller.
function(spherule_pkgconfig_item item)
  set(names ${SPHERULE_PKGCONFIG_NAMES})
  list(FILTER names INCLUDE REGEX "^${item}=")
  if(item MATCHES "^spherule::(.*)")
    list(APPEND requires "spherule-${CMAKE_MATCH_1} = ${PROJECT_VERSION}")
  elseif(names)
    string(REPLACE "${item}=" "" name "${names}")
    list(APPEND requires ${name})
  elseif(TARGET ${item})
    get_target_property(folders ${item} INTERFACE_INCLUDE_DIRECTORIES)
    foreach(folder IN LISTS folders)
      if(folder AND NOT folder IN_LIST CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES)
        list(APPEND cflags "-I${folder}")
      endif()
    endforeach()
    get_target_property(type ${item} TYPE)
    if(NOT type STREQUAL "INTERFACE_LIBRARY")
      get_target_property(location ${item} LOCATION)
      spherule_pkgconfig_item(${location})
    endif()
    get_target_property(links ${item} INTERFACE_LINK_LIBRARIES)
    foreach(link IN LISTS links)
      if(link)
        spherule_pkgconfig_item(${link})
      endif()
    endforeach()
  elseif(item MATCHES "^-")
    list(APPEND libs ${item})
  elseif(IS_ABSOLUTE ${item})
    get_filename_component(name ${item} NAME)
    get_filename_component(folder ${item} DIRECTORY)
    string(REGEX REPLACE "^lib(.*)\\.(so|a)[.0-9]*$" "\\1" name ${name})
    if(NOT folder IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
      list(APPEND libs "-L${folder}")
    endif()
    list(APPEND libs "-l${name}")
  else()
    list(APPEND libs "-l${item}")
  endif()
  foreach(kind requires cflags libs)
    list(REMOVE_DUPLICATES ${kind})
    set(${kind} "${${kind}}" PARENT_SCOPE)
  endforeach()
endfunction()

# Writes and installs the file of the library NAME, in the folder that declares it and once all is
# declared: imported targets are seen only there. A shared library knows what it links itself; with a
# static one its users link that, too, without having to ask for it (--static).
function(spherule_pkgconfig name)
  set(target spherule_${name})
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    get_target_property(links ${target} LINK_LIBRARIES)
  else()
    get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  endif()
  set(requires "")
  set(cflags "")
  set(libs "")
  if(NOT type STREQUAL "INTERFACE_LIBRARY")
    set(libs "-L\${libdir}" "-l${target}")
  endif()
  foreach(link IN LISTS links)
    if(NOT link MATCHES "LINK_ONLY")
      spherule_pkgconfig_item(${link})
    endif()
  endforeach()
  list(JOIN requires ", " requires)
  list(JOIN cflags " " cflags)
  list(JOIN libs " " libs)

  # Relative to the file, so that the prefix may be moved.
  set(folder ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig)
  file(RELATIVE_PATH to_libraries ${folder} ${CMAKE_INSTALL_FULL_LIBDIR})
  file(RELATIVE_PATH to_headers ${folder} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
  set(file ${CMAKE_CURRENT_BINARY_DIR}/spherule-${name}.pc)
  file(CONFIGURE OUTPUT ${file} @ONLY NEWLINE_STYLE UNIX CONTENT
"libdir=\${pcfiledir}/${to_libraries}
includedir=\${pcfiledir}/${to_headers}

Name: spherule-${name}
Description: ${PROJECT_DESCRIPTION} (${name}; needs C++20)
Version: ${PROJECT_VERSION}
Requires: ${requires}
Cflags: -I\${includedir} -I\${includedir}/spherule ${cflags}
Libs: ${libs}
")
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
