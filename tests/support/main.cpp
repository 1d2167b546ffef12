// The main function of every test: unmasks the floating-point traps divide, invalid and overflow, so that a test
// stops at the instruction that makes the first infinity or NaN instead of failing somewhere after it.
#include <fenv.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace {

// Sanitizers insert code of their own that does not expect traps. An optimising clang may compute both sides of a
// select and discard one, which is right only without traps; g++ respects trapping arithmetic by default.
constexpr bool compiled_for_traps() {
#if defined(BOUGH_TEST_WITHOUT_TRAPS) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#elif defined(__clang__) && defined(__OPTIMIZE__)
  return false;
#elif defined(__has_feature)
  return !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer) && !__has_feature(memory_sanitizer);
#else
  return true;
#endif
}

// valgrind masks traps and says so in its log at every start; it is recognised by LD_PRELOAD.
bool runs_under_valgrind() {
  const char* preload = std::getenv("LD_PRELOAD");
  return preload != nullptr && std::strstr(preload, "valgrind") != nullptr;
}

void put(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) {
    std::_Exit(EXIT_FAILURE);
  }
}

extern "C" void explain_trap(int signal, siginfo_t* info, void*) {
  put("\nfloating-point trap: ");
  put(info->si_code == FPE_FLTDIV   ? "division by zero"
      : info->si_code == FPE_FLTINV ? "invalid operation"
      : info->si_code == FPE_FLTOVF ? "overflow"
                                    : "arithmetic");
  if (const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info()) {
    put(" in ");
    put(test->test_suite_name());
    put(".");
    put(test->name());
  }
  put("\n");
  ::signal(signal, SIG_DFL);  // the instruction runs again and the process ends with SIGFPE: a debugger stops there
}

/// Seconds of processor time that the test may take, if its caller says so: other programs on the machine do not make
/// them more.
void limit_processor_time() {
  const char* seconds = std::getenv("BOUGH_TEST_CPU");
  const rlim_t most = seconds == nullptr ? 0 : std::strtoul(seconds, nullptr, 10);
  if (most == 0) return;
  const rlimit limit{most, most + 5};  // SIGXCPU says why, then SIGKILL
  setrlimit(RLIMIT_CPU, &limit);
}

}  // namespace

int main(int argc, char** argv) {
  limit_processor_time();
  testing::InitGoogleTest(&argc, argv);
  if (compiled_for_traps() && !runs_under_valgrind()) {
    struct sigaction action = {};
    action.sa_sigaction = explain_trap;
    action.sa_flags = SA_SIGINFO;
    sigaction(SIGFPE, &action, nullptr);
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
  }
  return RUN_ALL_TESTS();
}
