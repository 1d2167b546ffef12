/// Modes of undamped structures and mechanisms against closed forms, a transfer matrix, runs in time and dense
/// eigenvalues.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "bough/schedule/serial.hpp"
#include "bough/step/advance.hpp"
#include "bough/step/find_equilibrium.hpp"
#include "bough/step/modes.hpp"
#include "modes_scenes.hpp"

namespace bough::verify {
namespace {

using support::scene_of;
using support::text;

/// A straight Timoshenko beam of length 1 in one plane, (y, theta, M / EI, Q / EI) along it:
///   y' = theta + Q / GA,  theta' = M / EI,  M' = -Q - rho I w^2 theta,  Q' = -rho A w^2 y
struct Timoshenko {
  double EI, GA, m, J;
  /// 0 at frequencies of a beam that is free at 1, and clamped or free at 0.
  double condition(double w, bool is_clamped) const {
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    A(0, 1) = 1.0;
    A(0, 3) = EI / GA;
    A(1, 2) = 1.0;
    A(2, 3) = -1.0;
    A(2, 1) = -J / EI * w * w;
    A(3, 0) = -m / EI * w * w;
    const Eigen::Matrix4d T = A.exp();
    return is_clamped ? T.bottomRightCorner<2, 2>().determinant() : T.bottomLeftCorner<2, 2>().determinant();
  }
  std::vector<double> frequencies(std::size_t count, bool is_clamped, double step) const {
    std::vector<double> found;
    for (double a = step; found.size() < count; a += step) {
      double low = a, high = a + step;
      if ((condition(low, is_clamped) < 0.0) == (condition(high, is_clamped) < 0.0)) continue;
      for (int k = 0; k < 80; ++k) {
        const double middle = 0.5 * (low + high);
        ((condition(low, is_clamped) < 0.0) == (condition(middle, is_clamped) < 0.0) ? low : high) = middle;
      }
      found.push_back(0.5 * (low + high));
    }
    return found;
  }
};

/// The section of `bar` with a shear coefficient of its own, as numbers.
constexpr double E = 2.1e11, rho = 7850.0, area = 0.01, inertia = 1e-4 / 12.0, GA = E / 2.6 * area * 5.0 / 6.0;
const Timoshenko steel{E * inertia, GA, rho* area, rho* inertia};

std::string numbered_bar() {
  return R"("sections": [{"name": "bar", "stiffness": {"EA": )" + text(E * area) + R"(, "GA2": )" + text(GA) +
         R"(, "GA3": )" + text(GA) + R"(, "GJ": 1e6, "EI2": )" + text(E * inertia) + R"(, "EI3": )" +
         text(E * inertia) + R"(}, "mass": {"mass_per_length": )" + text(rho * area) + R"(, "rotary": [)" +
         text(2.0 * rho * inertia) + ", " + text(rho * inertia) + ", " + text(rho * inertia) + "]}}],";
}

scene::Scene cantilever(int elements, int order, const std::string& analysis) {
  return scene_of("{" + numbered_bar() + R"(
    "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "arm", "section": "bar", "start": "root", "end": "tip", "elements": )" +
                  std::to_string(elements) + R"(, "order": )" + std::to_string(order) + R"(}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
    "analysis": {"kind": "modes", )" +
                  analysis + "}}");
}

TEST(Modes, frequencies_of_a_timoshenko_cantilever_converge_with_orders_two_four_six) {
  const std::vector<double> exact = steel.frequencies(3, true, 50.0);
  EXPECT_NEAR(exact[0], 520.8406417, 1e-7);
  EXPECT_NEAR(exact[1], 3121.5777654, 1e-6);
  EXPECT_NEAR(exact[2], 8210.226133, 1e-5);
  for (int order = 1; order <= 3; ++order) {
    const int coarse_mesh = order == 3 ? 8 : 16;  // whose errors are of one sign
    const ModesSeen coarse(cantilever(coarse_mesh, order, R"("count": 5)")),
        fine(cantilever(2 * coarse_mesh, order, R"("count": 5)"));
    EXPECT_LT(fine.largest_residual(), 1e-9);
    EXPECT_TRUE(fine.says("None is missing"));
    const std::vector<double> w1 = coarse.frequencies(), w2 = fine.frequencies();
    ASSERT_GE(w2.size(), 5U);
    EXPECT_NEAR(w2[0], w2[1], 1e-9 * w2[0]);  // both planes
    const double p = support::order_of(std::abs(w1[2] - exact[1]), std::abs(w2[2] - exact[1]));
    std::printf("| cantilever, order %d | %.9f %.9f, error %.1e | order of the frequency %.2f |\n", order, w2[0], w2[2],
                std::abs(w2[2] / exact[1] - 1.0), p);
    EXPECT_NEAR(p, 2.0 * order, 0.35);
  }
  const std::vector<double> best = ModesSeen(cantilever(16, 3, R"("count": 5)")).frequencies();
  EXPECT_NEAR(best[0], exact[0], 1e-9 * exact[0]);
  EXPECT_NEAR(best[2], exact[1], 2e-9 * exact[1]);
}

TEST(Modes, a_free_beam_has_six_rigid_modes_with_their_names_and_its_vibrations) {
  const std::vector<double> exact = steel.frequencies(2, false, 50.0);
  const ModesSeen seen(scene_of("{" + numbered_bar() + R"(
    "nodes": [{"name": "a", "position": [3, 0, 0]}, {"name": "b", "position": [4, 0, 0]}],
    "beams": [{"name": "bar", "section": "bar", "start": "a", "end": "b", "elements": 24, "order": 3}],
    "analysis": {"kind": "modes", "about": "start", "count": 4}})"));
  ASSERT_EQ(seen.count_of("rigid"), 6U);
  const char* const names[] = {"translation x",    "translation y",    "translation z",
                               "rotation about x", "rotation about y", "rotation about z"};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(seen.text(k, "what"), names[k]);
  EXPECT_TRUE(seen.says("None is missing")) << seen.outcome.summary.tables.front().about;
  EXPECT_LT(seen.largest_residual(), 1e-8);
  const std::vector<double> w = seen.frequencies();
  ASSERT_EQ(w.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(w[k], exact[k / 2], 1e-8 * exact[k / 2]);
  // All of the mass, and the inertia about the centre, are in the rigid modes.
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i) sum += seen.number(i, "effective_mass_" + axis);
    EXPECT_NEAR(sum, rho * area, 1e-7 * rho * area);
  }
}

TEST(Modes, modes_next_to_a_shift_are_those_of_the_whole_list) {
  const std::vector<double> all = ModesSeen(cantilever(12, 2, R"("count": 20)")).frequencies();
  const double middle = 0.5 * (all[9] + all[8]);
  const ModesSeen near(cantilever(12, 2, R"("count": 4, "shift": )" + text(middle / (2.0 * std::numbers::pi))));
  EXPECT_TRUE(near.says("None is missing"));
  for (const double w : near.frequencies()) {
    double away = 1e300;
    for (const double other : all) away = std::min(away, std::abs(w - other));
    EXPECT_LT(away, 1e-9 * w);
  }
  EXPECT_GE(near.frequencies().size(), 4U);
}

TEST(Modes, hanging_pendulums_swing_as_their_closed_forms_and_are_named) {
  const char* const rods =
      R"("bodies": [{"name": "one", "mass": 2, "inertia": [0.2, 0.2, 1e-3], "position": [0, 0, -0.5]},
                                        {"name": "two", "mass": 2, "inertia": [0.2, 0.2, 1e-3], "position": [0, 0, -1.5]}],)";
  const ModesSeen seen(scene_of(std::string(R"({"gravity": [0, 0, -9.81], )") + rods + R"(
    "joints": [{"name": "top", "kind": "revolute", "first": "ground", "second": "one", "position": [0, 0, 0], "axis": [0, 1, 0]},
               {"name": "knee", "kind": "revolute", "first": "one", "second": "two", "position": [0, 0, -1], "axis": [0, 1, 0]}],
    "analysis": {"kind": "modes", "about": "equilibrium"}})"));
  // M = [I + m/4 + m, m/2; m/2, I + m/4], K = diag(3/2, 1/2) m g for rods of length 1 and both angles from below
  const double m = 2.0, I = 0.2, g = 9.81;
  Eigen::Matrix2d M, K;
  M << I + 1.25 * m, 0.5 * m, 0.5 * m, I + 0.25 * m;
  K << 1.5 * m * g, 0.0, 0.0, 0.5 * m * g;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> exact(K, M);
  const std::vector<double> w = seen.frequencies();
  ASSERT_EQ(w.size(), 2U);
  for (int k = 0; k < 2; ++k)
    EXPECT_NEAR(w[static_cast<std::size_t>(k)], std::sqrt(exact.eigenvalues()[k]), 1e-10 * w[1]);
  EXPECT_TRUE(seen.says("None is missing"));
  EXPECT_EQ(seen.text(0, "what").substr(0, 5), "'two'");
  const ModesSeen loose(scene_of(std::string("{") + rods + R"(
    "joints": [{"name": "top", "kind": "revolute", "first": "ground", "second": "one", "position": [0, 0, 0], "axis": [0, 1, 0]},
               {"name": "knee", "kind": "spherical", "first": "one", "second": "two", "position": [0, 0, -1]}],
    "analysis": {"kind": "modes", "about": "start"}})"));
  EXPECT_EQ(loose.count_of("rigid"), 4U);
  EXPECT_EQ(loose.text(0, "what").substr(0, 17), "rotation of joint");
}

