#!/bin/sh
# Builds three.min.js from three_parts.js with pinned versions from npm: run it where a version is to change, and commit what it
# writes. The library's licence (MIT) stands in three.LICENSE. Nothing of this is needed to build bough.
set -eu
cd "$(dirname "$0")"
three=0.187.0 esbuild=0.28.2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp three_parts.js "$scratch"
(cd "$scratch" && npm init -y > /dev/null && npm install --save-exact "three@$three" "esbuild@$esbuild" > /dev/null &&
  ./node_modules/.bin/esbuild three_parts.js --bundle --minify --charset=ascii --format=iife --global-name=THREE \
    --legal-comments=none --banner:js="/* three.js $three, MIT licence, Copyright 2010-2026 three.js authors */" --outfile=three.min.js)
cp "$scratch/three.min.js" .
cp "$scratch/node_modules/three/LICENSE" three.LICENSE
sha256sum three.min.js
