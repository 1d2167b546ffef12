#!/bin/sh
# check_minimal.sh SOURCE SCRATCH COMPILER   builds and installs the core library alone, without optimisation to keep it short, builds a
# user of it, runs it, and looks at what it loads. CMake is not allowed to find what the core does without. Lines are told for lean/check.sh.
set -eu
source=$1 scratch=$2 compiler=$3
none=
for package in nlohmann_json muparser CLI11 METIS KLU GTest; do
  none="$none -DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"
done
rm -rf "$scratch/prefix" "$scratch/user"
mkdir -p "$scratch"
# shellcheck disable=SC2086
cmake -G Ninja -S "$source" -B "$scratch/build" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O0 -g1" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_INSTALL_PREFIX="$scratch/prefix" -DBOUGH_BUILD_TESTS=OFF -DBOUGH_BUILD_APPS=OFF \
  -DBOUGH_WITH_IO=OFF -DBOUGH_WITH_METIS=OFF -DBOUGH_WITH_KLU=OFF $none
cmake --build "$scratch/build" --parallel 2
cmake --install "$scratch/build" > "$scratch/install.log"
# shellcheck disable=SC2086
cmake -G Ninja -S "$source/tests/consumer/minimal" -B "$scratch/user" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" $none
cmake --build "$scratch/user"
"$scratch/user/consumer"

left_out='metis|klu|libamd|libbtf|colamd|suitesparse|nlohmann|muparser|CLI11'
ldd "$scratch/user/consumer" | tee "$scratch/ldd.txt"
grep -q libtbb "$scratch/ldd.txt" || { echo "TBB is not loaded: what was looked at is not the program"; exit 1; }
if grep -E -i "$left_out" "$scratch/ldd.txt"; then
  echo "loaded, though left out: the lines above"
  exit 1
fi
if grep -E -i "LINK_LIBRARIES.*($left_out)" "$scratch/user/build.ninja"; then
  echo "linked, though left out: the lines above"
  exit 1
fi
if find "$scratch/prefix" -path '*/bough/io/*' ! -name number_text.hpp -o -path '*/bough/report/*' -o -name '*bough_report*' | grep .; then
  echo "installed, though left out: the files above"
  exit 1
fi
