// Rigid mechanisms against closed forms and independent high-precision integrations: the error falls with h^2 in every
// quantity, and Richardson extrapolation meets the reference to 1e-6 of the quantity's largest value.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Table;

constexpr double pi = 3.14159265358979323846;

/// A quantity of the run and its reference, each a function of a row of its own table.
struct Quantity {
  std::string name;
  std::function<double(const std::vector<double>&)> of_run, of_reference;
};

std::function<double(const std::vector<double>&)> pick(const Table& t, const std::string& column, double shift = 0.0) {
  return [c = t.column(column), shift](const std::vector<double>& row) { return row[c] + shift; };
}

struct Convergence {
  double coarse = 0.0, fine = 0.0, extrapolated = 0.0, scale = 0.0;  ///< largest errors over time, largest magnitude
  double order() const { return support::order_of(coarse, fine); }
};

Convergence compare(const Quantity& q, const Table& coarse, const Table& fine, const Table& reference, double until) {
  Convergence c;
  for (std::size_t r = 0; r < reference.times.size(); ++r) {
    const double t = reference.times[r];
    if (t <= 0.0 || t > until + 1e-9) continue;
    const double exact = q.of_reference(reference.rows[r]);
    const double a = q.of_run(coarse.rows[coarse.row_at(t)]), b = q.of_run(fine.rows[fine.row_at(t)]);
    c.coarse = std::max(c.coarse, std::abs(a - exact));
    c.fine = std::max(c.fine, std::abs(b - exact));
    c.extrapolated = std::max(c.extrapolated, std::abs(support::extrapolate(a, b) - exact));
    c.scale = std::max(c.scale, std::abs(exact));
  }
  return c;
}

/// Runs at h and h / 2; rows every `stride` steps of the coarse run (1: at every step of both).
struct Pair {
  Table coarse, fine;
  Pair(scene::Scene scene, double h, int stride)
      : coarse(at(scene, h, stride)), fine(at(scene, 0.5 * h, stride == 1 ? 1 : 2 * stride)) {}

 private:
  static Table at(scene::Scene& scene, double h, int stride) {
    scene.analysis.step_size = h;
    scene.analysis.tolerance = 1e-11;  // far below the errors that are looked at
    scene.output.stride = stride;
    scene.expected.clear();
    const support::Outcome outcome = support::run(scene);
    EXPECT_TRUE(outcome.ok()) << outcome.summary.cause;
    return outcome.history;
  }
};

void expect_second_order(const std::string& name, const std::vector<Quantity>& quantities, const Pair& runs,
                         const Table& reference, double until, double bar = 1e-6) {
  for (const Quantity& q : quantities) {
    const Convergence c = compare(q, runs.coarse, runs.fine, reference, until);
    std::printf("| %s | %s | %.2f | %.1e | %.1e |\n", name.c_str(), q.name.c_str(), c.order(), c.fine / c.scale,
                c.extrapolated / c.scale);
    EXPECT_NEAR(c.order(), 2.0, 0.2) << name << ", " << q.name;
    EXPECT_LT(c.extrapolated, bar * c.scale) << name << ", " << q.name;
  }
}

TEST(VerifyMechanisms, pendulum_meets_the_closed_form_in_motion_and_reaction) {
  scene::Scene scene = support::gallery("pendulum");
  scene.sensors.push_back(support::joint_sensor("speed", scene::SensorKind::joint_rate, "hinge"));
  const Table exact = support::reference("A01_pendulum.csv");
  const Pair runs(scene, 1e-3, 100);
  const std::size_t x = exact.column("x"), y = exact.column("y"), rate = exact.column("thetadot");
  // Force of the hinge on the bob: tension towards the hinge, T = m (theta'^2 L - g y / L) with L = 1.
  const auto tension = [rate, y](const std::vector<double>& row) { return row[rate] * row[rate] - 9.81 * row[y]; };
  expect_second_order(
      "pendulum",
      {{"x", pick(runs.fine, "bob.x"), pick(exact, "x")},
       {"y", pick(runs.fine, "bob.y"), pick(exact, "y")},
       {"angle", pick(runs.fine, "angle", -0.5 * pi), pick(exact, "theta_from_down")},
       {"rate", pick(runs.fine, "speed"), pick(exact, "thetadot")},
       {"reaction x", pick(runs.fine, "hinge force.fx"), [&](const auto& row) { return -tension(row) * row[x]; }},
       {"reaction y", pick(runs.fine, "hinge force.fy"), [&](const auto& row) { return -tension(row) * row[y]; }}},
      runs, exact, 10.0);
}

