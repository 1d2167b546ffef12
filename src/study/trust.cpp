#include "trust.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"

namespace bough::study {

namespace {

constexpr double unit_round_off = 0x1p-53;

double solver_figure(const results::Summary& summary, const char* name) {
  for (const auto& [key, value] : summary.solver)
    if (key == name) return value;
  return 0.0;
}

std::string number(double value) { return io::rounded_text(value, 2); }

/// Whether a value passes its bound, or is no number.
bool passes(double value, double bound) { return !(value <= bound); }

void doubt_energy(const results::Checks& c, const TrustLimits& limits, std::vector<results::Doubt>& doubts) {
  if (passes(c.energy_gained, limits.energy_gained * c.energy_scale))
    doubts.push_back({"energy", "energy grows out of nothing: the integrator has added " + number(c.energy_gained) +
                                    " J, " + number(100.0 * c.energy_gained / c.energy_scale) +
                                    " % of the largest energy; take smaller steps"});
  if (passes(c.numerical_dissipation, limits.energy_taken * c.energy_scale))
    doubts.push_back(
        {"energy", "the integrator has taken " + number(c.numerical_dissipation) + " J, " +
                       number(100.0 * c.numerical_dissipation / c.energy_scale) +
                       " % of the largest energy: what moves fast relative to the step is damped away; take "
                       "smaller steps or a spectral radius nearer to 1"});
}

void doubt_linear_solutions(const results::Summary& s, const TrustLimits& limits, std::vector<results::Doubt>& doubts) {
  const double unknowns = solver_figure(s, "unknowns");
  const double bar = limits.lapack_ratio * std::max(1.0, unknowns) * unit_round_off;
  if (passes(s.checks.linear_backward_error_max, bar))
    doubts.push_back({"linear solutions", "a linear solution left a residual of " +
                                              number(s.checks.linear_backward_error_max) +
                                              " of what enters it, above 30 n u = " + number(bar) +
                                              ": the tangent is singular or nearly so somewhere on the way"});
  for (const results::LevelFigures& level : s.levels)
    if (passes(level.backward_error, bar))
      doubts.push_back({"linear solutions", "on level " + std::to_string(level.level) +
                                                " of the tree a linear solution leaves a residual of " +
                                                number(level.backward_error)});
  const double condition = solver_figure(s, "condition_estimate");
  if (passes(condition * unit_round_off, limits.lost))
    doubts.push_back({"condition", "the condition number of the tangent is " + number(condition) + ": about " +
                                       number(std::log10(condition)) +
                                       " of 16 digits are lost, and results hang on the last bits; look for stiffness "
                                       "ratios or element numbers that can be less"});
}

void doubt_constraints(const results::Checks& c, const TrustLimits& limits, std::vector<results::Doubt>& doubts) {
  if (passes(c.relative_violation_position, limits.violation))
    doubts.push_back({"constraints", "joints stay open by " + number(c.relative_violation_position) +
                                         " of the size of the structure (or rad)"});
  if (passes(c.relative_violation_step, limits.violation_step))
    doubts.push_back({"constraints", "velocities leave the joints by " + number(c.relative_violation_step) +
                                         " of the size of the structure (or rad) in a step; take smaller steps"});
}

}  // namespace

std::vector<results::Doubt> doubts_of(const results::Summary& s, bool is_dynamic, const TrustLimits& limits) {
  std::vector<results::Doubt> doubts;
  if (s.status == results::RunStatus::failed) doubts.push_back({"run", "it broke off: " + s.cause});
  if (s.status == results::RunStatus::interrupted) doubts.push_back({"run", "it was stopped before its end"});
  const results::Checks& c = s.checks;
  if (c.evaluated && is_dynamic) doubt_energy(c, limits, doubts);
  if (c.evaluated) doubt_constraints(c, limits, doubts);
  doubt_linear_solutions(s, limits, doubts);
  if (is_dynamic && passes(c.unbalanced_at_floor, limits.unbalanced))
    doubts.push_back(
        {"round-off",
         std::to_string(c.steps_at_floor) + " of " + std::to_string(s.steps.accepted) +
             " steps ended at the round-off floor of the residual and left up to " + number(c.unbalanced_at_floor) +
             " of the largest force unbalanced: accelerations, reactions and section forces are no more exact"});
  if (static_cast<double>(s.steps.rejected) > limits.rejected * static_cast<double>(s.steps.accepted) &&
      s.status == results::RunStatus::ok)
    doubts.push_back({"steps", std::to_string(s.steps.rejected) + " steps were rejected for " +
                                   std::to_string(s.steps.accepted) +
                                   " accepted ones: the step size is not that of the problem"});
  return doubts;
}

}  // namespace bough::study
