# BOUGH_PRECOMPILE: headers that nearly every file reads are compiled once for each kind of target. Sanitized builds, which do not optimise, take a
# sixth less time with it. Off elsewhere: g++ gains little, warns about strings of its own library then, and files have to include what they use.
option(BOUGH_PRECOMPILE "Precompile the headers that most files read" OFF)

if(BOUGH_PRECOMPILE AND (BUILD_SHARED_LIBS OR NOT CMAKE_BUILD_TYPE STREQUAL "Debug"))
  message(FATAL_ERROR "BOUGH_PRECOMPILE is for static layers of the build type Debug, in which all tests have the same options: "
    "leave it out (-DBOUGH_PRECOMPILE=OFF)")
endif()

# bough_precompile(KIND target ...): the targets read the headers of KIND, layer or test, which an object library of the same options has compiled.
function(bough_precompile kind)
  if(NOT BOUGH_PRECOMPILE)
    return()
  endif()
  set(owner bough_precompiled_${kind})
  if(NOT TARGET ${owner})
    set(source "${PROJECT_BINARY_DIR}/precompiled/${kind}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "// Compiled for its precompiled headers.\n")
    add_library(${owner} OBJECT "${source}")
    target_link_libraries(${owner} PRIVATE bough_base bough_warnings)
    set_target_properties(${owner} PROPERTIES CXX_EXTENSIONS OFF)
    target_precompile_headers(${owner} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numeric> <optional>
      <span> <sstream> <string> <string_view> <tuple> <utility> <variant> <vector>)
    if(kind STREQUAL "layer")
      set_target_properties(${owner} PROPERTIES ${BOUGH_LAYER_PROPERTIES})
    else()
      target_link_libraries(${owner} PRIVATE GTest::gtest GTest::gmock)
      target_precompile_headers(${owner} PRIVATE <gtest/gtest.h>)
    endif()
  endif()
  foreach(target IN LISTS ARGN)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endforeach()
endfunction()

# bough_use_precompiled(target ...): options of targets of g++ with precompiled headers. ccache, which sees no header that stands in one, has to be told
# that there is one: it would take objects made with other headers. And the standard library, precompiled, is no system header to g++ 12, whose false
# alarms about strings are shown then.
function(bough_use_precompiled)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds)
  endforeach()
endfunction()

# bough_precompile_headers(target HEADERS header ... SKIP source ... SHARED_WITH target ...): in optimised builds of static layers by g++, HEADERS
# and the headers of the standard library that go with them are compiled once for the sources of a target, but for those with options of their own.
# The targets that share them take the same options.
function(bough_precompile_headers target)
  cmake_parse_arguments(PARSE_ARGV 1 PCH "" "" "HEADERS;SKIP;SHARED_WITH")
  if(BOUGH_PRECOMPILE OR BUILD_SHARED_LIBS OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  target_precompile_headers(${target} PRIVATE <algorithm> <cmath> ${PCH_HEADERS})
  set_source_files_properties(${PCH_SKIP} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  bough_use_precompiled(${target})
  foreach(other IN LISTS PCH_SHARED_WITH)
    if(TARGET ${other})
      target_precompile_headers(${other} REUSE_FROM ${target})
      bough_use_precompiled(${other})
    endif()
  endforeach()
endfunction()
