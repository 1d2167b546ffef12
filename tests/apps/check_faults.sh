#!/bin/sh
# check_faults.sh PROGRAM   makes every write, fsync and rename fail in turn: the run must end with 1 and a message, and no file may stand
# half-written under its final name. Needs strace; skipped (77) where it is missing or may not trace.
set -u
program=$(realpath "$1")
. "$(dirname "$0")/scenes.sh"
strace -o /dev/null true 2> /dev/null || { echo "strace cannot be used here"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
pendulum 0.5 > good.json
"$program" run good.json --out whole --quiet || exit 1
failures=0
checks=0
for call in write fsync rename; do
  number=1
  while [ "$number" -le 40 ]; do
    rm -rf out
    strace -f -o trace -e trace=$call -e inject=$call:error=ENOSPC:when=$number "$program" run good.json --out out --quiet 2> message
    status=$?
    grep -q INJECTED trace || break  # past the last call
    checks=$((checks + 1))
    problem=
    [ "$status" -eq 1 ] || problem="status $status"
    [ -s message ] || [ "$call" = write ] || problem="$problem no message"  # the write that failed may be the message itself
    [ -z "$(find out -name '*.partial' 2> /dev/null)" ] || problem="$problem partial files left"
    if [ -e out/history.csv ] && [ "$(tail -c 1 out/history.csv | od -An -c | tr -d ' ')" != '\n' ]; then problem="$problem cut row"; fi
    if [ -e out/summary.json ] && ! python3 -c 'import json; json.load(open("out/summary.json"))' 2> /dev/null; then problem="$problem bad summary"; fi
    if [ -e out/summary.json ] && [ ! -e out/history.csv ]; then problem="$problem summary without its history"; fi
    for frame in out/motion/*.vtu; do
      [ -e "$frame" ] && ! cmp -s "$frame" "whole/motion/$(basename "$frame")" && problem="$problem cut $frame"
    done
    if [ -n "$problem" ]; then
      failures=$((failures + 1))
      echo "FAIL: $call $number:$problem"; cat message; ls -a out 2> /dev/null
    fi
    number=$((number + 1))
  done
done
# A case for which no process can be started has failed, and the others run.
mkdir scenes && cp good.json scenes/a.json && cp good.json scenes/b.json
strace -f -o trace -e trace=clone -e inject=clone:error=EAGAIN:when=1 "$program" batch scenes --out batch > message 2>&1
status=$?
checks=$((checks + 1))
if [ "$status" -ne 1 ] || ! grep -q 'a: failed: no process could be started' message || ! grep -q 'b: ok' message; then
  failures=$((failures + 1))
  echo "FAIL: a fork that fails: status $status"; cat message
fi
echo "injected failures: $((checks - failures)) of $checks runs ended as they must"
[ "$failures" -eq 0 ] && [ "$checks" -gt 10 ]
