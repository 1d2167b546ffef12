#!/bin/sh
# check_study.sh BOUGH SOURCE_DIR   runs a small study and opens its page in a headless browser: no error on the console, screenshots
# (light, dark) that show something, and numbers equal to those of study.json. Exit status 77: there is no browser.
set -eu
bough=$1
source_dir=$2
browser=$(command -v chromium || command -v google-chrome || command -v chromium-browser || true)
if [ -z "$browser" ]; then
  echo "check_study: no chromium found"
  exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$bough" study "$source_dir/data/studies/princeton_beam.json" --out "$scratch/study" --threads 1 --repetitions 1 --quiet
python3 "$source_dir/tests/tools/check_html.py" "$scratch/study/study.html"

# shot NAME OPTIONS...: what the browser shows
shot() {
  name=$1
  shift
  timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --hide-scrollbars \
    --user-data-dir="$scratch/profile" --proxy-server=127.0.0.1:9 --window-size=1040,2400 "$@" \
    --screenshot="$scratch/$name.png" "file://$scratch/study/study.html" 2> "$scratch/log" || { cat "$scratch/log"; exit 1; }
}
shot light
shot dark --force-dark-mode --blink-settings=preferredColorScheme=0
timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
  --user-data-dir="$scratch/profile" --proxy-server=127.0.0.1:9 --dump-dom "file://$scratch/study/study.html" \
  > "$scratch/dom.html" 2> "$scratch/log"
python3 "$source_dir/tests/tools/check_page.py" "$scratch/dom.html" "$scratch/study/study.json" "$scratch/light.png" \
  "$scratch/dark.png"
if cmp -s "$scratch/light.png" "$scratch/dark.png"; then
  echo "check_study: the page is not dark where the reader's system is"
  exit 1
fi
