#!/bin/sh
# Runs clang-tidy on the library and the program with the compile commands of the dev-clang preset, and fails on
# findings of the naming rules, of bugprone or of performance.
set -eu
cd "$(dirname "$0")/../.."
cmake --preset dev-clang > /dev/null
cmake --build build/dev-clang --target bough_version
find src apps -name '*.cpp' -print0 |
  xargs -0 -n 4 -P "$(nproc)" clang-tidy-14 --quiet --warnings-as-errors='*' -p build/dev-clang 2>/dev/null
