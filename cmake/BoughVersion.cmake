# bough/version.hpp: the one version of project(), the commit, the compiler and its flags. The commit is read at
# every build; the file is rewritten only when its text changes, so that nothing is compiled again without need.
set(BOUGH_GENERATED_DIR "${CMAKE_CURRENT_BINARY_DIR}/generated/include")

string(TOUPPER "${CMAKE_BUILD_TYPE}" _build_type)
set(_flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${_build_type}} -ffp-contract=off")
if(BOUGH_ARCH)
  string(APPEND _flags " -march=${BOUGH_ARCH}")
endif()
if(BOUGH_VARIANTS)
  list(JOIN BOUGH_VARIANTS " or -march=" _variants)
  string(APPEND _flags ", layers also -march=${_variants}")
endif()
string(STRIP "${_flags}" _flags)
set(_version_command
  "${CMAKE_COMMAND}"
  "-DTEMPLATE=${CMAKE_CURRENT_SOURCE_DIR}/cmake/version.hpp.in"
  "-DOUTPUT=${BOUGH_GENERATED_DIR}/bough/version.hpp"
  "-DSOURCE_DIR=${CMAKE_CURRENT_SOURCE_DIR}"
  "-DBOUGH_VERSION=${PROJECT_VERSION}"
  "-DBOUGH_COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
  "-DBOUGH_FLAGS=${_flags}"
  -P "${CMAKE_CURRENT_SOURCE_DIR}/cmake/write_version.cmake")
execute_process(COMMAND ${_version_command} COMMAND_ERROR_IS_FATAL ANY)
add_custom_target(bough_version COMMAND ${_version_command} VERBATIM COMMENT "Reading the commit")
