#!/bin/sh
# check_dispatch.sh BUILD SOURCE SCRATCH COMPILER   installs a build with BOUGH_DISPATCH in SCRATCH, moves it, and
# checks that
#   - the program and the plain libraries contain no AVX instruction, the variants do; public structs have one layout;
#   - every name that a library needs exists in each variant, and no library uses a function of the program;
#   - the loader maps the libraries of one variant only, also in the build folder, and doctor and summaries name it;
#   - histories agree: to the last bit between x86-64-v3 and v4, to round-off with the plain libraries; the figures
#     expected by the gallery hold;
#   - another program, built with the installed package, gets the same libraries.
# A variant that this processor cannot run is checked as far as possible, and named.
set -eu
build=$1 source=$2 scratch=$3 compiler=$4
rm -rf "$scratch"
mkdir -p "$scratch"
cmake --install "$build" --prefix "$scratch/first" > "$scratch/install.log"
mv "$scratch/first" "$scratch/prefix"
cd "$scratch"
prefix=$scratch/prefix
program=$prefix/bin/bough
folder=$(dirname "$(find "$prefix" -type d -name glibc-hwcaps)")  # of the plain libraries
loader=$(readelf -lW "$program" | sed -n 's/.*interpreter: \(.*\)]/\1/p')
variants='x86-64-v3 x86-64-v4'

fail() {
  echo "check_dispatch: $*"
  exit 1
}

folder_of() {  # folder_of VARIANT|plain
  [ "$1" = plain ] && echo "$folder" || echo "$folder/glibc-hwcaps/$1"
}

name_of() {
  case $1 in
    plain) echo SSE2 ;;
    x86-64-v3) echo AVX2 ;;
    x86-64-v4) echo AVX-512 ;;
  esac
}

libraries_in() {
  find "$1" -maxdepth 1 -type f -name 'libbough_*.so.*' | sort
}

# The variants that this machine can run, the widest last.
runnable=plain
for variant in $variants; do
  if "$loader" --help | grep -q "^  $variant (supported"; then
    runnable="$runnable $variant"
  else
    echo "not run, since this processor cannot: $variant"
  fi
done

echo "== installed files"
names=$(libraries_in "$folder" | xargs -n 1 basename)
[ -n "$names" ] || fail "no libraries in $folder"
for variant in $variants; do
  [ "$(libraries_in "$(folder_of "$variant")" | xargs -n 1 basename)" = "$names" ] || fail "$variant has other libraries than plain"
done

echo "== instructions"
# avx_in FILE: the first instruction in VEX or EVEX form, or of BMI, that FMA and AVX come with
avx_in() {
  objdump -d --no-show-raw-insn "$1" | awk -F '\t' '
    NF >= 2 && $2 ~ /^(v[a-z0-9]+|andn|bextr|blsi|blsr|blsmsk|bzhi|mulx|pdep|pext|rorx|sarx|shlx|shrx)[ql]? / &&
      $2 !~ /^(verr|verw|vmcall|vmmcall)/ { print; exit }'
}
for file in "$program" $(libraries_in "$folder"); do
  found=$(avx_in "$file")
  [ -z "$found" ] || fail "$file runs not everywhere: $found"
done
for layer in elements solve; do
  objdump -d "$(folder_of x86-64-v3)"/libbough_$layer.so.?.?.? > code.txt
  grep -q 'vfmadd.*%ymm' code.txt || fail "no fused product of four doubles in $layer for x86-64-v3"
  if grep -q '%zmm' code.txt; then fail "AVX-512 in $layer for x86-64-v3"; fi
  objdump -d "$(folder_of x86-64-v4)"/libbough_$layer.so.?.?.? > code.txt
  grep -q 'vfmadd.*%zmm' code.txt || fail "no fused product of eight doubles in $layer for x86-64-v4"
done
rm code.txt

