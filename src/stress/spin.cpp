/// Very fast spin, tumbling for very long.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/parts.hpp"

namespace bough::stress {

namespace {

constexpr double spin = 1e4;  ///< [rad/s]

/// A rotor in a bearing whose axis is none of the axes of its frame, at one radian per step.
void bearing(Bench& bench) {
  scene::Scene s;
  s.name = "rotor";
  s.bodies = {scene::make_body("rotor", 3.0, {{0.02, 0.03, 0.045}}, {{0.1, 0.0, 0.0}})};
  s.joints = {scene::make_joint("bearing", scene::JointKind::revolute, "", Vec3::zero(), "rotor", {{-0.1, 0.0, 0.0}})};
  scene::InitialVelocity w;
  w.of = "rotor";
  w.angular_velocity = {{0.0, 0.0, spin}};
  w.velocity = {{0.0, 0.1 * spin, 0.0}};
  s.initial_velocities = {w};
  s.sensors = {scene::make_joint_sensor("angle", "bearing", scene::SensorKind::joint_angle),
               scene::make_joint_sensor("force", "bearing")};
  s.analysis.step_size = 1e-4;
  s.analysis.end_time = bench.shorten(1.0, 0.1);
  s.analysis.tolerance = 1e-11;
  const run::MemoryRun run = bench.run(s);
  const double angle = spin * s.analysis.end_time, pull = 3.0 * 0.1 * spin * spin;
  bench.error("angle, of all turns", std::abs(run.final("angle") / angle - 1.0), 1e-9);
  bench.error("centripetal force", std::abs(std::hypot(run.final("force.fx"), run.final("force.fy")) / pull - 1.0),
              1e-6);
}

/// A heavy top in steady precession: J1 p^2 cos(lean) - J3 w p + m g l = 0; its centre goes round at the rate p.
void precession(Bench& bench) {
  const double m = 1.0, g = 9.81, l = 0.1, J1 = 0.02, J3 = 1e-4, lean = 0.5;  // J1 about the pivot
  // w3 = spin about the axis; the slow root.
  const double a = J1 * std::cos(lean), b = -J3 * spin, c = m * g * l;
  const double p = -2.0 * c / (b - std::sqrt(b * b - 4.0 * a * c));
  scene::Scene s;
  s.name = "top";
  s.gravity = {{0.0, 0.0, -g}};
  scene::Body top = scene::make_body("top", m, {{J1 - m * l * l, J1 - m * l * l, J3}}, Vec3::zero());
  const double cl = std::cos(lean), sl = std::sin(lean);
  top.placement.pose.R = {{cl, 0, sl, 0, 1, 0, -sl, 0, cl}};  // axis 3 leans towards x
  top.placement.pose.x = {{l * sl, 0.0, l * cl}};
  s.bodies = {top};
  s.joints = {scene::make_joint("pivot", scene::JointKind::spherical, "", Vec3::zero(), "top", {{0.0, 0.0, -l}})};
  s.joints[0].first.offset.R = top.placement.pose.R;
  // Angular velocity: spin w3 along the axis and the part of p across it.
  scene::InitialVelocity w;
  w.of = "top";
  const double along = spin - p * cl;  // so that the component along the axis is `spin`
  w.angular_velocity = {{along * sl, 0.0, p + along * cl}};
  w.velocity = {{0.0, p * l * sl, 0.0}};
  s.initial_velocities = {w};
  s.sensors = {scene::make_point_sensor("top", scene::SensorKind::position, "top")};
  s.analysis.end_time = bench.shorten(0.1, 0.01);
  s.analysis.tolerance = 1e-11;
  // 0.02 rad per step, and half of that: the error of the scheme is C h^2 and grows as the top nutates, 8 times a
  // second.
  run::MemoryRun runs[2];
  for (int k = 0; k < 2; ++k) {
    s.analysis.step_size = k == 0 ? 2e-6 : 1e-6;
    s.output.stride = k == 0 ? 100 : 200;
    runs[k] = bench.run(s);
  }
  double fine = 0.0, extrapolated = 0.0;
  for (const records::HistoryRow& row : runs[0].rows) {
    const double exact[3] = {l * sl * std::cos(p * row.time), l * sl * std::sin(p * row.time), l * cl};
    const char* const columns[3] = {"top.x", "top.y", "top.z"};
    for (int i = 0; i < 3; ++i) {
      const double finer = value_at(runs[1], columns[i], row.time),
                   difference = finer - row.values[static_cast<std::size_t>(i)];
      fine = std::max(fine, std::abs(finer - exact[i]) / l);
      extrapolated = std::max(extrapolated, std::abs(finer + difference / 3.0 - exact[i]) / l);
    }
  }
  bench.tell("precession [rad/s]", p);
  bench.error("centre on its circle, of the distance from the pivot, finer step", fine, 2e-4);
  bench.error("the same extrapolated", extrapolated, 1e-5);
}

/// Momentum and energy of a body that tumbles about its middle axis, from angular velocity and attitude.
void tumbling(Bench& bench) {
  const long steps = bench.shorten(1000000L, 20000L);
  const double J[3] = {1.0, 2.0, 3.0};
  for (const scene::Integrator integrator : {scene::Integrator::variational, scene::Integrator::generalized_alpha}) {
    const bool is_variational = integrator == scene::Integrator::variational;
    scene::Scene s;
    s.name = "tumbling";
    s.bodies = {scene::make_body("body", 6.0, {{J[0], J[1], J[2]}}, Vec3::zero())};
    scene::InitialVelocity w;
    w.of = "body";
    w.angular_velocity = {{0.01, 1.0, 0.01}};
    s.initial_velocities = {w};
    scene::Sensor rate = scene::make_point_sensor("rate", scene::SensorKind::velocity, "body");
    rate.axes = scene::LoadAxes::body;
    s.sensors = {rate, scene::make_point_sensor("attitude", scene::SensorKind::quaternion, "body")};
    s.analysis.integrator = integrator;
    s.analysis.spectral_radius = 1.0;
    s.analysis.step_size = 0.05;
    s.analysis.end_time = 0.05 * static_cast<double>(steps);
    s.analysis.tolerance = 1e-12;
    s.output.stride = static_cast<int>(steps / 1000);
    s.output.checks = false;
    const run::MemoryRun run = bench.run(s);
    Vec3 first = Vec3::zero();
    double momentum = 0.0, energy[2] = {0.0, 0.0}, energy_0 = 0.0, norm = 0.0;
    for (std::size_t r = 0; r < run.rows.size(); ++r) {
      const auto value = [&](const char* name) { return run.rows[r].values[run.column(name)]; };
      const Vec3 omega{{value("rate.wx"), value("rate.wy"), value("rate.wz")}};
      const Vec3 q{{value("attitude.q1"), value("attitude.q2"), value("attitude.q3")}};
      const double q0 = value("attitude.q0");
      Vec3 own = omega;
      double e = 0.0;
      for (int i = 0; i < 3; ++i) {
        own[i] *= J[i];
        e += 0.5 * own[i] * omega[i];
      }
      const Vec3 twice = 2.0 * lanes::cross(q, own);
      const Vec3 spatial = own + q0 * twice + lanes::cross(q, twice);
      if (r == 0) {
        first = spatial;
        energy_0 = e;
        norm = length_of(first);
      }
      const Vec3 d = spatial - first;
      momentum = std::max(momentum, length_of(d) / norm);
      double& half = energy[r < run.rows.size() / 2 ? 0 : 1];
      half = std::max(half, std::abs(e / energy_0 - 1.0));
    }
    const std::string with = is_variational ? ", variational" : ", generalized-alpha";
    if (is_variational) {
      bench.round_off_error("angular momentum" + with, momentum, 1e-10);
      bench.figure("energy in the second half over that in the first" + with, energy[1] / energy[0], 1.1);
      bench.error("energy" + with, energy[1], 1e-2);
    } else {
      bench.tell("angular momentum" + with, momentum);
      bench.tell("energy" + with, energy[1]);
    }
  }
}

}  // namespace

void add_spin(std::vector<Definition>& table) {
  table.push_back({"fast_spin", "spin",
                   "an unbalanced rotor at 1e4 rad/s, one radian a step, 10000 steps: its angle to 1e-9, the pull in "
                   "the bearing to 1e-6",
                   bearing});
  table.push_back(
      {"fast_top", "spin",
       "a top at 1e4 rad/s in steady precession for 0.1 s, 0.02 and 0.01 rad of spin a step: its centre to 2e-4 of the "
       "arm, extrapolated from the two to 1e-5",
       precession});
  table.push_back({"tumbling", "spin",
                   "a free body tumbles for 1e6 steps: with the variational integrator its angular momentum stays to "
                   "1e-10, its energy within 1e-2 in both halves of the run alike",
                   tumbling});
}

}  // namespace bough::stress
