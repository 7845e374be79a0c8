# One folder, one target: searchlight_library(name [DEPENDS ...] [LINK ...]) takes every .cpp beside it and below.

function(searchlight_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(searchlight_${name} STATIC ${sources})
  add_library(searchlight::${name} ALIAS searchlight_${name})
  target_include_directories(searchlight_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM ARG_DEPENDS PREPEND searchlight_)
  target_link_libraries(searchlight_${name} PUBLIC ${ARG_DEPENDS} PRIVATE fmt::fmt ${ARG_LINK})
endfunction()

# Embeds files into a target as text: the definition of embeddedFiles() in base/embedded.h.
function(searchlight_embed target)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${target}_embedded.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DROOT=${PROJECT_SOURCE_DIR} "-DFILES=${ARGN}"
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()

# Seconds within which a test ends on the slowest machine; label slow: more.
set(SEARCHLIGHT_TEST_TIMEOUT 300)
if(SEARCHLIGHT_SANITIZE)
  set(SEARCHLIGHT_TEST_TIMEOUT 900)
endif()

# searchlight_tests(folder LINK ...): *_test.cpp beside the caller. *_gl_test.cpp gets the label gl, *_slow_test.cpp
# the label slow, the rest the label fast.
function(searchlight_tests folder)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  file(GLOB all CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  set(gl ${all})
  list(FILTER gl INCLUDE REGEX "_gl_test\\.cpp$")
  set(slow ${all})
  list(FILTER slow INCLUDE REGEX "_slow_test\\.cpp$")
  set(fast ${all})
  list(FILTER fast EXCLUDE REGEX "_(gl|slow)_test\\.cpp$")
  foreach(label fast gl slow)
    if(NOT ${label})
      continue()
    endif()
    set(target test_${folder}_${label})
    add_executable(${target} ${${label}})
    target_link_libraries(${target} PRIVATE ${ARG_LINK} fmt::fmt GTest::gmock GTest::gtest_main)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(${target} PRIVATE
      SEARCHLIGHT_SOURCE_DIR="${PROJECT_SOURCE_DIR}" SEARCHLIGHT_BINARY_DIR="${PROJECT_BINARY_DIR}")
    target_precompile_headers(${target} PRIVATE <gtest/gtest.h> <gmock/gmock.h> <vector> <string>)
    set(timeout ${SEARCHLIGHT_TEST_TIMEOUT})
    if(label STREQUAL slow)
      set(timeout 1200)
    endif()
    gtest_discover_tests(${target} DISCOVERY_MODE PRE_TEST PROPERTIES LABELS ${label} TIMEOUT ${timeout})
  endforeach()
endfunction()
