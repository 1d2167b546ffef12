// Stability of equilibria: critical loads by the inertia of the tangent against closed forms, and what a run says of
// them.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "bough/run/memory_run.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/step/find_equilibrium.hpp"
#include "bough/step/flutter.hpp"
#include "bough/step/stability.hpp"
#include "stability_scenes.hpp"

namespace bough::verify {
namespace {

const records::Doubt* doubt_of(const records::Summary& s) {
  for (const records::Doubt& d : s.doubts)
    if (d.about == "stability") return &d;
  return nullptr;
}

/// Where `is_unstable` changes, between a load at which it does not hold and one at which it does.
double bisect(double stable, double unstable, const std::function<bool(double)>& is_unstable) {
  for (int k = 0; k < 26; ++k) {
    const double middle = 0.5 * (stable + unstable);
    (is_unstable(middle) ? unstable : stable) = middle;
  }
  return 0.5 * (stable + unstable);
}

/// Directions in the plane. is_known: loads that follow may make vibrations grow, which is not known without masses.
int unstable_at(const scene::Scene& scene, bool is_known = true) {
  const support::Outcome run = support::run(scene);
  EXPECT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_EQ(run.summary.stability->is_known, is_known || run.summary.stability->unstable_directions > 0);
  return run.summary.stability->unstable_directions;
}

constexpr const char* one_step = R"("tolerance": 1e-11)";

// Eight elements of order 2 are off by 1e-7 of these loads (order 4 in the length of an element).
TEST(Stability, critical_load_of_a_clamped_column_is_the_closed_form) {
  const double load = bisect(2.0, 3.0, [](double p) { return unstable_at(clamped_column(p, one_step)) > 0; });
  std::printf("| clamped column, L/h = 20 | %.9f, closed form 2.464718048 |\n", load);
  EXPECT_NEAR(load, 2.46471804812228, 2e-6 * load);
}

TEST(Stability, critical_loads_of_a_hinged_column_with_its_joints_are_the_closed_forms) {
  const double first = bisect(8.0, 12.0, [](double p) { return unstable_at(hinged_column(p, one_step)) > 0; });
  EXPECT_NEAR(first, 9.826953089652771, 2e-5 * first);
  // P (1 + P (1 / GA - 1 / EA)) = 4 pi^2
  const double flexible = (3.12 - 1.0) / 4800.0, right = 4.0 * 9.869604401089358;
  const double exact = 2.0 * right / (1.0 + std::sqrt(1.0 + 4.0 * flexible * right));
  const double second = bisect(20.0, 50.0, [](double p) { return unstable_at(hinged_column(p, one_step)) > 1; });
  EXPECT_NEAR(second, exact, 2e-4 * second);
}

TEST(Stability, a_column_is_doubted_above_its_critical_load_and_not_below) {
  const support::Outcome below = support::run(clamped_column(0.999 * 2.464718, R"("load_steps": 4)"));
  ASSERT_TRUE(below.ok()) << below.summary.cause;
  EXPECT_EQ(doubt_of(below.summary), nullptr);
  EXPECT_TRUE(below.summary.stability->is_known);
  const support::Outcome above = support::run(clamped_column(1.001 * 2.464718, R"("load_steps": 4)"));
  ASSERT_NE(doubt_of(above.summary), nullptr);
  EXPECT_NE(doubt_of(above.summary)->text.find("'tip' moves most, along (0, 1, 0)"), std::string::npos)
      << doubt_of(above.summary)->text;
  ASSERT_TRUE(above.summary.stability->first_lost);
  EXPECT_EQ(above.summary.stability->first_lost->before, 0.75);
  EXPECT_EQ(above.summary.stability->first_lost->after, 1.0);
}

TEST(Stability, a_column_at_three_times_its_critical_load_is_doubted_unless_that_is_declared) {
  const support::Outcome run = support::run(clamped_column(3.0 * 2.464718, R"("load_steps": 10)"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  ASSERT_NE(doubt_of(run.summary), nullptr);
  EXPECT_EQ(run.summary.stability->unstable_directions, 1);
  const auto told = std::count_if(run.summary.doubts.begin(), run.summary.doubts.end(),
                                  [](const records::Doubt& d) { return d.about == "stability"; });
  EXPECT_EQ(told, 1) << "in the plane and out of it at once";
  for (const char* part :
       {"in one direction", "along (0, 1, 0)", "out of its plane", "the largest load is 'press', 7.39 N at 'tip'"})
    EXPECT_NE(doubt_of(run.summary)->text.find(part), std::string::npos) << part << ": " << doubt_of(run.summary)->text;
  const double critical = 1.0 / 3.0;
  EXPECT_LT(run.summary.stability->first_lost->before, critical + 1e-6);
  EXPECT_GT(run.summary.stability->first_lost->after, critical - 1e-6);
  const support::Outcome declared =
      support::run(clamped_column(3.0 * 2.464718, R"("load_steps": 10, "unstable": true)"));
  EXPECT_EQ(doubt_of(declared.summary), nullptr);
  EXPECT_EQ(declared.summary.stability->unstable_directions, 1);
}

TEST(Stability, a_column_that_bends_aside_is_stable_and_not_doubted) {
  const support::Outcome run = support::run(clamped_column(1.5 * 2.464718, R"("load_steps": 30)", 0.01));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_GT(std::abs(run.history.last("tip.y")), 0.3);
  EXPECT_TRUE(run.summary.stability->is_known);
  EXPECT_EQ(run.summary.stability->unstable_directions, 0);
  EXPECT_EQ(doubt_of(run.summary), nullptr);
}

// The strong axis is 1e4 times as stiff: the load of the closed form, for which it is rigid, is met to 1e-4.
TEST(Stability, a_strip_in_the_plane_of_its_load_is_doubted_where_it_buckles_out_of_it) {
  const double critical = 4.01259934357890083;
  const auto hidden_at = [](double load) {
    const support::Outcome run = support::run(strip(load, 1e4, one_step));
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    EXPECT_EQ(run.summary.stability->unstable_directions, 0) << "in the plane";
    EXPECT_EQ(run.summary.stability->hidden.empty(), doubt_of(run.summary) == nullptr);
    return !run.summary.stability->hidden.empty();
  };
  const double load = bisect(3.0, 5.0, hidden_at);
  std::printf("| strip, lateral torsional buckling | %.6f, closed form 4.012599 |\n", load);
  EXPECT_NEAR(load, critical, 1e-3 * critical);
  const support::Outcome run = support::run(strip(1.2 * critical, 1e4, one_step));
  EXPECT_NE(doubt_of(run.summary)->text.find("out of its plane"), std::string::npos);
  EXPECT_NE(doubt_of(run.summary)->text.find("'tip' moves most, along (0, 1, 0)"), std::string::npos)
      << doubt_of(run.summary)->text;
}

TEST(Stability, loads_that_follow_are_judged_by_the_sign_of_the_determinant) {
  // On a sliding hinge the part across goes into the guide: the load of Euler. On a free end (Beck) nothing diverges,
  // and flutter is not seen.
  const std::string follows = R"(, "axes": "body")";
  const double load = bisect(8.0, 12.0, [&](double p) {
    return unstable_at(hinged_column(p, std::string(one_step) + R"(, "max_iterations": 40)", follows), false) > 0;
  });
  EXPECT_NEAR(load, 9.826953089652771, 2e-5 * load);
  const support::Outcome beck = support::run(clamped_column(15.0, R"("load_steps": 4)", 0.0, follows));
  ASSERT_TRUE(beck.ok()) << beck.summary.cause;
  EXPECT_EQ(doubt_of(beck.summary), nullptr);
  EXPECT_NE(beck.summary.stability->not_conservative.find("'press' follows rotations"), std::string::npos);
}

/// Windows of four bars that hang in a row, their first bar pushed by a load that follows it.
scene::Scene windows(int count) {
  const auto body = [](const std::string& name, double mass, double inertia, double x, double z) {
    const std::string I = support::text(inertia);
    return R"({"name": ")" + name + R"(", "mass": )" + support::text(mass) + R"(, "inertia": [)" + I + ", " + I + ", " +
           I + R"(], "position": [)" + support::text(x) + ", 0, " + support::text(z) + "]}";
  };
  const auto hinge = [](const std::string& first, const std::string& second, double x, double z) {
    return R"({"name": ")" + first + " to " + second + R"(", "kind": "revolute", "first": ")" + first +
           R"(", "second": ")" + second + R"(", "position": [)" + support::text(x) + ", 0, " + support::text(z) +
           R"(], "axis": [0, 1, 0]})";
  };
  std::string bodies = body("crank 0", 1.0, 0.1, 0.0, -0.5), joints = hinge("ground", "crank 0", 0.0, 0.0);
  for (int k = 0; k < count; ++k) {
    const std::string crank = "crank " + std::to_string(k), next = "crank " + std::to_string(k + 1),
                      bar = "bar " + std::to_string(k);
    bodies += ", " + body(next, 1.0, 0.1, 2.0 * k + 2.0, -0.5) + ", " + body(bar, 3.0, 1.0, 2.0 * k + 1.0, -1.0);
    joints += ", " + hinge("ground", next, 2.0 * k + 2.0, 0.0) + ", " + hinge(crank, bar, 2.0 * k, -1.0) + ", " +
              hinge(next, bar, 2.0 * k + 2.0, -1.0);
  }
  return support::scene_of(R"({"gravity": [0, 0, -9.81], "bodies": [)" + bodies + R"(], "joints": [)" + joints +
                           R"(], "loads": [{"name": "push", "at": "bar 0", "axes": "body", "force": [0, 1, -5]}],
                              "analysis": {"kind": "modes"}})");
}

/// Bodies have no stiffness of their own, and rows of loops in space depend on each other: the factor of the tangent tells
/// of no fault and gives forces that are not those asked for.
TEST(Stability, the_factor_of_bodies_that_joints_alone_hold_is_tried_before_it_is_read) {
  for (const int count : {2, 3, 5, 8}) {
    const scene::Scene scene = windows(count);
    const plan::Plan plan = plan::make_plan(scene);
    step::System system(plan, scene.solver, schedule::make_serial_walker());
    step::State state = step::make_initial_state(plan);
    ASSERT_TRUE(step::find_equilibrium(system, state, step::make_step_options(scene.analysis), 1e-3).found);
    step::Linearisation linear(system);
    ASSERT_FALSE(linear.take(state));
    EXPECT_TRUE(linear.factor({}, solve::Symmetry::general).ok());
    EXPECT_FALSE(linear.factor_soundly({}, solve::Symmetry::general));
    EXPECT_TRUE(linear.factor_soundly({.mass = 1e-3 * linear.fastest()}, solve::Symmetry::general));
    const std::optional<step::Flutter> flutter = step::find_flutter(system, state);
    ASSERT_TRUE(flutter.has_value());
    EXPECT_FALSE(flutter->is_there) << flutter->frequency << " rad/s, growing by " << flutter->growth;
  }
}

TEST(Stability, joints_without_a_load_are_stable_and_rows_that_depend_are_not_counted) {
  // In space, guided twice.
  scene::Scene scene = hinged_column(9.0, one_step);
  scene.without = {"planar"};
  scene.joints.push_back(scene.joints.back());
  scene.joints.back().name = "second guide";
  const support::Outcome run = support::run(scene);
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_TRUE(run.summary.stability->is_known);
  EXPECT_EQ(run.summary.stability->unstable_directions, 0);
  double dependent = 0.0;
  for (const auto& [name, value] : run.summary.solver)
    if (name == "dependent_rows") dependent = value;
  EXPECT_EQ(dependent, 5.0);
  scene.point_loads[0].force = 1.2 * scene.point_loads[0].force;
  EXPECT_EQ(unstable_at(scene), 1) << "out of the plane it is clamped at both ends";
}

/// Negative eigenvalues of K on ker G by dense algebra, from the tangents of a system that are present.
int dense_unstable(const step::System& system) {
  const auto n = static_cast<Eigen::Index>(system.linear().tree().num_unknowns());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  std::vector<std::int64_t> unknowns;
  for (int e = 0; e < system.plan().graph.num_elements(); ++e) {
    const solve::ConstElementView a = system.elements().matrix_of(e, unknowns);
    const std::size_t size = unknowns.size();
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j < size; ++j) {
        const double half = 0.5 * a[static_cast<std::int64_t>(i * size + j)];
        A(unknowns[i], unknowns[j]) += half;
        A(unknowns[j], unknowns[i]) += half;
      }
  }
  const blocks::BlockGraph& g = system.plan().graph;
  std::vector<Eigen::Index> motion, rows;
  for (int b = 0; b < g.num_blocks(); ++b)
    for (std::int64_t u = system.places().block_begin(b); u < system.places().block_begin(b + 1); ++u)
      (g.block_kind[static_cast<std::size_t>(b)] == blocks::BlockKind::motion ? motion : rows).push_back(u);
  Eigen::MatrixXd K = A(motion, motion), G = A(rows, motion);
  const Eigen::VectorXd scale = K.diagonal().cwiseAbs().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
  K = scale.asDiagonal() * K * scale.asDiagonal();
  G = G * scale.asDiagonal();
  for (Eigen::Index i = 0; i < G.rows(); ++i) G.row(i) /= G.row(i).norm();
  Eigen::MatrixXd kernel = Eigen::MatrixXd::Identity(K.rows(), K.cols());
  if (G.rows() > 0) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(G, Eigen::ComputeFullV);
    kernel = svd.matrixV().rightCols(K.cols() - (svd.singularValues().array() > 1e-9).count());
  }
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(kernel.transpose() * K * kernel).eigenvalues();
  EXPECT_GT(values.cwiseAbs().minCoeff(), 1e-11) << "too near to a critical load for a comparison";
  return static_cast<int>((values.array() < 0.0).count());
}

