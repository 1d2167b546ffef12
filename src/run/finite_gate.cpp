#include "finite_gate.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "bough/io/number_text.hpp"

namespace bough::run {
namespace {

/// x - x is 0 if x is finite and NaN otherwise, and a NaN persists in the sum.
bool are_finite(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value - value;
  return sum == 0.0;
}

double largest_of(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) {
    if (std::isnan(value)) return value;
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

bool is_finite(const records::CurvePoint& p) {
  return are_finite(p.position) && are_finite(p.axes) && are_finite(p.force);
}
bool is_finite(const records::BodyPose& b) {
  return are_finite(b.position) && are_finite(b.axes) && are_finite(b.center) &&
         std::all_of(b.attachments.begin(), b.attachments.end(), [](const auto& x) { return are_finite(x); });
}

std::string text_of(double value) { return io::rounded_text(value, 6); }

}  // namespace

void FiniteGate::fail(double time, const std::string& what) {
  if (!cause_.empty()) return;
  const std::string when =
      std::isnan(time) ? "at the end of the run " : "at time (or load factor) " + text_of(time) + " ";
  cause_ = when + what +
           ": these are no results; look for lengths, speeds, masses, stiffnesses, angles or laws in the scene that "
           "are beyond "
           "1e100, or an axis shorter than 1e-100";
}

void FiniteGate::fail_at(std::string_view name, double value, double time) {
  fail(time, std::string(name) + " is " + text_of(value));
}

void FiniteGate::look_at(const records::HistoryHeader& header, const records::HistoryRow& row) {
  if (are_finite(row.values) && std::isfinite(row.time) && std::isfinite(row.step_size)) return;
  look_at("the time itself", row.time, row.time);
  look_at("the step size", row.step_size, row.time);
  for (std::size_t k = 0; k < row.values.size() && k < header.columns.size(); ++k)
    look_at("the sensor value " + header.columns[k], row.values[k], row.time);
}

void FiniteGate::look_at(const records::MotionFrame& frame) {
  for (const records::Curve& curve : frame.curves)
    for (const records::CurvePoint& p : curve.points)
      if (!is_finite(p))
        return fail(frame.time, "beam '" + curve.name + "' has a position or force that is not finite");
  for (const records::BodyPose& body : frame.bodies)
    if (!is_finite(body)) return fail(frame.time, "body '" + body.name + "' has a position that is not finite");
  for (const records::Link& link : frame.links)
    if (!are_finite(link.first) || !are_finite(link.second))
      return fail(frame.time, "joint or spring '" + link.name + "' has an end that is not finite");
}

void FiniteGate::look_at(const step::State& state, const plan::Plan& plan) {
  const std::vector<elements::NodeMotion>& nodes = step::nodes_in_space(plan, state);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const elements::NodeMotion& n = nodes[k];
    bool good = are_finite(n.R.m);
    for (int i = 0; i < 3; ++i) good = good && std::isfinite(n.x.hi[i]);
    for (int i = 0; i < 6; ++i) good = good && std::isfinite(n.v[i]);
    if (!good)
      return fail(state.time, "node '" + plan.nodes[k].name + "' has a position or velocity that is not finite");
  }
  if (!are_finite(state.multipliers)) fail(state.time, "a force of a joint is not finite");
}

std::string_view FiniteGate::not_finite_in(const results::Energies& e) {
  const double parts[] = {e.kinetic, e.strain, e.potential, e.total()};
  if (are_finite(parts) && are_finite(e.momentum.v)) return {};
  if (!std::isfinite(e.kinetic)) return "the kinetic energy is not finite";
  if (!std::isfinite(e.strain)) return "the strain energy is not finite";
  if (!std::isfinite(e.potential)) return "the potential energy is not finite";
  if (!std::isfinite(e.total())) return "the sum of energies is not finite";
  for (int i = 0; i < 6; ++i)
    if (!std::isfinite(e.momentum[i])) return "the momentum is not finite";
  return {};
}

std::string FiniteGate::worst_part(const records::MotionFrame& frame) {
  std::string name;
  double farthest = -1.0;
  const auto look = [&](const char* what, const std::string& part, double distance) {
    if (std::isnan(farthest) || distance <= farthest) return;
    farthest = distance;
    name = what + (" '" + part + "'");
  };
  for (const records::BodyPose& body : frame.bodies) look("body", body.name, largest_of(body.position));
  for (const records::Curve& curve : frame.curves)
    for (const records::CurvePoint& p : curve.points) look("beam", curve.name, largest_of(p.position));
  return name.empty() ? "" : " (farthest from the origin is " + name + ", at " + text_of(farthest) + " m)";
}

void FiniteGate::look_at(const records::Summary& s) {
  const double end = std::nan("");  // told as "at the end of the run"
  const records::Checks& c = s.checks;
  for (const auto& [name, value] : std::initializer_list<std::pair<const char*, double>>{
           {"the error of the energy balance", c.energy_balance},
           {"the scale of the energy", c.energy_scale},
           {"the energy taken by the integrator", c.numerical_dissipation},
           {"the energy added by the integrator", c.energy_gained},
           {"the error of the momentum balance", c.momentum_balance},
           {"the error of the balance of angular momentum", c.angular_momentum_balance},
           {"the violation of constraints", c.constraint_violation_position},
           {"the violation of constraints by velocities", c.constraint_violation_velocity},
           {"the local error of a step", c.local_error_max},
           {"the sum of local errors", c.local_error_sum},
           {"the local error of velocities", c.local_error_max_velocity},
           {"the error of a linear solution", c.linear_backward_error_max},
           {"the unbalanced force", c.unbalanced_at_floor}})
    look_at(name, value, end);
  for (std::size_t k = 0; k < s.final_values.size() && k < s.header.columns.size(); ++k)
    look_at("the last value of " + s.header.columns[k], s.final_values[k], end);
  for (const records::ExpectedResult& figure : s.expected)
    if (figure.reached && figure.has_value) look_at("the expected figure " + figure.name, figure.value, end);
}

}  // namespace bough::run
