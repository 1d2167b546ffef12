/// A million steps: energy, constraints.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/scene/parts.hpp"

namespace bough::stress {

namespace {

/// Two point masses on bars of 1 m from the horizontal: chaotic, so energy and constraints are what can be promised.
void double_pendulum(Bench& bench, scene::Integrator integrator) {
  const long steps = bench.shorten(1000000L, 10000L);
  scene::Scene s;
  s.name = "double pendulum";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.bodies = {scene::make_body("upper", 1.0, {{1e-2, 0.1, 0.1}}, {{0.5, 0.0, 0.0}}),
              scene::make_body("lower", 1.0, {{1e-2, 0.1, 0.1}}, {{1.5, 0.0, 0.0}})};
  const scene::JointKind hinge = scene::JointKind::revolute;
  s.joints = {scene::make_joint("root", hinge, "", Vec3::zero(), "upper", {{-0.5, 0, 0}}),
              scene::make_joint("middle", hinge, "upper", {{0.5, 0, 0}}, "lower", {{-0.5, 0, 0}})};
  scene::Sensor energy;
  energy.name = "energy";
  energy.kind = scene::SensorKind::total_energy;
  s.sensors = {energy};
  s.analysis.integrator = integrator;
  s.analysis.step_size = 2e-3;
  s.analysis.end_time = 2e-3 * static_cast<double>(steps);
  s.analysis.spectral_radius = 0.9;
  s.analysis.tolerance = 1e-11;
  s.output.stride = static_cast<int>(steps / 2000);
  const run::MemoryRun run = bench.run(s);
  const double scale = 2.0 * 9.81 * 2.0;  // what it can fall
  double gained[2] = {0.0, 0.0}, lost[2] = {0.0, 0.0};
  const double begin = run.rows.front().values[0];
  for (std::size_t r = 0; r < run.rows.size(); ++r) {
    const std::size_t half = r < run.rows.size() / 2 ? 0 : 1;
    const double change = (run.rows[r].values[0] - begin) / scale;
    gained[half] = std::max(gained[half], change);
    lost[half] = std::max(lost[half], -change);
  }
  bench.figure("constraint violation [m]", run.summary.checks.constraint_violation_position, 1e-11);
  bench.tell("steps rejected", static_cast<double>(run.summary.steps.rejected));
  if (integrator == scene::Integrator::variational) {
    bench.error("energy, first half", std::max(gained[0], lost[0]), 1e-2);
    bench.error("energy, second half", std::max(gained[1], lost[1]), 1e-2);
  } else {
    bench.error("energy gained", std::max(gained[0], gained[1]), 1e-2);
    bench.tell("energy lost", std::max(lost[0], lost[1]));
  }
}

void generalized_alpha(Bench& bench) { double_pendulum(bench, scene::Integrator::generalized_alpha); }
void variational(Bench& bench) { double_pendulum(bench, scene::Integrator::variational); }

}  // namespace

void add_long(std::vector<Definition>& table) {
  table.push_back({"million_steps_alpha", "long runs",
                   "a double pendulum for 1e6 steps of generalized-alpha: no energy gained above 1e-2 of what it can "
                   "fall, constraints to 1e-11 m",
                   generalized_alpha});
  table.push_back(
      {"million_steps_variational", "long runs",
       "the same with the variational integrator: energy within 1e-2 in both halves, constraints to 1e-11 m",
       variational});
}

}  // namespace bough::stress
