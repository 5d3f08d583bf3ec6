# SPDX-License-Identifier: BSD-3-Clause
# Runs DOXYGEN on the Doxyfile in FOLDER and fails if it warns; finish_site.py then mends links and
# fails where one leads nowhere. A data member may go without a comment
# of its own: most say with their name and their structure's comment what they hold.
cmake_minimum_required(VERSION 3.25)
set(log ${FOLDER}/warnings.txt)
file(REMOVE ${log})
execute_process(COMMAND ${DOXYGEN} ${FOLDER}/Doxyfile WORKING_DIRECTORY ${FOLDER}
                RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${DOXYGEN} failed with ${result}")
endif()
file(READ ${log} warnings)
string(REGEX REPLACE "[^\n]*\\(variable\\)[^\n]* is not documented\\.\n" "" warnings "${warnings}")
if(warnings)
  message(FATAL_ERROR "Doxygen warns:\n${warnings}")
endif()
execute_process(COMMAND ${PYTHON} ${CMAKE_CURRENT_LIST_DIR}/finish_site.py ${SOURCES} ${FOLDER}/html
                RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "links of the site lead nowhere")
endif()
message("site: ${FOLDER}/html/index.html")
