// What iterations leave must stay below what steps leave, at the default tolerance and near an unstable motion, which
// multiplies both.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bough/run/memory_run.hpp"

namespace bough::run {
namespace {

constexpr double end = 5.0;
constexpr std::array<double, 3> inertia{0.1, 0.2, 0.3}, spin{0.001, 10.0, 0.001};

/// Euler's equations  J w' = (J w) x w  by the classical fourth-order scheme in steps of 25 microseconds: to 1e-9, from
/// steps twice as large.
std::array<double, 3> exact_spin() {
  using Vec = std::array<double, 3>;
  const auto rate = [](const Vec& w) {
    Vec r{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      r[i] = (inertia[j] - inertia[k]) / inertia[i] * w[j] * w[k];
    }
    return r;
  };
  const auto along = [](const Vec& w, double h, const Vec& r) {
    return Vec{w[0] + h * r[0], w[1] + h * r[1], w[2] + h * r[2]};
  };
  constexpr int steps = 200000;
  constexpr double h = end / steps;
  Vec w = spin;
  for (int n = 0; n < steps; ++n) {
    const Vec a = rate(w), b = rate(along(w, 0.5 * h, a)), c = rate(along(w, 0.5 * h, b)), d = rate(along(w, h, c));
    for (std::size_t i = 0; i < 3; ++i) w[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return w;
}

/// The largest error of the angular velocity at the end, own axes. on_pivot: the body turns on a ball joint at its
/// centre instead of freely, which is the same motion with multipliers.
double error_of(double h, double tolerance, bool on_pivot, const std::array<double, 3>& exact) {
  scene::Scene s;
  scene::Body body;
  body.name = "body";
  body.mass = 1.0;
  for (int i = 0; i < 3; ++i) body.inertia(i, i) = inertia[static_cast<std::size_t>(i)];
  s.bodies.push_back(body);
  if (on_pivot) {
    scene::Joint joint;
    joint.name = "pivot";
    joint.kind = scene::JointKind::spherical;
    joint.second.to = "body";
    s.joints.push_back(joint);
  }
  s.initial_velocities.push_back(
      {"body", scene::LoadAxes::body, "", scene::Vec3::zero(), {{spin[0], spin[1], spin[2]}}});
  scene::Sensor sensor;
  sensor.name = "body";
  sensor.kind = scene::SensorKind::velocity;
  sensor.at.to = "body";
  sensor.axes = scene::LoadAxes::body;
  s.sensors.push_back(sensor);
  s.analysis.end_time = end;
  s.analysis.step_size = h;
  s.analysis.tolerance = tolerance;
  const MemoryRun run = run_in_memory(s);
  EXPECT_TRUE(run.ok()) << run.text();
  const char* const columns[] = {"body.wx", "body.wy", "body.wz"};
  double error = 0.0;
  for (std::size_t i = 0; i < 3; ++i) error = std::max(error, std::abs(run.final(columns[i]) - exact[i]));
  return error;
}

TEST(Tolerance, keeps_the_order_of_a_tumbling_body) {
  const std::array<double, 3> exact = exact_spin();
  for (const bool on_pivot : {false, true}) {
    std::printf("%s\n", on_pivot ? "on a pivot" : "free");
    for (const double h : {1e-3, 5e-4, 2.5e-4}) {
      const double usual = error_of(h, 1e-8, on_pivot, exact), tight = error_of(h, 1e-12, on_pivot, exact);
      const double of_steps = 91.0 * h * h;  // measured at tolerances of 1e-12 and below
      std::printf("h %.2g ms: error %.2e, at a tolerance of 1e-12 %.2e, of the steps %.2e\n", 1e3 * h, usual, tight,
                  of_steps);
      EXPECT_LT(usual, 3.0 * of_steps) << h;
    }
  }
}

}  // namespace
}  // namespace bough::run