echo "== layout of public structs"
if "$compiler" --version | grep -q 'Free Software Foundation'; then
  (cd "$source/include" && find bough -name '*.hpp' | sort | sed 's/.*/#include "&"/') > headers.cpp
  [ -d "$prefix/include/bough/report" ] || sed -i '/"bough\/report/d' headers.cpp
  for march in x86-64 $variants; do
    mkdir -p "layout/$march"
    (cd "layout/$march" && "$compiler" -std=c++20 -march="$march" -ffp-contract=off -DEIGEN_MAX_ALIGN_BYTES=64 -I"$prefix/include" \
      $(pkg-config --cflags eigen3 2>/dev/null || echo -I/usr/include/eigen3) -fsyntax-only -fdump-lang-class ../../headers.cpp)
    # Each class, and the lines of sizes below it. Only the types of registers may differ.
    sed 's/registers_of_[0-9]*/registers/g' "layout/$march"/*.class |
      awk '/^Class /{name = $0} /size=/{print name ":" $0}' | grep -v 'registers::detail::' | sort -u > "layout/$march.txt"
    cmp "layout/x86-64.txt" "layout/$march.txt" || fail "a struct has another layout with -march=$march"
  done
  echo "$(grep -c 'bough::' layout/x86-64.txt) lines of sizes of bough's classes are equal"
else
  echo "skipped: only g++ prints it in this form"
fi

echo "== names"
if nm -D --undefined-only "$program" | grep registers_of_; then
  fail "the program calls the functions above, whose names differ between the variants"
fi
for variant in plain $variants; do
  # The loader relocates without running anything. ldd -r would also search the variants below the plain folder.
  LD_LIBRARY_PATH=$(folder_of "$variant") LD_TRACE_LOADED_OBJECTS=1 LD_WARN=yes LD_BIND_NOW=yes \
    "$loader" --glibc-hwcaps-mask none "$program" > ldd.txt 2>&1
  if grep -E 'undefined|not found' ldd.txt; then fail "names are missing in $variant"; fi
  [ "$(grep -c "=> $(folder_of "$variant")/libbough_" ldd.txt)" = "$(echo "$names" | wc -l)" ] || fail "not all libraries are of $variant: $(cat ldd.txt)"
done

# A cube of beams, clamped at one face and released: spatial, with many equal sub-domains and large fronts.
python3 - > lattice.json <<'PYTHON'
import itertools
import json
n = 4
name = lambda p: "n{}{}{}".format(*p)
points = list(itertools.product(range(n), repeat=3))
beams = []
for p in points:
    for a in range(3):
        q = tuple(p[k] + (k == a) for k in range(3))
        if q in points:
            side = [0, 0, 1] if a == 1 else [0, 1, 0]
            beams.append({"name": name(p) + " " + "xyz"[a], "section": "bar", "start": name(p), "end": name(q),
                          "axis_2": side, "elements": 2})
print(json.dumps({
    "schema_version": 1, "title": "lattice", "gravity": [0, 0, -9.81],
    "materials": [{"name": "soft", "young": 1e7, "poisson": 0.3, "density": 1000}],
    "sections": [{"name": "bar", "shape": {"kind": "rectangle", "width": 0.04, "height": 0.04}, "material": "soft"}],
    "nodes": [{"name": name(p), "position": list(map(float, p))} for p in points],
    "beams": beams,
    "joints": [{"name": "wall " + name(p), "kind": "fixed", "first": "ground", "second": name(p), "position": list(map(float, p))}
               for p in points if p[0] == 0],
    "sensors": [{"name": "corner", "kind": "position", "at": name((n - 1,) * 3)}, {"name": "energy", "kind": "total_energy"}],
    "analysis": {"kind": "dynamic", "end_time": 0.2, "step_size": 0.01}}))
PYTHON
cp "$source/data/scenarios/chain.json" chain.json

# run_as VARIANT|plain ARGUMENTS...: runs the program without libraries of wider instruction sets
run_as() {
  mask=$1
  shift
  "$loader" --glibc-hwcaps-mask "$mask" "$program" "$@"
}

# mapped FILE WHO LIBRARIES [COUNT]: checks in the loader's report FILE that COUNT (all) libraries came from there
mapped() {
  sed -n 's/.*calling init: \(.*libbough_.*\)/\1/p' "$1" | xargs realpath | sort > mapped.txt
  [ "$(xargs -n 1 dirname < mapped.txt | sort -u)" = "$(realpath "$3")" ] && [ "$(wc -l < mapped.txt)" = "${4:-$(echo "$names" | wc -l)}" ] ||
    fail "$2 was to be loaded from $3, these were: $(cat mapped.txt)"
}

for level in $runnable; do
  echo "== runs with $level"
  for scene in chain lattice; do
    rm -f debug.*
    LD_DEBUG=files LD_DEBUG_OUTPUT=debug run_as "$level" run $scene.json --quiet --check-expected --threads 2 --out "$level/$scene"
    mapped "$(ls debug.*)" "$level" "$(folder_of "$level")"
    grep "\"instruction_set\": \"$(name_of "$level")\"" "$level/$scene/summary.json" || fail "the summary tells another instruction set"
  done
  run_as "$level" doctor > doctor.txt || fail "doctor is not well: $(cat doctor.txt)"
  grep "lanes   $(name_of "$level")," doctor.txt || fail "doctor tells another instruction set: $(cat doctor.txt)"

  # The libraries' calls must not end in the program, whose copies of shared templates are compiled for the baseline.
  rm -f debug.*
  LD_BIND_NOW=1 LD_DEBUG=bindings LD_DEBUG_OUTPUT=debug run_as "$level" --version
  sed -n "s/.*binding file \(.*libbough_.*\) \[0\] to \(.*\) \[0\]: .*symbol .\([^']*\)'.*/\1 \2 \3/p" debug.* > bindings.txt
  [ -s bindings.txt ] || fail "the loader reports no bindings"
  grep " $program " bindings.txt | awk '{print $3}' | sort -u > to_program.txt
  nm -D --defined-only "$program" | awk '$2 ~ /[TtWi]/ {print $3}' | sort -u > functions.txt
  if comm -12 to_program.txt functions.txt | c++filt | grep .; then
    fail "$level takes the functions above from the program"
  fi
  echo "$(wc -l < to_program.txt) names bound to the program: $(c++filt < to_program.txt | cut -c 1-120 | tr '\n' ';')"
  echo "$(grep -c ' .*libbough_' bindings.txt) of $(wc -l < bindings.txt) bindings of the layers go to layers"
