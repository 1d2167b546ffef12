# The layers, lowest first. tests/tools/check_includes.py holds the arrows between them.
set(BOUGH_LAYERS lanes blocks motion laws scene records elements plan io tree solve schedule step results run study stress report)

# What every layer and every user of a layer compiles with.
#   -ffp-contract=off: kernels are templates and may be instantiated in a user's file; the linker keeps one copy, so
#   all of them must give the same bits.
#   EIGEN_MAX_ALIGN_BYTES: one alignment for all instruction sets, so that public structs keep one layout.
#   -march (BOUGH_ARCH): the whole library and its users within this build are built for one instruction set. Single
#   files built for a wider one would leak its instructions into template instances that the linker shares. Whole
#   libraries for several are another matter: BoughDispatch.cmake.
# The installed package does not carry -march. What users name has one layout on all instruction sets (packs have one
# size and alignment, EIGEN_MAX_ALIGN_BYTES is fixed), the width of registers stands in the symbols of what takes packs,
# so that a user who calls such kernels meets an undefined symbol and no other layout; and "native" would mean another
# instruction set where the package is used than where it was built. Who calls kernels on packs links bough::arch, too.
add_library(bough_base INTERFACE)
add_library(bough::base ALIAS bough_base)
set_target_properties(bough_base PROPERTIES EXPORT_NAME base)
target_compile_features(bough_base INTERFACE cxx_std_20)
target_compile_options(bough_base INTERFACE -ffp-contract=off)
if(BOUGH_ARCH)
  target_compile_options(bough_base INTERFACE "$<BUILD_INTERFACE:-march=${BOUGH_ARCH}>")
  add_library(bough_arch INTERFACE)
  add_library(bough::arch ALIAS bough_arch)
  set_target_properties(bough_arch PROPERTIES EXPORT_NAME arch)
  target_compile_options(bough_arch INTERFACE "-march=${BOUGH_ARCH}")
  install(TARGETS bough_arch EXPORT boughTargets)
