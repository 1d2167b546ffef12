# The installed package: find_package(bough) gives bough::bough and one target per layer. The find modules of the
# optional libraries are installed beside the config file, since their packages bring none.
include(CMakePackageConfigHelpers)
set(_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/bough")

install(FILES "${BOUGH_GENERATED_DIR}/bough/version.hpp" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/bough")
install(EXPORT boughTargets NAMESPACE bough:: DESTINATION "${_package_dir}")
configure_package_config_file("${CMAKE_CURRENT_SOURCE_DIR}/cmake/boughConfig.cmake.in"
  "${CMAKE_CURRENT_BINARY_DIR}/boughConfig.cmake" INSTALL_DESTINATION "${_package_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/boughConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${CMAKE_CURRENT_BINARY_DIR}/boughConfig.cmake"
  "${CMAKE_CURRENT_BINARY_DIR}/boughConfigVersion.cmake"
  cmake/FindKLU.cmake
  cmake/FindMETIS.cmake
  DESTINATION "${_package_dir}")

# What must go along with every copy: the licence, and those of what is linked or bundled.
install(FILES LICENSE THIRD_PARTY.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# The manual as Markdown, and as pages where the target `bough_manual` has made them.
install(DIRECTORY data/manual/ DESTINATION "${CMAKE_INSTALL_DOCDIR}/manual" PATTERN "make" EXCLUDE)
if(BOUGH_BUILD_APPS)
  find_package(Python3 COMPONENTS Interpreter QUIET)
  if(Python3_FOUND)
    set(_manual "${CMAKE_CURRENT_BINARY_DIR}/manual")
    add_custom_target(bough_manual COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/data/manual/make/render.py"
      $<TARGET_FILE:bough> "${_manual}" VERBATIM)
    install(DIRECTORY "${_manual}/site/" DESTINATION "${CMAKE_INSTALL_DOCDIR}/manual" OPTIONAL)
    install(FILES "${_manual}/manual.html" DESTINATION "${CMAKE_INSTALL_DOCDIR}" OPTIONAL)
    # Pages of `man` and completion of words in the shell, where the target `bough_shell` has made them.
    set(_shell "${CMAKE_CURRENT_BINARY_DIR}/shell")
    add_custom_target(bough_shell COMMAND "${Python3_EXECUTABLE}" "${CMAKE_CURRENT_SOURCE_DIR}/data/manual/make/shell.py"
      $<TARGET_FILE:bough> "${_shell}" "${PROJECT_VERSION}" VERBATIM)
    install(DIRECTORY "${_shell}/man1/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" OPTIONAL)
    install(DIRECTORY "${_shell}/completions/" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" OPTIONAL)
  endif()
endif()

# The reader and runner for Python: put this folder into PYTHONPATH.
if(BOUGH_BUILD_APPS)
  install(FILES apps/python/bough.py DESTINATION "${CMAKE_INSTALL_DATADIR}/bough/python")
endif()

# Libraries of a BOUGH_DISPATCH build that lie there would be loaded instead of those installed now.
if(BUILD_SHARED_LIBS AND NOT BOUGH_DISPATCH)
  install(CODE "
    file(GLOB older \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/*/libbough_*\")
    if(older)
      message(FATAL_ERROR \"This prefix holds libraries of a build with BOUGH_DISPATCH, which the loader would take instead of \"
        \"these. Remove them first: \${older}\")
    endif()")
endif()

include(BoughPackage)
