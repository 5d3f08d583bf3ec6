# SPDX-License-Identifier: BSD-3-Clause
# Installs PROJECT_BUILD below WORK, then builds and runs main.cpp in SOURCE with no more than
# the flags that pkg-config names for spherule-NAME. With FORBIDDEN (a regular expression of
# libraries), none of them may be among these.
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/run_command.cmake)

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${PROJECT_BUILD} --prefix ${WORK}/staged)
# Moved, as a package is from where it was staged.
file(RENAME ${WORK}/staged ${WORK}/prefix)
if(EXISTS ${WORK}/prefix/bin/spherule)
  foreach(file bash-completion/completions/spherule fish/vendor_completions.d/spherule.fish
               zsh/site-functions/_spherule man/man1/spherule.1 man/man1/spherule-fit.1)
    if(NOT EXISTS ${WORK}/prefix/share/${file})
      message(FATAL_ERROR "the command is installed without share/${file}")
    endif()
  endforeach()
endif()
set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/${LIBRARIES}/pkgconfig)
run(${PKG_CONFIG} --print-errors --validate spherule-${NAME})
run(${PKG_CONFIG} --modversion spherule-${NAME})
run(${PKG_CONFIG} --cflags --libs spherule-${NAME})
if(FORBIDDEN AND output MATCHES "${FORBIDDEN}")
  message(FATAL_ERROR "the flags name ${FORBIDDEN}: ${output}")
endif()
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
separate_arguments(named UNIX_COMMAND "${output}")
set(program ${WORK}/consumer)
file(GLOB urdf ${SOURCE}/*.urdf)
run(${COMPILER} -std=c++20 ${flags} "-DURDF=\"${urdf}\"" ${SOURCE}/main.cpp ${named} -o ${program})
set(ENV{LD_LIBRARY_PATH} ${WORK}/prefix/${LIBRARIES})
run(${program})
message("${output}")
