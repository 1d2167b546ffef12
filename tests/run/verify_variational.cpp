// The variational integrator: order in positions, velocities and multipliers against another integrator, momentum to
// round-off, energy within a bound, the gallery's figures.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "bough/results/balance.hpp"
#include "order_scenes.hpp"
#include "support/scenes.hpp"
#include "support/stepper.hpp"

namespace bough::run {
namespace {

using support::Difference;
using support::Sample;
using support::Stepper;

/// A soft, damped beam on a driven hinge with a body at its tip, a follower force on it.
constexpr const char* damped_beam = R"json({
  "gravity": [0, 0, -9.81],
  "sections": [{"name": "soft", "stiffness": {"EA": 400, "GA2": 200, "GA3": 200, "GJ": 5, "EI2": 10, "EI3": 8},
                "mass": {"mass_per_length": 1, "rotary": [0.02, 0.01, 0.01]}, "damping": {"time": 0.002}}],
  "nodes": [{"name": "root"}],
  "bodies": [{"name": "tip", "mass": 0.5, "inertia": [0.02, 0.03, 0.04], "position": [1, 0, 0], "center_of_mass": [0.1, 0.1, 0.2]}],
  "beams": [{"name": "beam", "section": "soft", "start": "root", "end": "tip", "elements": 2, "order": 2}],
  "joints": [{"name": "motor", "kind": "revolute", "first": "ground", "second": "root", "position": [0, 0, 0], "axis": [0, 1, 3],
              "drives": [{"law": {"expression": "2*t^2"}}]}],
  "loads": [{"at": "tip", "axes": "body", "force": [0, 3, 0], "law": {"expression": "sin(20*t)"}}],
  "analysis": {"kind": "dynamic", "end_time": 1, "tolerance": 1e-12}})json";

/// Largest errors over 20 h of steps of h and h / 2, against generalized-alpha in much finer ones.
void check_orders(const char* name, scene::Scene scene, double h, double fineness) {
  scene.analysis.integrator = scene::Integrator::generalized_alpha;
  const std::vector<Sample> reference = support::march(scene, h / fineness, h, 20);
  scene.analysis.integrator = scene::Integrator::variational;
  const Difference coarse = support::compare(support::march(scene, h, h, 20), reference, 1, 20, 1),
                   fine = support::compare(support::march(scene, h / 2.0, h, 20), reference, 1, 20, 1);
  const double p = support::order_of(coarse.positions, fine.positions),
               v = support::order_of(coarse.velocities, fine.velocities),
               m = support::order_of(coarse.multipliers, fine.multipliers);
  std::printf("| %s | %.2f (%.1e) | %.2f (%.1e) | %.2f (%.1e) |\n", name, p, fine.positions, v, fine.velocities, m,
              fine.multipliers);
  for (const double order : {p, v, m}) {
    EXPECT_GT(order, 1.8) << name;
    EXPECT_LT(order, 2.5) << name;
  }
}

TEST(Variational, is_of_second_order_with_ball_hinge_and_damper) {
  check_orders("ball and hinge", run::spatial_pendulum(), 0.008, 32.0);
}
TEST(Variational, is_of_second_order_with_a_driven_joint) {
  check_orders("driven hinge", run::driven_pendulum(), 0.008, 32.0);
}
TEST(Variational, is_of_second_order_with_a_driven_beam_and_a_follower_force) {
  check_orders("driven beam", support::scene_of(damped_beam), 0.0008, 16.0);
}

struct Drift {
  double momentum = 0.0;           ///< largest change of linear and angular momentum over their size
  double early = 0.0, late = 0.0;  ///< largest change of energy over the energy, in both halves of the run
};

Drift drift_of(const char* text, double h, int steps) {
  Stepper s(support::scene_of(text, {"/analysis/integrator=variational"}));
  s.start(h);
  results::EnergyMeter meter(s.system().plan());
  const auto measure = [&] { return meter.eval(s.system(), s.state()); };
  const results::Energies start = measure();
  Drift d;
  double linear = 0.0, angular = 0.0;
  for (int i = 0; i < 3; ++i) {
    linear = std::max(linear, std::abs(start.momentum[i]));
    angular = std::max(angular, std::abs(start.momentum[3 + i]));
  }
  for (int k = 1; k <= steps; ++k) {
    s.step(k * h);
    if (k % 10 != 0) continue;
    const results::Energies now = measure();
    for (int i = 0; i < 6; ++i)
      d.momentum = std::max(d.momentum, std::abs(now.momentum[i] - start.momentum[i]) / (i < 3 ? linear : angular));
    double& part = k <= steps / 2 ? d.early : d.late;
    part = std::max(part, std::abs(now.total() - start.total()) / start.kinetic);
  }
  std::printf("| %d steps of %g | momentum %.1e | energy %.2e, then %.2e |\n", steps, h, d.momentum, d.early, d.late);
  return d;
}

/// Velocities such that the centre moves slowly: positions stay of order one, and so does the round-off of angular
/// momentum.
constexpr const char* tumbling_body = R"json({
  "bodies": [{"name": "body", "mass": 2, "center_of_mass": [0.3, -0.2, 0.1], "inertia": [1, 2, 3]}],
  "initial_velocities": [{"of": "body", "axes": "body", "velocity": [-0.7, -0.45, 1.1], "angular_velocity": [1, 3, 2]}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}})json";

