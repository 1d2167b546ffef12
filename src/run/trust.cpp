#include "trust.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"

namespace bough::run {

namespace {

constexpr double unit_round_off = 0x1p-53;

double solver_figure(const records::Summary& summary, const char* name) {
  for (const auto& [key, value] : summary.solver)
    if (key == name) return value;
  return 0.0;
}

std::string number(double value) { return io::rounded_text(value, 2); }

/// Whether a value exceeds its bound or is not a number.
bool passes(double value, double bound) { return !(value <= bound); }

void doubt_energy(const records::Summary& s, const TrustLimits& limits, std::vector<records::Doubt>& doubts) {
  const records::Checks& c = s.checks;
  const auto bound = [&c](double share) { return std::max(share * c.energy_scale, c.energy_round_off); };
  if (passes(c.energy_gained, bound(limits.energy_gained)))
    doubts.push_back({"energy", "energy grows out of nothing: the integrator has added " + number(c.energy_gained) +
                                    " J, " + number(100.0 * c.energy_gained / c.energy_scale) +
                                    " % of the largest energy; " +
                                    (s.instability.empty() ? "take smaller steps" : s.instability)});
  if (passes(c.numerical_dissipation, bound(limits.energy_taken)))
    doubts.push_back(
        {"energy", "the integrator has taken " + number(c.numerical_dissipation) + " J, " +
                       number(100.0 * c.numerical_dissipation / c.energy_scale) +
                       " % of the largest energy: what moves fast relative to the step is damped away; take "
                       "smaller steps or a spectral radius nearer to 1"});
  const bool is_told = !doubts.empty() && doubts.back().about == "energy";
  if (!is_told && passes(c.energy_balance, bound(limits.energy_balance)))
    doubts.push_back({"energy", "the energy balance is open by " + number(c.energy_balance) + " J on the way, " +
                                    number(100.0 * c.energy_balance / c.energy_scale) +
                                    " % of the largest energy: the integrator adds and takes energy, or one is not "
                                    "counted; smaller steps tell which"});
}

/// Of what nothing ties to the ground: impulses of reactions are no better than the steps resolve these.
void doubt_momentum(const records::Checks& c, const TrustLimits& limits, std::vector<records::Doubt>& doubts) {
  const auto look_at = [&](const char* what, double error, double scale, const char* unit) {
    if (scale > 0.0 && passes(error, limits.momentum_lost * scale))
      doubts.push_back({"momentum", std::string(what) + " changes by " + number(error) + " " + unit + ", " +
                                        number(100.0 * error / scale) +
                                        " % of the largest, that no load and no support gives; take smaller steps"});
  };
  look_at("momentum", c.momentum_balance, c.momentum_scale, "kg m/s");
  look_at("angular momentum", c.angular_momentum_balance, c.angular_momentum_scale, "kg m^2/s");
}

/// The step size or tolerance that would bring the error below its bound, given that errors are of second order in the
/// step and of first order in the tolerance. The margin covers the error of the estimate itself in runs with large
/// errors; in all runs that were tried it was smaller.
std::string remedy(const records::Summary& s, double excess) {
  constexpr double margin = 1.5;
  excess *= margin;
  if (s.steps.size_changes > 0) return "a tolerance of step_control " + number(excess) + " times smaller";
  return "steps of " + number(s.step_size / std::sqrt(excess)) + " s";
}

/// What can be done about an error that is `excess` times its bound.
std::string remedies(const records::Summary& s, const TrustLimits& limits, const TrustContext& more, double excess) {
  constexpr double out_of_reach = 1e4;  // a hundredth of the step, or of the tolerance as far as it goes
  const std::string bound = number(100.0 * limits.sensor_error) + " %";
  const std::string sensitive =
      "the motion is sensitive, any disturbance grows by e every " + number(more.errors_grow_in) + " s";
  if (more.errors_grow_in > 0.0 && !(excess < out_of_reach))
    return sensitive + ", so that no steps make it right to its end: end it earlier, or take what holds on average";
  return (more.errors_grow_in > 0.0 ? sensitive + "; " : "") + remedy(s, excess) + " would make it less than " + bound;
}

void doubt_errors(const records::Summary& s, const TrustLimits& limits, const TrustContext& more,
                  std::vector<records::Doubt>& doubts) {
  const auto& all = s.sensor_errors;
  if (all.empty()) {
    const double sum = s.checks.local_error_sum;
    if (s.checks.local_error_known && passes(sum, limits.local_error_sum))
      doubts.push_back({more.about_estimate, "the local errors of the steps add up to " + number(100.0 * sum) +
                                                 " % of the size of the structure (or of 1 rad); " +
                                                 remedy(s, sum / limits.local_error_sum) + " would make it less than " +
                                                 number(100.0 * limits.local_error_sum) + " %"});
    return;
  }
  const auto is_wrong = [&](const records::SensorError& e) { return passes(e.relative(), limits.sensor_error); };
  const auto count = std::count_if(all.begin(), all.end(), is_wrong);
  if (count == 0) return;
  const auto& worst = *std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.relative() < b.relative() || (std::isnan(b.relative()) && !std::isnan(a.relative()));
  });
  const double error = worst.of_steps + worst.of_energy;
  doubts.push_back(
      {more.about_estimate,
       "'" + worst.column + "' is " +
           (worst.relative() > 1.0
                ? "wrong altogether by the end, off by more than the " + number(worst.range) + " over which it ranges"
                : "off by about " + number(error) + " by the end, " + number(100.0 * worst.relative()) + " % of the " +
                      number(worst.range) + " over which it ranges") +
           (count > 1 ? " (and " + std::to_string(count - 1) + " more columns by more than " +
                            number(100.0 * limits.sensor_error) + " %)"
                      : "") +
           (worst.of_energy > worst.of_steps ? ", since the energy that the integrator took slows the motion down"
                                             : ", as the local errors of the steps add up and grow") +
           "; " + remedies(s, limits, more, worst.relative() / limits.sensor_error)});
}

