#!/bin/sh
# Format, include arrows and file lengths. Every check runs; the exit status tells whether all passed.
set -u
cd "$(dirname "$0")/../.."
format=clang-format-14
command -v "$format" >/dev/null || format=clang-format
failed=0

if find include src apps tests benchmarks \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
    xargs -0 -r "$format" --dry-run --Werror --ferror-limit=1; then
  echo "format: clean"
else
  echo "format: run 'make format'"
  failed=1
fi
python3 tests/tools/check_includes.py || failed=1
sh tests/tools/check_length.sh || failed=1
exit $failed
