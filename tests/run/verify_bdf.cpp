// Backward differences of second and third order on the group: orders of positions, velocities and multipliers, stiff
// parts, moving frames, failures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "order_scenes.hpp"
#include "support/stepper.hpp"

namespace bough::run {
namespace {

using support::compare;
using support::Difference;
using support::march;
using support::Outcome;
using support::Sample;
using support::Stepper;

scene::Scene by_bdf(scene::Scene scene, int order = 3) {
  scene.analysis.integrator = scene::Integrator::bdf;
  scene.analysis.bdf_order = order;
  return scene;
}

void expect_order(const std::string& what, const Difference& coarse, const Difference& fine, double least) {
  const double p = support::order_of(coarse.positions, fine.positions),
               v = support::order_of(coarse.velocities, fine.velocities),
               m = support::order_of(coarse.multipliers, fine.multipliers);
  std::printf("| %s | %.2f (%.1e) | %.2f (%.1e) | %.2f (%.1e) |\n", what.c_str(), p, fine.positions, v, fine.velocities,
              m, fine.multipliers);
  EXPECT_GT(p, least) << what;
  EXPECT_GT(v, least) << what;
  EXPECT_GT(m, least) << what;
}

/// The reference: the rule of third order at h / 16, and generalized-alpha extrapolated from much smaller steps says
/// that it is right.
void check_orders(const std::string& name, const scene::Scene& scene, double h, int order = 3) {
  const std::vector<Sample> reference = march(by_bdf(scene, 3), h / 16.0, h / 2.0, 80),
                            coarse = march(by_bdf(scene, order), h, h, 40),
                            fine = march(by_bdf(scene, order), h / 2.0, h / 2.0, 80);
  const double least = order - 0.2;
  expect_order(name + ", steps 3 to 10", compare(coarse, reference, 3, 10, 2), compare(fine, reference, 3, 10, 1),
               least);
  expect_order(name + ", 40 h", compare(coarse, reference, 1, 40, 2), compare(fine, reference, 1, 80, 1), least);
  std::vector<Sample> alpha = march(scene, h / 128.0, h / 2.0, 80);
  const std::vector<Sample> twice = march(scene, h / 64.0, h / 2.0, 80);
  for (std::size_t k = 0; k < alpha.size(); ++k) {
    const auto extrapolate = [](std::vector<double>& a, const std::vector<double>& b) {
      for (std::size_t i = 0; i < a.size(); ++i) a[i] += (a[i] - b[i]) / 3.0;
    };
    extrapolate(alpha[k].positions, twice[k].positions);
    extrapolate(alpha[k].velocities, twice[k].velocities);
  }
  const Difference methods = compare(reference, alpha, 1, 80, 1), error = compare(fine, reference, 1, 80, 1);
  std::printf("| %s, against generalized-alpha | positions %.1e, velocities %.1e |\n", name.c_str(), methods.positions,
              methods.velocities);
  EXPECT_LT(methods.positions, 0.05 * error.positions);
  EXPECT_LT(methods.velocities, 0.05 * error.velocities);
}

TEST(Bdf, is_of_third_order_with_ball_and_hinge) { check_orders("ball and hinge", spatial_pendulum(), 0.01); }
TEST(Bdf, is_of_third_order_with_a_driven_joint) { check_orders("driven hinge", driven_pendulum(), 0.01); }
TEST(Bdf, is_of_third_order_with_a_driven_beam) { check_orders("driven beam", driven_beam(), 0.002); }

TEST(Bdf, of_second_order_is_so_with_ball_and_hinge) { check_orders("ball and hinge", spatial_pendulum(), 0.004, 2); }
TEST(Bdf, of_second_order_is_so_with_a_driven_joint) { check_orders("driven hinge", driven_pendulum(), 0.004, 2); }
TEST(Bdf, of_second_order_is_so_with_a_driven_beam) { check_orders("driven beam", driven_beam(), 0.0005, 2); }

/// An undamped beam is spun up; its vibrations have some 3 to 12 steps a period, where the rule of third order grows.
TEST(Bdf, of_second_order_damps_what_the_rule_of_third_order_lets_grow) {
  const auto energy = [](int order) {
    scene::Scene scene = support::gallery(
        "spin_up", {"/analysis/integrator=\"bdf\"", "/analysis/step_size=1e-2", "/analysis/end_time=10"});
    scene.analysis.bdf_order = order;
    return support::run(scene);
  };
  EXPECT_FALSE(energy(3).ok());
  const Outcome second = energy(2);
  EXPECT_TRUE(second.ok()) << second.summary.cause;
  EXPECT_LT(second.summary.checks.energy_balance, 0.02 * second.summary.checks.energy_scale);
}

TEST(Bdf, is_of_third_order_across_a_change_of_step_size_and_after_a_failure) {
  // 10 steps of h, 10 of h / 2, 10 of h: each change is a new start.
  const auto uneven = [](double h, int fineness) {
    Stepper s(by_bdf(spatial_pendulum()));
    std::vector<Sample> run;
    s.start(h / fineness);
    double at = 0.0;
    for (const double size : {h, 0.5 * h, h}) {
      s.change(size / fineness);
      for (int k = 1; k <= 10; ++k) {
        for (int i = 1; i <= fineness; ++i) s.step(at + size * i / fineness);
        at += size;
        run.push_back(s.sample());
      }
    }
    return run;
  };
  const std::vector<Sample> coarse = uneven(0.01, 2), fine = uneven(0.01, 4), reference = uneven(0.01, 32);
  expect_order("changing steps", compare(coarse, reference, 0, 29, 1), compare(fine, reference, 0, 29, 1), 2.9);
}

TEST(Bdf, runs_the_heavy_top_to_its_table_with_fewer_steps_than_generalized_alpha) {
  const auto error_at_end = [](const std::string& integrator, const std::string& h) {
    const Outcome run =
        support::run(support::gallery("heavy_top", {"/analysis/integrator=\"" + integrator + "\"",
                                                    "/analysis/step_size=" + h, "/analysis/end_time=1"}));
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    return std::array<double, 3>{run.history.last("center.x"), run.history.last("center.y"),
                                 run.history.last("center.z")};
  };
  const auto distance = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  const auto reference = error_at_end("bdf", "2e-5");
  const double a = distance(error_at_end("bdf", "4e-4"), reference),
               b = distance(error_at_end("bdf", "2e-4"), reference),
               alpha = distance(error_at_end("generalized_alpha", "2e-4"), reference);
  std::printf("| heavy top, 1 s, h = 0.4, 0.2 ms | %.1e, %.1e m, order %.2f | generalized-alpha %.1e m |\n", a, b,
              support::order_of(a, b), alpha);
  EXPECT_GT(support::order_of(a, b), 2.7);
  EXPECT_LT(b, alpha);
}

/// The gallery's spin-up, undamped, at a step at which order 3 makes its vibrations grow until the run ends.
TEST(Bdf, takes_order_2_by_itself_where_order_3_makes_vibrations_grow) {
  scene::Scene scene = support::gallery("spin_up", {"/analysis/end_time=6.76", "/analysis/step_size=0.01"});
  scene.expected.clear();
  scene.analysis.integrator = scene::Integrator::bdf;
  const auto says = [](const records::Summary& s, const std::string& text) {
    return std::any_of(s.notes.begin(), s.notes.end(),
                       [&](const std::string& n) { return n.find(text) != std::string::npos; });
  };
  const Outcome chosen = support::run(scene);
  ASSERT_TRUE(chosen.ok()) << chosen.summary.cause;
  EXPECT_TRUE(says(chosen.summary, "backward differences of order 2 are taken: "));
  EXPECT_NEAR(chosen.history.last("tip.x"), -0.809969332439257, 0.02);
  scene.analysis.bdf_order = 3;
  const Outcome asked = support::run(scene);
  EXPECT_TRUE(says(asked.summary, "take \"bdf_order\": 2 or generalized_alpha"));
  ASSERT_FALSE(asked.ok());
  EXPECT_NE(asked.summary.cause.find("order 3 make grow: take \"bdf_order\": 2"), std::string::npos)
      << asked.summary.cause;
  std::printf("| spin-up by order 3 | %s |\n", asked.summary.cause.c_str());
}

/// Nothing vibrates, or nothing undamped, or nothing at 3 to 12 steps a period.
TEST(Bdf, keeps_order_3_elsewhere) {
  const auto order = [](scene::Scene scene) {
    scene.expected.clear();
    scene.analysis.integrator = scene::Integrator::bdf;
    scene.analysis.end_time = 5.0 * scene.analysis.step_size;
    const Outcome run = support::run(scene);
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    for (const auto& [pointer, value] : run.summary.options)
      if (pointer == "analysis/bdf_order") return value;
    return std::string("none");
  };
  const auto mass_on_spring = [](const std::string& damping, double step) {
    return support::scene_of(R"({
      "bodies": [{"name": "mass", "mass": 1, "inertia": [1, 1, 1]}],
      "bushings": [{"name": "spring", "first": "ground", "second": "mass", "stiffness": [100, 100, 100, 100, 100, 100],
                    "damping": )" +
                             damping + R"(}],
      "initial_velocities": [{"of": "mass", "velocity": [1, 0, 0]}],
      "sensors": [{"name": "x", "kind": "position", "at": "mass"}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": )" +
                             support::text(step) + "}}");
  };
  const double period = 2.0 * 3.141592653589793 / 10.0;
  for (const double steps : {3.5, 6.0, 11.0})
    EXPECT_EQ(order(mass_on_spring("[0, 0, 0, 0, 0, 0]", period / steps)), "2") << steps;
  for (const double steps : {1.0, 2.5, 14.0, 100.0})
    EXPECT_EQ(order(mass_on_spring("[0, 0, 0, 0, 0, 0]", period / steps)), "3") << steps;
  EXPECT_EQ(order(mass_on_spring("[2, 2, 2, 2, 2, 2]", period / 6.0)), "3") << "a tenth of the critical damping";
  EXPECT_EQ(order(mass_on_spring("[1, 1, 1, 1, 1, 1]", period / 6.0)), "2") << "a twentieth";
  EXPECT_EQ(order(support::gallery("heavy_top")), "3");
  EXPECT_EQ(order(support::gallery("gyroscope_on_turntable")), "3");
}

TEST(Bdf, knows_frames_that_move) {
  const auto tilt = [](const std::string& integrator, double h) {
    scene::Scene scene = support::gallery("gyroscope_on_turntable",
                                          {"/analysis/integrator=\"" + integrator + "\"", "/analysis/end_time=0.2"});
    scene.analysis.step_size = h;
    scene.analysis.tolerance = 1e-11;
    const Outcome run = support::run(scene);
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    return run.summary.final_values;
  };
  const auto reference = tilt("generalized_alpha", 1e-5), coarse = tilt("bdf", 1e-3), fine = tilt("bdf", 5e-4);
  double a = 0.0, b = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double scale = std::max(1.0, std::abs(reference[i]));
    a = std::max(a, std::abs(coarse[i] - reference[i]) / scale);
    b = std::max(b, std::abs(fine[i] - reference[i]) / scale);
  }
  std::printf("| gyroscope on a turntable, all sensors | %.1e, %.1e, order %.2f |\n", a, b, support::order_of(a, b));
  EXPECT_GT(support::order_of(a, b), 2.5);
}

}  // namespace
}  // namespace bough::run