endif()
target_compile_definitions(bough_base INTERFACE EIGEN_MAX_ALIGN_BYTES=64)
target_include_directories(bough_base INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
  $<BUILD_INTERFACE:${BOUGH_GENERATED_DIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
install(TARGETS bough_base EXPORT boughTargets)

# What only this project's own files compile with; never exported.
add_library(bough_warnings INTERFACE)
# In a unity build a file hides names of the file before it. The presets for development are none, and warn of hiding.
target_compile_options(bough_warnings INTERFACE
  -Wall -Wextra -Wconversion $<$<NOT:$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wshadow>
  $<$<BOOL:${BOUGH_WARNINGS_AS_ERRORS}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms of g++ 12: its AVX-512 header warns about its own undefined registers in every file, its string
  # about concatenation, and inlined vectors about writes that cannot happen.
  target_compile_options(bough_warnings INTERFACE -Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow)
endif()

# g++ copies structs by moves of 16 bytes where the tuning of a processor does not say otherwise, and a register that is loaded from what two
# narrower stores wrote waits until both have left for the cache. Copies of packs are by whole registers then, as wide as the instruction set has
# them.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag("-mmove-max=512 -mstore-max=512" BOUGH_HAS_MOVE_MAX)
if(BOUGH_HAS_MOVE_MAX)
  target_compile_options(bough_warnings INTERFACE -mmove-max=512 -mstore-max=512)
endif()

# Kernels over packs are trees of small functions on structs of several hundred bytes. g++ stops inlining them early and copies such structs
# by calls of memcpy: with these limits lifted the planar beam takes 0.6 of the instructions. No arithmetic changes.
# bough_kernels(a.cpp ...): call in the folder of the sources.
function(bough_kernels)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(options
      -finline-limit=20000 --param=large-function-growth=5000 --param=large-function-insns=20000
      --param=inline-unit-growth=2000 --param=max-inline-insns-single=5000 --param=max-inline-insns-auto=2000
      --param=large-stack-frame=100000 --param=large-stack-frame-growth=5000
      -mmemcpy-strategy=vector_loop:8192:noalign,libcall:-1:noalign)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS "$<$<CONFIG:Release>:${options}>")
  endif()
endfunction()

# Sanitized builds compile without optimisation, which spares most of the time that derivative kernels take. Arithmetic that would then be waited for is given some back.
# bough_optimise_sanitized(target ...)
function(bough_optimise_sanitized)
  foreach(target IN LISTS ARGN)
    if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=" AND TARGET ${target})
      target_compile_options(${target} PRIVATE $<$<CONFIG:Debug>:-O1>)
      set_target_properties(${target} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()

# Layers that a step spends its time in take the optimisation of the build type (-O3 of Release). Those that read, check and plan a scene take -O2: a
# sixth less code, and a fifth less time to compile. What runs once in a run takes -O1, another fifth less (-Wno-uninitialized: g++ 12 warns of its own
# AVX-512 header then). Results have the same bits either way.
set(BOUGH_LAYERS_OF_STEPS lanes blocks motion laws elements tree solve schedule step results)
set(BOUGH_LAYERS_OF_PAGES run study stress report)
set(BOUGH_MODERATE_OPTIMISATION $<$<CONFIG:Release>:-O2>)
set(BOUGH_LITTLE_OPTIMISATION $<$<CONFIG:Release>:-O1> $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Wno-uninitialized>)

# Of layers in static archives.
set(BOUGH_LAYER_PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)

# bough_add_layer(NAME SOURCES a.cpp ... USES lower layers ... LIBS public targets ... PRIVATE_LIBS targets ...
#                 PRIVATE_DEFS definitions ... PRIVATE_INCLUDES folders ... [HEADERS a.hpp ...])
# makes the target bough_NAME (alias and export bough::NAME) with the headers of include/bough/NAME (HEADERS: only
# these of them). Without SOURCES the layer is header-only. Each layer is a library of its own, so that the algebra can be used without the
# mechanics; BUILD_SHARED_LIBS makes all of them static or all of them shared. Symbols are hidden in static archives
# and visible in shared libraries: an export macro on every public type would buy little here.
# With BOUGH_DISPATCH a layer is built again for each of BOUGH_VARIANTS, as bough_NAME-VARIANT; nobody links these but one another.
function(bough_add_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 LAYER "" "" "SOURCES;USES;LIBS;PRIVATE_LIBS;PRIVATE_DEFS;PRIVATE_INCLUDES;HEADERS")
  if(LAYER_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "bough_add_layer(${name}): unknown arguments ${LAYER_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT name IN_LIST BOUGH_LAYERS)
    message(FATAL_ERROR "bough_add_layer(${name}): not one of ${BOUGH_LAYERS}")
  endif()

  set(target bough_${name})
  foreach(used IN LISTS LAYER_USES)
    if(NOT TARGET bough_${used})
      message(FATAL_ERROR "bough_add_layer(${name}): no layer ${used} below it")
    endif()
  endforeach()
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/bough/${name}/*.hpp")
  if(LAYER_HEADERS)
    list(TRANSFORM LAYER_HEADERS PREPEND "${PROJECT_SOURCE_DIR}/include/bough/${name}/" OUTPUT_VARIABLE headers)
  endif()
  bough_add_layer_target(${target} "")
  add_library(bough::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  set(scope PUBLIC)
  if(NOT LAYER_SOURCES)
    set(scope INTERFACE)
  endif()
  target_sources(${target} ${scope}
    FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}/include" FILES ${headers})
  install(TARGETS ${target} EXPORT boughTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  foreach(variant IN LISTS BOUGH_VARIANTS)
    bough_add_layer_target(${target}-${variant} -${variant})
    bough_make_variant(${target} ${variant})
  endforeach()
endfunction()

# The part of bough_add_layer, whose arguments it sees, that is the same for every variant; `suffix` names the variant in targets.
function(bough_add_layer_target target suffix)
  list(TRANSFORM LAYER_USES REPLACE "(.+)" "bough_\\1${suffix}" OUTPUT_VARIABLE uses)
  if(NOT LAYER_SOURCES)
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE bough_base ${uses} ${LAYER_LIBS})
    return()
  endif()
  add_library(${target} ${LAYER_SOURCES})
  target_link_libraries(${target} PUBLIC bough_base ${uses} ${LAYER_LIBS}
    PRIVATE ${LAYER_PRIVATE_LIBS} $<BUILD_INTERFACE:bough_warnings>)
  target_compile_definitions(${target} PRIVATE ${LAYER_PRIVATE_DEFS})
  target_include_directories(${target} PRIVATE ${LAYER_PRIVATE_INCLUDES})
  if(name IN_LIST BOUGH_LAYERS_OF_PAGES)
    target_compile_options(${target} PRIVATE ${BOUGH_LITTLE_OPTIMISATION})
  elseif(NOT name IN_LIST BOUGH_LAYERS_OF_STEPS)
    target_compile_options(${target} PRIVATE ${BOUGH_MODERATE_OPTIMISATION})
  endif()
  if(name IN_LIST BOUGH_LAYERS_OF_STEPS AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)  # neighbours would change what is inlined into kernels
  endif()
  add_dependencies(${target} bough_version)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  if(BOUGH_DISPATCH)
    bough_bind_to_itself(${target})
  elseif(NOT BUILD_SHARED_LIBS)
    set_target_properties(${target} PROPERTIES ${BOUGH_LAYER_PROPERTIES})
    bough_precompile(layer ${target})
  endif()
endfunction()
