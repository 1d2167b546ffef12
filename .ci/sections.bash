# Sourced by .ci/run and .ci/check-all: named sections with their time, and one summary at the end.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CI=true DEBIAN_FRONTEND=noninteractive CLICOLOR=0
jobs=$(nproc)
mkdir -p build
summary=()
tests_passed=0
tests_failed=0

# section NAME COMMAND...: runs the command, counts the tests that ctest reports, goes on after a failure. A section
# that fails without a failed test counts as one.
section() {
  local name=$1 start=$SECONDS status passed failed
  shift
  printf '\n==== %s\n' "$name"
  "$@" 2>&1 | tee build/ci.log
  status=${PIPESTATUS[0]}
  read -r passed failed < <(awk '
    match($0, /[0-9]+ tests? failed out of [0-9]+/) {
      split(substr($0, RSTART, RLENGTH), word, " "); failed += word[1]; total += word[6] }
    END { print total - failed, failed + 0 }' build/ci.log)
  if [ "$status" -ne 0 ] && [ "$failed" -eq 0 ]; then
    failed=1
  fi
  tests_passed=$((tests_passed + passed))
  tests_failed=$((tests_failed + failed))
  summary+=("$(printf '%-7s %5d s %5d passed %4d failed  %s' "$([ "$status" -eq 0 ] && echo ok || echo FAILED)" \
    $((SECONDS - start)) "$passed" "$failed" "$name")")
  printf '%s\n' "${summary[-1]}"
}

# build_and_test PRESET TARGETS CTEST_ARGUMENTS...
build_and_test() {
  local preset=$1 targets=$2
  shift 2
  cmake --preset "$preset" > "build/configure-$preset.log" 2>&1 || { cat "build/configure-$preset.log"; return 1; }
  # shellcheck disable=SC2086
  cmake --build "build/$preset" --parallel "$jobs" --target $targets || return 1
  run_ctest "build/$preset" "$@"
}

# With the library of the release build, so that only the benchmarks are compiled.
build_benchmarks() {
  cmake build/release -DBOUGH_BUILD_BENCHMARKS=ON > build/configure-benchmarks.log 2>&1 ||
    { cat build/configure-benchmarks.log; return 1; }
  cmake --build build/release --parallel "$jobs"
}

run_ctest() {
  local folder=$1
  shift
  ${no_randomisation:-} ctest --test-dir "$folder" --output-on-failure --no-tests=error -j "$jobs" "$@"
}

# The thread sanitizer's runtime of clang 14 cannot start where the kernel randomises more than 28 bits of addresses.
thread_sanitizer() {
  local no_randomisation=
  if [ "$(cat /proc/sys/vm/mmap_rnd_bits 2>/dev/null || echo 32)" -gt 28 ]; then
    no_randomisation="setarch -R"
  fi
  sh cmake/build_tsan_tbb.sh || return 1
  # A test that starts threads has "thread" in its full name, PROGRAM.SUITE.TEST. A race needs a second thread, so the
  # others are left out.
  TSAN_OPTIONS="halt_on_error=1 second_deadlock_stack=1" build_and_test tsan \
    "tests_tree_unit tests_schedule_unit test_solve_threads test_solve_forms test_step_threads" \
    -L '^unit$' -R '^schedule/|[Tt]hread'
}

finish() {
  printf '\n==== summary\n'
  printf '%s\n' "${summary[@]}"
  printf '%d passed, %d failed\n' "$tests_passed" "$tests_failed"
  [ "$tests_failed" -eq 0 ]
}
