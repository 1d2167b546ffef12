#!/bin/sh
# check_cli.sh PROGRAM   exit statuses, messages and files of the command line, each in a scratch directory.
set -u
program=$(realpath "$1")
. "$(dirname "$0")/scenes.sh"
reference=$(realpath "$(dirname "$0")/../../data/reference/razi_unit_disc.csv")
gallery=$(realpath "$(dirname "$0")/../../data/scenarios")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
checks=0

# expect STATUS PATTERN WORDS...   PATTERN must occur in what is printed (both streams), unless it is "silence"
expect() {
  want=$1 pattern=$2
  shift 2
  "$program" "$@" > printed 2>&1
  got=$?
  checks=$((checks + 1))
  if [ "$got" -ne "$want" ] || { [ "$pattern" != silence ] && ! grep -qe "$pattern" printed; }; then
    failures=$((failures + 1))
    echo "FAIL: bough $*: status $got, wanted $want and '$pattern':"
    cat printed
  fi
}
# holds WORDS...   a shell test
holds() {
  checks=$((checks + 1))
  "$@" || { failures=$((failures + 1)); echo "FAIL: $*"; }
}

pendulum 0.5 > good.json
echo '{"schema_version": 1, "bodies": [{"name": "a", "mass": -1}, 7], "nonsense": 1}' > bad.json

# words
expect 0 '^bough [0-9]' --version
expect 0 'bough run' --help
for verb in run view batch sweep check expand schema compare export-matrix kinematics study stress profile tune plan doctor status; do expect 0 '  bough '$verb $verb --help; done
expect 2 "did you mean 'run'" rnu good.json
expect 2 "did you mean 'compare'" comapre a b
expect 2 'Verbs:' xyzzy
expect 2 . 
expect 2 . run
expect 2 . run good.json --threads 0
expect 2 . run good.json --threads many
expect 2 . run good.json --no-such-option
expect 2 . run good.json more
expect 2 . view good.out --view sideways
expect 2 'not a number' compare a b --rel nan
holds test ! -e good.out

# a figure of a time beyond a shortened run is told, and no failure
sed 's|"sensors"|"expected": [{"quantity": "bob.x", "time": 0.5, "value": 1, "tolerance": 10}], "sensors"|' good.json > figure.json
expect 0 'not reached' run figure.json --set /analysis/end_time=0.1 --out figure.out --check-expected
holds grep -q '"reached": false' figure.out/summary.json
expect 0 'holds' run figure.json --out figure.out --check-expected

# bad input: every problem, also when quiet; no directory
expect 2 'no such file' run missing.json
expect 2 'nonsense' run bad.json --out bad.out --quiet
expect 2 'mass' run bad.json --out bad.out --quiet
holds test ! -e bad.out
expect 2 'problem' check bad.json
expect 2 . run good.json --set /analysis/step_size=-1 --out bad.out
expect 0 'ok: ' check "$gallery/arm_inverse.json"
expect 0 'ok: 1 body, 2 joints, 1 actuator, 3 sensors, 2 expected figures' check "$gallery/boom_servo.json"
expect 0 'ok: 1 body, 1 joint, 3 signals, 2 sensors, 3 expected figures' check "$gallery/governor.json"
expect 2 "'fore' can still turn about the axis" check "$gallery/arm_inverse.json" --set /joints/1/drives=[]
expect 1 "at joint 'elbow'" run "$gallery/arm_inverse.json" --set /joints/1/drives=[] --out undriven.out
expect 2 . run good.json --set nonsense --out bad.out
holds test ! -e bad.out

# a scene that varies is expanded to one that gives the same results
expect 0 '"rod 2"' expand "$gallery/rod_chain.json" --set /parameters/N=3
"$program" expand "$gallery/rod_chain.json" --set /parameters/N=3 > expanded.json
expect 0 'done' run expanded.json --set /analysis/end_time=0.05 --out expanded.out
expect 0 'done' run "$gallery/rod_chain.json" --set /parameters/N=3 --set /analysis/end_time=0.05 --out varied.out
holds cmp expanded.out/history.csv varied.out/history.csv
expect 2 'no parameter' expand "$gallery/rod_chain.json" --set /parameters/M=3
expect 2 'mass' expand bad.json

