#!/bin/sh
# check_files.sh PROGRAM   what the program does to files, streams and processes around it: nothing of others is
# touched, former good results stand until new ones do, mixed results are refused, and what cannot be written is told.
set -u
program=$(realpath "$1")
. "$(dirname "$0")/scenes.sh"
scratch=$(mktemp -d)
trap 'chmod -R u+w "$scratch"; rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
checks=0

# expect STATUS PATTERN WORDS...   PATTERN must occur in what is printed (both streams), unless it is "silence"
expect() {
  want=$1 pattern=$2
  shift 2
  "$program" "$@" > printed 2>&1
  report $? "$*"
}
# report STATUS WHAT   after `want` and `pattern` were set and `printed` was written
report() {
  checks=$((checks + 1))
  if [ "$1" -ne "$want" ] || { [ "$pattern" != silence ] && ! grep -qe "$pattern" printed; }; then
    failures=$((failures + 1))
    echo "FAIL: bough $2: status $1, wanted $want and '$pattern':"
    cat printed
  fi
}
# holds WORDS...   a shell test
holds() {
  checks=$((checks + 1))
  "$@" || { failures=$((failures + 1)); echo "FAIL: $*"; }
}

pendulum 0.5 > good.json
pendulum 0.3 > short.json
sed 's/"step_size": 0.01/"step_size": 0.01, "max_iterations": 1, "max_cuts": 0/' good.json > fails.json

# standard streams that are closed, broken or full
"$program" run good.json --out whole > /dev/null 2>&1
for closed in '2>&-' '>&- 2>&-' '<&- >&- 2>&-'; do
  rm -rf closed
  eval "\"$program\" run good.json --quiet --out closed $closed"
  holds test $? -eq 0
  holds cmp whole/history.csv closed/history.csv
done
want=1 pattern='cannot write to standard output'
for verb in --help --version 'check good.json' schema doctor 'plan good.json' 'run good.json --out full' \
  'compare whole whole' 'kinematics razi' 'kinematics motion --to 1 2 3' 'view whole' 'export-matrix good.json' \
  'tune good.json --steps 1 --seconds 0' \
  'profile good.json --steps 2 --out full.profile'; do
  # shellcheck disable=SC2086
  "$program" $verb > /dev/full 2> printed
  report $? "$verb > /dev/full"
done
"$program" schema 2> printed >&-
report $? 'schema >&-'
{ "$program" schema 2> printed; echo $? > status; } | true
report "$(cat status)" 'schema | true'
want=1 pattern='File too large'
(ulimit -f 1; "$program" run good.json --out limited --quiet > /dev/null 2> printed)
report $? 'run with a limit on the size of files'

# what a terminal gets
escape=$(printf '\033')
cp good.json "red$escape[31m.json"
printf '{"a": 1, "b%s[31m": 2, "c\377": 3}' "$escape" > colours.json
for file in "red$escape[31m.json" colours.json "missing$escape[2J.json" "$(printf 'latin\351.json')"; do
  "$program" check "$file" > printed 2>&1
  "$program" run "$file" --out coloured >> printed 2>&1
  holds test -z "$(LC_ALL=C grep "$escape" printed)"
  holds iconv -f UTF-8 -t UTF-8 -o /dev/null printed
done
{ cat good.json; printf '\0and more'; } > zero.json
expect 2 'zero byte' check zero.json

# standard input
"$program" run - --out from_input --quiet < good.json
holds cmp whole/history.csv from_input/history.csv
expect 2 'not JSON' check - < /dev/null

# what is not finite, or cannot be counted
expect 2 '1e+19 steps' run good.json --set /analysis/step_size=1e-19 --set /analysis/end_time=1 --out steps
holds test ! -e steps
sed 's/"position": \[1, 0, 0\]}/"position": [1e300, 0, 0]}/; s/"joints".*$//' good.json > far.json
"$program" run far.json --set /bodies/bob/position=[1e308,0,1e308] --out far > printed 2>&1
holds test $? -ne 0

# inputs are never overwritten
for words in 'plan good.json --json good.json' 'tune good.json --steps 1 --seconds 0 --out ./good.json' \
  'export-matrix good.json --out good.json' \
  'export-matrix good.json --out m.mtx --rhs m.mtx' 'run good.json --out .' 'profile good.json --out .' \
  'run whole/summary.json --out whole' \
  'view whole --out whole/history.csv' 'view whole --out w.html --svg w.html' \
  'kinematics razi --csv r.csv --json r.csv'; do
  cp good.json before.json
  # shellcheck disable=SC2086
  expect 2 . $words
  holds cmp good.json before.json
  cp before.json good.json
done
holds test ! -e m.mtx -a ! -e r.csv -a ! -e w.html
mkdir scenes && cp good.json scenes/a.json
expect 2 'is read here' batch scenes --out scenes
holds test "$(ls scenes)" = a.json

