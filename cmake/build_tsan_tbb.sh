#!/bin/sh
# build_tsan_tbb.sh [FOLDER]   builds TBB with -fsanitize=thread in FOLDER (default build/tsan-tbb) from Debian's own
# source package. The thread sanitizer reports races that are none when the TBB it runs with is not instrumented.
# The apt lists live in FOLDER too: /etc/apt stays as it is, and no root is needed.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
folder=${1:-$root/build/tsan-tbb}
if [ -e "$folder/install/lib/cmake/TBB/TBBConfig.cmake" ]; then
  exit 0
fi
mkdir -p "$folder/lists/partial" "$folder/source"
folder=$(cd "$folder" && pwd)

# the mirror and the suite that libtbb-dev itself comes from
origin=$(apt-cache policy libtbb-dev | awk '$2 ~ /^(https?|file|mirror)/ { print $2, $3; exit }')
mirror=${origin%% *}
suite=${origin##* }
suite=${suite%%/*}
echo "deb-src ${mirror:-http://deb.debian.org/debian} ${suite:-bookworm} main" > "$folder/sources.list"

private_apt() {
  apt-get -qq -o Acquire::Retries=3 -o Dir::Etc::sourcelist="$folder/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o Dir::State::lists="$folder/lists" -o Dir::Cache::srcpkgcache= -o Dir::Cache::pkgcache= -o APT::Sandbox::User= "$@"
}
echo "Fetching the source of TBB from $(cat "$folder/sources.list")"
private_apt update
(cd "$folder/source" && private_apt source onetbb)
source=$(find "$folder/source" -mindepth 1 -maxdepth 1 -type d -name 'onetbb-*')

echo "Building TBB with the thread sanitizer in $folder"
cmake -G Ninja -S "$source" -B "$folder/build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_C_COMPILER=clang-14 \
  -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_CXX_FLAGS="-fsanitize=thread -gline-tables-only" \
  -DCMAKE_SHARED_LINKER_FLAGS=-fsanitize=thread -DCMAKE_INSTALL_PREFIX="$folder/install" -DCMAKE_INSTALL_LIBDIR=lib \
  -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON \
  > "$folder/configure.log"
cmake --build "$folder/build" > "$folder/build.log" || { tail -30 "$folder/build.log"; exit 1; }
cmake --install "$folder/build" > "$folder/install.log"
echo "Done: $folder/install"