# the chain of the manual, with the options given there
page=$gallery/../manual/guides/varying-scenes.md
awk '/^```json/ { text = ""; inside = 1; next } /^```/ { if (inside && text ~ /"repeat"/) printf "%s", text; inside = 0 }
     inside { text = text $0 "\n" }' "$page" > chain.json
for verb in run expand; do
  options=$(sed -n "s/^bough $verb chain.json //p" "$page")
  holds test -n "$options"
  # shellcheck disable=SC2086
  expect 0 . $verb chain.json $options
  holds test -z "$(grep -e DOUBT printed)"
done

# a sweep: the table does not depend on threads or on what is kept; what is measured is a column
sweeps=$gallery/../sweeps
expect 0 '25 cases, 5 left out' sweep "$sweeps/rod_chain_lengths.json" --dry-run
expect 0 '25 cases' sweep "$sweeps/rod_chain_lengths.json" --out sweep.one --threads 1
expect 0 silence sweep "$sweeps/rod_chain_lengths.json" --out sweep.two --threads 2 --keep none --quiet
for file in batch.csv batch.json batch.html cases.csv; do holds cmp sweep.one/$file sweep.two/$file; done
holds grep -q ',N,l,g,lowest,reach$' sweep.one/batch.csv
expect 0 'view.html' view sweep.one --case 07
expect 2 'were not kept' view sweep.two --case 07
expect 2 'has no case 7' view sweep.two --case 7
expect 2 'holds results of bough sweep, not of one run: name the folder of a case' view sweep.two
expect 2 'there is no folder sweep.none' view sweep.none
# of many cases results are stored: failed and chosen ones have folders, and view takes others out of the store
cat > many.json <<EOF
{"schema_version": 1, "scene": "good.json", "set": [{"pointer": "/analysis/end_time", "value": 0.02}],
 "designs": [{"kind": "random", "samples": 210, "variables": [
  {"name": "mass", "pointer": "/bodies/bob/mass", "distribution": {"kind": "uniform", "low": 1, "high": 2}}]}]}
