/// bench_step [--case=REGEX] [--solver=REGEX] [--scaling=yes] [--million=yes] [--loops=yes] [options of Google
/// Benchmark]. One iteration is one accepted time step of the program, from rest. Instead of the usual cases
/// --scaling=yes: chains of 32 to 32768 links; --million=yes: a chain and a lattice of about a million unknowns;
/// --loops=yes: 20 to 320 windows of four-bars in space, in motion.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "../solve/peer.hpp"
#include "../solve/trial.hpp"
#include "../support/arguments.hpp"
#include "../support/context.hpp"
#include "../support/scenes.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/parts.hpp"
#include "bough/solve/visits.hpp"

namespace {

using namespace bough;
using namespace bough::bench;

constexpr double step_size = 1e-3;

struct StepCase {
  std::string name;
  int size;
  int steps;  ///< timed in a run
  scene::Scene (*make)(int);
  bool has_klu_rows;
};

scene::Scene make_clamped_lattice(int n) { return make_lattice_2d(n, Support::clamp); }

/// Gravity has a component out of their plane, so that it is not taken for a planar motion: three constraint rows of
/// each window depend on others.
scene::Scene make_four_bars_in_space(int windows) {
  scene::Scene s = scene::make_four_bars(windows);
  s.gravity[2] = 0.1;
  return s;
}

std::vector<StepCase> make_step_cases(bool scaling, bool million, bool loops) {
  std::vector<StepCase> cases;
  if (loops) {
    for (int windows : {20, 40, 80, 160, 320})
      cases.push_back({"four_bars_" + std::to_string(windows), windows, 50, make_four_bars_in_space, true});
    return cases;
  }
  if (million)
    return {{"chain_60000", 60000, 10, make_chain, false}, {"lattice_408", 408, 10, make_clamped_lattice, false}};
  if (scaling) {
    for (int links : {32, 128, 512, 2048, 8192, 32768})
      cases.push_back({"chain_" + std::to_string(links), links, links > 4096 ? 10 : 50, make_chain, false});
    return cases;
  }
  for (int links : {128, 512, 2048}) cases.push_back({"chain_" + std::to_string(links), links, 50, make_chain, true});
  cases.push_back({"lattice_50", 50, 20, make_clamped_lattice, true});
  cases.push_back({"lattice_100", 100, 5, make_clamped_lattice, true});
  cases.push_back({"rigid_chain_2048", 2048, 50, make_rigid_chain, true});
  return cases;
}

class NoRecorder final : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

scene::Scene make_scene(const StepCase& c, scene::SolverForm form, int steps) {
  scene::Scene s = c.make(c.size);
  s.analysis.step_size = step_size;
  s.analysis.end_time = step_size * steps;
  s.solver.form = form;
  s.output.stride = steps;  // steps are timed, not rows: only the first and the last are observed
  return s;
}

/// Operations of one factorization, and bytes that one solution reads: all factors once, L upward and U downward. 0 for
/// other than the hierarchical solver.
struct Loads {
  double factor_flops = 0.0, factor_bytes = 0.0;
};

records::Summary simulate(const scene::Scene& s, int threads, const run::ProgressCallback& progress = {},
                          Loads* loads = nullptr) {
  NoRecorder recorder;
  run::SimulateOptions options;
  options.threads = threads;
  options.after_run = [loads](step::System& system, const step::State&) {
    if (loads == nullptr || system.linear().solver().hierarchical() == nullptr) return;
    loads->factor_flops = system.linear().solver().counters().factor_flops;
    const solve::VisitShapes shapes = solve::make_visit_shapes(
        system.plan().graph, system.linear().tree(), step::make_solve_options(system.plan(), scene::Solver{}));
    for (const solve::VisitShape& v : shapes.visits) loads->factor_bytes += static_cast<double>(v.factor_bytes);
  };
  return run::simulate(s, options, recorder, progress);
}

/// Times the steps after the first one in runs of steps + 1. The times of phases are differences to a run of one step,
/// which `start` stores over the repetitions.
void run_steps(benchmark::State& state, const StepCase& c, scene::SolverForm form, int threads,
               std::optional<records::Summary>& start) {
  const scene::Scene one = make_scene(c, form, 1), all = make_scene(c, form, c.steps + 1);
  records::Summary end;
  Loads loads;
  while (state.KeepRunningBatch(c.steps)) {
    state.PauseTiming();
    if (!start) start = simulate(one, threads);
    end = simulate(
        all, threads,
        [&](const records::Progress& p) {
          if (p.step == 1) state.ResumeTiming();
          if (p.step == c.steps + 1) state.PauseTiming();
          return true;
        },
        &loads);
    state.ResumeTiming();
    if (start->status != records::RunStatus::ok || end.status != records::RunStatus::ok || end.steps.rejected > 0) {
      state.SkipWithError(("the run failed or rejected steps: " + end.cause).c_str());
      return;
    }
  }
  const auto per_step = [&](auto of) { return static_cast<double>(of(end) - of(*start)) / c.steps; };
  using S = records::Summary;
  state.counters["evaluate_ms"] = 1e3 * per_step([](const S& s) { return s.times.assemble; });
  state.counters["factor_ms"] = 1e3 * per_step([](const S& s) { return s.times.factor; });
  state.counters["solve_ms"] = 1e3 * per_step([](const S& s) { return s.times.solve; });
  state.counters["update_ms"] = 1e3 * per_step([](const S& s) { return s.times.update; });
  state.counters["output_ms"] = 1e3 * per_step([](const S& s) { return s.times.output; });
  state.counters["iterations_a_step"] = per_step([](const S& s) { return s.steps.newton_iterations; });
  state.counters["factorizations_a_step"] = per_step([](const S& s) { return s.steps.factorizations; });
  state.counters["prepare_s"] = end.times.prepare;  // reading apart: plan, tree and symbolic factorization
  state.counters["memory_peak_mb"] = 1e-6 * static_cast<double>(end.memory_peak_bytes);
  if (loads.factor_flops == 0.0) return;
  const auto rate = [&](const char* of, double amount) {  // per CPU time; omitted if the phase takes none
    const double seconds = 1e-3 * state.counters[of].value;
    return seconds > 1e-9 ? 1e-9 * amount / seconds : 0.0;
  };
  state.counters["factor_gflops"] =
      rate("factor_ms", loads.factor_flops * state.counters["factorizations_a_step"].value);
  state.counters["solve_gbytes"] = rate("solve_ms", loads.factor_bytes * state.counters["iterations_a_step"].value);
}

void add_step_row(const std::string& solver, const StepCase& c, scene::SolverForm form, int threads) {
  benchmark::RegisterBenchmark((solver + "/" + c.name + "/threads:" + std::to_string(threads)).c_str(),
                               [&c, form, threads, start = std::optional<records::Summary>()](
                                   benchmark::State& state) mutable { run_steps(state, c, form, threads, start); })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

#ifdef BOUGH_BENCH_HAS_KLU
struct KluRow {
  Problem problem;
  std::unique_ptr<Session> session;
  std::string ordering;
};

/// The matrix of the second step in the unknowns of the plan, which for a chain in a plane are three a node.
Problem make_planar_problem(const StepCase& c) {
  const scene::Scene s = make_scene(c, scene::SolverForm::local, 2);
  Problem problem;
  NoRecorder recorder;
  run::SimulateOptions options;
  options.after_run = [&](step::System& system, const step::State&) {
    const blocks::BlockGraph& graph = system.plan().graph;
    std::vector<std::vector<double>> elements(static_cast<std::size_t>(graph.num_elements()));
    for (int e = 0; e < graph.num_elements(); ++e) {
      std::int64_t n = 0;
      for (auto k = graph.element_begin[static_cast<std::size_t>(e)];
           k < graph.element_begin[static_cast<std::size_t>(e) + 1]; ++k)
        n += graph.block_size[static_cast<std::size_t>(graph.element_blocks[static_cast<std::size_t>(k)])];
      const solve::ConstElementView a = system.linear().solver().hierarchical()->element(e);
      for (std::int64_t k = 0; k < n * n; ++k) elements[static_cast<std::size_t>(e)].push_back(a[k]);
    }
    problem = make_problem(c.name + "_planar", graph, std::move(elements), Values::unsymmetric);
  };
  static_cast<void>(run::simulate(s, options, recorder, {}));
  return problem;
}

/// KLU's refactorization and solution of a matrix.
std::unique_ptr<KluRow> add_klu_row(const std::string& solver, const StepCase& c, Problem problem) {
  auto row = std::make_unique<KluRow>();
  row->problem = std::move(problem);
  Trial t = try_peer(make_klu_peer(), row->problem, "");
  if (!t.failure.empty()) {
    benchmark::AddCustomContext("left out " + solver + "/" + c.name, t.failure);
    return row;
  }
  row->session = std::move(t.session);
  row->ordering = t.ordering;
  benchmark::RegisterBenchmark((solver + "/" + c.name + "/threads:1").c_str(),
                               [r = row.get()](benchmark::State& state) {
                                 std::vector<double> x;
                                 for (auto _ : state)
                                   if (!r->session->refactor_and_solve(x)) {
                                     state.SkipWithError("the solver failed");
                                     return;
                                   }
                                 state.counters["backward_error"] =
                                     eval_backward_error(r->problem.matrix, x, r->problem.rhs);
                                 state.SetLabel(r->ordering);
                               })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  return row;
}
#endif

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  const std::regex wanted_case(take_option(arguments, "case", ".*"));
  const std::regex wanted_solver(take_option(arguments, "solver", ".*"));
  const bool scaling = take_option(arguments, "scaling", "no") == "yes";
  const bool million = take_option(arguments, "million", "no") == "yes";
  const bool loops = take_option(arguments, "loops", "no") == "yes";
  std::vector<std::string> defaults{"--benchmark_repetitions=5", "--benchmark_enable_random_interleaving=true",
                                    "--benchmark_min_time=0.01"};
  for (std::string& d : defaults) arguments.insert(arguments.begin() + 1, d.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  add_context();

  const std::vector<StepCase> cases = make_step_cases(scaling, million, loops);
#ifdef BOUGH_BENCH_HAS_KLU
  std::vector<std::unique_ptr<KluRow>> klu_rows;
#endif
  for (const StepCase& c : cases) {
    if (!std::regex_match(c.name, wanted_case)) continue;
    if (std::regex_match("bough", wanted_solver))
      for (int threads : {1, 2}) add_step_row("bough", c, scene::SolverForm::local, threads);
#ifdef BOUGH_BENCH_HAS_KLU
    if (!c.has_klu_rows) continue;
    if (std::regex_match("bough_klu", wanted_solver)) add_step_row("bough_klu", c, scene::SolverForm::monolithic, 1);
    if (!c.name.starts_with("chain")) continue;
    if (std::regex_match("klu", wanted_solver))
      klu_rows.push_back(add_klu_row("klu", c, make_problem(c.name + "_u", c.make(c.size), Values::unsymmetric)));
    if (std::regex_match("klu_planar", wanted_solver))
      klu_rows.push_back(add_klu_row("klu_planar", c, make_planar_problem(c)));
#endif
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
