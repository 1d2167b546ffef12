#include "second_thread.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "../support/side_by_side.hpp"
#include "cases.hpp"
#include "trial.hpp"

namespace bough::bench {

namespace {

bool is_sound(const Problem& problem, Session& session) {
  std::vector<double> x;
  return session.analyze() && session.factor() && session.refactor_and_solve(x) &&
         eval_backward_error(problem.matrix, x, problem.rhs) <= largest_backward_error;
}

/// Chains and lattices large enough for a second thread.
bool is_one_of_the_rows(const Case& c) {
  if (c.values != Values::unsymmetric) return false;
  if (c.family == Family::chain) return c.size >= 128 && c.size <= 2048;
  return (c.family == Family::lattice_2d && c.size >= 50 && c.size <= 100) ||
         (c.family == Family::lattice_3d && c.size == 12);
}

/// Empty if a solver fails.
std::unique_ptr<SecondThreadCase> make_case(const Case& c) {
  auto out = std::make_unique<SecondThreadCase>();
  out->problem = std::make_unique<Problem>(c.make_problem());
  const Problem& p = *out->problem;
  const auto first = std::make_shared<BoughStorage>(p);
  out->alone[0] = std::make_unique<BoughSession>(p, first, 1);
  out->alone[1] = std::make_unique<BoughSession>(p, std::make_shared<BoughStorage>(p), 1);
  out->together = std::make_unique<BoughSession>(p, first, 2);
  for (Session* s : {out->alone[0].get(), out->alone[1].get(), out->together.get()})
    if (!is_sound(p, *s)) return nullptr;
  std::vector<double> x;
  const auto once = [&](int) { static_cast<void>(out->alone[0]->refactor_and_solve(x)); };
  out->rounds = std::max(1L, std::lround(0.03 / eval_rounds(1, 1, once)));
  return out;
}

void run_row(benchmark::State& state, SecondThreadCase& c) {
  std::vector<double> x[2];
  bool solved[2] = {true, true};
  const auto on_one = [&](int k) { solved[k] = c.alone[k]->refactor_and_solve(x[k]) && solved[k]; };
  const auto on_two = [&](int) { solved[0] = c.together->refactor_and_solve(x[0]) && solved[0]; };
  const auto rounds_on_two = [&](int) {
    c.together->iterate([&] {
      for (long r = 0; r < c.rounds; ++r) on_two(0);
    });
  };
  SideBySide times;
  double together = 0.0;
  while (state.KeepRunningBatch(c.rounds)) {
    times.add(state, c.rounds, on_one);
    together += eval_rounds(1, 1, rounds_on_two);
  }
  if (!solved[0] || !solved[1]) {
    state.SkipWithError("the solver failed");
    return;
  }
  times.report(state);
  state.counters["together"] = 1e3 * together / static_cast<double>(state.iterations());
  state.counters["gained"] = times.alone / together;
}

}  // namespace

std::vector<std::unique_ptr<SecondThreadCase>> add_second_thread_rows(
    const std::function<bool(const std::string&)>& is_wanted) {
  std::vector<std::unique_ptr<SecondThreadCase>> rows;
  for (const Case& c : make_cases()) {
    if (!is_one_of_the_rows(c) || !is_wanted(c.name)) continue;
    std::unique_ptr<SecondThreadCase> made = make_case(c);
    if (made == nullptr) {
      benchmark::AddCustomContext("left out second_thread/" + c.name, "the solver failed");
      continue;
    }
    rows.push_back(std::move(made));
    benchmark::RegisterBenchmark(("second_thread/" + c.name).c_str(),
                                 [row = rows.back().get()](benchmark::State& state) { run_row(state, *row); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
  return rows;
}

}  // namespace bough::bench