TEST(Modes, a_parallelogram_whose_rows_depend_on_each_other_swings_as_its_closed_form) {
  const ModesSeen seen(scene_of(R"({"gravity": [0, 0, -9.81],
    "bodies": [{"name": "left", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 0, -0.5]},
               {"name": "right", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [2, 0, -0.5]},
               {"name": "bar", "mass": 3, "inertia": [1, 1, 1], "position": [1, 0, -1]}],
    "joints": [{"name": "a", "kind": "revolute", "first": "ground", "second": "left", "position": [0, 0, 0], "axis": [0, 1, 0]},
               {"name": "b", "kind": "revolute", "first": "ground", "second": "right", "position": [2, 0, 0], "axis": [0, 1, 0]},
               {"name": "c", "kind": "revolute", "first": "left", "second": "bar", "position": [0, 0, -1], "axis": [0, 1, 0]},
               {"name": "d", "kind": "revolute", "first": "right", "second": "bar", "position": [2, 0, -1], "axis": [0, 1, 0]}],
    "analysis": {"kind": "modes"}})"));
  const std::vector<double> w = seen.frequencies();
  ASSERT_EQ(w.size(), 1U);
  EXPECT_NEAR(w[0], std::sqrt((0.5 + 0.5 + 3.0) * 9.81 / (2.0 * (0.1 + 0.25) + 3.0)), 1e-9 * w[0]);
  EXPECT_TRUE(seen.says("None is missing"));
}