TEST(VerifyMechanisms, four_bars_pass_flat_positions_on_their_branch) {
  const Table exact = support::reference("A02_fourbar_N2.csv");
  const Pair runs(support::gallery("four_bar_planar"), 2e-3, 50);
  expect_second_order(
      "four-bars, N = 2",
      {{"x", pick(runs.fine, "B0.x"), pick(exact, "B0x")}, {"y", pick(runs.fine, "B0.y"), pick(exact, "B0y")}}, runs,
      exact, 10.0);
  // B0 lies on y = 0 where the bars are flat: a singular instant at 0.714 s, then three a turn; all have been passed.
  int crossings = 0;
  const std::vector<double> height = runs.fine.of("B0.y");
  for (std::size_t k = 1; k < height.size(); ++k) crossings += (height[k] < 0.0) != (height[k - 1] < 0.0) ? 1 : 0;
  EXPECT_GT(crossings, 5);
}

/// The scene with copies of its windows and the one written out by hand name their joints differently, and that is all.
TEST(VerifyMechanisms, windows_by_repeat_give_the_bits_of_those_written_out) {
  const Table hand = support::run(support::gallery("four_bar_planar", {"/analysis/end_time=1"})).history;
  const Table copies = support::run(support::gallery("four_bar_windows", {"/parameters/N=2"})).history;
  ASSERT_EQ(hand.times.size(), 501u);
  EXPECT_EQ(hand.columns, copies.columns);
  EXPECT_EQ(hand.rows, copies.rows);
}

TEST(VerifyMechanisms, andrews_squeezer_meets_minimal_coordinates) {
  const Table exact = support::reference("A03_andrews_iftomm.csv");
  scene::Scene scene = support::gallery("andrews_squeezer");
  scene.sensors.push_back(support::joint_sensor("rate", scene::SensorKind::joint_rate, "O"));
  const Pair runs(scene, 2e-5, 25);
  expect_second_order("Andrews squeezer",
                      {{"beta", pick(runs.fine, "beta", -0.062), pick(exact, "beta")},
                       {"rate", pick(runs.fine, "rate"), pick(exact, "betadot")},
                       {"F x", pick(runs.fine, "F.x"), pick(exact, "Fx")},
                       {"F y", pick(runs.fine, "F.y"), pick(exact, "Fy")}},
                      runs, exact, 0.05);
}

TEST(VerifyMechanisms, bricard_moves_although_its_hinges_depend_on_each_other) {
  const Table exact = support::reference("A04_bricard_square0.1.csv");
  scene::Scene scene = support::gallery("bricard");
  const Pair runs(scene, 1e-3, 1);
  expect_second_order("Bricard",
                      {{"P3 x", pick(runs.fine, "P3.x"), pick(exact, "P3x")},
                       {"P3 y", pick(runs.fine, "P3.y"), pick(exact, "P3y")},
                       {"P3 z", pick(runs.fine, "P3.z"), pick(exact, "P3z")}},
                      runs, exact, 2.0);
}

/// R_ij of a quaternion (scalar first): the same for q and -q.
std::function<double(const std::vector<double>&)> rotation_entry(const Table& t, const std::string& first, int i,
                                                                 int j) {
  return [c = t.column(first), i, j](const std::vector<double>& row) {
    const double w = row[c], *v = row.data() + c + 1;
    const double cross[3][3] = {{0, -v[2], v[1]}, {v[2], 0, -v[0]}, {-v[1], v[0], 0}};
    return 2.0 * (v[i] * v[j] + w * cross[i][j]) + (i == j ? 2.0 * w * w - 1.0 : 0.0);
  };
}

TEST(VerifyMechanisms, heavy_top_meets_euler_in_place_attitude_velocity_and_pivot_force) {
  const Table exact = support::reference("heavytop_fast_BrulsCardona.csv");
  scene::Scene scene = support::gallery("heavy_top");
  const scene::Attachment center{"top", {scene::Mat3::identity(), {{0, 1, 0}}}};
  scene.sensors.push_back(support::point_sensor("velocity", scene::SensorKind::velocity, center));
  scene.sensors.push_back(support::point_sensor("spin", scene::SensorKind::velocity, center, scene::LoadAxes::body));
  scene.sensors.push_back(
      support::point_sensor("attitude", scene::SensorKind::quaternion, {"top", scene::Frame::identity()}));
  const Pair runs(scene, 5e-5, 2000);
  std::vector<Quantity> quantities;
  for (const char* axis : {"x", "y", "z"}) {
    const std::string a = axis;
    quantities.push_back({a, pick(runs.fine, "center." + a), pick(exact, a)});
    quantities.push_back({"v" + a, pick(runs.fine, "velocity.v" + a), pick(exact, "v" + a)});
    quantities.push_back({"pivot force " + a, pick(runs.fine, "pivot force.f" + a), pick(exact, "Fpivot_" + a)});
  }
  quantities.push_back({"spin 1", pick(runs.fine, "spin.wx"), pick(exact, "Om1")});
  quantities.push_back({"spin 3", pick(runs.fine, "spin.wz"), pick(exact, "Om3")});
  for (int i = 0; i < 3; ++i)
    quantities.push_back({"R" + std::to_string(i) + "2", rotation_entry(runs.fine, "attitude.q0", i, 2),
                          rotation_entry(exact, "q0", i, 2)});
  quantities.push_back({"R00", rotation_entry(runs.fine, "attitude.q0", 0, 0), rotation_entry(exact, "q0", 0, 0)});
  expect_second_order("heavy top", quantities, runs, exact, 2.0);
}

