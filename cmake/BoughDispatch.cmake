# BOUGH_DISPATCH: one program for every x86-64, which runs the widest instruction set that the processor has. All layers are
# shared libraries, built for the baseline and for each of BOUGH_VARIANTS; the variants stand below the baseline's folder in
# glibc-hwcaps/VARIANT, where the loader of glibc 2.33 or later looks first. Nothing in the code chooses: src/lanes/README.md.
set(BOUGH_VARIANTS)
if(NOT BOUGH_DISPATCH)
  return()
endif()

if(BOUGH_ARCH)
  message(FATAL_ERROR "BOUGH_DISPATCH builds for several instruction sets, BOUGH_ARCH=${BOUGH_ARCH} asks for one: "
    "leave one of them out (-DBOUGH_ARCH= or -DBOUGH_DISPATCH=OFF)")
endif()
if(BOUGH_BUILD_BENCHMARKS)
  message(FATAL_ERROR "Benchmarks call kernels on packs, whose names differ between the libraries of BOUGH_DISPATCH: "
    "build them with BOUGH_ARCH (-DBOUGH_BUILD_BENCHMARKS=OFF or -DBOUGH_DISPATCH=OFF)")
endif()
if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux" OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  message(FATAL_ERROR "BOUGH_DISPATCH is for Linux on x86-64, not for ${CMAKE_SYSTEM_NAME} on ${CMAKE_SYSTEM_PROCESSOR}")
endif()
if(CMAKE_CONFIGURATION_TYPES)
  message(FATAL_ERROR "BOUGH_DISPATCH needs a generator of one configuration, such as Ninja: "
    "the loader looks for the variants in one folder below the libraries")
endif()

# Asked anew whenever CMake runs: compiler flags may have changed.
foreach(result BOUGH_LOADER_CHOOSES BOUGH_FLAGS_ARE_BASELINE)
  unset(${result} CACHE)
endforeach()
set(CMAKE_REQUIRED_QUIET ON)
include(CheckCXXCompilerFlag)
include(CheckCXXSourceCompiles)
check_cxx_source_compiles("
  #include <features.h>
  #if !__GLIBC_PREREQ(2, 33)
  #error
  #endif
  int main() {}" BOUGH_LOADER_CHOOSES)
if(NOT BOUGH_LOADER_CHOOSES)
  message(FATAL_ERROR "BOUGH_DISPATCH needs glibc 2.33 or later: the loader of this C library knows no glibc-hwcaps folders")
endif()
check_cxx_source_compiles("
  #ifdef __SSE3__
  #error
  #endif
  int main() {}" BOUGH_FLAGS_ARE_BASELINE)
if(NOT BOUGH_FLAGS_ARE_BASELINE)
  message(FATAL_ERROR "BOUGH_DISPATCH needs a compiler that makes code for every x86-64 when not told otherwise: "
    "take -march and -m... out of CMAKE_CXX_FLAGS ('${CMAKE_CXX_FLAGS}')")
endif()

set(BOUGH_VARIANTS x86-64-v3 x86-64-v4)
foreach(variant IN LISTS BOUGH_VARIANTS)
  string(MAKE_C_IDENTIFIER "BOUGH_COMPILER_KNOWS_${variant}" knows)
  check_cxx_compiler_flag("-march=${variant}" ${knows})
  if(NOT ${knows})
    message(FATAL_ERROR "BOUGH_DISPATCH needs a compiler that knows -march=${variant} (g++ 11, clang 12)")
  endif()
endforeach()
unset(CMAKE_REQUIRED_QUIET)
set(BUILD_SHARED_LIBS ON)

# A library calls its own copies of what it and others hold: template instances and inline functions have the same names in
# the baseline's program and in every variant, and by the rules of ELF the program's would be taken for all. -z defs: what
# no library below defines is an error of the build.
function(bough_bind_to_itself target)
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
  target_link_options(${target} PRIVATE LINKER:-Bsymbolic-functions LINKER:-z,defs)
  set_target_properties(${target} PROPERTIES VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")
endfunction()

# Makes TARGET-VARIANT, so far as TARGET, the library of that instruction set.
function(bough_make_variant target variant)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    return()
  endif()
  target_compile_options(${target}-${variant} PRIVATE "-march=${variant}")
  set_target_properties(${target}-${variant} PROPERTIES
    OUTPUT_NAME ${target}
    LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib/glibc-hwcaps/${variant}"
    INSTALL_RPATH "$ORIGIN/../..")  # the folder of the baseline, so that the loader chooses there as it did before
  install(TARGETS ${target}-${variant}
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${variant}" NAMELINK_SKIP)
endfunction()
