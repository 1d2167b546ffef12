#!/bin/sh
# check.sh KIND SOURCE SCRATCH COMPILER [BUILD]   installs bough into SCRATCH/KIND, builds a project against it, runs it.
#   static   installs BUILD, the build folder that the tests run from
#   minimal  builds the core library alone: CMake is not allowed to find what it does without, and the user must not load it
#   shared   builds the whole library in the folder of minimal, where most files are compiled already
# The last two are shared libraries without optimisation, to keep it short; with lines, for lean/check.sh.
set -eu
[ -z "${BOUGH_TEST_CPU:-}" ] || ulimit -t "$BOUGH_TEST_CPU"  # of one process; a busy machine does not matter
kind=$1 source=$2 scratch=$3 compiler=$4 build=${5:-$3/build}
prefix=$scratch/$kind/prefix user=$scratch/$kind/user
rm -rf "$prefix" "$user"
mkdir -p "$scratch/$kind"

# build_library OPTION...
build_library() {
  cmake -G Ninja -S "$source" -B "$build" -DBUILD_SHARED_LIBS=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O0 -g1" \
    -DCMAKE_CXX_COMPILER="$compiler" -DBOUGH_BUILD_TESTS=OFF -DBOUGH_BUILD_APPS=OFF -DCMAKE_INSTALL_PREFIX="$prefix" "$@"
  cmake --build "$build" --parallel 2
}

# with_left_out ON|OFF   the packages that the core library does without, for CMake to look for or not
with_left_out() {
  for package in nlohmann_json muparser CLI11 METIS KLU GTest; do
    printf ' -DCMAKE_DISABLE_FIND_PACKAGE_%s=%s' "$package" "$1"
  done
}

hidden=
project=$source/tests/consumer
# shellcheck disable=SC2046
case $kind in
  minimal)
    hidden=$(with_left_out ON)
    project=$source/tests/consumer/minimal
    build_library -DBOUGH_WITH_IO=OFF -DBOUGH_WITH_METIS=OFF -DBOUGH_WITH_KLU=OFF $hidden
    ;;
  shared)
    build_library -DBOUGH_WITH_IO=ON -DBOUGH_WITH_REPORTS=ON -DBOUGH_WITH_VTK=ON -DBOUGH_WITH_METIS=ON -DBOUGH_WITH_KLU=ON \
      $(with_left_out OFF)
    ;;
esac
cmake --install "$build" --prefix "$prefix" > "$scratch/$kind/install.log"
# shellcheck disable=SC2086
cmake -G Ninja -S "$project" -B "$user" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" $hidden
cmake --build "$user"
"$user/consumer" "$source"
if [ "$kind" = static ]; then  # of a user whose own libraries are shared
  cmake -G Ninja -S "$project" -B "$user" -DBUILD_SHARED_LIBS=ON
  cmake --build "$user"
  "$user/consumer" "$source"
fi
if [ "$kind" = static ] && [ -x "$prefix/bin/bough" ] && command -v python3 > /dev/null; then
  # What is installed for notebooks works there; 77: there is no NumPy.
  python3 "$source/tests/apps/check_python.py" "$prefix/bin/bough" "$prefix/share/bough/python" || [ $? = 77 ]
fi
[ "$kind" = minimal ] || exit 0

left_out='metis|klu|libamd|libbtf|colamd|suitesparse|nlohmann|muparser|CLI11'
ldd "$user/consumer" | tee "$scratch/$kind/ldd.txt"
grep -q libtbb "$scratch/$kind/ldd.txt" || { echo "TBB is not loaded: what was looked at is not the program"; exit 1; }
if grep -E -i "$left_out" "$scratch/$kind/ldd.txt"; then
  echo "loaded, though left out: the lines above"
  exit 1
fi
if grep -E -i "LINK_LIBRARIES.*($left_out)" "$user/build.ninja"; then
  echo "linked, though left out: the lines above"
  exit 1
fi
if find "$prefix" -path '*/bough/io/*' ! -name number_text.hpp -o -path '*/bough/report/*' -o -name '*bough_report*' | grep .; then
  echo "installed, though left out: the files above"
  exit 1
fi
