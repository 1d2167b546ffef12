/// Every reason to doubt a run: by its bound alone, and provoked in a run.
#include "trust.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bough/run/memory_run.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/parts.hpp"
#include "support/given.hpp"
#include "support/untrapped.hpp"

namespace bough::run {
namespace {

using scene::Vec3;

/// A run nothing speaks against.
records::Summary good() {
  records::Summary s;
  s.status = records::RunStatus::ok;
  s.steps.accepted = 100;
  s.checks.energy_scale = 10.0;
  s.checks.linear_backward_error_max = 1e-16;
  s.solver = {{"unknowns", 12.0}, {"condition_estimate", 1e4}, {"solution_error_estimate", 1e-9}};
  s.unsure_reactions = {{"hinge", 0.5, 3.0, 1e-9, 10.0}};
  s.levels = {{0, 1, 0, 0.0, 1e-16}};
  return s;
}

bool is_doubted(const std::vector<records::Doubt>& doubts, const std::string& about) {
  for (const records::Doubt& d : doubts)
    if (d.about == about) return true;
  return false;
}
bool is_doubted(const records::Summary& s, const std::string& about) { return is_doubted(doubts_of(s, true), about); }

TEST(Trust, nothing_speaks_against_a_good_run) {
  EXPECT_TRUE(doubts_of(good(), true).empty());
  records::Summary without = good();
  without.levels.clear();
  without.solver.clear();
  EXPECT_TRUE(doubts_of(without, true).empty());
}

TEST(Trust, unstable_equilibria_are_doubted_unless_they_are_declared) {
  records::Summary s = good();
  records::Stability& stability = s.stability.emplace();
  EXPECT_TRUE(doubts_of(s, false).empty());
  stability.unstable_directions = 1;
  EXPECT_TRUE(is_doubted(doubts_of(s, false), "stability"));
  stability.unstable_directions = 0;
  stability.first_lost = {0.1, 0.2};
  EXPECT_TRUE(is_doubted(doubts_of(s, false), "stability")) << "regained later";
  stability.first_lost.reset();
  stability.hidden = "out of its plane";
  EXPECT_TRUE(is_doubted(doubts_of(s, false), "stability"));
  EXPECT_NE(doubts_of(s, false)[0].text.find("the last equilibrium is unstable out of its plane"), std::string::npos);
  stability.unstable_directions = 3;
  stability.first_lost = {0.1, 0.2};
  stability.largest_load = "the largest load is 'push'";
  ASSERT_EQ(doubts_of(s, false).size(), 1u);
  for (const char* part : {"in 3 directions", "out of its plane as well", "between load factors 0.1 and 0.2", "'push'"})
    EXPECT_NE(doubts_of(s, false)[0].text.find(part), std::string::npos) << part;
  stability.is_declared = true;
  EXPECT_TRUE(doubts_of(s, false).empty());
}

/// Just below and just above each bound.
TEST(Trust, each_bound_is_where_it_is_said_to_be) {
  const test::Untrapped untrapped;  // NaN is compared
  const TrustLimits limits;
  struct Case {
    const char* about;
    double bound;
    double& (*of)(records::Summary&);
  };
  const Case cases[] = {
      {"energy", limits.energy_gained * 10.0, [](auto& s) -> double& { return s.checks.energy_gained; }},
      {"energy", limits.energy_taken * 10.0, [](auto& s) -> double& { return s.checks.numerical_dissipation; }},
      {"linear solutions", limits.lapack_ratio * 12.0 * 0x1p-53,
       [](auto& s) -> double& { return s.checks.linear_backward_error_max; }},
      {"linear solutions", limits.lapack_ratio * 12.0 * 0x1p-53,
       [](auto& s) -> double& { return s.levels[0].backward_error; }},
      {"condition", limits.lost, [](auto& s) -> double& { return s.solver[2].second; }},
      {"condition", limits.lost * 10.0, [](auto& s) -> double& { return s.unsure_reactions[0].error; }},
      {"round-off", limits.unbalanced, [](auto& s) -> double& { return s.checks.unbalanced_at_floor; }},
      {"constraints", limits.violation, [](auto& s) -> double& { return s.checks.relative_violation_position; }},
      {"constraints", limits.violation_step, [](auto& s) -> double& { return s.checks.relative_violation_step; }}};
  for (const Case& c : cases) {
    records::Summary s = good();
    c.of(s) = 0.99 * c.bound;
    EXPECT_FALSE(is_doubted(s, c.about)) << c.about;
    c.of(s) = 1.01 * c.bound;
    EXPECT_TRUE(is_doubted(s, c.about)) << c.about;
    EXPECT_EQ(doubts_of(s, true).size(), 1u) << c.about;
    c.of(s) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(is_doubted(s, c.about)) << c.about << ", not a number";
  }
}

TEST(Trust, the_tangent_may_be_singular_where_a_limit_point_was_located) {
  records::Summary s = good();
  s.solver[2].second = 1.0;
  EXPECT_TRUE(is_doubted(doubts_of(s, false), "condition"));
  s.limit_points = {{0.5, true}};
  EXPECT_FALSE(is_doubted(doubts_of(s, false), "condition"));
}

TEST(Trust, balances_that_were_not_made_are_not_judged) {
  records::Summary s = good();
  s.checks.energy_gained = 5.0;
  s.checks.relative_violation_position = 1.0;
  EXPECT_FALSE(is_doubted(doubts_of(s, false), "energy"));
  s.checks.evaluated = false;
  EXPECT_TRUE(doubts_of(s, true).empty());
}

TEST(Trust, estimated_errors_are_judged_by_what_sensors_show) {
  records::Summary s = good();
  s.step_size = 0.1;
  s.sensor_errors = {{"bob.x", 0.01, 0.0, 1.0}, {"bob.y", 0.01, 0.01, 1.0}};
  EXPECT_FALSE(is_doubted(s, "error"));
  s.sensor_errors[1].of_energy = 0.15;
  const std::vector<records::Doubt> doubts = doubts_of(s, true);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_NE(doubts[0].text.find("bob.y"), std::string::npos);
  EXPECT_NE(doubts[0].text.find("steps of 0.041 s"), std::string::npos)
      << "a quarter of the error, and a margin of 1.5: " << doubts[0].text;
  s.steps.size_changes = 3;
  EXPECT_NE(doubts_of(s, true)[0].text.find("step_control 6 times smaller"), std::string::npos);
}

/// A body at rest but for round-off: what it gains is none, and is all the energy there is.
TEST(Trust, energies_of_round_off_do_not_grow) {
  records::Summary s = good();
  s.checks.energy_scale = s.checks.energy_gained = 4.6e-30;
  EXPECT_TRUE(is_doubted(s, "energy"));
  s.checks.energy_round_off = 1e-16;
  EXPECT_FALSE(is_doubted(s, "energy"));
}

TEST(Trust, runs_that_broke_off_or_floundered_are_doubted) {
  records::Summary s = good();
  s.status = records::RunStatus::failed;
  s.cause = "nothing holds 'tip'";
  ASSERT_TRUE(is_doubted(s, "run"));
  EXPECT_NE(doubts_of(s, true)[0].text.find("tip"), std::string::npos);
  s = good();
  s.status = records::RunStatus::interrupted;
  EXPECT_TRUE(is_doubted(s, "run"));
  s = good();
  s.steps.rejected = 10;
  EXPECT_FALSE(is_doubted(s, "steps"));
  s.steps.rejected = 11;
  EXPECT_TRUE(is_doubted(s, "steps"));
}

scene::Scene cantilever(int elements) {
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e4, 5e3, 5e3, 100, 100, 100), 1.0, elements, 1);
  s.point_loads = {scene::make_load("tip", {{0, 1e-3, 0}})};
  return s;
}