EOF
expect 0 silence sweep many.json --out sweep.many --threads 2 --keep-case 007 --quiet
holds test -s sweep.many/007/history.csv
holds test ! -e sweep.many/008
holds test "$(ls sweep.many | wc -l)" -le 12
expect 0 'view.html' view sweep.many --case 008
"$program" run good.json --out many.one --set /analysis/end_time=0.02 --set "/bodies/bob/mass=$(sed -n 's/^008,//p' sweep.many/cases.csv)" > /dev/null
holds cmp many.one/history.csv sweep.many/008/history.csv
holds cmp many.one/motion.bin sweep.many/008/motion.bin
expect 0 '210 of 210 cases are done' sweep many.json --out sweep.many --resume
rm sweep.many/store_000.pack
expect 0 'of 210 cases are done' sweep many.json --out sweep.many --resume
holds test -s sweep.many/store_000.pack
# comments and spaces do not make another scene
sed 's/"title": "pendulum",/"title":   "pendulum", "comment": "other",/' good.json > other.json && mv good.json first.json && mv other.json good.json
expect 0 '210 of 210 cases are done' sweep many.json --out sweep.many --resume
# nor does a formula for a number, but another number in it
sed 's/"step_size": 0.01/"step_size": {"expression": "h"}/; s/"title"/"parameters": {"h": 0.01}, "title"/' first.json > good.json
expect 0 '210 of 210 cases are done' sweep many.json --out sweep.many --resume
sed -i 's/"h": 0.01/"h": 0.005/' good.json
expect 0 '^0 of 210 cases are done' sweep many.json --out sweep.many --resume
# files that a scene names are part of it
mkdir -p outlined
printf '0 0\n0.1 0\n0 0.1\n' > corners.txt
pendulum 0.02 | sed 's/"kind": "point_mass", "mass": 1,/"shape": {"kind": "extrusion", "file": "corners.txt", "length": 1}, "mass": 1,/' > outlined/scene.json
mv corners.txt outlined
expect 0 '1 cases' batch outlined --out outlined.out
expect 0 '1 of 1 cases are done' batch outlined --out outlined.out --resume
printf '0 0\n0.2 0\n0 0.1\n' > outlined/corners.txt
expect 0 '0 of 1 cases are done' batch outlined --out outlined.out --resume
mv first.json good.json
holds test -s sweep.one/07/history.csv
holds test ! -e sweep.two/07
expect 0 '1 cases' sweep "$sweeps/rod_chain_lengths.json" --out sweep.case --case 07
holds cmp sweep.one/07/history.csv sweep.case/07/history.csv
cp sweep.two/batch.csv whole.csv
expect 2 'results of 24 other cases in sweep.two: give another folder' sweep "$sweeps/rod_chain_lengths.json" --out sweep.two --case 07
holds cmp whole.csv sweep.two/batch.csv
expect 2 '1 case of this batch: --resume' sweep "$sweeps/rod_chain_lengths.json" --out sweep.case --case 07
expect 0 '1 cases' sweep "$sweeps/rod_chain_lengths.json" --out sweep.case --case 07 --replace
expect 3 'are left' sweep "$sweeps/rod_chain_lengths.json" --out sweep.stopped --threads 1 --stop-after 0.02 --quiet
expect 0 'cases are done' sweep "$sweeps/rod_chain_lengths.json" --out sweep.stopped --resume
holds cmp sweep.one/batch.csv sweep.stopped/batch.csv
# shards: the collected table is that of one machine, and what is missing is named
for shard in 1/2 2/3 3/3; do expect 0 'from the command line' sweep "$sweeps/rod_chain_lengths.json" --out sweep.shards --shard $shard --keep none; done
expect 3 'cases are missing: ' batch --collect sweep.shards --out sweep.part
expect 0 'shard 1 of 3' sweep "$sweeps/rod_chain_lengths.json" --out sweep.shards --shard 1/3 --keep none
expect 0 '4 shards with 25 of 25' batch --collect sweep.shards --out sweep.shards
for file in batch.csv batch.json; do holds cmp sweep.one/$file sweep.shards/$file; done
expect 2 'I from 1 to N' sweep "$sweeps/rod_chain_lengths.json" --out sweep.none --shard 4/3
expect 2 'FOLDER or --collect' batch --out sweep.none
expect 2 'no shard' batch --collect "$gallery" --out sweep.none
expect 0 'sbatch' sweep "$sweeps/rod_chain_lengths.json" --out sweep.jobs --export slurm
holds grep -q -- '--shard "${SLURM_ARRAY_TASK_ID}/1"$' sweep.jobs/job.slurm
# two batches do not write into one folder
"$program" sweep "$sweeps/rod_chain_lengths.json" --out sweep.busy --threads 1 --set /analysis/step_size=1e-6 > /dev/null 2>&1 &
busy=$!
until test -e sweep.busy/journal.jsonl; do kill -0 $busy || break; sleep 0.1; done
expect 2 'writes into sweep.busy' sweep "$sweeps/rod_chain_lengths.json" --out sweep.busy --quiet
kill $busy
wait $busy
mkdir stiff
cp "$gallery/elastica.json" stiff
hard='--set /analysis/max_cuts=0 --set /analysis/max_iterations=5 --set /analysis/load_steps=1 --set /expected=[]'
expect 1 'elastica: failed' batch stiff --out stiff.out $hard
expect 0 'tried again with /analysis/load_steps=2, for it had failed' batch stiff --out stiff.out $hard --retries 3 --resume
expect 0 '1 of 1 cases are done' batch stiff --out stiff.out $hard --retries 3 --resume
mkdir large
cp good.json large/small.json
awk 'BEGIN { n = 700000; printf "{\"schema_version\": 1, \"bodies\": [{\"name\": \"a\", \"kind\": \"point_mass\", \"mass\": 1}], \"loads\": [{\"at\": \"a\", \"force\": [1, 0, 0], \"law\": {\"kind\": \"table\", \"times\": [0"
  for (i = 1; i < n; ++i) printf ",%d", i; printf "], \"values\": [0"; for (i = 1; i < n; ++i) printf ",1"
  printf "]}}], \"analysis\": {\"kind\": \"dynamic\", \"end_time\": 1, \"step_size\": 0.1}}" }' > large/table.json