/// A free soft beam thrown and spun about no principal axis, with a lump at one end.
constexpr const char* thrown_beam = R"json({
  "sections": [{"name": "soft", "stiffness": {"EA": 1e4, "GA2": 1e4, "GA3": 1e4, "GJ": 50, "EI2": 50, "EI3": 50},
                "mass": {"mass_per_length": 1, "rotary": [0.2, 0.1, 0.1]}}],
  "nodes": [{"name": "end", "position": [2, 0, 0]}],
  "bodies": [{"name": "lump", "mass": 0.5, "inertia": [0.02, 0.03, 0.04], "center_of_mass": [0, 0.1, 0.2]}],
  "beams": [{"name": "beam", "section": "soft", "start": "lump", "end": "end", "elements": 1, "order": 2}],
  "initial_velocities": [{"of": "lump", "velocity": [0, -1, 2], "angular_velocity": [2, 3, 1]}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.005}})json";

constexpr const char* heavy_top = R"json({
  "gravity": [0, 0, -9.81],
  "bodies": [{"name": "top", "mass": 15, "center_of_mass": [0, 1, 0], "inertia": [0.234375, 0.46875, 0.234375]}],
  "joints": [{"name": "pivot", "kind": "spherical", "first": "ground", "second": "top", "position": [0, 0, 0]}],
  "initial_velocities": [{"of": "top", "angular_velocity": [0, 15, -0.46]}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.002}})json";

constexpr const char* double_pendulum = R"json({
  "gravity": [0, -9.81, 0],
  "bodies": [{"name": "a", "mass": 1, "inertia": [0.1, 0.1, 0.1], "center_of_mass": [0.5, 0, 0]},
             {"name": "b", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [1, 0, 0], "center_of_mass": [0.5, 0, 0]}],
  "joints": [{"name": "p", "kind": "revolute", "first": "ground", "second": "a", "position": [0, 0, 0], "axis": [0, 0, 1]},
             {"name": "q", "kind": "revolute", "first": "a", "second": "b", "position": [1, 0, 0], "axis": [0, 0, 1]}],
  "initial_velocities": [{"of": "a", "angular_velocity": [0, 0, 3]}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.005}})json";

TEST(Variational, keeps_momentum_of_a_tumbling_body_to_round_off_and_energy_within_a_bound) {
  const Drift d = drift_of(tumbling_body, 0.01, 100000), half = drift_of(tumbling_body, 0.005, 20000);
  EXPECT_LT(d.momentum, 1e-11);  // roundings of 1e5 steps, were they all of one sign
  EXPECT_LT(d.late, 1.1 * d.early);
  EXPECT_NEAR(d.early / half.early, 4.0, 0.4);
}

TEST(Variational, keeps_momentum_of_a_thrown_beam_to_round_off_and_energy_within_a_bound) {
  const Drift d = drift_of(thrown_beam, 0.005, 100000);
  EXPECT_LT(d.momentum, 1e-10);
  EXPECT_LT(d.late, 1.5 * d.early);
  EXPECT_LT(d.early, 0.02);
}

TEST(Variational, keeps_energy_of_a_heavy_top_and_a_double_pendulum_within_a_bound) {
  const Drift top = drift_of(heavy_top, 0.002, 20000), pendulum = drift_of(double_pendulum, 0.002, 20000);
  EXPECT_LT(top.late, 1.1 * top.early);
  EXPECT_LT(top.early, 1e-3);
  EXPECT_LT(pendulum.late, 1.5 * pendulum.early);
  EXPECT_LT(pendulum.early, 0.01);
}

/// The scenes' own figures, from closed forms and other programs, hold under this integrator too.
class Gallery : public testing::TestWithParam<const char*> {};
TEST_P(Gallery, figures_hold_under_the_variational_integrator) {
  const support::Outcome run = support::run(support::gallery(GetParam(), {"/analysis/integrator=variational"}));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_FALSE(run.summary.expected.empty());
  for (const records::ExpectedResult& e : run.summary.expected)
    EXPECT_TRUE(e.holds) << e.name << ": " << e.value << " for " << e.reference;
}
INSTANTIATE_TEST_SUITE_P(Variational, Gallery,
                         testing::Values("pendulum", "double_pendulum", "slider_crank", "four_bar_planar", "bricard",
                                         "free_body", "tumbling_body", "flying_spaghetti", "right_angle_cantilever"));

bool has_note(const support::Outcome& run, const char* words) {
  for (const std::string& note : run.summary.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

/// Bars far too stiff for the step: the run tells when they vibrate, and ends where they take energy out of nothing.
TEST(Variational, ends_a_run_whose_unresolved_vibrations_grow_and_names_the_cause) {
  const support::Outcome run = support::run(
      support::scene_of(std::string(thrown_beam), {"/analysis/integrator=variational", "/analysis/end_time=2",
                                                   "/analysis/step_size=0.02", "/sections/soft/stiffness/EA=1e9"}));
  EXPECT_FALSE(run.ok());
  EXPECT_TRUE(has_note(run, "vibrations faster than the step"));
  EXPECT_NE(run.summary.cause.find("does not damp vibrations"), std::string::npos) << run.summary.cause;
}
TEST(Variational, says_nothing_of_vibrations_that_the_step_resolves) {
  const support::Outcome run = support::run(
      support::scene_of(std::string(thrown_beam), {"/analysis/integrator=variational", "/analysis/end_time=1"}));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_FALSE(has_note(run, "vibrations faster than the step"));
}
TEST(Variational, ends_the_spin_up_of_a_stiff_beam_where_its_energy_grows) {
  const support::Outcome run = support::run(support::gallery("spin_up", {"/analysis/integrator=variational"}));
  EXPECT_FALSE(run.ok());
  EXPECT_NE(run.summary.cause.find("the energy grew"), std::string::npos) << run.summary.cause;
  EXPECT_NE(run.summary.cause.find("use generalized_alpha or a smaller step"), std::string::npos) << run.summary.cause;
}

}  // namespace
}  // namespace bough::run