done

widest=$(echo "$runnable" | awk '{print $NF}')
echo "== unasked: $widest"
for where in "$program" "$build/bough"; do
  rm -f debug.*
  LD_DEBUG=files LD_DEBUG_OUTPUT=debug "$where" doctor > doctor.txt
  grep "lanes   $(name_of "$widest")," doctor.txt || fail "$where runs something else"
  expected=$(folder_of "$widest")
  [ "$where" = "$program" ] || expected="$build/lib${expected#"$folder"}"
  mapped "$(ls debug.*)" "$where" "$expected"
done

echo "== results"
for scene in chain lattice; do
  for level in $runnable; do
    [ "$level" = plain ] || cmp "x86-64-v3/$scene/history.csv" "$level/$scene/history.csv" || fail "$scene: $level and x86-64-v3 differ"
  done
  case $runnable in
    # The total energy hardly changes, so its range is no scale. Tens of joules are exchanged, of which Newton's
    # tolerance leaves 1e-8.
    *v3*) "$program" compare plain/$scene x86-64-v3/$scene --rel 1e-8 --abs 1e-7 ||
      fail "$scene: plain and x86-64-v3 differ by more than round-off" ;;
  esac
done
for level in $runnable; do
  echo "gallery, $level:"
  run_as "$level" batch "$source/data/scenarios" --out "gallery/$level" --check-expected > gallery.txt || fail "$(cat gallery.txt)"
  tail -n 1 gallery.txt
done

echo "== a user of the package"
cmake -S "$source/tests/consumer" -B user -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" > user.log && cmake --build user >> user.log ||
  fail "$(cat user.log)"
rm -f debug.*
LD_DEBUG=files LD_DEBUG_OUTPUT=debug user/consumer "$source"
# It needs fewer layers than the program.
wanted=$(LD_TRACE_LOADED_OBJECTS=1 user/consumer | grep -c libbough_)
[ "$wanted" -gt 0 ] || fail "consumer asks for none of the libraries"
mapped "$(ls debug.*)" consumer "$(folder_of "$widest")" "$wanted"