void doubt_linear_solutions(const records::Summary& s, const TrustLimits& limits, std::vector<records::Doubt>& doubts) {
  const double unknowns = solver_figure(s, "unknowns");
  const double bar = limits.lapack_ratio * std::max(1.0, unknowns) * unit_round_off;
  if (passes(s.checks.linear_backward_error_max, bar))
    doubts.push_back({"linear solutions", "a linear solution left a residual of " +
                                              number(s.checks.linear_backward_error_max) +
                                              " of what enters it, above 30 n u = " + number(bar) +
                                              ": the tangent is singular or nearly so somewhere on the way"});
  for (const records::LevelFigures& level : s.levels)
    if (passes(level.backward_error, bar))
      doubts.push_back({"linear solutions", "on level " + std::to_string(level.level) +
                                                " of the tree a linear solution leaves a residual of " +
                                                number(level.backward_error)});
}

/// Effect of round-off and tolerance on the results. At a located limit point the tangent is singular by nature, so
/// such a run is not doubted for it.
void doubt_condition(const records::Summary& s, bool is_dynamic, const TrustLimits& limits, double least_force,
                     std::vector<records::Doubt>& doubts) {
  const double error = solver_figure(s, "solution_error_estimate");
  if (s.limit_points.empty() && passes(error, limits.lost))
    doubts.push_back(
        {"condition", "one more correction would move the " + std::string(is_dynamic ? "end" : "equilibrium") + " by " +
                          number(error) + " of its displacement: it hangs on round-off and the tolerance (condition " +
                          number(solver_figure(s, "condition_estimate")) +
                          " of the tangent); look for parts that hardly anything holds, stiffness ratios or element "
                          "numbers that can be less"});
  const records::UnsureReaction* worst = nullptr;
  std::size_t unsure = 0;
  for (const records::UnsureReaction& r : s.unsure_reactions) {
    if (!passes(r.error, std::max(limits.lost * r.largest, limits.unbalanced * least_force))) continue;
    ++unsure;
    if (worst == nullptr || r.error > worst->error) worst = &r;
  }
  if (worst == nullptr) return;
  doubts.push_back(
      {"condition", "the reaction of '" + worst->joint + "'" +
                        (unsure > 1 ? " and those of " + std::to_string(unsure - 1) + " other joints hang" : " hangs") +
                        " on round-off and the tolerance: at time " + io::rounded_text(worst->time, 6) +
                        " one more correction would change " + number(worst->size) + " N (N m over the " +
                        "size of an element) by " + number(worst->error) +
                        ": constraints come close to depending on each other there; take larger steps or "
                        "leave these times out"});
}

std::string named(const std::string& joint) { return joint.empty() ? "a joint " : "joint '" + joint + "' "; }

void doubt_constraints(const records::Checks& c, const TrustLimits& limits, std::vector<records::Doubt>& doubts) {
  if (passes(c.relative_violation_position, limits.violation))
    doubts.push_back({"constraints", named(c.open_joint) + "stays open by " + number(c.relative_violation_position) +
                                         " of the size of the parts that meet in it (or rad)"});
  if (passes(c.relative_violation_step, limits.violation_step))
    doubts.push_back(
        {"constraints", named(c.fast_joint) + "is left by velocities that open it by " +
                            number(c.relative_violation_step) +
                            " of the size of the parts that meet in it (or rad) in a step; take smaller steps"});
}

/// "the last equilibrium is unstable, it is left in one direction: ..."; empty if it is stable in the motions of the
/// plan.
std::string unstable_text(const records::Stability& s) {
  if (s.unstable_directions == 0) return "";
  const std::string count = !s.not_conservative.empty()  ? "an odd number of directions"
                            : s.unstable_directions == 1 ? "one direction"
                                                         : std::to_string(s.unstable_directions) + " directions";
  return "the last equilibrium is unstable, it is left in " + count + ": " + s.mode;
}

