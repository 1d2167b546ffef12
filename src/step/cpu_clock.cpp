#include "bough/step/cpu_clock.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace bough::step {

namespace {

constexpr std::int64_t longest_guess = 200000;  // [ns]

double read(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::int64_t steady_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

double CpuClock::now() {
  if (!has_one_thread_) return read(CLOCK_PROCESS_CPUTIME_ID);
  if (read_at_ >= 0) {
    const std::int64_t since = steady_now() - read_at_;
    if (since < longest_guess) return told_ = std::max(told_, cpu_ + 1e-9 * static_cast<double>(since));
  }
  cpu_ = read(CLOCK_THREAD_CPUTIME_ID);
  read_at_ = steady_now();  // read after the CPU clock, so that waiting between both does not count as work
  return told_ = std::max(told_, cpu_);
}

void CpuClock::charge(double* next) {
  const double time = now();
  if (charged_ != nullptr) *charged_ += time - begun_;
  charged_ = next;
  begun_ = time;
  is_left_open_ = false;
}

PhaseTimer::PhaseTimer(CpuClock& clock, double& sum)
    : clock_(clock), outer_(clock.is_left_open_ ? nullptr : clock.charged_) {
  if (clock.charged_ == &sum)
    clock.is_left_open_ = false;  // the phase goes on, so that the clock need not be read
  else
    clock.charge(&sum);
}
PhaseTimer::~PhaseTimer() {
  if (outer_ == nullptr && clock_.is_chained_)
    clock_.is_left_open_ = true;
  else if (clock_.charged_ != outer_)
    clock_.charge(outer_);
}

PhaseChain::PhaseChain(CpuClock& clock) : clock_(clock) { clock.is_chained_ = true; }
PhaseChain::~PhaseChain() {
  clock_.is_chained_ = false;
  if (clock_.is_left_open_) clock_.charge(nullptr);
}

}  // namespace bough::step
