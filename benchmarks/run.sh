#!/bin/sh
# run.sh BUILD_FOLDER   runs every micro benchmark; tables to the terminal, JSON beside the programs.
set -eu
folder=$1/benchmarks
found=0
for program in "$folder"/bench_*; do
  case "$program" in *.json) continue ;; esac
  [ -x "$program" ] || continue
  found=1
  "$program" --benchmark_min_time=0.2 --benchmark_out="$program.json" --benchmark_out_format=json
done
[ "$found" -eq 1 ] || { echo "no benchmarks in $folder" >&2; exit 1; }
echo "JSON in $folder"
