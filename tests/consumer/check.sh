#!/bin/sh
# check.sh KIND BUILD SOURCE SCRATCH COMPILER   installs bough into SCRATCH, builds this project against it, runs it.
#   static  installs the build folder that the tests run from
#   shared  first builds the library again as shared libraries, without optimisation, to keep it short
set -eu
kind=$1 build=$2 source=$3 scratch=$4 compiler=$5
rm -rf "$scratch/prefix" "$scratch/user"
mkdir -p "$scratch"
if [ "$kind" = shared ]; then
  cmake -G Ninja -S "$source" -B "$scratch/build" -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_CXX_COMPILER="$compiler" -DBOUGH_BUILD_TESTS=OFF -DBOUGH_BUILD_APPS=OFF \
    -DCMAKE_INSTALL_PREFIX="$scratch/prefix"
  cmake --build "$scratch/build" --parallel 2
  build=$scratch/build
fi
cmake --install "$build" --prefix "$scratch/prefix" > "$scratch/install.log"
cmake -G Ninja -S "$source/tests/consumer" -B "$scratch/user" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler"
cmake --build "$scratch/user"
"$scratch/user/consumer" "$source"