/// EA L^2 / EI n^2 = 4e14: shear and extension are that much stiffer than bending over the whole, and the condition is
/// 1e14. Yet nine digits are right.
TEST(Trust, a_large_condition_alone_is_no_doubt) {
  const MemoryRun few = run_in_memory(cantilever(10));
  ASSERT_TRUE(few.ok()) << few.text();
  EXPECT_TRUE(few.summary.doubts.empty()) << few.summary.doubts[0].text;
  scene::Scene slender = cantilever(2000);
  slender.sections = {scene::make_section("s", 1e10, 5e9, 5e9, 100, 100, 100)};
  slender.point_loads = {scene::make_load("tip", {{0, 1e-3, 0}})};
  const MemoryRun many = run_in_memory(slender);
  ASSERT_TRUE(many.ok()) << many.text();
  EXPECT_NEAR(many.final("tip.y"), 1e-3 * (1.0 / 300.0 + 1.0 / 5e9), 1e-12);
  EXPECT_TRUE(many.summary.doubts.empty()) << many.summary.doubts[0].text;
}

/// A parallelogram that turns through its flat position 1.1e-4 rad at a time: gaps of some 1e-16 m there are newtons
/// of the joints' reactions, and runs at
/// other tolerances differ by that. In steps 20 times as long they do not.
TEST(Trust, reactions_that_hang_on_round_off_near_a_flat_four_bar_are_doubted_by_joint) {
  scene::Scene s = scene::make_four_bars(1);
  for (const scene::Joint& j : s.joints) s.sensors.push_back(scene::make_joint_sensor("at " + j.name, j.name));
  s.analysis.end_time = 0.72;
  for (const double step : {1e-4, 2e-3}) {
    s.analysis.step_size = step;
    s.analysis.tolerance = 1e-8;
    const MemoryRun run = run_in_memory(s);
    s.analysis.tolerance = 1e-10;
    const MemoryRun other = run_in_memory(s);
    ASSERT_TRUE(run.ok() && other.ok()) << run.text() << other.text();
    double most = 0.0, largest = 0.0;
    for (const scene::Joint& j : s.joints)
      for (const char* axis : {".fx", ".fy"}) {
        const std::vector<double> a = run.series("at " + j.name + axis), b = other.series("at " + j.name + axis);
        largest = std::max(largest, run.largest("at " + j.name + axis));
        for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
      }
    EXPECT_EQ(most > 1e-3 * largest, step < 1e-3) << most << " of " << largest;
    EXPECT_EQ(is_doubted(run.summary.doubts, "condition"), step < 1e-3) << most << " of " << largest;
    for (const records::Doubt& d : run.summary.doubts)
      EXPECT_TRUE(d.about != "condition" || d.text.find("the reaction of '") == 0) << d.text;
  }
  s.sensors.resize(1);  // nobody asks for reactions
  s.analysis.step_size = 1e-4;
  EXPECT_FALSE(is_doubted(run_in_memory(s).summary.doubts, "condition"));
}

