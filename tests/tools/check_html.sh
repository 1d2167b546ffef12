#!/bin/sh
# check_html.sh FILE...   opens each report in a headless browser without network; fails when its script writes an
# error to the console or the page shows neither a drawing nor a canvas.
set -eu
browser=$(command -v chromium || command -v google-chrome || command -v chromium-browser || true)
if [ -z "$browser" ]; then
  echo "check_html: no chromium found" >&2
  exit 1
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
for file in "$@"; do
  page=file://$(realpath "$file")
  timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
    --user-data-dir="$scratch/profile" --proxy-server=127.0.0.1:9 --virtual-time-budget=5000 --enable-logging=stderr \
    --dump-dom "$page" > "$scratch/dom" 2> "$scratch/log" || true
  problems=$(grep -E 'CONSOLE' "$scratch/log" | grep -E 'Uncaught|Error|ERR_|Refused|Failed to load' || true)
  if [ -n "$problems" ]; then
    echo "$file: $problems"
    failed=1
  elif ! grep -qE '<(svg|canvas)' "$scratch/dom"; then
    echo "$file: no drawing in the page"
    failed=1
  else
    echo "$file: opens, $(wc -c < "$scratch/dom") bytes of page, no error on the console"
  fi
done
exit $failed