# nothing of others is removed, no link is followed
"$program" run good.json --out mixed --quiet
touch mixed/motion/frame_999999.vtu
expect 2 'frame_999999.vtu' run short.json --out mixed
holds test -e mixed/motion/frame_999999.vtu
holds test -e mixed/motion/frame_000000.vtu
mkdir precious && touch precious/frame_000000.vtu
"$program" run good.json --out linked --quiet && rm -r linked/motion && ln -s "$scratch/precious" linked/motion
expect 2 'linked' run short.json --out linked
holds test -e precious/frame_000000.vtu
mkdir outer && mkdir outer/scenes && cp good.json outer/scenes/...json
expect 0 '1 cases' batch outer/scenes --out outer/results
holds test ! -e outer/history.csv
holds test -s outer/results/...json/history.csv

# twice into one folder, also into the one that the process stands in
expect 0 silence run short.json --out twice --quiet
expect 0 silence view twice
expect 0 silence run good.json --out twice --replace --quiet
holds cmp whole/history.csv twice/history.csv
holds test ! -e twice/view.html
holds test -z "$(ls -a | grep bough-new)"
mkdir here && (cd here && "$program" run ../short.json --out . --quiet && "$program" run ../good.json --out . --replace --quiet)
holds test $? -eq 0
holds cmp whole/history.csv here/history.csv

# a run that fails keeps former good results
expect 1 'kept' run fails.json --out twice --replace
holds cmp whole/history.csv twice/history.csv
holds grep -q '"status": "failed"' twice.failed/summary.json
expect 1 'fails' run fails.json --out fresh
holds grep -q '"status": "failed"' fresh/summary.json

# a second run into a folder that is being written
pendulum 100000 > long.json
"$program" run long.json --out twice --replace --set /output/motion=false --quiet 2> /dev/null &
process=$!
until [ -e .twice.bough-new/manifest.json ]; do kill -0 $process || break; sleep 0.1; done
expect 1 'another run is writing it' run good.json --out twice --replace
kill -HUP $process
wait $process
holds test $? -eq 3
holds cmp whole/history.csv twice/history.csv
holds grep -q '"status": "interrupted"' twice.failed/summary.json

# files of different runs are refused
cp -r whole mix && cp from_input/history.csv mix/ && expect 0 silence view mix --out mix.html
"$program" run short.json --out other --quiet
cp other/motion.bin mix/motion.bin
expect 2 'not the file that was written with the summary' view mix
cp whole/motion.bin mix/ && cp other/history.csv mix/
expect 2 'not the file that was written with the summary' compare mix whole
rm -f mix/summary.json
expect 0 'did not end' view mix
"$program" run good.json --out set --set /output/stride=2 --quiet
holds grep -q '^ *"/output/stride=2"$' set/summary.json
holds grep -q '"scene_hash": "[0-9a-f]\{16\}"' set/summary.json
holds grep -q '"program_hash": "[0-9a-f]\{16\}"' set/summary.json

# batch: figures that fail are said, a case past its limit keeps its rows
figure='{"quantity": "bob.x", "time": 0.5, "value": 7, "tolerance": 1}'
sed "s|\"sensors\"|\"expected\": [$figure], \"sensors\"|" good.json > scenes/figure.json
expect 0 'figure: figures_fail: bob.x' batch scenes --out judged
holds grep -q '^figure,figures_fail,"*bob.x' judged/batch.csv
expect 1 'figures_fail' batch scenes --out judged --replace --check-expected --quiet
mkdir slow && cp long.json slow/
expect 1 'long: timed_out: stopped by the time limit of 2 s' batch slow --out limited.batch --time-limit 2 \
  --set /output/motion=false
holds test "$(wc -l < limited.batch/long/history.csv)" -gt 2

# a study that measures nothing is no success, and says so
cat > study.json <<'END'
{"schema_version": 1, "scene": "good.json", "set": [{"pointer": "/analysis/end_time", "value": 0.2}],
 "quantities": [{"name": "place", "sensor": "bob"}], "repetitions": 1,
 "reference": {"set": [{"pointer": "/analysis/step_size", "value": 2.5e-4}],
               "check": [{"pointer": "/analysis/step_size", "value": 5e-4}], "order": 2},
 "grids": [{"name": "steps", "axes": [{"name": "step size", "values": [0.02]}],
   "orders": [{"quantity": "place", "order": 2, "theory": "second order"}]}]}
END
expect 1 'could be measured' study study.json --out measured --quiet
expect 2 . study study.json --out . --quiet
holds test -s study.json

echo "files, streams and processes: $((checks - failures)) of $checks checks passed"
[ "$failures" -eq 0 ]