/// However far apart the rows of the history are that springs are looked at in; the first stride passes between the
/// first two rows. A mass that orbits the anchor turns the spring round as well.
TEST(Trust, springs_that_pass_through_length_0_are_named_and_those_that_turn_round_are_not) {
  const auto is_told = [](double sideways, double along, int stride) {
    scene::Scene s;
    s.bodies = {scene::make_body("dot", 1.0, {{1.0, 1.0, 1.0}}, {{0.0, -0.1, 0.0}})};
    support::GivenSpring spring;
    spring.name = "rope";
    spring.second.to = "dot";
    spring.stiffness = 8000.0;
    spring.rest_length = 0.05;
    s.couplings = {spring};
    scene::InitialVelocity v;
    v.of = "dot";
    v.velocity = {{sideways, along, 0.0}};
    s.initial_velocities = {v};
    s.analysis.end_time = 0.12;
    s.analysis.step_size = 1e-3;
    s.output.stride = stride;
    const MemoryRun run = run_in_memory(s);
    EXPECT_TRUE(run.ok()) << run.text();
    return is_doubted(run.summary.doubts, "springs");
  };
  for (const int stride : {1, 3}) EXPECT_TRUE(is_told(0.0, 8.0, stride)) << stride;
  for (const int stride : {1, 3, 20, 50, 78, 79, 80}) EXPECT_FALSE(is_told(6.3, 0.0, stride)) << stride;
}

