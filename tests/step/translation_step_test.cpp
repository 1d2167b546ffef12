/// Scenes of which all nodes only translate: their steps on R^3 and R^1 against those in space, and against closed
/// forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bough/motion/so3.hpp"
#include "same_motion.hpp"
#include "support/given.hpp"

namespace bough::step {
namespace {

using motion::Vec3;
using test::Rig;

scene::Body point_mass(const std::string& name, double mass, const Vec3<double>& at) {
  scene::Body b;
  b.name = name;
  b.mass = mass;
  b.is_point_mass = true;
  b.placement.pose.x = at;
  return b;
}
support::GivenSpring spring_between(const std::string& a, const std::string& b, double stiffness, double rest_length) {
  support::GivenSpring s;
  s.name = a + "-" + b;
  s.first.to = a;
  s.second.to = b;
  s.stiffness = stiffness;
  s.rest_length = rest_length;
  return s;
}

/// A net under its weight between two fixed corners; one mass follows a law, another one carries a load, and the frames
/// of all bodies are turned against the ground's.
scene::Scene make_net(int across) {
  scene::Scene s;
  s.name = "net";
  s.gravity = {{0.3, 0.0, -9.81}};
  const auto name = [](int i, int j) { return "m" + std::to_string(i) + "_" + std::to_string(j); };
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      s.bodies.push_back(point_mass(name(i, j), 0.2 + 0.01 * i, {{0.5 * i, 0.5 * j, 0.05 * i * j}}));
      s.bodies.back().placement.pose.R = motion::exp_so3(Vec3<double>{{0.3 + 0.1 * i, -0.8, 0.5 * j}});
      const auto tie = [&](int k, int l, double length) {
        if (k < 0 || l < 0 || k >= across) return;
        support::GivenSpring spring = spring_between(name(k, l), name(i, j), 400.0, length);
        spring.damping = 0.3;
        s.couplings.push_back(spring);
      };
      tie(i - 1, j, 0.49);
      tie(i, j - 1, 0.48);
      tie(i - 1, j - 1, 0.7);
      tie(i + 1, j - 1, 0.7);
    }
  for (const int corner : {0, across - 1}) {
    scene::Joint ball;
    ball.name = "ball" + std::to_string(corner);
    ball.kind = scene::JointKind::spherical;
    ball.second.to = name(corner, 0);
    ball.first.offset.x = {{0.5 * corner, 0.0, 0.0}};
    s.joints.push_back(ball);
  }
  scene::PrescribedMotion shaken;
  shaken.name = "shaken";
  shaken.at.to = name(0, across - 1);
  const Vec3<double>& at = s.bodies[static_cast<std::size_t>(across - 1)].placement.pose.x;
  for (std::size_t i = 0; i < 3; ++i)
    shaken.displacement[i] = laws::make_harmonic(i == 2 ? 0.05 : 0.0, 9.0, 0.0, at[static_cast<int>(i)]);
  s.motions.push_back(shaken);
  scene::PointLoad load;
  load.name = "load";
  load.at.to = name(across - 1, across - 1);
  load.force = {{1.0, -2.0, 0.5}};
  load.law = laws::make_harmonic(0.5, 4.0, 0.2, 1.0);
  s.point_loads.push_back(load);
  s.analysis.tolerance = 1e-12;
  return s;
}

/// Masses on one inclined line, fixed at both ends.
scene::Scene make_row(int masses, const Vec3<double>& direction) {
  scene::Scene s;
  s.name = "row";
  for (int k = 1; k <= masses; ++k) {
    const std::string name = "m" + std::to_string(k);
    s.bodies.push_back(point_mass(name, 0.5, (0.25 * k) * direction));
    s.couplings.push_back(spring_between(k == 1 ? "" : "m" + std::to_string(k - 1), name, 800.0, 0.2));
  }
  s.couplings.push_back(spring_between("m" + std::to_string(masses), "", 800.0, 0.2));
  s.couplings.back().second.offset.x = (0.25 * (masses + 1)) * direction;
  s.analysis.tolerance = 1e-12;
  return s;
}
const Vec3<double> slope{{0.48, -0.6, 0.64}};  // of length 1

template <class G>
void compare_with_space(scene::Scene s, double h, double tolerance) {
  using scene::Integrator;
  for (const Integrator kind : {Integrator::generalized_alpha, Integrator::bdf, Integrator::variational}) {
    SCOPED_TRACE(static_cast<int>(kind));
    s.analysis.integrator = kind;
    s.without.clear();
    Rig reduced(s);
    ASSERT_TRUE(reduced.plan.is_on<G>());
    s.without = {"line", "translation", "planar"};
    Rig space(s);
    ASSERT_TRUE(space.plan.is_on<motion::Se3>());
    test::take_steps(reduced, h);
    test::take_steps(space, h);
    test::expect_equal(reduced, space, tolerance);
  }
}

TEST(TranslationStep, of_a_net_agrees_with_steps_in_space) {
  compare_with_space<motion::Translations<3>>(make_net(5), 1e-3, 1e-9);
}

TEST(TranslationStep, on_a_line_agrees_with_steps_in_space) {
  scene::Scene s = make_row(9, slope);
  s.gravity = 3.0 * slope;
  scene::InitialVelocity struck;
  struck.of = "m1";
  struck.velocity = 0.7 * slope;
  s.initial_velocities.push_back(struck);
  compare_with_space<motion::Translations<1>>(s, 1e-3, 1e-9);
}

TEST(TranslationStep, finds_the_equilibrium_of_a_net_as_in_space) {
  scene::Scene s = make_net(4);
  s.analysis.kind = scene::AnalysisKind::statics;
  Rig reduced(s);
  ASSERT_TRUE(reduced.plan.is_on<motion::Translations<3>>());
  s.without = {"line", "translation", "planar"};
  Rig space(s);
  const StepOptions options = make_step_options(s.analysis);
  for (Rig* rig : {&reduced, &space})
    for (const double factor : {0.25, 0.5, 0.75, 1.0}) {
      const StepReport report = equilibrate(rig->system, rig->state, options, factor);
      ASSERT_TRUE(report.converged) << report.cause;
    }
  test::expect_equal(reduced, space, 1e-11);
}

/// In a row of equal masses m between equal springs k, the modes are x_i = sin(i j pi / (n + 1)), with frequencies
/// 2 sqrt(k / m) sin(j pi / (2 (n + 1))). Of two step sizes, the error of the smaller one is a quarter.
TEST(TranslationStep, follows_the_normal_modes_of_a_row) {
  constexpr int n = 6;
  for (const bool on_line : {true, false})
    for (const int mode : {1, 4}) {
      SCOPED_TRACE(testing::Message() << "on a line " << on_line << ", mode " << mode);
      scene::Scene s = make_row(n, slope);
      s.analysis.spectral_radius = 1.0;
      if (!on_line) s.without = {"line"};
      const auto shape = [mode](int i) { return std::sin(i * mode * std::numbers::pi / (n + 1)); };
      for (int i = 1; i <= n; ++i) {
        scene::InitialVelocity v;
        v.of = "m" + std::to_string(i);
        v.velocity = (0.3 * shape(i)) * slope;
        s.initial_velocities.push_back(v);
      }
      const double frequency = 2.0 * std::sqrt(800.0 / 0.5) * std::sin(mode * std::numbers::pi / (2.0 * (n + 1)));
      double errors[2];
      for (const int fine : {0, 1}) {
        const double h = fine == 0 ? 1e-3 : 5e-4;
        const int steps = fine == 0 ? 100 : 200;
        Rig rig(s);
        if (on_line)
          ASSERT_TRUE(rig.plan.is_on<motion::Translations<1>>());
        else
          ASSERT_TRUE(rig.plan.is_on<motion::Translations<3>>());
        rig.run(steps, h);
        errors[fine] = 0.0;
        for (int i = 1; i <= n; ++i) {
          const double along = 0.25 * i + 0.3 / frequency * shape(i) * std::sin(frequency * 0.1);
          for (int k = 0; k < 3; ++k)
            errors[fine] = std::max(errors[fine],
                                    std::abs(rig.nodes()[static_cast<std::size_t>(i - 1)].x.hi[k] - along * slope[k]));
        }
      }
      EXPECT_LT(errors[1], 1e-4);
      EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.1);
    }
}

/// Positions are pairs of numbers: a net moved by kilometres steps as the one at the origin.
TEST(TranslationStep, keeps_the_digits_of_places_far_away) {
  scene::Scene s = make_row(9, slope);
  s.without = {"line"};
  s.gravity = {{0.0, 0.0, -9.81}};
  Rig near(s);
  const Vec3<double> shift{{4096.0, -8192.0, 2048.0}};
  for (scene::Body& b : s.bodies) b.placement.pose.x += shift;
  s.couplings.front().first.offset.x += shift;
  s.couplings.back().second.offset.x += shift;
  Rig far(s);
  ASSERT_TRUE(far.plan.is_on<motion::Translations<3>>());
  near.run(50, 1e-3);
  far.run(50, 1e-3);
  for (std::size_t n = 0; n < near.nodes().size(); ++n)
    for (int i = 0; i < 3; ++i) {
      // The places of the scene itself are rounded by 2^-40 m there; a run must not add to that.
      EXPECT_NEAR(far.nodes()[n].x.hi[i] - shift[i], near.nodes()[n].x.hi[i], 4e-12);
      EXPECT_NEAR(far.nodes()[n].v[i], near.nodes()[n].v[i], 1e-9);
    }
}

}  // namespace
}  // namespace bough::step
