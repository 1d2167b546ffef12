#!/bin/sh
# check_view.sh PROGRAM SOURCE   opens views in a headless browser with WebGL in software: the script runs under the
# page's content security policy, nothing is asked for from elsewhere, no error is on the console; time, views, selection,
# colours, ghosts, traces and plots do what they say (view_behaviour.js); names that look like markup, long ones and
# right-to-left ones stay text. Exit status 77: no browser.
set -u
program=$(realpath "$1")
source=$(realpath "$2")
browser=$(command -v chromium || command -v google-chrome || command -v chromium-browser || true)
[ -n "$browser" ] || { echo "no chromium found"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0

open_page() {
  timeout 180 "$browser" --headless --no-sandbox --disable-dev-shm-usage --no-first-run --use-gl=angle \
    --use-angle=swiftshader --enable-unsafe-swiftshader --user-data-dir="$scratch/profile" --proxy-server=127.0.0.1:9 \
    --virtual-time-budget=20000 --enable-logging=stderr --window-size="$1",1400 --dump-dom "file://$2" \
    > "$scratch/dom" 2> "$scratch/log" || true
  if grep -aE 'CONSOLE' "$scratch/log" | grep -aE 'Uncaught|Error|ERR_|Refused|Failed to load|violates'; then
    failed=1
  fi
}

look() { # look FOLDER
  page="$scratch/$1/view.html"
  open_page 1300 "$page"
  grep -q 'class="has-view"' "$scratch/dom" || { echo "$1: the script does not run under the page's policy"; failed=1; }
  {
    sed 's|<meta http-equiv="Content-Security-Policy"[^>]*>||' "$page"
    echo '<script>'
    cat "$source/tests/tools/view_behaviour.js"
    echo '</script>'
  } > "$scratch/page.html"
  for width in 1300 400; do
    open_page $width "$scratch/page.html"
    grep -q 'VIEW END' "$scratch/dom" || { echo "$1, $width px: the view was not handled to the end"; failed=1; }
    if grep -a 'VIEW: ' "$scratch/dom" | sed "s|.*VIEW: |$1, $width px: |"; then failed=1; fi
  done
  echo "$1: looked at, $(wc -c < "$page") bytes"
}

cd "$scratch" || exit 1
for scene in robot_arm rotor; do
  "$program" run "$source/data/gallery/$scene.json" --out $scene --quiet --set /analysis/end_time=0.5 || exit 1
  "$program" view $scene > /dev/null || exit 1
  look $scene
done
long=$(printf 'n%.0s' $(seq 100))
cat > names.json << SCENE
{"schema_version": 1, "title": "</script><script>wasCalled=1</script><img src=x onerror=wasCalled=1>",
 "gravity": [0, 0, -9.81],
 "bodies": [{"name": "<script>wasCalled=1<img src=x onerror=wasCalled=1>", "mass": 1, "inertia": [1, 1, 1]},
            {"name": "$long", "mass": 1, "shape": {"kind": "sphere", "radius": 0.2}, "position": [1, 0, 0]},
            {"name": "שלום עולם", "mass": 1, "shape": {"kind": "box", "size": [0.2, 0.3, 0.4]},
             "position": [2, 0, 0]}],
 "joints": [{"name": "hinge", "kind": "revolute", "first": "ground",
             "second": "<script>wasCalled=1<img src=x onerror=wasCalled=1>", "position": [-0.5, 0, 0], "axis": [0, 1, 0]},
            {"name": "pin", "kind": "spherical", "first": "$long", "second": "שלום עולם", "position": [1.5, 0, 0]}],
 "sensors": [{"name": "\"><img src=x onerror=wasCalled=1>", "kind": "velocity",
              "at": "<script>wasCalled=1<img src=x onerror=wasCalled=1>"},
             {"name": "$long", "kind": "position", "at": "$long"}],
 "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}}
SCENE
"$program" run names.json --out names --set /output/motion=true --quiet > /dev/null || exit 1
"$program" view names > /dev/null || exit 1
look names
exit $failed