/// Reactions of three cranks on two couplers have a pole where they are flat, which steps do not resolve: how large
/// they are there hangs on when the motion comes by. Errors are those against reactions of the closed form, of the
/// range.
TEST(Trust, reactions_at_a_pole_that_the_motion_comes_to_late_are_doubted) {
  struct Case {
    int windows;
    double speed, step;
    bool is_wrong;
  };
  for (const Case& c : {Case{3, 3.0, 5e-3, true},      // off by 43 %
                        Case{3, 3.0, 2e-3, true},      // 7.3 %
                        Case{2, 3.0, 1e-3, true},      // 4.0 %
                        Case{2, 1.0, 5e-3, true},      // 1.5 %
                        Case{2, 3.0, 2e-3, true},      // 1.3 %
                        Case{2, 3.0, 5e-4, false},     // 0.7 %
                        Case{3, 3.0, 5e-4, false},     // 0.7 %
                        Case{2, 1.0, 1e-3, false},     // 0.08 %
                        Case{3, 1.0, 1e-3, false},     // 0.1 %
                        Case{1, 3.0, 5e-3, false}}) {  // 0.03 %: no pole
    scene::Scene s = scene::make_four_bars(c.windows);
    for (scene::InitialVelocity& v : s.initial_velocities) {
      for (int i = 0; i < 3; ++i) {
        v.velocity[i] *= c.speed;
        v.angular_velocity[i] *= c.speed;
      }
    }
    for (const scene::Joint& j : s.joints) s.sensors.push_back(scene::make_joint_sensor("at " + j.name, j.name));
    s.analysis.end_time = 0.9;
    s.analysis.step_size = c.step;
    const MemoryRun run = run_in_memory(s);
    ASSERT_TRUE(run.ok()) << run.text();
    bool is_doubted = false;
    for (const records::Doubt& d : run.summary.doubts)
      is_doubted |= d.about == "error" && d.text.find("pole") != std::string::npos;
    EXPECT_EQ(is_doubted, c.is_wrong) << c.windows << " windows, " << c.speed << " m/s, " << c.step << " s";
  }
}

/// Rows of a parallelogram depend on each other where it is flat, and nowhere else: it can go on as a parallelogram or
/// crossed.
TEST(Trust, a_mechanism_that_passes_a_singular_position_is_not_called_unique) {
  scene::Scene s;
  for (const char* const name : {"left", "right", "coupler"})
    s.bodies.push_back(scene::make_body(name, 1.0, {{0.1, 0.1, 0.1}}, Vec3::zero()));
  s.bodies[0].placement.pose.x = {{0.5, 0.0, 0.0}};
  s.bodies[1].placement.pose.x = {{2.5, 0.0, 0.0}};
  s.bodies[2].placement.pose.x = {{2.0, 0.0, 0.0}};
  const Vec3 half{{0.5, 0.0, 0.0}}, back{{-0.5, 0.0, 0.0}};
  const auto hinge = [](const char* name, const char* first, const Vec3& a, const char* second, const Vec3& b) {
    return scene::make_joint(name, scene::JointKind::revolute, first, a, second, b);
  };
  s.joints = {hinge("A", "", Vec3::zero(), "left", back), hinge("B", "", {{2.0, 0.0, 0.0}}, "right", back),
              hinge("C", "left", half, "coupler", {{-1.0, 0.0, 0.0}}),
              hinge("D", "right", half, "coupler", {{1.0, 0.0, 0.0}})};
  for (const char* const name : {"left", "right", "coupler"}) {
    scene::InitialVelocity v;
    v.of = name;
    v.velocity = {{0.0, std::string(name) == "coupler" ? 1.0 : 0.5, 0.0}};
    v.angular_velocity = {{0.0, 0.0, std::string(name) == "coupler" ? 0.0 : 1.0}};
    s.initial_velocities.push_back(v);
  }
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 0.1;
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_TRUE(run.says("at time 0, ")) << run.text();
  EXPECT_TRUE(run.says("singular position")) << run.text();
  EXPECT_FALSE(run.says("the motion is unique")) << run.text();
}

