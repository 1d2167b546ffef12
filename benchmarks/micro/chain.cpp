/// A chain of flexible links (four beam elements each, revolute joints): refactorization with solution, and a whole step, by the tree of
/// sub-domains and by KLU on the same matrices.
#include <benchmark/benchmark.h>

#include <memory>

#include "../../tests/step/small_scenes.hpp"
#include "bough/schedule/threads.hpp"
#include "bough/step/advance.hpp"

namespace {

using namespace bough;

struct Rig {
  scene::Scene scene;
  plan::Plan plan;
  schedule::Threads threads;
  step::System system;
  step::State state;
  step::StepOptions options;
  long steps = 0;

  Rig(int links, int num_threads, scene::SolverKind kind)
      : scene(make(links, kind)),
        plan(plan::make_plan(scene)),
        threads(num_threads),
        system(plan, scene.solver, threads.walker()),
        state(step::make_initial_state(plan)),
        options(step::make_step_options(scene.analysis)) {
    if (!step::make_consistent(system, state, true, 1e-3).ok || !step::start_alpha(system, state, options, 1e-3).ok)
      std::abort();
    advance();
  }

  static scene::Scene make(int links, scene::SolverKind kind) {
    scene::Scene s = test::make_chain(links);
    for (scene::Beam& b : s.beams) b.elements = 4;
    s.solver.kind = kind;
    return s;
  }

  void advance() {
    ++steps;
    if (!step::advance(system, state, options, static_cast<double>(steps) * 1e-3).converged) std::abort();
  }
};

void factor_and_solve(benchmark::State& state, scene::SolverKind kind) {
  Rig rig(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), kind);
  const elements::Slopes slopes{2e3, 4e6, false};
  if (rig.system.evaluate(rig.state, slopes, true)) std::abort();
  std::vector<double> x(rig.system.num_unknowns());
  for (auto _ : state) {
    if (rig.system.factor(false, slopes)) std::abort();
    if (rig.system.solve(rig.system.residual().data(), x.data())) std::abort();
  }
  state.counters["backward_error"] = rig.system.counts().backward_error_max;
}

void one_step(benchmark::State& state, scene::SolverKind kind) {
  Rig rig(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), kind);
  for (auto _ : state) rig.advance();
}

}  // namespace

BENCHMARK_CAPTURE(factor_and_solve, tree, bough::scene::SolverKind::hierarchical)
    ->ArgNames({"links", "threads"})
    ->ArgsProduct({{32, 128, 512}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(factor_and_solve, klu, bough::scene::SolverKind::monolithic)
    ->ArgNames({"links", "threads"})
    ->ArgsProduct({{32, 128, 512}, {1}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(one_step, tree, bough::scene::SolverKind::hierarchical)
    ->ArgNames({"links", "threads"})
    ->ArgsProduct({{32, 128, 512}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(one_step, klu, bough::scene::SolverKind::monolithic)
    ->ArgNames({"links", "threads"})
    ->ArgsProduct({{32, 128, 512}, {1}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);
