find_package(GTest REQUIRED)
include(GoogleTest)

# bough_add_test(name SOURCES a.cpp ... LAYERS layers ... LABEL unit|verification|slow [LIBS targets ...]
#                [DEFS definitions ...] [TIMEOUT seconds] [NO_TRAPS] [NO_SANITIZERS])
# makes one GoogleTest executable and one ctest entry FOLDER/name.Suite.case for each of its tests; the targets
# tests_LABEL and tests_FOLDER_LABEL build all of them. The main function is ours: it unmasks floating-point traps
# (tests/support/main.cpp); NO_TRAPS leaves them masked. NO_SANITIZERS leaves the test out of sanitized builds, for
# tests that replace operator new as the sanitizers do. BOUGH_SOURCE_DIR is defined as the path of the source tree,
# for reading data/.
function(bough_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 TEST "NO_TRAPS;NO_SANITIZERS" "LABEL;TIMEOUT" "SOURCES;LAYERS;LIBS;DEFS")
  if(TEST_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "bough_add_test(${name}): unknown arguments ${TEST_UNPARSED_ARGUMENTS}")
  endif()
  set(timeout_unit 120)
  set(timeout_verification 600)
  set(timeout_slow 3600)
  if(NOT DEFINED timeout_${TEST_LABEL})
    message(FATAL_ERROR "bough_add_test(${name}): LABEL is unit, verification or slow, not '${TEST_LABEL}'")
  endif()
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT ${timeout_${TEST_LABEL}})
  endif()

  if(TEST_NO_SANITIZERS AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
    return()
  endif()
  set(target test_${name})
  list(TRANSFORM TEST_LAYERS PREPEND bough_)
  foreach(used IN LISTS TEST_LAYERS)
    if(NOT TARGET ${used} AND BOUGH_ONLY)
      return()  # needs a layer that was not asked for
    endif()
  endforeach()
  add_executable(${target} ${TEST_SOURCES})
  set(main bough_test_main)
  if(TEST_NO_TRAPS)
    set(main bough_test_main_untrapped)
  endif()
  target_link_libraries(${target} PRIVATE ${TEST_LAYERS} ${TEST_LIBS} bough_base bough_warnings ${main})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_compile_definitions(${target} PRIVATE ${TEST_DEFS} BOUGH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  get_filename_component(folder "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
  gtest_discover_tests(${target} TEST_PREFIX "${folder}/${name}." DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${TEST_LABEL} TIMEOUT ${TEST_TIMEOUT})
  foreach(group tests_${TEST_LABEL} tests_${folder}_${TEST_LABEL})
    if(NOT TARGET ${group})
      add_custom_target(${group})
    endif()
    add_dependencies(${group} ${target})
  endforeach()
endfunction()
