/// bench_solve [--case=REGEX] [--solver=REGEX] [--lockstep=yes] [--side_by_side=yes] [options of Google Benchmark]
/// Numeric refactorization plus one solution, symbolic work reused: bough and its peers on the same matrices.
/// --lockstep=yes: unsymmetric chains with both of bough's trees. --side_by_side=yes: instead of these, the gain by a
/// second thread on chains and lattices, and that of two threads that share no work (second_thread.hpp).
#include <benchmark/benchmark.h>

#include <cstdio>
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
  std::vector<double> x;
  bool ok = true;
  entrant.session->iterate([&] {
    for (auto _ : state)
      if (!(ok = entrant.session->refactor_and_solve(x))) {
        state.SkipWithError("the solver failed");
        return;
      }
  });
  if (!ok) return;
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
  state.SetLabel(entrant.ordering);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  const std::regex wanted_case(take_option(arguments, "case", ".*"));
  const std::regex wanted_solver(take_option(arguments, "solver", ".*"));
  const bool lockstep = take_option(arguments, "lockstep", "no") == "yes";
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
  OwnRows own;
  if (std::regex_match("bough", wanted_solver)) own.thread_counts = {1, 2};
  own.lockstep = lockstep;
  const std::vector<Case> cases = make_cases();
  std::vector<Field> fields;
  std::vector<LeftOut> left_out;
  Memory memory;
  for (const Case& c : cases) {
    if (!std::regex_match(c.name, wanted_case)) continue;
    std::fprintf(stderr, "preparing %s\n", c.name.c_str());
    fields.push_back(make_field(c, peers, own, memory, left_out));
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
}
