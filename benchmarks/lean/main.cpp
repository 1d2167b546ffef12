/// bench_lean [--case=REGEX] [--checks=yes] [options of Google Benchmark]
/// Rows taken/CASE and barred/CASE: the same scene with a decision of its plan taken and excluded, interleaved; CASE
/// begins with the name of the decision. One iteration is one accepted step; for symmetric_... it is one
/// factorization.
#include <benchmark/benchmark.h>

#include <chrono>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "../support/arguments.hpp"
#include "../support/context.hpp"
#include "../support/scenes.hpp"
#include "bough/elements/catalogue.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/parts.hpp"

namespace {

using namespace bough;
using namespace bough::bench;

struct LeanCase {
  std::string decision, name;
  int size, steps;
  scene::Scene (*make)(int);
};

/// The lattice moving in its own plane, with gravity along it.
scene::Scene make_hanging_lattice(int n) {
  scene::Scene s = make_lattice_2d(n, Support::clamp);
  s.gravity = {{0.0, -9.81, 0.0}};
  return s;
}
scene::Scene make_level_lattice(int n) { return make_lattice_2d(n, Support::clamp); }
/// A beam of a given number of elements, held at one end, falls from the horizontal.
scene::Scene make_cantilever(int elements) {
  scene::Scene s = make_chain(1);
  s.joints[0].kind = scene::JointKind::fixed;
  s.beams[0].elements = elements;
  return s;
}
/// The same beam, so light that it hardly moves: to round-off a linear structure.
scene::Scene make_light_cantilever(int elements) {
  scene::Scene s = make_cantilever(elements);
  s.gravity = 1e-3 * s.gravity;
  return s;
}
/// Two such beams at an angle, which gravity bends and twists out of their plane: also linear, but in space.
scene::Scene make_light_bracket(int elements) {
  scene::Scene s = make_chain(2);
  for (scene::Joint& joint : s.joints) joint.kind = scene::JointKind::fixed;
  for (scene::Beam& beam : s.beams) beam.elements = elements / 2;
  s.nodes.back().placement.pose.x = {{1.0, 1.0, 0.0}};
  s.gravity = 1e-3 * s.gravity;
  return s;
}
/// Links connected by fixed joints instead of hinges, the first on its hinge: one long beam made of parts.
scene::Scene make_tied_chain(int links) {
  scene::Scene s = make_chain(links);
  for (std::size_t l = 1; l < s.joints.size(); ++l) s.joints[l].kind = scene::JointKind::fixed;
  return s;
}
/// The lattice assembled from bars: each has nodes of its own, which fixed joints connect to the crossings.
scene::Scene make_tied_lattice(int n) {
  scene::Scene s = make_level_lattice(n);
  std::map<std::string, scene::Vec3> crossings;
  for (const scene::Node& node : s.nodes) crossings[node.name] = node.placement.pose.x;
  for (scene::Beam& beam : s.beams)
    for (std::string* end : {&beam.start, &beam.end}) {
      scene::Node node;
      node.name = (end == &beam.start ? "start of " : "end of ") + beam.name;
      node.placement.pose.x = crossings.at(*end);
      s.nodes.push_back(node);
      scene::Joint tie;
      tie.name = "tie at " + node.name;
      tie.kind = scene::JointKind::fixed;
      tie.first.to = *end;
      tie.second.to = *end = node.name;
      s.joints.push_back(tie);
    }
  return s;
}
scene::Scene make_sprung_lattice(int n) { return make_lattice_2d(n, Support::spring); }

/// A point mass, and a spring from it to the one before.
scene::Body point_mass(const std::string& name, const scene::Vec3& at) {
  scene::Body b;
  b.name = name;
  b.mass = 0.01;
  b.is_point_mass = true;
  b.placement.pose.x = at;
  return b;
}
scene::Coupling spring_between(const std::string& first, const std::string& second, double length) {
  return scene::make_coupling(elements::kind_of<elements::Spring>, first + "-" + second, first, second,
                              {300.0, length, 0.05});
}
/// A net of n x n masses with springs along its edges and one diagonal, hanging by two springs from the ground.
scene::Scene make_net(int n) {
  scene::Scene s;
  s.gravity = {{0.0, 0.0, -9.81}};
  const auto name = [](int i, int j) { return "m" + std::to_string(i) + "_" + std::to_string(j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      s.bodies.push_back(point_mass(name(i, j), {{0.1 * i, 0.1 * j, 0.01 * ((i * j) % 3)}}));
      if (i > 0) s.couplings.push_back(spring_between(name(i - 1, j), name(i, j), 0.098));
      if (j > 0) s.couplings.push_back(spring_between(name(i, j - 1), name(i, j), 0.098));
      if (i > 0 && j > 0) s.couplings.push_back(spring_between(name(i - 1, j - 1), name(i, j), 0.139));
    }
  for (const int corner : {0, n - 1}) {
    s.couplings.push_back(spring_between("", name(corner, 0), 0.09));
    s.couplings.back().first.offset.x = {{0.1 * corner, 0.0, 0.1}};
  }
  return s;
}
/// Masses on one line between springs, the first one struck.
scene::Scene make_row(int masses) {
  scene::Scene s;
  for (int k = 0; k < masses; ++k) {
    const std::string name = "m" + std::to_string(k);
    s.bodies.push_back(point_mass(name, {{0.1 * (k + 1), 0.0, 0.0}}));
    s.couplings.push_back(spring_between(k == 0 ? "" : "m" + std::to_string(k - 1), name, 0.1));
  }
  scene::InitialVelocity struck;
  struck.of = "m0";
  struck.velocity = {{1.0, 0.0, 0.0}};
  s.initial_velocities.push_back(struck);
  return s;
}

std::vector<LeanCase> make_cases() {
  return {{"planar", "chain_128", 128, 100, make_chain},
          {"planar", "rigid_chain_128", 128, 100, make_rigid_chain},
          {"planar", "lattice_20", 20, 20, make_hanging_lattice},
          {"planar", "lattice_50", 50, 10, make_hanging_lattice},
          {"translation", "net_20", 20, 100, make_net},
          {"line", "row_64", 64, 400, make_row},
          {"welded", "tied_chain_32", 32, 100, make_tied_chain},
          {"welded", "tied_chain_128", 128, 50, make_tied_chain},
          {"welded", "tied_lattice_10", 10, 20, make_tied_lattice},
          {"welded", "tied_lattice_20", 20, 10, make_tied_lattice},
          {"held", "cantilever_8", 8, 400, make_cantilever},
          {"held", "cantilever_64", 64, 200, make_cantilever},
          {"held", "lattice_20", 20, 20, make_level_lattice},
          {"reuse", "chain_128", 128, 50, make_chain},
          {"reuse", "cantilever_64", 64, 200, make_cantilever},
          {"reuse", "cantilever_512", 512, 50, make_cantilever},
          {"reuse", "light_cantilever_64", 64, 200, make_light_cantilever},
          {"reuse", "light_cantilever_512", 512, 50, make_light_cantilever},
          {"reuse", "light_bracket_64", 64, 200, make_light_bracket},
          {"reuse", "light_bracket_512", 512, 50, make_light_bracket},
          {"reuse", "lattice_20", 20, 20, make_level_lattice},
          {"reuse", "lattice_50", 50, 10, make_level_lattice},
          {"reuse", "lattice_100", 100, 5, make_level_lattice},
          {"symmetric", "lattice_50", 50, 5, make_sprung_lattice},
          {"symmetric", "lattice_100", 100, 3, make_sprung_lattice},
          {"symmetric", "lattice_3d_12", 12, 3, make_lattice_3d},
          {"small", "chain_4", 4, 200, make_chain},
          {"lanes", "chain_128", 128, 50, make_chain}};
}

class NoRecorder final : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

bool is_of_factors(const LeanCase& c) { return c.decision == "symmetric"; }

scene::Scene make_scene(const LeanCase& c, bool barred, bool checks) {
  scene::Scene s = c.make(c.size);
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1e-3 * (c.steps + 1);
  s.output.stride = c.steps + 1;
  s.output.checks = checks;
  if (barred) s.without = {c.decision};
  if (is_of_factors(c)) s.without.push_back("reuse");  // a factorization in every iteration
  return s;
}

void run_case(benchmark::State& state, const LeanCase& c, bool barred, bool checks, int threads) {
  const scene::Scene s = make_scene(c, barred, checks);
  run::SimulateOptions options;
  options.threads = threads;
  NoRecorder recorder;
  records::Summary end;
  double first_factor = 0.0;
  long first_factorizations = 0;
  options.before_step = [&](step::System& system, const step::State&, const run::BeforeStep& attempt) {
    if (attempt.number == 2) {
      first_factor = system.counts().factor;
      first_factorizations = system.counts().factorizations;
    }
    return true;
  };
  const bool of_factors = is_of_factors(c);
  while (state.KeepRunningBatch(c.steps)) {  // a run is this many iterations, so the least time covers all its steps
    double seconds = 0.0;
    std::chrono::steady_clock::time_point start;
    end = run::simulate(s, options, recorder, [&](const records::Progress& p) {
      const auto now = std::chrono::steady_clock::now();
      if (p.step == 1) start = now;
      seconds = std::chrono::duration<double>(now - start).count();
      return true;
    });
    if (end.status != records::RunStatus::ok || end.steps.rejected > 0) {
      state.SkipWithError(("the run failed or rejected steps: " + end.cause).c_str());
      return;
    }
    state.SetIterationTime(of_factors ? c.steps * (end.times.factor - first_factor) /
                                            static_cast<double>(end.steps.factorizations - first_factorizations)
                                      : seconds);
  }
  state.counters["iterations_a_step"] =
      static_cast<double>(end.steps.newton_iterations) / static_cast<double>(end.steps.accepted);
  state.counters["factorizations_a_step"] =
      static_cast<double>(end.steps.factorizations) / static_cast<double>(end.steps.accepted);
  state.counters["prepare_ms"] = 1e3 * end.times.prepare;  // plan, tree and symbolic factorization
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  const std::regex wanted(take_option(arguments, "case", ".*"));
  const bool checks =
      take_option(arguments, "checks", "no") == "yes";  // the checks of results, whose cost is then in both rows
  std::vector<std::string> defaults{"--benchmark_repetitions=3", "--benchmark_enable_random_interleaving=true",
                                    "--benchmark_min_time=0.05"};
  for (std::string& d : defaults) arguments.insert(arguments.begin() + 1, d.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  add_context();
  const std::vector<LeanCase> cases = make_cases();
  for (const LeanCase& c : cases)
    if (std::regex_match(c.decision + "_" + c.name, wanted))
      for (bool barred : {false, true}) {
        const int threads = c.decision == "small" ? 2 : 1;
        benchmark::RegisterBenchmark(
            (std::string(barred ? "barred/" : "taken/") + c.decision + "_" + c.name +
             "/threads:" + std::to_string(threads))
                .c_str(),
            [&c, barred, checks, threads](benchmark::State& state) { run_case(state, c, barred, checks, threads); })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
      }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
