# SPDX-License-Identifier: BSD-3-Clause
# Installs PROJECT_BUILD below WORK, then configures, builds and runs the consumer in SOURCE against
# it. With FORBIDDEN (a regular expression of libraries), none of them may be found, stand in the
# link line, or be loaded by the program. With MPIRUN it runs by that, too.
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/run_command.cmake)

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${PROJECT_BUILD} --prefix ${WORK}/prefix)

set(options "")
if(FORBIDDEN)
  # find_package for these fails even where they are installed.
  foreach(package assimp TBB ZLIB tinyxml2)
    list(APPEND options -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
  endforeach()
endif()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}"
    -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF ${options})
run(${CMAKE_COMMAND} --build ${WORK}/build)
set(program ${WORK}/build/consumer)
run(${program})
message("${output}")

# With MPIRUN, on several processes the program says the same.
if(MPIRUN)
  set(alone "${output}")
  # Of Open MPI: as root, and more processes than cores.
  set(ENV{OMPI_ALLOW_RUN_AS_ROOT} 1)
  set(ENV{OMPI_ALLOW_RUN_AS_ROOT_CONFIRM} 1)
  set(ENV{OMPI_MCA_rmaps_base_oversubscribe} 1)
  foreach(processes IN ITEMS 2 4)
    run(${MPIRUN} -n ${processes} ${program})
    if(NOT output STREQUAL alone)
      message(FATAL_ERROR "${processes} processes: ${output}\none: ${alone}")
    endif()
  endforeach()
endif()

if(FORBIDDEN)
  file(GLOB link_lines ${WORK}/build/build.ninja ${WORK}/build/CMakeFiles/consumer.dir/link.txt)
  if(NOT link_lines)
    message(FATAL_ERROR "the link line cannot be looked at with the generator ${GENERATOR}")
  endif()
  foreach(file IN LISTS link_lines)
    file(STRINGS ${file} lines REGEX "(${FORBIDDEN})")
    if(lines)
      message(FATAL_ERROR "the build names ${FORBIDDEN}:\n${lines}")
    endif()
  endforeach()
  run(ldd ${program})
  if(output MATCHES "${FORBIDDEN}")
    message(FATAL_ERROR "the program loads ${FORBIDDEN}:\n${output}")
  endif()
endif()
