#!/bin/sh
# check.sh SOURCE MINIMAL SCRATCH COMPILER   builds left_out.cpp with the core library that consumer/check.sh has left under MINIMAL, and has
# left_out.py run it under callgrind. That library is not optimised: nothing is inlined, every instruction is charged to the function that
# asks for it, and none is one that valgrind does not know.
set -eu
[ -z "${BOUGH_TEST_CPU:-}" ] || ulimit -t "$BOUGH_TEST_CPU"  # of one process; a busy machine does not matter
source=$1 minimal=$2 scratch=$3 compiler=$4
if ! command -v valgrind >/dev/null || ! command -v python3 >/dev/null; then
  echo "SKIPPED: valgrind or python3 is not installed"
  exit 77
fi
mkdir -p "$scratch"
cmake -G Ninja -S "$source/tests/lean" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$minimal/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O0 -g1" > "$scratch/configure.log"
cmake --build "$scratch/build" --clean-first
exec python3 "$source/tests/lean/left_out.py" "$scratch/build/left_out" "$source" "$scratch/profiles"
