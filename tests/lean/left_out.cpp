/// Runs small scenes, with and without one feature each, and has callgrind count the instructions of some steps of
/// each. Run by left_out.py under valgrind; without it the requests to callgrind do nothing.
#include <valgrind/callgrind.h>

#include <cstdio>

#include "bough/run/simulate.hpp"
#include "bough/scene/problems.hpp"
#include "links.hpp"

namespace {

using namespace bough;

struct Discard : records::Recorder {
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

constexpr int first_counted = 2, num_counted = 2;  ///< attempts of steps

/// Counts steps `first_counted` to `first_counted + num_counted` of a run and has callgrind write them under the
/// scene's name. Factors are made anew, so that each step has a tangent to be counted.
bool count_steps(scene::Scene scene) {
  scene.without.push_back("reuse");
  for (const scene::SceneProblem& problem : scene::problems_in(scene)) {
    std::printf("%s: %s %s\n", scene.name.c_str(), problem.section.c_str(), problem.rule.c_str());
    return false;
  }
  int tried = 0;
  run::SimulateOptions options;
  options.before_step = [&](step::System&, const step::State&, const run::BeforeStep&) {
    if (++tried == first_counted) {
      CALLGRIND_START_INSTRUMENTATION;
      CALLGRIND_ZERO_STATS;
    }
    if (tried < first_counted + num_counted) return true;
    CALLGRIND_STOP_INSTRUMENTATION;
    CALLGRIND_DUMP_STATS_AT(scene.name.c_str());
    return false;
  };
  Discard recorder;
  const records::Summary summary = run::simulate(scene, options, recorder);
  if (tried == first_counted + num_counted && summary.steps.accepted > 0) return true;
  std::printf("%s: only %d steps tried: %s\n", scene.name.c_str(), tried, summary.cause.c_str());
  return false;
}

}  // namespace

int main() {
  bool ok = true;
  for (const scene::Scene& scene : lean::make_scenes()) ok = count_steps(scene) && ok;
  return ok ? 0 : 1;
}