expect 1 'out of memory' batch large --out large.out --threads 2 --memory-limit 40M
holds grep -q '^small,ok,' large.out/batch.csv
expect 2 'no case' sweep "$sweeps/rod_chain_lengths.json" --out sweep.none --case 7
expect 2 'out DIR' sweep "$sweeps/rod_chain_lengths.json"
expect 2 'designs' sweep good.json --dry-run
expect 0 'bough sweep' schema --sweep

# a run
expect 0 '1 body, 1 joint' check good.json
expect 0 'done' run good.json
for file in history.csv motion.pvd motion.bin summary.json motion/frame_000000.vtu; do holds test -s good.out/$file; done
holds test -z "$(find good.out -name '*.partial')"
holds test "$(head -1 good.out/history.csv)" = 'time,step_size,iterations,bob.x,bob.y,bob.z'
holds test "$(wc -l < good.out/history.csv)" -eq 52
holds grep -q '"status": "ok"' good.out/summary.json
expect 0 silence run good.json --out quiet --quiet
holds test ! -s printed
LC_ALL=de_DE.UTF-8 "$program" run good.json --out german --threads 2 --quiet
holds cmp good.out/history.csv german/history.csv
expect 0 'done' run good.json --out stride --set /output/stride=10
holds test "$(wc -l < stride/history.csv)" -eq 7

# names in tables

expect 0 'done' run good.json --out formula --set '/sensors/0/name="=1+1"'
holds grep -q "^time,step_size,iterations,'=1+1" formula/history.csv
expect 0 '^equal' compare formula formula
named() { echo "{\"schema_version\":1,\"scene\":\"good.json\",\"designs\":[$1],\"measures\":[{\"name\":\"$2\",\"quantity\":\"bob.z\",\"figure\":\"min\"}]}" > named.json; }
mass='"pointer":"/bodies/bob/mass","values":[1,2]'
for name in case status cause; do
  named "{\"kind\":\"grid\",\"variables\":[{\"name\":\"$name\",$mass}]}" low
  expect 2 '/designs/0/variables/0/name.*column of this name' sweep named.json --dry-run
  named "{\"kind\":\"grid\",\"variables\":[{\"name\":\"m\",$mass}]}" $name
  expect 2 '/measures/0/name.*column of this name' sweep named.json --dry-run
done
printf 'm,m\n1,2\n' > twice.csv
named '{"kind":"csv","file":"twice.csv","variables":[{"name":"m","pointer":"/bodies/bob/mass"}]}' low
expect 2 'two columns "m"' sweep named.json --dry-run
named '{"kind":"grid","variables":[{"name":"s","pointer":"/analysis/step_size","values":[0.02,-1]}]}' low
expect 1 '2: bad_input' sweep named.json --out named.out --quiet
expect 1 '1 of 2 cases are not done' sweep named.json --out named.out --quiet --resume
echo '{"schema_version":1,"to":{"position":[1,2,3],"rotation":{"axis":[0,0,1],"angle":5e-324}}}' > tiny.json
expect 1 'is not a finite number' kinematics motion tiny.json --json tiny.out
holds test ! -e tiny.out