TEST(Modes, an_inverted_pendulum_is_found_unstable_and_a_state_out_of_balance_is_doubted) {
  const auto pendulum = [](const std::string& place, const std::string& about) {
    return scene_of(R"({"gravity": [0, 0, -9.81],
      "bodies": [{"name": "rod", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": )" +
                    place + R"(}],
      "joints": [{"name": "top", "kind": "revolute", "first": "ground", "second": "rod", "position": [0, 0, 0], "axis": [0, 1, 0]}],
      "analysis": {"kind": "modes", "about": ")" +
                    about + "\"}}");
  };
  const ModesSeen up(pendulum("[0, 0, 0.5]", "start"));
  ASSERT_EQ(up.count(), 1U);
  EXPECT_EQ(up.text(0, "kind"), "growth");
  EXPECT_NEAR(up.number(0, "real_part"), std::sqrt(0.5 * 9.81 / 0.35), 1e-9);
  EXPECT_TRUE(up.outcome.summary.doubts.empty());
  const ModesSeen aside(pendulum("[0.5, 0, 0]", "start"));
  ASSERT_FALSE(aside.outcome.summary.doubts.empty());
  EXPECT_EQ(aside.outcome.summary.doubts.front().about, "state");
  const ModesSeen hangs(pendulum("[0.5, 0, 0]", "equilibrium"));
  EXPECT_TRUE(hangs.outcome.summary.doubts.empty());
  EXPECT_NEAR(hangs.frequencies().at(0), std::sqrt(0.5 * 9.81 / 0.35), 1e-8);
}

/// A weight on a strip that it bends far: the period of small oscillations, after a push beside the equilibrium.
TEST(Modes, a_mode_about_a_bent_equilibrium_is_the_small_oscillation_of_a_run) {
  const auto scene = [](const std::string& more) {
    return scene_of(R"({"gravity": [0, 0, -9.81],
      "sections": [{"name": "strip", "stiffness": {"EA": 1e5, "GA2": 4e4, "GA3": 4e4, "GJ": 20, "EI2": 10, "EI3": 10},
                    "mass": {"mass_per_length": 1e-3, "rotary": [2e-7, 1e-7, 1e-7]}}],
      "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
      "bodies": [{"name": "weight", "mass": 2, "inertia": [1e-5, 1e-5, 1e-5], "position": [1, 0, 0]}],
      "beams": [{"name": "strip", "section": "strip", "start": "root", "end": "tip", "axis_2": [0, 1, 0], "elements": 6, "order": 2}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"},
                 {"name": "grip", "kind": "fixed", "first": "tip", "second": "weight"}],
      "sensors": [{"name": "weight", "kind": "position", "at": "weight"}],)" +
                    more + "}");
  };
  const ModesSeen modes(scene(R"("analysis": {"kind": "modes", "count": 3})"));
  // The slowest mode that moves the weight along y.
  double w = 0.0;
  for (std::size_t k = modes.count(); k-- > 0;)
    if (modes.number(k, "effective_mass_y") > 1.0) w = modes.number(k, "angular_frequency");
  ASSERT_GT(w, 0.0);
  const support::Outcome run = support::run_ok(scene(
      R"("initial_velocities": [{"of": "weight", "velocity": [0, 1e-4, 0]}],
         "analysis": {"kind": "dynamic", "start": "equilibrium", "end_time": 60, "step_size": 5e-3, "spectral_radius": 0.5})"));
  const std::vector<double> y = run.history.of("weight.y");
  std::vector<double> crossings;
  for (std::size_t k = 1; k < y.size(); ++k)
    if (y[k - 1] < 0.0 && y[k] >= 0.0)
      crossings.push_back(run.history.times[k - 1] +
                          (run.history.times[k] - run.history.times[k - 1]) * y[k - 1] / (y[k - 1] - y[k]));
  ASSERT_GT(crossings.size(), 10U);
  const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  const double rigid = 2.0 * std::numbers::pi / w;
  std::printf("| weight on a bent strip | mode %.9f s, run %.9f s |\n", rigid, period);
  EXPECT_NEAR(period, rigid, 2e-4 * rigid);
}

/// Eigenvalues of K x = w^2 M x on the kernel of G, dense: the slowest ones.
std::vector<double> dense_squares(const step::Linearisation& linear) {
  using Part = step::Linearisation::Part;
  const auto n = static_cast<Eigen::Index>(linear.size());
  Eigen::MatrixXd K(n, n), M(n, n);
  std::vector<double> unit(linear.size(), 0.0), column(linear.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    unit[static_cast<std::size_t>(j)] = 1.0;
    linear.multiply(Part::stiffness, unit, column);
    K.col(j) = Eigen::Map<Eigen::VectorXd>(column.data(), n);
    linear.multiply(Part::mass, unit, column);
    M.col(j) = Eigen::Map<Eigen::VectorXd>(column.data(), n);
    unit[static_cast<std::size_t>(j)] = 0.0;
  }
  std::vector<Eigen::Index> motions, rows;
  for (Eigen::Index i = 0; i < n; ++i)
    (linear.weights()[static_cast<std::size_t>(i)] > 0.0 ? motions : rows).push_back(i);
  const Eigen::MatrixXd G = K(rows, motions);
  Eigen::MatrixXd Z =
      Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(motions.size()), static_cast<Eigen::Index>(motions.size()));
  if (!rows.empty()) Z = Eigen::FullPivLU<Eigen::MatrixXd>(G).setThreshold(1e-9).kernel();
  const Eigen::MatrixXd Kr = Z.transpose() * K(motions, motions) * Z, Mr = Z.transpose() * M(motions, motions) * Z;
  // 1 / (w^2 + s) are accurate where w^2 is small beside the largest.
  constexpr double s = 1e4;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      0.5 * (Mr + Mr.transpose()), 0.5 * (Kr + Kr.transpose()) + s * 0.5 * (Mr + Mr.transpose()));
  std::vector<double> squares;
  for (Eigen::Index k = Kr.rows(); k-- > 0;) squares.push_back(1.0 / solver.eigenvalues()[k] - s);
  return squares;
}

/// Frames of beams between random places, some ends clamped, loops, hinges in them and bodies at nodes.
std::string random_frame(unsigned seed) {
  auto any = [next = 88172645463325252ULL + 7919ULL * seed]() mutable {
    next ^= next << 13;
    next ^= next >> 7;
    next ^= next << 17;
    return static_cast<double>(next % 10000) / 10000.0;
  };
  const int count = 4 + static_cast<int>(4.0 * any());
  std::string nodes, beams, joints, bodies;
  const auto add = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
  for (int k = 0; k < count; ++k)
    add(nodes, R"({"name": "n)" + std::to_string(k) + R"(", "position": [)" + text(k + 0.3 * any()) + ", " +
                   text(any()) + ", " + text(any()) + "]}");
  const auto beam = [&](int a, int b) {
    add(beams, R"({"name": "b)" + std::to_string(a) + "-" + std::to_string(b) + R"(", "section": "bar", "start": "n)" +
                   std::to_string(a) + R"(", "end": "n)" + std::to_string(b) +
                   R"(", "axis_2": [0.1, 0.2, 1], "elements": 2})");
  };
  for (int k = 0; k + 1 < count; ++k) beam(k, k + 1);
  for (int k = 0; k + 2 < count; ++k)
    if (any() < 0.5) beam(k, k + 2);
  if (any() < 0.8) add(joints, R"({"name": "clamp", "kind": "fixed", "first": "ground", "second": "n0"})");
  if (any() < 0.6)
    add(joints, R"({"name": "end", "kind": "spherical", "first": "ground", "second": "n)" + std::to_string(count - 1) +
                    R"("})");
  if (any() < 0.6) {
    add(bodies, R"({"name": "mass", "mass": 5, "inertia": [0.1, 0.2, 0.3], "position": [1.5, 2, 0.5]})");
    add(joints,
        R"({"name": "hinge", "kind": "revolute", "first": "n1", "second": "mass", "position": [1.5, 2, 0.5], "axis": [0.3, 0.5, 0.7]})");
    if (any() < 0.5)
      add(joints,
          R"({"name": "again", "kind": "spherical", "first": "n2", "second": "mass", "position": [1.6, 2.1, 0.5]})");
  }
  return "{" + numbered_bar() + R"("nodes": [)" + nodes + R"(], "beams": [)" + beams + R"(], "bodies": [)" + bodies +
         R"(], "joints": [)" + joints + R"(], "analysis": {"kind": "modes", "about": "start", "count": 8}})";
}

