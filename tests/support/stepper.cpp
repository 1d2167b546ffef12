#include "support/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bough/schedule/serial.hpp"
#include "support/scenes.hpp"

namespace bough::support {

namespace {

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (double v : values) most = std::max(most, std::abs(v));
  return most;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

Stepper::Stepper(const scene::Scene& scene)
    : plan_(plan::make_plan(scene)),
      system_(plan_, scene.solver, schedule::make_serial_walker()),
      state_(step::make_initial_state(plan_)),
      options_(step::make_step_options(scene.analysis)) {
  integrator_ = step::make_integrator(system_, scene.solver, options_);
}

Stepper::~Stepper() {
  expect_sound_solutions(system_.counts().backward_error_max, static_cast<double>(system_.places().size()));
}

step::StartReport Stepper::start(double step_size) {
  const step::StartReport consistent = step::make_consistent(system_, state_, state_.time == 0.0, step_size);
  if (!consistent.ok) throw std::runtime_error(consistent.cause);
  const step::StartReport started = integrator_->start(state_, options_, step_size);
  if (!started.ok) throw std::runtime_error(started.cause);
  return consistent;
}

void Stepper::change(double step_size) {
  const step::StartReport changed = integrator_->change_step_size(state_, options_, step_size);
  if (!changed.ok) throw std::runtime_error(changed.cause);
}

void Stepper::step(double end_time) {
  const step::StepReport report = integrator_->advance(state_, options_, end_time);
  if (!report.converged) throw std::runtime_error(report.cause);
  step::accept_turns(system_, state_);
}

Sample Stepper::sample() const {
  Sample s;
  s.time = state_.time;
  for (const elements::NodeMotion& n : nodes_in_space(system_.plan(), state_)) {
    s.positions.insert(s.positions.end(), n.R.m, n.R.m + 9);
    for (int i = 0; i < 3; ++i) s.positions.push_back(n.x.hi[i] + n.x.lo[i]);
    s.velocities.insert(s.velocities.end(), n.v.v, n.v.v + 6);
  }
  s.multipliers = state_.multipliers;
  return s;
}

void Difference::include(const Sample& a, const Sample& b, const Sample& scale) {
  positions = std::max(positions, largest_difference(a.positions, b.positions) / scale.positions.front());
  velocities = std::max(velocities, largest_difference(a.velocities, b.velocities) / scale.velocities.front());
  if (!a.multipliers.empty())
    multipliers = std::max(multipliers, largest_difference(a.multipliers, b.multipliers) / scale.multipliers.front());
}

Sample scale_of(const std::vector<Sample>& run) {
  Sample s{0.0, {0.0}, {0.0}, {0.0}};
  for (const Sample& a : run) {
    s.positions[0] = std::max(s.positions[0], largest(a.positions));
    s.velocities[0] = std::max(s.velocities[0], largest(a.velocities));
    s.multipliers[0] = std::max(s.multipliers[0], largest(a.multipliers));
  }
  return s;
}

std::vector<Sample> march(const scene::Scene& scene, double h, double sampling, int samples) {
  Stepper s(scene);
  s.start(h);
  std::vector<Sample> run{s.sample()};
  const auto every = static_cast<int>(std::lround(sampling / h));
  for (int k = 1; k <= samples * every; ++k) {
    s.step(k * h);
    if (k % every == 0) run.push_back(s.sample());
  }
  return run;
}

Difference compare(const std::vector<Sample>& run, const std::vector<Sample>& reference, std::size_t first,
                   std::size_t last, std::size_t ratio) {
  Difference d;
  const Sample scale = scale_of(reference);
  for (std::size_t k = first; k <= last; ++k) d.include(run[k], reference[k * ratio], scale);
  return d;
}

}  // namespace bough::support
