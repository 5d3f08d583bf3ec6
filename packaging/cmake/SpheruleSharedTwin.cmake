# SPDX-License-Identifier: BSD-3-Clause
# For the tests of a static build: every library once more as a shared one, linked of the same
# objects, as BUILD_SHARED_LIBS makes it.

# To be called in the folder that declares the library NAME and once all is declared: imported targets
# are seen only there. Libraries come in the order in which they depend on each other.
function(spherule_shared_twin name)
  set(twin spherule_shared_${name})
  add_library(${twin} SHARED $<TARGET_OBJECTS:spherule_${name}>)
  set_target_properties(${twin} PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME spherule_${name}
                        LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/shared)
  spherule_shared_settings(${twin})
  get_target_property(links spherule_${name} LINK_LIBRARIES)
  list(TRANSFORM links REPLACE "^spherule::" "spherule_shared_")
  target_link_libraries(${twin} PUBLIC ${links})
endfunction()