# what cannot be written
: > file
expect 1 'file' run good.json --out file
expect 1 'file' run good.json --out file/below
holds test -f file

mkfifo pipe
expect 1 'not a regular file' view good.out --out pipe
holds test -p pipe

# pages
expect 0 'view.html' view good.out --svg drawing.svg
holds grep -q '</html>' good.out/view.html
holds grep -q '</svg>' drawing.svg
expect 0 'page.html' view stride --view xz --out page.html
"$program" run good.json --out still --set /output/motion=false --quiet
expect 0 'motion=true' view still
expect 2 'motion=true' view still --svg still.svg
holds test ! -e still.svg
expect 2 'missing' view missing

# comparison
expect 0 '^equal' compare good.out german --rel 0
expect 0 '^equal' compare good.out/history.csv german/history.csv
sed '10s/,[^,]*$/,nan/' good.out/history.csv > nan.csv
expect 1 'not finite' compare good.out/history.csv nan.csv --rel 1e300
expect 1 'not finite' compare nan.csv nan.csv
"$program" run good.json --out finer --set /analysis/spectral_radius=0.5 --quiet
expect 1 'differs' compare good.out finer
expect 0 '^equal' compare good.out finer --rel 0.1
expect 1 'rows' compare good.out stride --rel 1
expect 2 'missing' compare good.out missing
expect 2 'not a history' compare good.out/history.csv good.out/motion.pvd
mkdir unfinished && cp good.out/history.csv unfinished
expect 2 'summary.json' compare good.out unfinished

# schema
expect 0 '"\$schema"' schema
holds python3 -c 'import json, sys; json.load(open("printed"))'

# matrices
expect 0 '^matrix.mtx: 11 unknowns' export-matrix good.json --out matrix.mtx --rhs rhs.mtx --step 3 --without planar
holds grep -q '^%%MatrixMarket matrix coordinate real' matrix.mtx
holds grep -q "^% 1-6 'bob' displacement" matrix.mtx
holds grep -q '^11 1$' rhs.mtx
expect 0 'good.mtx' export-matrix good.json --time 0.025 --without planar
holds test "$(grep -v '^%' good.mtx | cksum)" = "$(grep -v '^%' matrix.mtx | cksum)"
expect 1 'no such step' export-matrix good.json --step 100000 --out none.mtx
expect 2 . export-matrix good.json --step 0 --out none.mtx
expect 2 . export-matrix good.json --step 1 --time 0.1 --out none.mtx
expect 2 . export-matrix good.json --time soon --out none.mtx
expect 2 . export-matrix
expect 2 'mass' export-matrix bad.json --out none.mtx
expect 2 'no such file' export-matrix missing.json --out none.mtx
expect 1 'folder' export-matrix good.json --out folder/none.mtx
holds test ! -e none.mtx

# study
cat > study.json <<'EOF'
{"schema_version": 1, "scene": "good.json", "set": [{"pointer": "/analysis/end_time", "value": 0.2}],
 "quantities": [{"name": "place", "sensor": "bob"}], "repetitions": 1,
 "reference": {"set": [{"pointer": "/analysis/step_size", "value": 2.5e-4}],
               "check": [{"pointer": "/analysis/step_size", "value": 5e-4}], "order": 2},
 "grids": [{"name": "steps", "axes": [{"name": "step size", "values": [0.02, 0.01, 0.005]}],
   "orders": [{"quantity": "place", "order": 2, "theory": "second order"}]}]}
