#!/bin/sh
# run.sh BUILD_FOLDER   runs all benchmarks, then prints the tables of ratios: micro (JSON beside the programs), and
# solve, matrices, step, lean, second_thread (the gain by a second thread), motion and start (each to BUILD_FOLDER/NAME.json).
set -eu
build=$1
folder=$build/benchmarks
here=$(dirname "$0")
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1   # one thread a call, whatever BLAS is installed
found=0
for name in solve step lean; do
  program=$folder/bench_$name
  [ -x "$program" ] || continue
  found=1
  "$program" --benchmark_out="$build/$name.json" --benchmark_out_format=json --benchmark_display_aggregates_only=true
  sed -i 's|/real_time||g' "$build/$name.json"   # the rows are SOLVER/CASE/threads:N
done
if [ -x "$folder/bench_solve" ]; then
  "$folder/bench_solve" --matrix "$here/../data/reference/matrices" --benchmark_display_aggregates_only=true \
    --benchmark_out="$build/matrices.json" --benchmark_out_format=json
  sed -i 's|/real_time||g' "$build/matrices.json"
  "$folder/bench_solve" --side_by_side=yes --benchmark_repetitions=9 --benchmark_display_aggregates_only=true \
    --benchmark_out="$build/second_thread.json" --benchmark_out_format=json
fi
if [ -x "$folder/bench_motion" ]; then
  found=1
  "$folder/bench_motion" --benchmark_min_time=0.05 --benchmark_repetitions=9 --benchmark_enable_random_interleaving=true \
    --benchmark_display_aggregates_only=true --benchmark_out="$build/motion.json" --benchmark_out_format=json
fi
if [ -x "$folder/bench_start" ]; then
  found=1
  "$folder/bench_start" --benchmark_display_aggregates_only=true --benchmark_out="$build/start.json" --benchmark_out_format=json
fi
for program in "$folder"/bench_*; do
  case "$program" in *.json | */bench_solve | */bench_step | */bench_lean | */bench_motion | */bench_start) continue ;; esac
  [ -x "$program" ] || continue
  found=1
  "$program" --benchmark_min_time=0.1 --benchmark_out="$program.json" --benchmark_out_format=json
done
[ "$found" -eq 1 ] || { echo "no benchmarks in $folder" >&2; exit 1; }
python3 "$here/ratios.py" "$build"