TEST(Modes, random_frames_have_the_modes_of_dense_matrices_all_of_them) {
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const scene::Scene scene = scene_of(random_frame(seed));
    const plan::Plan plan = plan::make_plan(scene);
    step::System system(plan, scene.solver, schedule::make_serial_walker());
    step::State state = step::make_initial_state(plan);
    ASSERT_FALSE(system.set_time(0.0));
    ASSERT_TRUE(step::make_consistent(system, state, true, 1e-3).ok);
    step::Linearisation linear(system);
    ASSERT_FALSE(linear.take(state));
    const std::vector<double> exact = dense_squares(linear);
    const step::ModesFound found = step::find_undamped_modes(linear, {8, 0.0});
    ASSERT_TRUE(found.cause.empty()) << seed << ": " << found.cause;
    ASSERT_TRUE(found.missing.has_value()) << seed;
    EXPECT_EQ(*found.missing, 0) << seed;
    ASSERT_LE(found.modes.size(), exact.size());
    ASSERT_GE(found.modes.size(), 8U) << seed;
    const double scale = exact[found.modes.size() - 1];
    for (std::size_t k = 0; k < found.modes.size(); ++k) {
      const double square = std::norm(found.modes[k].eigenvalue);
      worst = std::max(worst, std::abs(square - exact[k]) / scale);
      EXPECT_NEAR(square, exact[k], 1e-8 * scale) << "seed " << seed << ", mode " << k;
      EXPECT_LT(found.modes[k].residual, 1e-8) << "seed " << seed << ", mode " << k;
    }
  }
  std::printf("| 24 random frames | squared frequencies within %.1e of the largest |\n", worst);
}

