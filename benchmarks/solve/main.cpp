/// bench_solve [--case=REGEX] [--solver=REGEX] [--matrix FILE.mtx|FOLDER ...] [--side_by_side=yes] [options of Google
/// Benchmark]
/// Numeric refactorization plus one solution, symbolic work reused: bough and its peers on the same matrices. --matrix:
/// instead of the matrices of scenes, those of Matrix Market files (matrix_file.hpp). --side_by_side=yes: instead of
/// these, the gain by a second thread on chains and lattices, and that of two threads that share no work
/// (second_thread.hpp).
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <regex>
#include <string>
#include <vector>

#include "../support/arguments.hpp"
#include "../support/context.hpp"
#include "cases.hpp"
#include "second_thread.hpp"

namespace {

using namespace bough::bench;

void run_row(benchmark::State& state, const Problem& problem, Entrant& entrant) {
  state.SetLabel(entrant.ordering);
  if (!entrant.failure.empty()) {
    state.SkipWithError(entrant.failure.c_str());
    return;
  }
  using Clock = std::chrono::steady_clock;
  std::vector<double> x;
  bool ok = true;
  Clock::duration in_solutions{};
  const bool is_peer = entrant.solver != "bough";
  if (is_peer) set_blas_threads(entrant.threads);
  entrant.session->iterate([&] {
    for (auto _ : state) {
      ok = entrant.session->refactor();
      const Clock::time_point start = Clock::now();
      ok = ok && entrant.session->solve(x);
      in_solutions += Clock::now() - start;
      if (!ok) {
        state.SkipWithError("the solver failed");
        return;
      }
    }
  });
  if (is_peer) set_blas_threads(1);
  if (!ok) return;
  state.counters["solve_ms"] =
      benchmark::Counter(1e3 * std::chrono::duration<double>(in_solutions).count(), benchmark::Counter::kAvgIterations);
  state.counters["analysis_ms"] = 1e3 * entrant.analysis;
  state.counters["first_factor_ms"] = 1e3 * entrant.first;
  state.counters["backward_error"] = eval_backward_error(problem.matrix, x, problem.rhs);
  state.counters["unknowns"] = problem.matrix.n;
  state.counters["entries"] = problem.matrix.num_entries();
  if (const double entries = entrant.session->factor_entries(); entries > 0.0)
    state.counters["factor_entries"] = entries;
  if (const double bytes = entrant.session->memory_bytes(); bytes > 0.0) {
    state.counters["memory_bytes"] = bytes;
    std::size_t numbers = 0;
    for (const std::vector<double>& a : problem.elements) numbers += a.size();
    state.counters["matrix_bytes"] = static_cast<double>(sizeof(double) * numbers);
  }
  if (const double flops = entrant.session->factor_flops(); flops > 0.0)
    state.counters["flops"] = benchmark::Counter(flops, benchmark::Counter::kIsIterationInvariantRate);
}

int run(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  const std::regex wanted_case(take_option(arguments, "case", ".*"));
  const std::regex wanted_solver(take_option(arguments, "solver", ".*"));
  const std::vector<std::string> matrices = take_options(arguments, "matrix");
  const bool side_by_side = take_option(arguments, "side_by_side", "no") == "yes";
  std::vector<std::string> defaults{"--benchmark_repetitions=5", "--benchmark_enable_random_interleaving=true",
                                    "--benchmark_min_time=0.03"};
  for (std::string& d : defaults) arguments.insert(arguments.begin() + 1, d.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  add_context();
  if (side_by_side) {
    const auto rows =
        add_second_thread_rows([&](const std::string& name) { return std::regex_match(name, wanted_case); });
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
  }

  std::vector<Peer> peers;
  for (Peer& p : make_peers())
    if (std::regex_match(p.name, wanted_solver)) {
      benchmark::AddCustomContext("version " + p.name, p.version);
      peers.push_back(std::move(p));
    }
  const bool has_bough = std::regex_match("bough", wanted_solver);
  const std::vector<Case> cases = matrices.empty() ? make_cases() : make_cases(matrices);
  std::vector<Field> fields;
  std::vector<LeftOut> left_out;
  Memory memory;
  for (const Case& c : cases) {
    if (!std::regex_match(c.name, wanted_case)) continue;
    std::fprintf(stderr, "preparing %s\n", c.name.c_str());
    fields.push_back(make_field(c, peers, has_bough, memory, left_out));
  }
  for (Field& f : fields)
    for (Entrant& e : f.entrants)
      benchmark::RegisterBenchmark(
          (e.solver + "/" + f.bench_case->name + "/threads:" + std::to_string(e.threads)).c_str(),
          [&f, &e](benchmark::State& state) { run_row(state, *f.problem, e); })
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
  for (const LeftOut& l : left_out) benchmark::AddCustomContext("left out " + l.solver + "/" + l.case_name, l.reason);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_solve: %s\n", e.what());
    return 2;
  }
}