TEST(VerifyMechanisms, free_body_tumbles_with_the_period_of_the_elliptic_functions) {
  const Table exact = support::reference("dzhanibekov_J123_eps0.01.csv");
  const Pair runs(support::gallery("free_body"), 1e-2, 40);
  std::vector<Quantity> quantities;
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    quantities.push_back({"w" + axis, pick(runs.fine, "body.w" + axis), pick(exact, "Om" + std::to_string(k + 1))});
  }
  quantities.push_back({"R00", rotation_entry(runs.fine, "attitude.q0", 0, 0), rotation_entry(exact, "q0", 0, 0)});
  quantities.push_back({"R12", rotation_entry(runs.fine, "attitude.q0", 1, 2), rotation_entry(exact, "q0", 1, 2)});
  expect_second_order("free body", quantities, runs, exact, 40.0);
}

/// Time at which a column falls through zero, by a cubic through the four rows around the change of sign.
double falling_zero(const Table& t, const std::string& column, double after) {
  const std::vector<double> v = t.of(column);
  for (std::size_t k = 2; k + 1 < v.size(); ++k) {
    if (t.times[k] < after || v[k - 1] < 0.0 || v[k] >= 0.0) continue;
    // inverse interpolation: time as a cubic of the value
    double time = 0.0;
    for (std::size_t i = k - 2; i <= k + 1; ++i) {
      double weight = 1.0;
      for (std::size_t j = k - 2; j <= k + 1; ++j)
        if (j != i) weight *= (0.0 - v[j]) / (v[i] - v[j]);
      time += weight * t.times[i];
    }
    return time;
  }
  ADD_FAILURE() << column << " does not fall through zero";
  return 0.0;
}

TEST(VerifyMechanisms, periods_of_pendulum_and_tumbling_body_converge_to_the_closed_forms) {
  // Pendulum from the horizontal: 4 sqrt(L/g) K(1/2); tumbling body: period of omega_2.
  scene::Scene pendulum = support::gallery("pendulum");
  pendulum.analysis.end_time = 5.0;
  const Pair swings(pendulum, 1e-3, 1);
  const auto pendulum_period = [](const Table& t) {
    return falling_zero(t, "bob.x", 2.5) - falling_zero(t, "bob.x", 0.0);
  };
  scene::Scene body = support::gallery("free_body");
  body.analysis.end_time = 60.0;
  const Pair turns(body, 2e-2, 1);
  const auto body_period = [](const Table& t) {
    return falling_zero(t, "body.wy", 40.0) - falling_zero(t, "body.wy", 0.0);
  };
  const double a = pendulum_period(swings.coarse), b = pendulum_period(swings.fine);
  EXPECT_NEAR(support::order_of(a - 2.3678419475762374, b - 2.3678419475762374), 2.0, 0.2);
  EXPECT_NEAR(support::extrapolate(a, b), 2.3678419475762374, 1e-6 * 2.37);
  const double c = body_period(turns.coarse), d = body_period(turns.fine);
  EXPECT_NEAR(support::order_of(c - 39.1057341972687, d - 39.1057341972687), 2.0, 0.2);
  EXPECT_NEAR(support::extrapolate(c, d), 39.1057341972687, 1e-6 * 39.1);
}

TEST(VerifyMechanisms, double_pendulum_meets_lagrange) {
  const Table exact = support::reference("double_pendulum_pointmass.csv");
  const Pair runs(support::gallery("double_pendulum"), 1e-3, 100);
  const std::size_t th1 = exact.column("th1");
  expect_second_order("double pendulum",
                      {{"upper x", pick(runs.fine, "upper.x"), [&](const auto& row) { return std::sin(row[th1]); }},
                       {"upper y", pick(runs.fine, "upper.y"), [&](const auto& row) { return -std::cos(row[th1]); }},
                       {"lower x", pick(runs.fine, "lower.x"), pick(exact, "x2")},
                       {"lower y", pick(runs.fine, "lower.y"), pick(exact, "y2")}},
                      runs, exact, 2.0);
}

}  // namespace
}  // namespace bough::run
