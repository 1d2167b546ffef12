# A test is limited by the processor time of each of its processes, which other programs on the machine do not lengthen.
# Its wall clock only ends what waits for something that never comes, and has this many times as long.
set(BOUGH_TEST_PATIENCE 10)

# bough_limit_test(NAME SECONDS)   of processor time, which the test reads from BOUGH_TEST_CPU: tests/support/main.cpp, and
# scripts that work for minutes
function(bough_limit_test name seconds)
  math(EXPR wall "${BOUGH_TEST_PATIENCE} * ${seconds}")
  set_tests_properties(${name} PROPERTIES TIMEOUT ${wall} ENVIRONMENT "BOUGH_TEST_CPU=${seconds}")
endfunction()
