#include "schema_parts.hpp"

namespace bough::io {

void add_analysis_rules(RuleTable& t, const Field& frame) {
  const std::vector<Field> newton = {
      may("newton", word_rule("", {"full", "single"}), "full: to convergence. single: one linear solution per step.",
          "\"full\""),
      may("tolerance", number_rule("", 0.0, true, 1e-2),
          "Of relative motions, and of residuals relative to their contributions [-].", "1e-8"),
      may("max_iterations", integer_rule("", 1, 1000), "Newton's limit per step.", "20"),
      may("max_cuts", integer_rule("", 0, 60), "Halvings of a step before the run fails.", "10")};
  std::vector<Field> statics = {
      may("load_steps", integer_rule("", 1, 1e6), "Steps of the load factor from 0 to 1.", "1")};
  Rule arc = object_of(
      "Follows the path of equilibria, past limit points of the load, in steps of equal length (spherical arc length) "
      "instead of load steps. Ends where the load factor passes end_load_factor, or at a limit point.",
      {may("step", number_rule("", 0.0, true, 1.0),
           "Length of the first step: root mean square over nodes of displacements over the size of the structure and "
           "rotations in rad [-]. Default: 0.05, shorter where the path bends sharply at its start."),
       may("largest_step", number_rule("", 0.0, true, 10.0), "[-]. Default: four times step, or 0.2."),
       may("max_steps", integer_rule("", 1, 1e6), "More steps are an error.", "1000"),
       may("end_load_factor", number_rule(""), "Where the run ends. Default: 1."),
       may("after_limit_points", integer_rule("", 0, 1000), "Limit points to pass before end_load_factor counts."),
       may("end_at_limit_point", integer_rule("", 1, 1000), "Number of the limit point at which the run ends.")});
  arc.at_most_one = {{"end_load_factor", "end_at_limit_point"}, {"after_limit_points", "end_at_limit_point"}};
  statics.push_back(may("arc_length", made(std::move(arc)), "Statics past limit points. Default: load steps."));
  statics.push_back(may("unstable", boolean_rule(""),
                        "Unstable equilibria are what is looked for: the run is not doubted because of them.",
                        "false"));
  std::vector<Field> dynamics = {
      need("end_time", positive(""), "[s]."),
      may("start", word_rule("", {"given", "equilibrium"}),
          "given: the poses of the scene. equilibrium: the static equilibrium under gravity, loads and efforts at time "
          "0, relative to `frame` if that moves, with drives and prescribed motions in their places; initial "
          "velocities "
          "are added to it.",
          "\"given\""),
      may("step_size", positive(""), "h [s].", "1e-3"),
      may("integrator", word_rule("", {"generalized_alpha", "bdf", "variational"}),
          "generalized_alpha: second order; damps what is faster than the step. bdf: third order (or second, "
          "see bdf_order), for smooth motions "
          "to high accuracy; undamped vibrations of some 3 to 12 steps a period grow at order 3. variational: keeps "
          "the momentum "
          "of "
          "what floats freely to round-off, and energy within a bound where the step "
          "resolves the fastest vibration; it damps nothing and is not suited to stiff "
          "scenes with vibrations that the step does not resolve: they ring or grow, and "
          "a run ends with an error where energy comes out of nothing.",
          "\"generalized_alpha\""),
      may("spectral_radius", number_rule("", 0.0, false, 1.0),
          "Of generalized_alpha at high frequency: 0 damps most, 1 not at all [-].", "0.8"),
      may("bdf_order", integer_rule("", 2, 3),
          "Of bdf: 2 damps every vibration, 3 is more accurate where none is undamped. Default: 3, but 2 where the "
          "start has an "
          "undamped vibration of 3 to 12 steps a period, which order 3 makes grow; the run says so."),
      may("newmark_beta", number_rule("", 0.25, false, 1.0),
          "Of variational, for vibrations: 0.25 is the most accurate; more slows down those faster "
          "than the step, which is no cure for stiff scenes [-].",
          "0.3")};
  dynamics.push_back(may(
      "step_control",
      made(object_of(
          "Step sizes chosen from the local error of each step (generalized_alpha).",
          {may("tolerance", number_rule("", 0.0, true, 0.1),
               "Of the sum of local errors over the run, relative to the size of the structure, 1 rad and the "
               "largest speeds so far [-].",
               "1e-4"),
           may("position_tolerance", number_rule("", 0.0), "Allowed beside [m].", "0"),
           may("rotation_tolerance", number_rule("", 0.0), "Allowed beside [rad].", "0"),
           may("velocity_tolerance", number_rule("", 0.0), "Allowed beside [m/s].", "0"),
           may("angular_velocity_tolerance", number_rule("", 0.0), "Allowed beside [rad/s].", "0"),
           may("largest_step", positive(""), "[s]. Default: a fiftieth of the end time.")})),
      "Step sizes chosen so that errors follow a tolerance; step_size is then that of the first step. Default: steps "
      "of equal size."));
  const std::vector<Field> inverse_dynamics = {
      need("end_time", positive(""), "[s]."),
      may("step_size", positive(""),
          "Distance h of the times 0, h, 2 h, ... at which the motion is evaluated, besides those of expected figures; "
          "no result depends on it [s].",
          "1e-3"),
      may("max_cuts", integer_rule("", 0, 60), "Halvings of the way between two times where parts move far.", "10"),
      frame};
  statics.push_back(frame);
  dynamics.push_back(frame);
  statics.insert(statics.end(), newton.begin(), newton.end());
  dynamics.insert(dynamics.end(), newton.begin(), newton.end());
  t.named["analysis"] = choice_rule(
      "What is computed.",
      {made(object_of_kind({"static"}, "Equilibrium at load factors up to 1, or under prescribed motions.", statics)),
       made(object_of_kind({"dynamic"}, "Motion in time.", dynamics)),
       made(object_of_kind({"inverse_dynamics"},
                           "Efforts of drives and reactions for a motion that drives and prescribed motions determine "
                           "completely, evaluated at given times: nothing is integrated. Refused where a part can "
                           "still move, bend or follow a state.",
                           inverse_dynamics))});
}

}  // namespace bough::io
