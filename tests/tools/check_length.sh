#!/bin/sh
# Reports files of more than 400 lines; fails on one of more than 600 in the library or the program.
set -eu
cd "$(dirname "$0")/../.."
find include src apps tests benchmarks \( -name '*.hpp' -o -name '*.cpp' \) -exec wc -l {} + |
  awk '$2 != "total" && $1 > 400 { print $1, $2 }' | sort -rn |
  awk '
    { mark = ($1 > 600 && $2 !~ /^(tests|benchmarks)\//) ? "  too long" : ""; if (mark != "") bad++
      printf "%5d lines  %s%s\n", $1, $2, mark }
    END { printf "file lengths: %d over 400 lines, %d too long\n", NR, bad; exit bad > 0 }'