TEST(Stability, counts_what_dense_eigenvalues_count) {
  std::vector<scene::Scene> scenes;
  for (const double load : {5.0, 12.0, 45.0, 120.0})
    for (const bool twice : {false, true}) {
      scenes.push_back(hinged_column(load, one_step));
      if (twice) {
        scenes.back().without = {"planar"};
        scenes.back().joints.push_back(scenes.back().joints.back());
        scenes.back().joints.back().name = "second guide";
      }
    }
  for (const double load : {2.0, 8.0, 40.0}) {
    scenes.push_back(clamped_column(load, one_step));
    scenes.push_back(clamped_column(load, one_step));
    scenes.back().without = {"planar", "held"};
  }
  scenes.push_back(strip(3.0, 50.0, R"("load_steps": 4)", 1e-3));
  scenes.push_back(right_angle_frame(1.5, 1e-3, R"("load_steps": 4)"));
  int different = 0;
  for (const scene::Scene& scene : scenes) {
    run::SimulateOptions options;
    int dense = -1, close = -1;
    options.after_run = [&](step::System& system, const step::State& state) {
      ASSERT_FALSE(system.set_time(state.time).has_value());
      ASSERT_FALSE(system.evaluate(state, {}, true).has_value());
      dense = dense_unstable(system);
      close = step::Stability(system).look_closely().unstable;
    };
    const run::MemoryRun run = run::run_in_memory(scene, options);
    ASSERT_EQ(run.summary.status, records::RunStatus::ok) << run.summary.cause;
    EXPECT_TRUE(run.summary.stability->is_known);
    EXPECT_EQ(run.summary.stability->unstable_directions, dense);
    EXPECT_EQ(close, dense);
    different += dense > 1 ? 1 : 0;
  }
  EXPECT_GT(different, 3);
}

}  // namespace
}  // namespace bough::verify
