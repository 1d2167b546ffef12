#!/bin/sh
# check_limits.sh PROGRAM   what is said of memory, steps and stack before a run.
set -u
program=$(realpath "$1")
. "$(dirname "$0")/scenes.sh"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
# expect STATUS PATTERN WORDS...
expect() {
  want=$1 pattern=$2
  shift 2
  "$@" > printed 2>&1
  got=$?
  if [ "$got" -ne "$want" ] || ! grep -qe "$pattern" printed; then
    failures=$((failures + 1))
    echo "FAIL: $*: status $got, wanted $want and '$pattern':"
    cat printed
  fi
}
pendulum 0.5 > good.json
sed 's|"bodies"|"nodes": [{"name": "a", "position": [0, 1, 0]}, {"name": "b", "position": [9, 1, 0]}],\
 "sections": [{"name": "bar", "stiffness": [1e6, 1e6, 1e6, 1e3, 1e3, 1e3],\
   "mass": {"mass_per_length": 1, "rotary": [1e-3, 5e-4, 5e-4]}}],\
 "beams": [{"name": "bar", "section": "bar", "start": "a", "end": "b", "elements": 1000000}],\
 "bodies"|' good.json > large.json

# memory: refused with the numbers, before anything is allocated, by everyone who would take it
for verb in run check plan profile tune export-matrix; do
  expect 2 'about [0-9]* MB of memory, .*and 1[0-9]* MB are there: 1000000 nodes' \
    "$program" $verb large.json --memory-limit 1G
done
[ ! -e large.out ] || { failures=$((failures + 1)); echo "FAIL: a folder for a run that was refused"; }
mkdir scenes && cp large.json scenes
expect 1 'MB of memory' "$program" batch scenes --out batch --memory-limit 1G
expect 2 'about 18000 MB of memory, .*and [0-9]* MB are there' sh -c "ulimit -v 400000; '$program' check large.json"
# a study and the table of stiff cases: every run that they would make, before any of them
cat > study.json << 'END'
{"schema_version": 1, "title": "Meshes", "scene": "large.json", "sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
 "quantities": [{"name": "place", "sensor": "bob", "unit": "m", "formula": [0, 0, 0], "source": "none", "uncertainty": 0}],
 "grids": [{"name": "meshes", "axes": [{"name": "elements", "values": [4, 8, 500000, 1000000]}]}]}
END
expect 2 "the run 'elements 1000000' of the grid 'meshes' (and 1 more): .* MB are there: 1000000 nodes" \
  "$program" study study.json --out study --threads 1 --memory-limit 1G
expect 2 'MB of memory, .*and 540 MB are there: .*; 2 runs go side by side' \
  "$program" study study.json --out study --threads 2 --memory-limit 1G
[ ! -e study ] || { failures=$((failures + 1)); echo "FAIL: a folder for a study that was refused"; }
expect 1 'elastica: fails, listed as holds: a run would take about [0-9]* MB of memory, and 1 MB are there' \
  "$program" stress --quick --out stress --case elastica --memory-limit 1M
expect 0 'hold, 0 fail' "$program" stress --quick --out stress --case elastica --memory-limit 64M
for verb in study stress; do
  expect 2 "is not a size" "$program" $verb study.json --out study --memory-limit=nan
done
expect 0 'ok: ' "$program" check good.json --memory-limit 64M
for size in 0 -1 nan 1X M; do expect 2 "is not a size" "$program" check good.json --memory-limit=$size; done

# a law with millions of breakpoints is named, by check and by the run that comes to it
sed 's|"sensors"|"loads": [{"name": "push", "at": "bob", "force": [0, 0, 1],\
  "law": {"expression": "step(sin(1e9*t))"}}], "sensors"|' good.json > fast.json
expect 2 'law changes branch more than 1000 times a step of 0.01 s' "$program" check fast.json
sed 's|step(sin(1e9\*t))|step(sin(max(0, t-1)*1e9))|; s|"end_time": 0.5|"end_time": 2|' fast.json > later.json
expect 1 "the law of 'push' changes branch more than 1000 times a step" "$program" run later.json

# the plan: steps and time, and what a decision changes in per cent
expect 0 '^a run, 50 steps, about ' "$program" plan good.json
expect 0 '[0-9] % shorter\|[0-9] % longer\|step the same' "$program" plan good.json

# a stack that no run fits in is told, one that can be raised is
for size in 64 256 900; do
  expect 1 "the stack is limited to $size kB" sh -c "ulimit -s $size; '$program' run good.json"
done
expect 0 'done' sh -c "ulimit -s 1024; '$program' run good.json"
expect 0 'done' sh -c "ulimit -S -s 128; '$program' run good.json"
[ "$failures" -eq 0 ]
