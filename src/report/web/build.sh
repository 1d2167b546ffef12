#!/bin/sh
# Builds three.min.js from three_parts.js with the versions and hashes of package-lock.json: run it where a version is to
# change, and commit what it writes. The licence of three.js (MIT) is put before the bundle, and so stands in every page.
# Nothing of this is needed to build bough.
#   sh build.sh           writes three.min.js
#   sh build.sh --check   fails unless three.min.js is what the locked packages give
# A version is changed in package.json, and then in the lock file by `npm install --package-lock-only`.
set -eu
cd "$(dirname "$0")"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp three_parts.js package.json package-lock.json "$scratch"
(cd "$scratch" && npm ci --ignore-scripts --no-audit --no-fund > /dev/null &&
  ./node_modules/.bin/esbuild three_parts.js --bundle --minify --charset=ascii --format=iife --global-name=THREE \
    --legal-comments=none --log-level=warning --outfile=bundle.js)
three=$(sed -n 's/.*"version": "\(.*\)".*/\1/p' "$scratch/node_modules/three/package.json")
{
  printf '/*\nthree.js %s\n\n' "$three"
  sed 's/©/(c)/' "$scratch/node_modules/three/LICENSE"
  printf '*/\n'
  cat "$scratch/bundle.js"
} > "$scratch/three.min.js"
if [ "${1:-}" = --check ]; then
  cmp "$scratch/three.min.js" three.min.js
else
  cp "$scratch/three.min.js" .
  sha256sum three.min.js
fi
