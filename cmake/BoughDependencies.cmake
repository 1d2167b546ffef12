# Everything the layers link from outside, found once. A layer names imported targets only:
#   Eigen3::Eigen  TBB::tbb  nlohmann_json::nlohmann_json (with BOUGH_WITH_IO)  Threads::Threads
#   ZLIB::ZLIB (with BOUGH_WITH_IO)
#   SuiteSparse::KLU and METIS::METIS exist only when BOUGH_HAS_KLU / BOUGH_HAS_METIS is true here.
# What programs and tests use besides (CLI11, GoogleTest, muParser) is found where it is used.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
if(BOUGH_WITH_IO)
  find_package(nlohmann_json 3.11 REQUIRED)
endif()

# What compresses VTU files and pages.
set(BOUGH_NEEDS_ZLIB OFF)
if(BOUGH_WITH_IO)
  find_package(ZLIB REQUIRED)
  set(BOUGH_NEEDS_ZLIB ON)
endif()

set(BOUGH_HAS_KLU OFF)
if(BOUGH_WITH_KLU)
  find_package(KLU)
  set(BOUGH_HAS_KLU ${KLU_FOUND})
endif()

# GPL: never part of what is passed on. Asked for means needed.
set(BOUGH_HAS_GPL OFF)
if(BOUGH_WITH_GPL)
  find_package(GplSuiteSparse REQUIRED)
  set(BOUGH_HAS_GPL ON)
endif()

set(BOUGH_HAS_METIS OFF)
if(BOUGH_WITH_METIS)
  find_package(METIS)
  set(BOUGH_HAS_METIS ${METIS_FOUND})
endif()