EOF
expect 0 '3 runs, 0 failed; orders: 1 as in theory, 0 not' study study.json --out study.out
holds test "$(head -c 15 study.out/study.csv)" = 'grid,step size,'
holds test "$(wc -l < study.out/study.csv)" -eq 6
holds python3 -c 'import json; runs = json.load(open("study.out/study.json"))["runs"]; assert len([r for r in runs if "pair" not in r]) == 3 and len(runs) == 5'
holds grep -q '</html>' study.out/study.html
sed 's/"order": 2, "theory"/"order": 3, "theory"/' study.json > high.json
expect 1 'theory 3' study high.json --out high.out
sed 's/step size/step sise/; s/"bob"/"bab"/' study.json > bad_study.json
expect 2 'line 2, column .*/quantities/0/sensor .*\[unknown-name\]' study bad_study.json --out bad_study.out
expect 2 'help: did you mean "bob"' study bad_study.json --out bad_study.out
holds test ! -e bad_study.out
mkdir studies no_studies && cp study.json good.json studies
expect 2 'needs the key "quantities"' study studies --out studies.out
holds test ! -e studies.out
sed -i 's|"good.json"|"../good.json"|' studies/study.json && rm studies/good.json
expect 0 'index.html' study studies --out studies.out
holds grep -q 'study/study.html' studies.out/index.html
expect 2 'no study' study no_studies --out studies.out
expect 0 '"grids"' schema --study

# kinematics razi
expect 0 '^5 .*45 .*33.0711 ' kinematics razi --csv razi.csv --json razi.json --svg razi.svg
holds test "$(head -1 razi.csv)" = 'spin,precession,tilt_deg,radius,psi_deg,centripetal,razi,coriolis,tangential,local,total'
holds test "$(wc -l < razi.csv)" -eq 2167
holds python3 -c 'import json; assert len(json.load(open("razi.json"))["series"]) == 6'
holds python3 -c 'import xml.dom.minidom as x; x.parse("razi.svg")'
expect 0 'one.csv' kinematics razi --spin 1 --precession 1 --tilt 90 --points 5 --csv one.csv
holds test "$(head -1 one.csv)" = 'psi_deg,centripetal,razi,coriolis,tangential,local,total'
holds awk -F, 'function near(a, b) { d = a - b; return d * d < 1e-28 }
  NR == 2 { ok = near($2, sqrt(2)) && near($3, 1) && near($7, sqrt(5)) } NR == 3 { ok = ok && near($2, 2) && near($3, 0) && near($7, 2) }
  END { exit !(ok && NR == 6) }' one.csv
# the whole of the reference, to its 12 printed digits
for lean in 30 45 60 90; do
  "$program" kinematics razi --spin 1 --precession 1 --tilt $lean --points 25 --csv lean.csv > /dev/null
  grep "^$lean," "$reference" | cut -d, -f2-5 > wanted.csv
  holds awk -F, 'function bad(a, b) { d = a - b; return d * d > (5.1e-12 * (b > 1 ? b : 1)) ^ 2 }
    FNR == NR { psi[FNR] = $1; c[FNR] = $2; r[FNR] = $3; t[FNR] = $4; n = FNR; next }
    FNR > 1 { k = FNR - 1; if ($1 != psi[k] || bad($2, c[k]) || bad($3, r[k]) || bad($7, t[k])) exit 1; rows = k }
    END { exit !(rows == 25 && n == 25) }' wanted.csv lean.csv
done
expect 2 'precession' kinematics razi --spin 5
expect 2 . kinematics
expect 2 . kinematics turn
for words in '--points 1' '--points 2.5' '--tilt nan' '--radius -1' '--radius 0' '--spin inf --precession 1' '--spin 1e300 --precession 1' '--nonsense'; do
  expect 2 . kinematics razi $words --csv none.csv
done
cat > chain.json <<'JSON'
{"schema_version": 1, "title": "rotor on a car",
 "frames": [{"name": "car", "position": [{"expression": "10*t"}, 0, 0], "turns": [{"axis": [0, 0, 1], "angle": {"expression": "t^2"}}]},
            {"name": "rotor", "turns": [{"axis": [0, 1, 0], "angle": 20, "rate": true}]}],
 "point": {"position": [0.2, 0, 0]}, "in": "car", "time": {"end": 1, "points": 11}}