struct Work {
  long factorizations = 0, solutions = 0;
  step::ModesFound found;
};
Work work_of(const scene::Scene& scene) {
  const plan::Plan plan = plan::make_plan(scene);
  step::System system(plan, scene.solver, schedule::make_serial_walker());
  step::State state = step::make_initial_state(plan);
  EXPECT_FALSE(system.set_time(0.0));
  EXPECT_TRUE(step::find_equilibrium(system, state, step::make_step_options(scene.analysis), 1e-3).found);
  step::Linearisation linear(system);
  EXPECT_FALSE(linear.take(state));
  linear.take_symmetric_part(step::Linearisation::Part::stiffness);
  Work work;
  work.found = step::find_undamped_modes(linear, {10, 0.0});
  work.factorizations = linear.factorizations();
  work.solutions = linear.solutions();
  return work;
}

TEST(Modes, ten_modes_of_a_large_lattice_and_a_long_chain_take_few_factors_and_solutions) {
  scene::Scene lattice =
      support::gallery("lattice", {"/parameters/n=50", "/analysis={\"kind\": \"modes\", \"about\": \"start\"}"});
  for (int i = 0; i < 3; ++i) lattice.sections[0].mass(i, i) = 1.0;
  for (int i = 3; i < 6; ++i) lattice.sections[0].mass(i, i) = 1e-4;
  const Work of_lattice = work_of(lattice);
  std::fflush(stdout);
  std::printf("| lattice 50 x 50 | %ld factorizations, %ld solutions, %zu modes |\n", of_lattice.factorizations,
              of_lattice.solutions, of_lattice.found.modes.size());
  std::string nodes, beams, joints;
  constexpr int links = 2048;
  for (int k = 0; k < links; ++k) {
    const std::string n = std::to_string(k), comma = k > 0 ? ", " : "";
    nodes += comma + R"({"name": "a)" + n + R"(", "position": [0, 0, )" + text(-k) + R"(]}, {"name": "b)" + n +
             R"(", "position": [0, 0, )" + text(-k - 1) + "]}";
    beams += comma + R"({"name": "l)" + n + R"(", "section": "bar", "start": "a)" + n + R"(", "end": "b)" + n +
             R"(", "axis_2": [0, 1, 0], "elements": 1, "order": 1})";
    joints += comma + R"({"name": "h)" + n + R"(", "kind": "revolute", "first": ")" +
              (k > 0 ? "b" + std::to_string(k - 1) : "ground") + R"(", "second": "a)" + n + R"(", "axis": [0, 1, 0]})";
  }
  const Work of_chain = work_of(scene_of(R"({"gravity": [0, 0, -9.81], )" + numbered_bar() + R"("nodes": [)" + nodes +
                                         R"(], "beams": [)" + beams + R"(], "joints": [)" + joints +
                                         R"(], "analysis": {"kind": "modes", "about": "start"}})"));
  std::printf("| chain of 2048 | %ld factorizations, %ld solutions, %zu modes |\n", of_chain.factorizations,
              of_chain.solutions, of_chain.found.modes.size());
  for (const Work* work : {&of_lattice, &of_chain}) {
    EXPECT_TRUE(work->found.cause.empty()) << work->found.cause;
    EXPECT_GE(work->found.modes.size(), 10U);
    ASSERT_TRUE(work->found.missing.has_value());
    EXPECT_EQ(*work->found.missing, 0);
    EXPECT_LE(work->factorizations, 3);
    EXPECT_LE(work->solutions, 80);
    for (const step::Mode& mode : work->found.modes) EXPECT_LT(mode.residual, 1e-8);
  }
}

}  // namespace
}  // namespace bough::verify
