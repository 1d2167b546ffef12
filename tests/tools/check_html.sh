#!/bin/sh
# check_html.sh FILE...   opens each report in a headless browser without network; fails when its script writes an
# error to the console or the page shows neither a drawing nor a table, and where, at some width of the window or on
# paper, texts of a drawing overlap or lie on what is drawn, columns are cut or drawings blown up (page_boxes.js).
set -eu
browser=$(command -v chromium || command -v google-chrome || command -v chromium-browser || true)
if [ -z "$browser" ]; then
  echo "check_html: no chromium found" >&2
  exit 1
fi
tools=$(dirname "$0")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0

# dump WIDTH PAGE   the page as the browser has it, into $scratch/dom
dump() {
  timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run \
    --user-data-dir="$scratch/profile" --proxy-server=127.0.0.1:9 --virtual-time-budget=5000 --enable-logging=stderr \
    --window-size="$1",1600 --dump-dom "file://$2" > "$scratch/dom" 2> "$scratch/log" || true
}

# boxes WIDTH PAGE WHERE FILE   what page_boxes.js says of a page
boxes() {
  dump "$1" "$2"
  if ! grep -q 'BOXES END' "$scratch/dom"; then
    echo "$4, $3: the layout was not looked at"
    failed=1
  elif grep 'BOXES: ' "$scratch/dom" | sed "s|.*BOXES: |$4, $3: |" | sed 's/&quot;/"/g' | grep .; then
    failed=1
  fi
}

for file in "$@"; do
  page=$(realpath "$file")
  dump 1040 "$page"
  problems=$(grep -E 'CONSOLE' "$scratch/log" | grep -E 'Uncaught|Error|ERR_|Refused|Failed to load' || true)
  if [ -n "$problems" ]; then
    echo "$file: $problems"
    failed=1
  elif ! grep -qE '<(svg|canvas|table)' "$scratch/dom"; then
    echo "$file: no drawing and no table in the page"
    failed=1
  else
    echo "$file: opens, $(wc -c < "$scratch/dom") bytes of page, no error on the console"
  fi
  # The page lets no further script in, so a copy without that rule is looked at; paper is a window of 190 mm with the rules of print.
  sed 's|<meta http-equiv="Content-Security-Policy"[^>]*>||' "$page" > "$scratch/page.html"
  { echo '<script>'; cat "$tools/page_boxes.js"; echo '</script>'; } >> "$scratch/page.html"
  sed 's/@media print/@media all/' "$scratch/page.html" > "$scratch/paper.html"
  boxes 1300 "$scratch/page.html" "1300 px wide" "$file"
  boxes 1000 "$scratch/page.html" "1000 px wide" "$file"
  boxes 400 "$scratch/page.html" "400 px wide" "$file"
  boxes 718 "$scratch/paper.html" "on paper" "$file"
done
exit $failed
