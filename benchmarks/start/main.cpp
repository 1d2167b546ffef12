/// bench_start [options of Google Benchmark]
/// Cost of starting the program: whole processes, one per iteration, timed from before the start until the exit status
/// is read.
/// start/nothing /bin/true: the cost of any process
///   start/version        bough --version
///   start/ten_unknowns   bough run of a scene of ten unknowns and 100 steps, files written
/// Wall time; the counters cpu_ms (user and system time of the child), faults (of pages, without reading).
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "../support/context.hpp"
#include "bough/io/history.hpp"

namespace {

constexpr long steps = 100;

struct Outcome {
  int status = -1;  ///< exit status; -1: it did not start or end by itself
  double wall = 0.0, cpu = 0.0;
  long faults = 0;
};

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

Outcome run_process(const std::vector<std::string>& command) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  Outcome out;
  pid_t child = -1;
  const auto start = std::chrono::steady_clock::now();
  const int error = posix_spawn(&child, words[0], &actions, nullptr, words.data(), environ);
  rusage usage{};
  int status = -1;
  if (error == 0 && wait4(child, &status, 0, &usage) == child && WIFEXITED(status)) out.status = WEXITSTATUS(status);
  out.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  posix_spawn_file_actions_destroy(&actions);
  out.cpu = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  out.faults = usage.ru_minflt;
  return out;
}

void add_row(const std::string& name, const std::vector<std::string>& command) {
  benchmark::RegisterBenchmark(
      ("start/" + name).c_str(),
      [command](benchmark::State& state) {
        double cpu = 0.0, faults = 0.0;
        for (auto _ : state) {
          const Outcome out = run_process(command);
          if (out.status != 0) {
            state.SkipWithError((command.front() + " failed").c_str());
            break;
          }
          state.SetIterationTime(out.wall);
          cpu += out.cpu;
          faults += static_cast<double>(out.faults);
        }
        state.counters["cpu_ms"] = benchmark::Counter(1e3 * cpu, benchmark::Counter::kAvgIterations);
        state.counters["faults"] = benchmark::Counter(faults, benchmark::Counter::kAvgIterations);
      })
      ->UseManualTime()
      ->Iterations(20)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  std::vector<std::string> defaults{"--benchmark_repetitions=11", "--benchmark_enable_random_interleaving=true"};
  for (std::string& d : defaults) arguments.insert(arguments.begin() + 1, d.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  bough::bench::add_context();

  const std::filesystem::path out = std::filesystem::path(BOUGH_PROGRAM).parent_path() / "bench_start.out";
  const std::vector<std::string> run{BOUGH_PROGRAM, "run", BOUGH_START_SCENE, "--out", out.string(), "--quiet"};
  const bool did_run = run_process(run).status == 0;
  if (!did_run || bough::io::read_history(out / "history.csv").rows.size() != steps + 1) {
    std::fprintf(stderr, "bench_start: %s run %s did not write %ld steps to %s\n", BOUGH_PROGRAM, BOUGH_START_SCENE,
                 steps, out.c_str());
    return 1;
  }
  add_row("nothing", {"/bin/true"});
  add_row("version", {BOUGH_PROGRAM, "--version"});
  add_row("ten_unknowns", run);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  std::filesystem::remove_all(out);
}