JSON
expect 0 'rotor on a car' kinematics razi --chain chain.json --csv chain.csv --json chain.out.json --svg chain.svg
holds test "$(head -1 chain.csv)" = 'time,centripetal,razi,coriolis,tangential,local,origin,total'
holds test "$(wc -l < chain.csv)" -eq 12
expect 2 . kinematics razi --chain chain.json --tilt 5
expect 2 'no such file' kinematics razi --chain missing.json --csv none.csv
sed 's/"car", "time"/"cat", "time"/; s/10\*t/10*/' chain.json > bad_chain.json
expect 2 'did you mean "car"' kinematics razi --chain bad_chain.json --csv none.csv
expect 2 'line 2, column .*expression' kinematics razi --chain bad_chain.json --json none.csv
sed 's/10\*t/1\/(t-0.5)/' chain.json > pole.json
expect 2 'not finite at t = 0.5' kinematics razi --chain pole.json --svg none.csv
holds test ! -e none.csv
expect 1 'folder' kinematics razi --csv folder/none.csv
mkdir taken.csv
expect 1 'taken.csv' kinematics razi --csv taken.csv
holds test -d taken.csv
holds test -z "$(find . -name '*.partial')"
expect 0 'moving_frame' schema --chain
holds python3 -c 'import json; json.load(open("printed"))'

# kinematics motion: a quarter turn about z that moves the origin by 1 m along x turns about (0.5, 0.5)
expect 0 'nearest point \[m\]  *0.5  *0.5  *0$' kinematics motion --to 1 0 0 0 0 1.5707963267948966 --json motion.json
holds python3 -c 'import json; m = json.load(open("motion.json")); assert m["screw"]["kind"] == "screw" and abs(m["screw"]["axis_point"][1] - 0.5) < 1e-15'
expect 0 '^kind of motion  *translation$' kinematics motion --to 1,2,3
expect 0 'none: infinite' kinematics motion --to 1,2,3
echo '{"schema_version": 1, "from": {"position": [0, 0, 1]}, "to": {"position": [1, 0, 0], "rotation": {"quaternion": [0.6, 0, 0, 0.8]}}}' > poses.json
"$program" kinematics motion --from 0 0 1 --to 1,0,0,0.6,0,0,0.8 > by_options
expect 0 'screw' kinematics motion poses.json
holds cmp printed by_options
expect 2 'FILE or --to' kinematics motion
expect 2 'not 4' kinematics motion --to 1 2 3 4 --json none.json
expect 2 'not 5' kinematics motion --to 1 2 3 --from 1 2 3 4 5 --json none.json
expect 2 'length 1' kinematics motion --to 1 2 3 1 1 0 0 --json none.json
for words in '--to 1 2' '--to 1 2 nan' '--to 1 2 3e300' '--to 1 2 3 --from x' '--from 1 2 3' 'poses.json --to 1 2 3' '--to 1 2 3 --seen-from first' 'missing.json'; do
  expect 2 . kinematics motion $words --json none.json
done
sed 's/0.6, 0, 0/0.6, 1, 0/; s/"from"/"form"/' poses.json > bad_poses.json
expect 2 'did you mean "from"' kinematics motion bad_poses.json --json none.json
expect 2 '/to/rotation/quaternion.*length 1' kinematics motion bad_poses.json --json none.json
holds test ! -e none.json
expect 0 'seen_from' schema --motion
holds python3 -c 'import json; json.load(open("printed"))'
expect 2 . schema --motion --chain

