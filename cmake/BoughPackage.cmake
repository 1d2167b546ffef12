# `make deb`: a Debian package of all that `make install` installs, made by CPack. What only a package has (its copyright
# file, the module where Debian's Python looks) stands in the component `debian`, which no other installation takes.
if(NOT PROJECT_IS_TOP_LEVEL OR NOT BOUGH_BUILD_APPS)
  return()
endif()
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES apps/python/bough.py DESTINATION lib/python3/dist-packages COMPONENT debian EXCLUDE_FROM_ALL)

if(BOUGH_DISPATCH)
  set(_processors "It runs on every x86-64, with AVX2 or AVX-512 where the processor has it.")
elseif(BOUGH_ARCH)
  set(_processors "This one is built for processors like that of one machine (-march=${BOUGH_ARCH}).")
else()
  set(_processors "It uses what every processor of this architecture has.")
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bough)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "flexible multibody dynamics: beams, rigid bodies and joints")
set(CPACK_PACKAGE_DESCRIPTION "bough computes the motion and the internal forces of flexible multibody systems:
geometrically exact beams, rigid bodies, springs and joints, in statics and in
time, and their modes of vibration. A scene is a JSON file.
.
The package has the program, the library with its headers and CMake package,
the module for Python and the manual. ${_processors}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};bough;ALL;/;${CMAKE_BINARY_DIR};bough;debian;/")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "bough authors <bough@localhost>")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Where libraries of the package's own lie in the build folder, so that they are not looked for in other packages.
if(BOUGH_DISPATCH)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_BINARY_DIR}/lib")
elseif(BUILD_SHARED_LIBS)
  list(TRANSFORM BOUGH_LAYERS PREPEND "${CMAKE_BINARY_DIR}/src/" OUTPUT_VARIABLE CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS)
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy")
# For programs that are built against it.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, libeigen3-dev, libtbb-dev, libsuitesparse-dev, libmetis-dev, zlib1g-dev")
include(CPack)
