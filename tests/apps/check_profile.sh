#!/bin/sh
# check_profile.sh PROGRAM SOURCE   profiles scenes of the gallery and opens the pages in a headless browser without network: no error on
# the console, all drawings there, the buttons change colours. Exit status 77: there is no browser.
set -u
program=$(realpath "$1")
source=$(realpath "$2")
browser=$(command -v chromium || command -v google-chrome || command -v chromium-browser || true)
[ -n "$browser" ] || { echo "no chromium found"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
for scene in chain four_bar_planar bend_45; do
  "$program" profile "$source/data/scenarios/$scene.json" --out $scene --steps 10 --quiet || { echo "FAIL: $scene"; exit 1; }
  python3 "$source/tests/tools/check_html.py" $scene/profile.html || failures=$((failures + 1))
  for drawing in hierarchy 'scene by sub-domains' 'timeline of tasks' Speed-up; do
    grep -q "$drawing" $scene/profile.html || { echo "FAIL: $scene has no $drawing"; failures=$((failures + 1)); }
  done
done
# Each button paints the same page anew: four pictures, all different.
sed 's/id="icicle-time" checked/id="icicle-time"/; s/id="icicle-condition"/& checked/' chain/profile.html > condition.html
sed 's/id="icicle-time" checked/id="icicle-time"/; s/id="icicle-size"/& checked/' chain/profile.html > size.html
sed 's/ checked> <label for="scene-/> <label for="scene-/; s/id="scene-1"/& checked/' chain/profile.html > level.html
cp chain/profile.html time.html
for page in time condition size level; do
  timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --user-data-dir="$scratch/p" \
    --proxy-server=127.0.0.1:9 --hide-scrollbars --window-size=1040,1200 --screenshot="$scratch/$page.png" \
    "file://$scratch/$page.html" > /dev/null 2>&1
  [ -s $page.png ] || { echo "FAIL: no picture of $page"; failures=$((failures + 1)); }
done
different=$(cksum time.png condition.png size.png level.png | cut -d' ' -f1 | sort -u | wc -l)
[ "$different" -eq 4 ] || { echo "FAIL: $different of 4 pictures differ"; failures=$((failures + 1)); }
[ "$failures" -eq 0 ]
