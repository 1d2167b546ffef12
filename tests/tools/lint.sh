#!/bin/sh
# Checks the format, the arrows of includes, the lengths of files, READMEs and lines of text, and that no code outside
# of elements depends on the type of an element. Every check runs; the exit status is 0 if all passed.
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
# Elements declare what they are (elements::Role etc.); code outside must not guess it from their types or members.
guesses=$(grep -rnE 'is_same_v<.*elements::|requires( ?\(.*\))? ?\{ *(e|element|own|load)\.' src apps include \
  --include='*.cpp' --include='*.hpp' | grep -v '^\(src\|include/bough\)/elements/')
if [ -n "$guesses" ]; then
  echo "types of elements are guessed:"
  echo "$guesses"
  failed=1
fi
# Rows of tables cannot be wrapped.
long=$(find . -name '*.md' -not -path './build/*' -exec grep -nE '^[^|].{120,}$' {} +)
if [ -n "$long" ]; then
  echo "lines of more than 120 characters:"
  echo "$long"
  failed=1
fi
# A README is one page: what is longer belongs to the manual.
pages=$(wc -l README.md src/*/README.md benchmarks/README.md tests/*/README.md | awk '$2 != "total" && $1 >= 120 { print $1, $2 }')
if [ -n "$pages" ]; then
  echo "READMEs of 120 lines and more:"
  echo "$pages"
  failed=1
fi
sh tests/tools/check_length.sh || failed=1
exit $failed