/// Adds at most one doubt about stability, whatever the motions in which equilibria are unstable.
void doubt_stability(const records::Stability& s, std::vector<records::Doubt>& doubts) {
  std::string text = unstable_text(s);
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (!s.hidden.empty())
    add((text.empty() ? "the last equilibrium is unstable " : "it is unstable ") + s.hidden +
        (text.empty() ? "" : " as well") + ", which the plan leaves out of the motions: " + s.hidden_mode);
  if (s.first_lost) {
    const std::string lost = "the first unstable equilibrium was met between load factors " +
                             io::rounded_text(s.first_lost->before, 6) + " and " +
                             io::rounded_text(s.first_lost->after, 6);
    add(s.unstable_directions > 0
            ? lost
            : "equilibria on the way are unstable, the structure would have left them: " + lost + "; " + s.mode);
  }
  if (text.empty()) return;
  if (!s.largest_load.empty()) text += "; " + s.largest_load;
  doubts.push_back(
      {"stability", text + "; a small imperfection of the shape or a small load in that direction leads to the branch "
                           "that the structure takes; if unstable equilibria are what is looked for, say so with "
                           "\"unstable\": true in /analysis"});
}

std::string vector_text(const std::array<double, 3>& v) {
  return "(" + io::rounded_text(v[0], 4) + ", " + io::rounded_text(v[1], 4) + ", " + io::rounded_text(v[2], 4) + ")";
}

void doubt_start(const std::vector<records::ChangedVelocity>& changed, const TrustLimits& limits,
                 std::vector<records::Doubt>& doubts) {
  if (!changed.empty() && passes(changed.front().change, limits.velocity_changed))
    doubts.push_back({"initial velocities", describe(changed) +
                                                "; give velocities that joints and drives allow to all parts that "
                                                "move, or only to those that determine the motion"});
}

}  // namespace

std::string describe(const std::vector<records::ChangedVelocity>& changed) {
  constexpr std::size_t most_named = 3;
  std::string text = "joints and drives do not allow the given initial velocities:";
  for (std::size_t i = 0; i < std::min(changed.size(), most_named); ++i) {
    const records::ChangedVelocity& v = changed[i];
    const char* const unit = v.is_angular ? " rad/s" : " m/s";
    text += (i == 0 ? " '" : "; '") + v.of + "' was given " + vector_text(v.asked) + unit + " and starts with " +
            vector_text(v.got) + unit;
  }
  if (changed.size() > most_named) text += "; and " + std::to_string(changed.size() - most_named) + " others";
  return text;
}

std::vector<records::Doubt> doubts_of(const records::Summary& s, bool is_dynamic, const TrustLimits& limits,
                                      const TrustContext& more) {
  std::vector<records::Doubt> doubts;
  if (s.status == records::RunStatus::failed) doubts.push_back({"run", "it broke off: " + s.cause});
  if (s.status == records::RunStatus::interrupted) doubts.push_back({"run", "it was stopped before its end"});
  doubt_start(s.changed_velocities, limits, doubts);
  const records::Checks& c = s.checks;
  if (c.evaluated && is_dynamic) doubt_energy(s, limits, doubts);
  if (c.evaluated && is_dynamic) doubt_momentum(c, limits, doubts);
  if (c.evaluated && is_dynamic) doubt_errors(s, limits, more, doubts);
  if (c.evaluated) doubt_constraints(c, limits, doubts);
  doubt_linear_solutions(s, limits, doubts);
  doubt_condition(s, is_dynamic, limits, more.least_force, doubts);
  if (is_dynamic && passes(c.unbalanced_at_floor, limits.unbalanced))
    doubts.push_back(
        {"round-off",
         std::to_string(c.steps_at_floor) + " of " + std::to_string(s.steps.accepted) +
             " steps ended at the round-off floor of the residual and left up to " + number(c.unbalanced_at_floor) +
             " of the largest force unbalanced: accelerations, reactions and section forces are no more exact"});
  if (s.stability && !s.stability->is_declared) doubt_stability(*s.stability, doubts);
  // Step control rejects steps to keep its tolerance, and load steps are cut to find equilibria, which do not depend on
  // them: sizes that the program chose itself are those of the problem.
  const long rejected = is_dynamic ? s.steps.rejected - s.steps.rejected_for_error : 0;
  if (static_cast<double>(rejected) > limits.rejected * static_cast<double>(s.steps.accepted) &&
      s.status == records::RunStatus::ok)
    doubts.push_back({"steps", std::to_string(rejected) + " steps were rejected for " +
                                   std::to_string(s.steps.accepted) +
                                   " accepted ones: the step size is not that of the problem"});
  return doubts;
}

}  // namespace bough::run
