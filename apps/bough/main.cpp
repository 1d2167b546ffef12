#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>

#include "arguments.hpp"
#include "bough/io/manifest.hpp"
#include "standard_streams.hpp"
#include "terminal.hpp"

namespace {

/// The elimination of a sub-domain in lockstep has 400 kB of its own on the stack, in any thread.
constexpr rlim_t least_stack = 1024 * 1024, usual_stack = 8 * least_stack;

/// A smaller stack is raised as far as the system allows. False, and a word, where that is not enough.
bool has_stack() {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= least_stack) return true;
  const rlim_t given = limit.rlim_cur;
  limit.rlim_cur = std::min(limit.rlim_max, usual_stack);
  pthread_attr_t of_threads;
  if (limit.rlim_cur >= least_stack && setrlimit(RLIMIT_STACK, &limit) == 0 && pthread_attr_init(&of_threads) == 0) {
    const bool is_set =
        pthread_attr_setstacksize(&of_threads, limit.rlim_cur) == 0 && pthread_setattr_default_np(&of_threads) == 0;
    pthread_attr_destroy(&of_threads);
    if (is_set) return true;
  }
  std::cerr << "bough: the stack is limited to " << given / 1024 << " kB and has to hold " << least_stack / 1024
            << " kB at least: raise it, by ulimit -s 8192 say\n";
  return false;
}

/// Memory that is free at the end of the heap goes back to the system only where it is much: a picture of a moving
/// structure takes some 100 kB and gives them back, which were two system calls for every kilobyte that it grew by.
void keep_heap() {
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  mallopt(M_TOP_PAD, 1 << 20);
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
}

/// Memory for what happens after an allocation has failed: destructors of JSON values allocate, and must not fail.
std::unique_ptr<char[]> reserve;

/// Called where memory cannot be had: gives the reserve back, and lets that allocation fail.
void release_reserve() {
  reserve.reset();
  std::set_new_handler(nullptr);
  throw std::bad_alloc();
}

void hold_reserve() {
  constexpr std::size_t size = 1u << 19u;
  reserve.reset(new char[size]);
  std::set_new_handler(release_reserve);
}

/// Whatever was not foreseen still ends in a sentence and a status.
int dispatch_guarded(int count, char** values) {
  try {
    return bough::app::dispatch(count, values);
  } catch (const bough::io::OutputRefused& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return bough::app::exit_bad_input;
  } catch (const std::exception& error) {
    std::cerr << "bough: " << bough::app::cause_of(error) << "\n";
  }
  return bough::app::exit_failed;
}

}  // namespace

int main(int count, char** values) {
  bough::app::hold_standard_descriptors();
  bough::app::ignore_signals_of_writes();
  keep_heap();
  try {
    hold_reserve();
    bough::app::StandardStreams streams;
    return streams.finish(has_stack() ? dispatch_guarded(count, values) : bough::app::exit_failed);
  } catch (const std::bad_alloc&) {
    std::fputs("bough: out of memory before it could begin\n", stderr);
  }
  return bough::app::exit_failed;
}
