find_package(GTest REQUIRED)
include(GoogleTest)

# Kernels for scalars that only tests use (complex, Jet, Taylor) take most of the compilation and little of the run.
# (-Wno-uninitialized: at -O1 g++ 12 warns about its own AVX-512 header.)
set(BOUGH_TEST_OPTIONS $<$<CONFIG:Release>:-O1 -Wno-uninitialized>)

# bough_add_test_objects(name SOURCES a.cpp ... LAYERS layers ... [LIBS targets ...])
# compiles once what several tests use; they name it under OBJECTS. Tests may be among them.
function(bough_add_test_objects name)
  cmake_parse_arguments(PARSE_ARGV 1 OBJECTS "" "" "SOURCES;LAYERS;LIBS")
  list(TRANSFORM OBJECTS_LAYERS PREPEND bough_)
  foreach(used IN LISTS OBJECTS_LAYERS)
    if(NOT TARGET ${used} AND BOUGH_ONLY)
      return()  # as the tests that use it
    endif()
  endforeach()
  add_library(test_${name} OBJECT ${OBJECTS_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${OBJECTS_LAYERS} ${OBJECTS_LIBS} bough_base bough_warnings GTest::gtest)
  target_include_directories(test_${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_compile_options(test_${name} PRIVATE ${BOUGH_TEST_OPTIONS})
  set_target_properties(test_${name} PROPERTIES CXX_EXTENSIONS OFF)
  bough_precompile(test test_${name})
endfunction()

# bough_add_test(name SOURCES a.cpp ... LAYERS layers ... LABEL unit|verification|slow [LIBS targets ...]
#                [OBJECTS objects ...] [DEFS definitions ...] [TIMEOUT seconds of processor time] [AS_WRITTEN] [NO_TRAPS]
#                [NO_SANITIZERS])
# makes one GoogleTest executable and one ctest entry FOLDER/name.Suite.case for each of its tests; the targets
# tests_LABEL and tests_FOLDER_LABEL build all of them. The main function is ours: it unmasks floating-point traps
# (tests/support/main.cpp); NO_TRAPS leaves them masked. AS_WRITTEN: without optimisation, for tests that run for less
# time than it would take to compile. NO_SANITIZERS leaves the test out of sanitized builds, for
# tests that replace operator new as the sanitizers do. support/source_dir.hpp tells where data/ lies.
function(bough_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 TEST "AS_WRITTEN;NO_TRAPS;NO_SANITIZERS" "LABEL;TIMEOUT" "SOURCES;LAYERS;LIBS;DEFS;OBJECTS")
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
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
    math(EXPR TEST_TIMEOUT "5 * ${TEST_TIMEOUT}")  # they slow tests down tenfold and more, most of all beside others
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
  list(TRANSFORM TEST_OBJECTS REPLACE "(.+)" "$<TARGET_OBJECTS:test_\\1>")
  add_executable(${target} ${TEST_SOURCES} ${TEST_OBJECTS})
  set(main bough_test_main)
  if(TEST_NO_TRAPS)
    set(main bough_test_main_untrapped)
  endif()
  target_link_libraries(${target} PRIVATE ${TEST_LAYERS} ${TEST_LIBS} bough_base bough_warnings ${main})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_compile_definitions(${target} PRIVATE ${TEST_DEFS})
  if(TEST_AS_WRITTEN)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O0>)
  elseif(NOT TEST_LABEL STREQUAL "slow")
    target_compile_options(${target} PRIVATE ${BOUGH_TEST_OPTIONS})
  endif()
  bough_precompile(test ${target})
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  get_filename_component(folder "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
  math(EXPR wall "${BOUGH_TEST_PATIENCE} * ${TEST_TIMEOUT}")
  math(EXPR discovery "${BOUGH_TEST_PATIENCE} * 60")
  gtest_discover_tests(${target} TEST_PREFIX "${folder}/${name}." DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT ${discovery}
    PROPERTIES LABELS ${TEST_LABEL} TIMEOUT ${wall} ENVIRONMENT "BOUGH_TEST_CPU=${TEST_TIMEOUT}")
  foreach(group tests_${TEST_LABEL} tests_${folder}_${TEST_LABEL})
    if(NOT TARGET ${group})
      add_custom_target(${group})
    endif()
    add_dependencies(${group} ${target})
  endforeach()
endfunction()