# batch
mkdir scenes && cp good.json scenes/a.json && cp good.json scenes/c.json && cp bad.json scenes/b.json
expect 1 'b: bad_input' batch scenes --out batch --threads 2 --quiet
holds test "$(wc -l < batch/batch.csv)" -eq 4
holds cmp good.out/history.csv batch/a/history.csv
holds test ! -e batch/b
rm scenes/b.json
expect 0 '2 cases, 0 not done' batch scenes --out batch2
# Doubts: in the first line, with --quiet too, counted in batches; --strict makes them exit status 1.
mkdir doubted
cat > doubted/pulse.json << 'END'
{"schema_version": 1, "bodies": [{"name": "b", "kind": "point_mass", "mass": 1}],
 "loads": [{"at": "b", "force": [1, 0, 0], "law": {"expression": "1e5*exp(-((t-0.5005)/5e-5)^2)"}}],
 "sensors": [{"name": "x", "kind": "position", "at": "b"}],
 "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-3}}
END
expect 0 'pulse: done, not to be trusted' run doubted/pulse.json --out pulse1.out
expect 0 'DOUBT (error)' run doubted/pulse.json --out pulse2.out --quiet
expect 1 'DOUBT (error)' run doubted/pulse.json --out pulse3.out --quiet --strict
expect 0 '1 not to be trusted' batch doubted --out batch4
expect 0 '1 of 1 cases are not to be trusted' batch doubted --out batch5 --quiet
expect 1 '1 of 1 cases are not to be trusted' batch doubted --out batch6 --quiet --strict
expect 0 . view pulse1.out
holds grep -q 'Not to be trusted without a closer look' pulse1.out/view.html
mkdir empty
expect 2 'no scene' batch empty --out batch3
expect 2 'missing' batch missing --out batch3

# profile and tune
expect 0 'sub-domains on' profile good.json --out good.profile --steps 5
for file in profile.html profile.json trace.json; do holds test -s good.profile/$file; done
expect 0 silence profile good.json --steps 5 --quiet --threads 1
holds test -s good.profile/trace.json
expect 0 'walks no sub-domains' profile good.json --set /solver/form=monolithic
expect 2 . profile good.json --steps 0
expect 0 '"form"' tune good.json --steps 3 --seconds 0 --out solver.json
expect 0 silence run good.json --out tuned.out --quiet --set "/solver=$(cat solver.json)"
expect 2 . tune good.json --seconds nan

expect 0 'all is well' doctor
# What doctor says that runs is what a summary records.
set_of_instructions=$(sed -n 's/^  lanes   \([^,]*\),.*/\1/p' printed)
holds grep -q "\"instruction_set\": \"${set_of_instructions:-none}\"" tuned.out/summary.json

expect 0 'stress.html' stress --out table --quick --threads 2 --case one_body
holds grep -q '"name": "one_body"' table/stress.json
holds grep -q '"status": "holds"' table/stress.json
holds grep -q 'one_body' table/stress.html
expect 2 "did you mean 'elastica'" stress --out table --case elastic

# Ctrl-C keeps the history to the last accepted step and says so
pendulum 100000 > long.json
"$program" run long.json --out long --set /output/motion=false --quiet 2> printed &
process=$!
until [ "$(cat .long.bough-new/history.csv.partial 2> /dev/null | wc -l)" -gt 2 ]; do kill -0 $process || break; sleep 0.1; done
kill -INT $process
wait $process
holds test $? -eq 3
holds grep -q -- '--resume goes on from time' printed
holds grep -q '"status": "interrupted"' long/summary.json
holds test "$(wc -l < long/history.csv)" -gt 2
holds test "$(tail -1 long/history.csv | tr -cd , | wc -c)" -eq 5
accepted=$(sed -n 's/.*"accepted": \([0-9]*\).*/\1/p' long/summary.json)
holds test "$(wc -l < long/history.csv)" -eq "$((accepted + 2))"

# Ctrl-C ends a case of the stress table where it is; a case cut short is none
"$program" stress --out cut --case million_steps_variational > printed 2>&1 &
process=$!
until [ -e .cut.bough-new/manifest.json ]; do kill -0 $process || break; sleep 0.1; done
sleep 1.5
kill -INT $process
wait $process
holds test $? -eq 1
holds grep -q '"cases": \[\]' cut/stress.json

echo "command line: $((checks - failures)) of $checks checks passed"
[ "$failures" -eq 0 ]