/// A tolerance of fewer digits than there are is reached at the floor and no reason for doubt, unless what is left
/// unbalanced is.
TEST(Trust, forces_that_round_off_leaves_unbalanced_are_told) {
  scene::Scene s = cantilever(10);
  s.analysis.tolerance = 1e-15;
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_GT(run.summary.checks.steps_at_floor, 0);
  EXPECT_TRUE(run.summary.doubts.empty()) << run.summary.doubts[0].text;
  // A rod on a bushing of 1e14 N/m at its end, swinging: u |x| k is a hundredth of its weight.
  scene::Scene stiff;
  stiff.name = "stiff";
  stiff.gravity = {{0.0, -9.81, 0.0}};
  stiff.bodies = {scene::make_body("rod", 1.0, {{0.01, 0.1, 0.1}}, {{0.3, 0.4, 0.0}})};
  support::GivenBushing b;
  b.name = "bushing";
  b.second.to = "rod";
  b.second.offset.x = {{-0.3, -0.4, 0.0}};
  for (int i = 0; i < 5; ++i) b.stiffness(i, i) = 1e14;
  stiff.couplings = {b};
  stiff.analysis.step_size = 1e-3;
  stiff.analysis.end_time = 0.05;
  const MemoryRun swinging = run_in_memory(stiff);
  ASSERT_TRUE(swinging.ok()) << swinging.text();
  EXPECT_TRUE(is_doubted(swinging.summary.doubts, "round-off")) << swinging.summary.checks.unbalanced_at_floor;
}

/// A mass on a spring, 20 vibrations in steps of a third of a period: the scheme takes what it does not resolve.
TEST(Trust, energy_that_the_integrator_takes_is_told) {
  scene::Scene s;
  s.name = "mass on a spring";
  s.bodies = {scene::make_body("mass", 1.0, {{0.1, 0.1, 0.1}}, Vec3::zero())};
  support::GivenBushing spring;
  spring.name = "spring";
  spring.second.to = "mass";
  for (int i = 0; i < 6; ++i) spring.stiffness(i, i) = 1e4;
  s.couplings = {spring};
  scene::InitialVelocity kick;
  kick.of = "mass";
  kick.velocity = {{1.0, 0.0, 0.0}};
  s.initial_velocities = {kick};
  s.analysis.step_size = 0.02;
  s.analysis.end_time = 1.2;
  s.analysis.spectral_radius = 0.5;
  EXPECT_TRUE(is_doubted(run_in_memory(s).summary.doubts, "energy"));
  s.analysis.step_size = 1e-3;
  const MemoryRun resolved = run_in_memory(s);
  EXPECT_TRUE(resolved.summary.doubts.empty()) << resolved.summary.doubts[0].text;
}

TEST(Trust, a_run_that_is_stopped_says_so) {
  SimulateOptions options;
  options.before_step = [](step::System&, const step::State&, const BeforeStep& step) { return step.number < 2; };
  scene::Scene s = cantilever(4);
  s.analysis.load_steps = 3;
  EXPECT_TRUE(is_doubted(run_in_memory(s, options).summary.doubts, "run"));
}

/// A^-1 of a known matrix: one body on a bushing in statics, springs that differ in what scaling cannot take out.
TEST(Trust, the_condition_is_told_by_level_and_in_all) {
  scene::Scene s = cantilever(64);
  s.solver.depth = 3;
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  ASSERT_EQ(run.summary.levels.size(), 4u);
  int subdomains = 0;
  for (const records::LevelFigures& level : run.summary.levels) {
    subdomains += level.subdomains;
    EXPECT_LT(level.backward_error, 1e-14) << level.level;
    EXPECT_GT(level.backward_error, 0.0) << level.level;
    if (level.level > 0) {
      EXPECT_GE(level.condition, 1.0) << level.level;
    }
  }
  EXPECT_EQ(subdomains, 15);
  double condition = 0.0;
  for (const auto& [name, value] : run.summary.solver)
    if (name == "condition_estimate") condition = value;
  EXPECT_GT(condition, 1e4);
  EXPECT_LT(condition, 1e10);
}

}  // namespace
}  // namespace bough::run
