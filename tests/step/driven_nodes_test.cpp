/// Nodes that joints move as prescribed, eliminated before the linear solver: the same equations, iterations and results as with all unknowns.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bough/schedule/threads.hpp"
#include "bough/step/arc_length.hpp"
#include "bough/step/step_control.hpp"
#include "driven_scenes.hpp"

namespace bough::step {
namespace {

using motion::Vec6;
using test::barred;
using test::drive_first_hinge;
using test::expand;
using test::expect_equal;
using test::largest;
using test::Rig;
using test::stir;
using test::take_steps;
using test::varied;

TEST(DrivenNodes, leave_the_equations_and_their_solution_as_they_are) {
  for (int order : {1, 2, 3})
    for (const elements::Slopes& slopes : {elements::Slopes{120.0, 2e4, false}, elements::Slopes{0.0, 0.0, true}}) {
      Rig driven(varied(order)), whole(barred(varied(order)));
      ASSERT_EQ(driven.plan.driven.size(), 2u);
      ASSERT_EQ(driven.plan.held.size(), 1u);
      ASSERT_EQ(driven.system.num_unknowns(), whole.system.num_unknowns());
      ASSERT_EQ(driven.system.tree().num_unknowns() + 24, whole.system.tree().num_unknowns());
      stir(driven, whole);
      for (Rig* rig : {&driven, &whole}) {
        ASSERT_FALSE(rig->system.set_time(0.3));
        ASSERT_FALSE(rig->system.evaluate(rig->state, slopes, true));
        ASSERT_FALSE(rig->system.factor(true, slopes));
      }
      EXPECT_EQ(expand(driven, whole, driven.system.residual()), whole.system.residual());
      ResidualSize a = driven.system.residual_size(), b = whole.system.residual_size();
      driven.system.name_worst(a);
      whole.system.name_worst(b);
      EXPECT_EQ(a.force, b.force);
      EXPECT_EQ(a.moment, b.moment);
      EXPECT_EQ(a.length, b.length);
      EXPECT_EQ(a.angle, b.angle);
      EXPECT_EQ(a.force_scale, b.force_scale);
      EXPECT_EQ(a.worst_joint, b.worst_joint);
      const ResidualSize c = driven.system.round_off_floor(), d = whole.system.round_off_floor();
      EXPECT_NEAR(c.force, d.force, 1e-14 * d.force);
      EXPECT_NEAR(c.moment, d.moment, 1e-14 * d.moment);
      const std::size_t n = driven.system.num_unknowns();
      std::vector<double> x(n, 0.0), product(n), other(n), rhs(n);
      std::vector<std::vector<double>> columns;  // of the whole, by the driven system's unknowns
      for (std::size_t i = 0; i < n; ++i) {
        x[i] = 1.0;
        driven.system.multiply(x.data(), product.data());
        whole.system.multiply(expand(driven, whole, x).data(), other.data());
        EXPECT_EQ(expand(driven, whole, product), other) << "column " << i;
        columns.push_back(other);
        x[i] = 0.0;
      }
      std::mt19937 random(5);
      for (double& r : rhs) r = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
      ASSERT_FALSE(driven.system.solve(rhs.data(), x.data()));
      // The solution without driven nodes solves the whole's equations, row by row (Oettli, Prager 1964).
      const std::vector<double> b_whole = expand(driven, whole, rhs);
      double worst = 0.0;
      for (std::size_t row = 0; row < b_whole.size(); ++row) {
        double left = b_whole[row], terms = std::abs(b_whole[row]);
        for (std::size_t i = 0; i < n; ++i) {
          left -= columns[i][row] * x[i];
          terms += std::abs(columns[i][row] * x[i]);
        }
        worst = std::max(worst, std::abs(left) / terms);
      }
      EXPECT_LT(worst, 1e-14);
      std::vector<double> rate, whole_rate;
      driven.system.evaluate_rate(driven.state, rate);
      whole.system.evaluate_rate(whole.state, whole_rate);
      EXPECT_EQ(expand(driven, whole, rate), whole_rate);
    }
}

/// At the default tolerance, which is not that near to round-off.
void compare_iterations(scene::Scene s, scene::Integrator integrator) {
  s.analysis.integrator = integrator;
  int iterations[2] = {};
  long factorizations[2] = {};
  for (int barred_too : {0, 1}) {
    Rig rig(barred_too != 0 ? barred(s) : s);
    ASSERT_TRUE(make_consistent(rig.system, rig.state, true, 1e-3).ok);
    iterations[barred_too] = take_steps(rig, 1e-3);
    factorizations[barred_too] = rig.system.counts().factorizations;
  }
  // A residual at the bound may fall on either side of it, and a factor costs more or less than the solutions it saves: with some 130 solutions,
  // three of a hundred and two.
  const auto work = [&](int k) { return iterations[k] + 1.5 * static_cast<double>(factorizations[k]); };
  EXPECT_LE(work(0), 1.03 * work(1) + 2.0) << iterations[0] << " and " << factorizations[0] << " instead of "
                                           << iterations[1] << " and " << factorizations[1];
}

/// A run with nodes eliminated and one with all unknowns; and that the iteration closes the rows of what is eliminated.
void compare_steps(scene::Scene s, scene::Integrator integrator = scene::Integrator::generalized_alpha) {
  constexpr double h = 5e-4;
  s.analysis.tolerance = 1e-12;
  s.analysis.integrator = integrator;
  Rig driven(s), whole(barred(s));
  ASSERT_FALSE(driven.plan.driven.empty());
  ASSERT_TRUE(whole.plan.driven.empty());
  for (Rig* rig : {&driven, &whole}) ASSERT_TRUE(make_consistent(rig->system, rig->state, true, h).ok);
  expect_equal(driven, whole, 1e-11);  // accelerations and multipliers at the start
  for (Rig* rig : {&driven, &whole}) take_steps(*rig, h);
  expect_equal(driven, whole, 1e-10);
  test::expect_near_momenta(driven.state, whole.state, 1e-10);
  EXPECT_LT(driven.system.relative_violation(driven.state, 0), 1e-12);
}

TEST(DrivenNodes, move_the_others_as_with_multipliers) {
  for (int order : {1, 2, 3}) compare_steps(varied(order));
}

TEST(DrivenNodes, move_the_others_as_with_multipliers_by_every_integrator) {
  compare_steps(varied(1), scene::Integrator::bdf);
  compare_steps(varied(2), scene::Integrator::variational);
}

TEST(DrivenNodes, take_no_more_iterations_and_factors_than_with_multipliers) {
  for (auto integrator : {scene::Integrator::generalized_alpha, scene::Integrator::bdf, scene::Integrator::variational})
    compare_iterations(varied(2), integrator);
}

TEST(DrivenNodes, are_left_to_the_solver_where_at_rest_ones_are) {
  scene::Scene s = varied(2);
  s.without.push_back("held");
  compare_steps(s);
}

TEST(DrivenNodes, of_a_plane_move_the_others_as_with_multipliers) {
  scene::Scene s = test::make_chain(12);  // in lanes
  drive_first_hinge(s, laws::make_harmonic(0.4, 6.0));
  ASSERT_TRUE(Rig(s).plan.took("planar"));
  compare_steps(s);
}

/// Equal beams side by side, each shaken at its root: sub-domains with a driven node each, one to a lane.
TEST(DrivenNodes, in_lockstep_move_the_others_as_with_multipliers) {
  for (bool is_planar : {false, true}) {
    scene::Scene s = test::make_chain(32, 2);
    if (!is_planar) s.without = {"planar"};
    s.joints.clear();
    for (int l = 0; l < 32; ++l) {
      scene::PrescribedMotion m;
      m.name = "table " + std::to_string(l);
      m.at.to = "a" + std::to_string(l);
      m.displacement[0] = m.displacement[1] = laws::make_constant(0.0);
      m.displacement[2] = laws::make_harmonic(0.02, 12.0);
      m.hold_rotation = true;
      s.motions.push_back(m);
    }
    ASSERT_EQ(Rig(s).plan.driven.size(), 32u);
    ASSERT_GT(Rig(s).system.solver().counters().fronts_in_lanes, 0);
    compare_steps(s);
  }
}

/// Fixed to a frame that turns, seen from the ground and from another one.
TEST(DrivenNodes, on_a_frame_that_moves_move_the_others_as_with_multipliers) {
  for (const char* observer : {"", "cart"}) {
    scene::Scene s = varied(2);
    s.frames.push_back(test::make_turntable({{0.0, 0.6, 0.8}}));
    s.frames.push_back(test::make_turntable({{1.0, 0.0, 0.0}}));
    s.frames[1].name = "cart";
    s.joints[0].kind = scene::JointKind::fixed;
    s.joints[0].drives.clear();
    s.joints[0].forces.clear();
    s.joints[0].first.to = "table";
    s.analysis.frame = observer;
    compare_steps(s);
  }
}

/// Masses on springs along a line and beside it, one of them moved.
TEST(DrivenNodes, without_rotations_move_the_others_as_with_multipliers) {
  for (double beside : {0.0, 0.4}) {
    scene::Scene s;
    s.gravity = {{0.0, 0.0, -9.81}};
    for (int k = 0; k < 3; ++k) {
      scene::Body b;
      b.name = "m" + std::to_string(k);
      b.mass = 1.0 + k;
      b.is_point_mass = true;
      b.placement.pose.x = {{k == 2 ? beside : 0.0, 0.5 * beside * k, -static_cast<double>(k)}};
      s.bodies.push_back(b);
      if (k == 0) continue;
      scene::Spring spring;
      spring.name = "s" + std::to_string(k);
      spring.first.to = "m" + std::to_string(k - 1);
      spring.second.to = b.name;
      spring.stiffness = 200.0;
      spring.rest_length = 1.0;
      s.springs.push_back(spring);
    }
    scene::PrescribedMotion shake;
    shake.name = "shake";
    shake.at.to = "m0";
    if (beside > 0.0) shake.displacement[0] = shake.displacement[1] = laws::make_constant(0.0);
    shake.displacement[2] = laws::make_harmonic(0.1, 8.0);
    s.motions.push_back(shake);
    EXPECT_EQ(Rig(s).plan.unknowns.count, beside > 0.0 ? 3 : 1);
    compare_steps(s);
  }
}

/// A displacement and a turn of the far end that grow with the load factor.
scene::Scene bent(int order, bool is_planar) {
  scene::Scene s = test::make_chain(1, order);
  s.analysis.kind = scene::AnalysisKind::statics;
  s.gravity = motion::Vec3<double>::zero();
  s.joints[0].kind = scene::JointKind::fixed;
  s.beams[0].elements = 4;
  if (!is_planar) s.without = {"planar"};
  scene::PrescribedMotion m;
  m.name = "grip";
  m.at.to = "b0";
  m.displacement[0] = laws::make_ramp(0.0, 1.0, 0.0, -0.2);
  if (!is_planar) m.displacement[1] = laws::make_ramp(0.0, 1.0, 0.0, 0.05);
  m.displacement[2] = laws::make_ramp(0.0, 1.0, 0.0, 0.3);
  m.rotation_axis = motion::Vec3<double>{{0.0, 1.0, 0.0}};
  m.angle = laws::make_ramp(0.0, 1.0, 0.0, 0.5);
  s.motions.push_back(m);
  return s;
}

TEST(DrivenNodes, bend_the_others_as_with_multipliers_in_statics) {
  for (int order : {1, 3})
    for (bool is_planar : {false, true}) {
      const scene::Scene s = bent(order, is_planar);
      Rig driven(s), whole(barred(s));
      ASSERT_EQ(driven.plan.driven.size(), 1u);
      ASSERT_EQ(driven.plan.unknowns.count, is_planar ? 3 : 6);
      const StepOptions options = make_step_options(s.analysis);
      int iterations[2] = {};
      for (Rig* rig : {&driven, &whole})
        for (double factor : {0.5, 1.0}) {
          const StepReport report = equilibrate(rig->system, rig->state, options, factor);
          ASSERT_TRUE(report.converged) << report.cause;
          iterations[rig == &whole] += report.iterations;
        }
      EXPECT_LE(iterations[0], iterations[1]);
      ASSERT_FALSE(driven.state.unsettled.empty());
      expect_equal(driven, whole, 1e-10);
      EXPECT_NEAR(driven.nodes()[1].x.hi[0], 0.8, 1e-15);
      EXPECT_GT(largest(driven.state.multipliers), 1e3);
    }
}

TEST(DrivenNodes, follow_the_path_of_equilibria_as_with_multipliers) {
  scene::Scene s = bent(2, false);
  s.motions[0].displacement[0] = laws::make_expression("-0.05*t^2");
  s.motions[0].displacement[1] = laws::make_expression("0.02*t");
  s.motions[0].displacement[2] = laws::make_expression("0.1*t");
  s.motions[0].angle = laws::make_expression("-0.2*t");
  s.analysis.arc_length = scene::ArcLength{};
  Rig driven(s), whole(barred(s));
  ASSERT_EQ(driven.plan.driven.size(), 1u);
  for (Rig* rig : {&driven, &whole}) {
    StepOptions options = make_step_options(s.analysis);
    ArcLengthPath path(rig->system, options);
    for (int k = 0; k < 4; ++k) {
      ASSERT_FALSE(path.set_tangent(rig->state));
      const StepReport report = path.advance(rig->state, 0.03);
      ASSERT_TRUE(report.converged) << report.cause;
    }
  }
  EXPECT_GT(driven.state.time, 0.1);
  EXPECT_NEAR(driven.state.time, whole.state.time, 1e-12);
  expect_equal(driven, whole, 1e-10);
}

/// Places and velocities that do not fit the rows are set right at the start, with the same impulses.
TEST(DrivenNodes, start_as_with_multipliers) {
  scene::Scene s = varied(1);
  s.motions[0].displacement[0] = laws::make_harmonic(0.02, 9.0, 1.0, 0.03);  // not zero at first
  scene::InitialVelocity v;
  v.of = "arm";
  v.velocity = {{0.3, 0.2, -1.0}};
  s.initial_velocities.push_back(v);
  v.of = "block";
  s.initial_velocities.push_back(v);
  Rig driven(s), whole(barred(s));
  ASSERT_EQ(driven.plan.driven.size(), 2u);
  const StartReport a = make_consistent(driven.system, driven.state, true, 1e-3),
                    b = make_consistent(whole.system, whole.state, true, 1e-3);
  ASSERT_TRUE(a.ok && b.ok) << a.cause << b.cause;
  EXPECT_GT(b.velocity_impulse, 0.1);
  EXPECT_GT(b.position_correction, 0.01);
  EXPECT_NEAR(a.velocity_impulse, b.velocity_impulse, 1e-12);
  EXPECT_NEAR(a.velocity_change, b.velocity_change, 1e-12);
  EXPECT_NEAR(a.position_correction, b.position_correction, 1e-12);
  expect_equal(driven, whole, 1e-11);
}

TEST(DrivenNodes, have_the_local_errors_and_changes_of_the_step_that_they_have_with_multipliers) {
  scene::Scene s = varied(2);
  s.analysis.tolerance = 1e-12;
  Rig driven(s), whole(barred(s));
  const StepOptions options = make_step_options(s.analysis);
  double errors[2];
  for (Rig* rig : {&driven, &whole}) {
    ASSERT_TRUE(make_consistent(rig->system, rig->state, true, 1e-3).ok);
    ASSERT_TRUE(start_alpha(rig->system, rig->state, options, 1e-3).ok);
    LocalError error(rig->system, options, 1.0);
    ASSERT_TRUE(advance(rig->system, rig->state, options, 1e-3).converged);
    ASSERT_FALSE(error.measure(rig->system, rig->state));
    errors[rig == &whole] = error.relative_motion();
    ASSERT_TRUE(change_step_size(rig->system, rig->state, options, 5e-4).ok);
    ASSERT_TRUE(advance(rig->system, rig->state, options, 1.5e-3).converged);
  }
  EXPECT_GT(errors[1], 0.0);
  EXPECT_NEAR(errors[0], errors[1], 1e-8 * errors[1]);
  expect_equal(driven, whole, 1e-10);
}

/// At a quarter of a turn from the pose that its rows ask for, two of these have the same gradient.
TEST(DrivenNodes, name_the_node_that_their_joints_no_longer_hold) {
  scene::Scene s = test::make_chain(2);
  s.without = {"planar"};
  scene::PrescribedMotion m;
  m.name = "grip";
  m.at.to = "a0";
  for (auto& law : m.displacement) law = laws::make_ramp(0.0, 1.0, 0.0, 0.1);
  m.hold_rotation = true;
  s.joints.erase(s.joints.begin());
  s.motions.push_back(m);
  Rig rig(s);
  ASSERT_EQ(rig.plan.driven.size(), 1u);
  Vec6<double> quarter = Vec6<double>::zero();
  quarter[3] = 0.5 * 3.14159265358979323846;
  move_node(rig.plan, rig.state, 0, quarter);
  const elements::Slopes slopes{120.0, 2e4, false};
  ASSERT_FALSE(rig.system.set_time(0.0));
  ASSERT_FALSE(rig.system.evaluate(rig.state, slopes, true));
  const auto trouble = rig.system.factor(true, slopes);
  ASSERT_TRUE(trouble);
  EXPECT_NE(trouble->text.find("'a0'"), std::string::npos) << trouble->text;
}

TEST(DrivenNodes, give_the_same_bits_on_any_number_of_threads) {
  scene::Scene s = varied(2);
  s.without.push_back("small");
  s.solver.leaf_size = 3;
  std::vector<State> ends;
  for (int threads : {1, 2, 8}) {
    const schedule::Threads pool(threads);
    Rig rig(s, pool.walker());
    rig.run(10, 1e-3);
    ends.push_back(rig.state);
  }
  for (std::size_t k = 1; k < ends.size(); ++k) {
    EXPECT_EQ(ends[0].multipliers, ends[k].multipliers);
    test::expect_same_nodes(ends[0], ends[k]);
  }
}

}  // namespace
}  // namespace bough::step
