#!/bin/sh
# busy.sh BUILD_FOLDER [ROUNDS] [CASES]   time of a step beside a busy loop of the shell: bench_step on one and two
# threads, alternately without and with the loop, then the medians of all repetitions. The machine must have no other
# load; a wide range shows that it had.
set -eu
program=$1/benchmarks/bench_step
[ -x "$program" ] || { echo "no $program" >&2; exit 1; }
rounds=${2:-4}
cases=${3:-'chain_2048|lattice_50'}
loop=
rows=$(mktemp)
stop() {
  if [ -n "$loop" ]; then kill "$loop" 2>/dev/null || true; fi
  loop=
}
trap 'stop; rm -f "$rows"' EXIT
trap 'exit 130' INT TERM
while [ "$rounds" -gt 0 ]; do
  for way in quiet busy; do
    if [ "$way" = busy ]; then
      sh -c 'while :; do :; done' &
      loop=$!
    fi
    "$program" --case="$cases" --solver=bough --benchmark_repetitions=3 --benchmark_format=csv 2>/dev/null |
      sed -n "s|^\"bough/\(.*\)/real_time\",[^,]*,\([^,]*\),.*|\1 $way \2|p" >>"$rows"
    stop
  done
  rounds=$((rounds - 1))
done
python3 - "$rows" <<'END'
import statistics, sys
times = {}
for row in open(sys.argv[1]):
    case, way, milliseconds = row.split()
    times.setdefault(case, {}).setdefault(way, []).append(float(milliseconds))
for case, of in times.items():
    medians = {way: statistics.median(values) for way, values in of.items()}
    ranges = {way: f"{medians[way]:.2f} ({min(values):.2f} to {max(values):.2f})" for way, values in of.items()}
    print(f"{case}: quiet {ranges['quiet']}, busy {ranges['busy']} ms, ratio {medians['busy'] / medians['quiet']:.2f}")
END
