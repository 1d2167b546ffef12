#!/bin/sh
# check_deb.sh BUILD SOURCE SCRATCH   makes the Debian package of a build folder, unpacks it in SCRATCH and checks that
#   - its control fields are complete, and Debian's own packages that it depends on are those that its files load;
#   - the unpacked program runs, knows its manual, and finds every library;
#   - headers, the CMake package, the module for Python, manual, licence, pages of man and completion are there;
#   - dpkg installs and removes it (as root, in a root of its own).
# 77: there is no cpack, dpkg-deb or dpkg-shlibdeps.
set -eu
build=$1 source=$2 scratch=$3
for tool in cpack dpkg-deb dpkg-shlibdeps; do
  command -v $tool > /dev/null || { echo "there is no $tool"; exit 77; }
done
fail() {
  echo "check_deb: $*"
  exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch"
cmake --build "$build" --target bough_shell > "$scratch/shell.log"
cpack --config "$build/CPackConfig.cmake" -B "$scratch/made" > "$scratch/cpack.log" 2>&1 || { cat "$scratch/cpack.log"; exit 1; }
package=$(find "$scratch/made" -maxdepth 1 -name 'bough_*.deb')
[ -n "$package" ] || fail "no package was made"
field() { dpkg-deb -f "$package" "$1"; }

version=$(sed -n 's/^project(bough VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
[ "$(field Package)" = bough ] || fail "Package is $(field Package)"
[ "$(field Version)" = "$version" ] || fail "Version is $(field Version), not $version"
[ "$(field Architecture)" = "$(dpkg --print-architecture)" ] || fail "Architecture is $(field Architecture)"
for name in Maintainer Section Priority Installed-Size Description Depends; do
  [ -n "$(field $name)" ] || fail "$name is empty"
done
echo "Depends: $(field Depends)"
for needed in libc6 'libstdc++6' libtbb; do
  field Depends | grep -qF "$needed" || fail "Depends lacks $needed"
done

root=$scratch/root
dpkg-deb -x "$package" "$root"
for path in bin/bough include/bough/version.hpp include/bough/run/simulate.hpp lib/cmake/bough/boughConfig.cmake \
  share/bough/python/bough.py lib/python3/dist-packages/bough.py share/doc/bough/copyright share/doc/bough/THIRD_PARTY.md \
  share/doc/bough/manual/first-hour.md share/man/man1/bough.1 share/man/man1/bough-run.1 \
  share/bash-completion/completions/bough; do
  [ -s "$root/usr/$path" ] || fail "usr/$path is missing"
done
[ -z "$(find "$root" -type f -perm /6000)" ] || fail "a file has the rights of its owner"
find "$root" -name '*.so*' -o -path '*/bin/bough' | while read -r file; do
  ! ldd "$file" | grep 'not found' || fail "a library of $file is not found"
done

program=$root/usr/bin/bough
cd "$scratch"
"$program" doctor
"$program" run "$source/data/scenarios/pendulum.json" --out pendulum --check-expected --quiet
"$program" explain unknown-name | grep -q 'messages.md' || fail "the package does not know its manual"
for verb in $("$program" --help | sed -n '/^Subcommands:/,/^Examples:/s/^  \([a-z-]*\) .*/\1/p'); do
  [ -s "$root/usr/share/man/man1/bough-$verb.1" ] || fail "man has no page of '$verb'"
  bash -c 'source "$1"; COMP_WORDS=(bough "$2"); COMP_CWORD=1; _bough; printf "%s\n" "${COMPREPLY[@]}"' _ \
    "$root/usr/share/bash-completion/completions/bough" "$verb" | grep -qx "$verb" || fail "'$verb' is not completed"
done
if command -v man > /dev/null; then
  told=$(LC_ALL=C man -l --warnings "$root/usr/share/man/man1/bough-run.1" 2>&1 > man.txt)
  [ -z "$told" ] || fail "man: $told"
  grep -q -- '--threads' man.txt || fail "the page of run does not know --threads"
fi

if [ "$(id -u)" = 0 ]; then
  mkdir -p installed/var/lib/dpkg/info installed/var/lib/dpkg/updates
  : > installed/var/lib/dpkg/status
  dpkg --root="$scratch/installed" --force-depends --install "$package" > dpkg.log 2>&1 || { cat dpkg.log; exit 1; }
  installed/usr/bin/bough --version
  dpkg --root="$scratch/installed" --remove bough >> dpkg.log 2>&1 || { cat dpkg.log; exit 1; }
  [ ! -e installed/usr/bin/bough ] || fail "dpkg did not remove the program"
fi
echo "$(basename "$package"): $(du -k "$package" | cut -f 1) kB"
