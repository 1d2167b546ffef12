#include "conservation.hpp"

#include <algorithm>
#include <cmath>

#include "bough/results/observe.hpp"

namespace bough::run {

Conservation::Conservation(const step::System& system, bool has_balance)
    : system_(system),
      plan_(system.plan()),
      has_balance_(has_balance),
      work_meter_(system.plan()),
      energy_meter_(system.plan()) {}

void Conservation::begin(const step::State& state) {
  if (!has_balance_) return;
  const results::Energies now = energy_meter_.eval(system_, state);
  work_meter_.begin(system_, state);
  balance_.begin(now);
}

void Conservation::jump(const results::Energies& before, const step::State& state) {
  if (!has_balance_) return;
  const results::Energies now = energy_meter_.eval(system_, state);
  work_meter_.begin(system_, state);
  balance_.jump(before, now);
}

void Conservation::add_step(const step::State& state, double step_size) {
  if (has_balance_) work_meter_.add(system_, state, step_size);
}

void Conservation::check(const step::State& state, double step_size, records::Checks& c, FiniteGate& gate,
                         ErrorWatch* error_watch) {
  const step::Violations gaps = system_.constraints().violations(state);
  gate.look_at("the violation of constraints", gaps.position, state.time);
  c.constraint_violation_position = std::max(c.constraint_violation_position, gaps.position);
  if (gaps.relative_position > c.relative_violation_position) {
    c.relative_violation_position = gaps.relative_position;
    open_joint_ = gaps.open_joint;
  }
  if (!plan_.is_dynamic) return;
  gate.look_at("the violation of constraints by velocities", gaps.velocity, state.time);
  c.constraint_violation_velocity = std::max(c.constraint_violation_velocity, gaps.velocity);
  if (gaps.relative_velocity * step_size > c.relative_violation_step) {
    c.relative_violation_step = gaps.relative_velocity * step_size;
    fast_joint_ = gaps.fast_joint;
  }
  if (!has_balance_) return;
  const results::Energies energies = energy_meter_.eval(system_, state);
  gate.look_at(energies, state.time, [&] { return results::eval_motion(system_, state); });
  gate.look_at("the work of loads and drives", work_meter_.supply().work, state.time);
  gate.look_at("the energy taken by dampers", work_meter_.supply().dissipation, state.time);
  balance_.compare(energies, work_meter_.supply(), work_meter_.mass(), plan_.length_scale);
  if (error_watch != nullptr)
    error_watch->see_energies(state.time, energies.kinetic, energies.strain + energies.potential,
                              balance_.last_energy_error(), balance_.energy_scale());
}

/// Uncertainty of the energy balance: round-off of the energies and of the work of weight over the size of the
/// structure, and the kinetic energy of the motion that Newton's tolerance leaves undetermined over the run.
double Conservation::energy_round_off(const step::StepOptions& options, double duration) const {
  constexpr double digits = 64.0 * 0x1p-53;  // allows for round-off of sums over elements and steps
  const double mass = work_meter_.mass(), size = plan_.length_scale;
  const double open = options.tolerance * size / duration;
  return digits * (mass * length_of(plan_.gravity) * size + balance_.largest_energies()) + 0.5 * mass * open * open;
}

void Conservation::sum_up(records::Checks& c, const step::StepOptions& options, double duration) const {
  if (open_joint_ >= 0) c.open_joint = plan_.joints[static_cast<std::size_t>(open_joint_)].name;
  if (fast_joint_ >= 0) c.fast_joint = plan_.joints[static_cast<std::size_t>(fast_joint_)].name;
  c.energy_balance = balance_.energy_error();
  c.energy_scale = balance_.energy_scale();
  if (plan_.is_dynamic && duration > 0.0) c.energy_round_off = energy_round_off(options, duration);
  c.numerical_dissipation = std::max(0.0, -balance_.last_energy_error());
  c.energy_gained = std::max(0.0, balance_.last_energy_error());
  c.momentum_balance = balance_.momentum_error();
  if (work_meter_.is_tied()) return;
  c.momentum_scale = balance_.momentum_scale();
  if (lanes::dot(plan_.gravity, plan_.gravity) > 0.0) return;
  c.angular_momentum_balance = balance_.angular_momentum_error();
  c.angular_momentum_scale = balance_.angular_momentum_scale();
}

}  // namespace bough::run
