/// Step sizes from far below to far above the smallest period.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/io/number_text.hpp"
#include "bough/step/options.hpp"
#include "bough/study/scene_parts.hpp"
#include "rigid_reference.hpp"
#include "tangent_matrix.hpp"

namespace bough::study::stress {

namespace {

constexpr double unit_round_off = 0x1p-53;
constexpr double gravity = 9.81;
constexpr double swing =
    2.3678419475762374;  ///< period of a pendulum of 1 m from the horizontal: 4 sqrt(L/g) K(1/2) [s]

scene::Scene pendulum(double h, int steps) {
  scene::Scene s;
  s.name = "pendulum";
  s.gravity = {{0.0, -gravity, 0.0}};
  scene::Body bob = make_body("bob", 1.0, Vec3::zero(), {{1.0, 0.0, 0.0}});
  bob.is_point_mass = true;
  s.bodies = {bob};
  s.joints = {make_joint("hinge", scene::JointKind::revolute, "", Vec3::zero(), "bob", {{-1.0, 0.0, 0.0}})};
  s.sensors = {make_point_sensor("bob", scene::SensorKind::position, "bob"),
               make_joint_sensor("rate", "hinge", scene::SensorKind::joint_rate), make_joint_sensor("hinge", "hinge")};
  s.analysis.step_size = h;
  s.analysis.end_time = h * steps;
  s.analysis.spectral_radius = 0.9;
  s.analysis.tolerance = 1e-12;
  return s;
}

struct Errors {
  double place = 0.0, rate = 0.0, force = 0.0;  ///< relative to 1 m, the largest rate, the largest force 3 m g
};

/// Errors at the end, and their largest over the last rows where the closed form is followed step by step.
Errors errors_of(Bench& bench, double h, int steps, int watched) {
  const MemoryRun run = bench.run(pendulum(h, steps), "h = " + io::rounded_text(h, 3));
  const double largest_rate = std::sqrt(2.0 * gravity);
  Errors worst;
  const std::size_t first = run.rows.size() - static_cast<std::size_t>(watched);
  PendulumState exact = physical_pendulum(gravity, 0.0, run.rows[first].time);
  for (std::size_t r = first; r < run.rows.size(); ++r) {
    if (r > first) exact = physical_pendulum(gravity, exact.angle, run.rows[r].time - run.rows[r - 1].time, exact.rate);
    const auto value = [&](const char* name) { return run.rows[r].values[run.column(name)]; };
    const double c = std::cos(exact.angle), s = std::sin(exact.angle);
    const double tension = exact.rate * exact.rate - gravity * s;
    worst.place = std::max(worst.place, std::hypot(value("bob.x") - c, value("bob.y") - s));
    worst.rate = std::max(worst.rate, std::abs(value("rate") - exact.rate) / largest_rate);
    worst.force = std::max(
        worst.force, std::hypot(value("hinge.fx") + tension * c, value("hinge.fy") + tension * s) / (3.0 * gravity));
  }
  return worst;
}

/// Truncation is C (h/T)^2, round-off of a place x leaves u |x| / h in velocities and u m |x| / h^2 in forces: C from steps where only it
/// shows, the floors from steps so small that they alone show.
void floors(Bench& bench) {
  const double T = swing;
  const Errors resolved = errors_of(bench, 1e-2 * T, 50, 20);
  const double C_place = resolved.place / 1e-4, C_rate = resolved.rate / 1e-4, C_force = resolved.force / 1e-4;
  bench.error("place at h = 1e-2 T", resolved.place, 1e-2);
  // Steps of 1e-4 of the smallest period, over half of it.
  const int steps = bench.shorten(5000, 1000);
  const Errors small = errors_of(bench, 1e-4 * T, steps, 20);
  const double h = 1e-4 * T, largest_rate = std::sqrt(2.0 * gravity);
  bench.error("place at h = 1e-4 T", small.place, 4.0 * C_place * 1e-8 + 1e2 * unit_round_off);
  bench.error("rate at h = 1e-4 T", small.rate, 4.0 * C_rate * 1e-8 + 1e2 * unit_round_off / h / largest_rate);
  bench.error("force at h = 1e-4 T", small.force,
              4.0 * C_force * 1e-8 + 1e2 * unit_round_off / (h * h) / (3.0 * gravity));
  // Far below: the floors, in units of u |x| / h and u m |x| / h^2.
  const double tiny = 1e-7 * T;
  const Errors floor = errors_of(bench, tiny, 200, 150);
  const double rate_floor = floor.rate * largest_rate * tiny / unit_round_off,
               force_floor = floor.force * 3.0 * gravity * tiny * tiny / unit_round_off;
  bench.figure("floor of rates at h = 1e-7 T over u |x| / h", rate_floor, 1e2);
  bench.figure("floor of forces at h = 1e-7 T over u m |x| / h^2", force_floor, 1e2);
  bench.error("place at h = 1e-7 T", floor.place, 1e3 * unit_round_off);
  // The h at which floor and truncation are equal: C (h/T)^2 = f u / h, g u / h^2.
  bench.tell("h/T below which round-off rules rates",
             std::cbrt(rate_floor * unit_round_off / largest_rate / (C_rate * T)));
  bench.tell("h/T below which round-off rules forces",
             std::pow(force_floor * unit_round_off / (3.0 * gravity) / (C_force * T * T), 0.25));
}

/// Above the period nothing is resolved: places stay on the circle, nothing grows.
void large_steps(Bench& bench) {
  const int steps = bench.shorten(2000, 300);
  for (const double ratio : {0.1, 1.0, 3.0, 10.0}) {
    const MemoryRun run = bench.run(pendulum(ratio * swing, steps), "h = " + io::rounded_text(ratio, 2) + " T");
    double off = 0.0, energy = 0.0;
    for (const results::HistoryRow& row : run.rows) {
      const double x = row.values[run.column("bob.x")], y = row.values[run.column("bob.y")],
                   w = row.values[run.column("rate")];
      off = std::max(off, std::abs(std::hypot(x, y) - 1.0));
      energy = std::max(energy, 0.5 * w * w + gravity * y);
    }
    bench.figure("distance from the circle, h/T = " + io::rounded_text(ratio, 2), off, 1e-11);
    bench.figure("energy gained over m g L, h/T = " + io::rounded_text(ratio, 2), energy / gravity, 1.0);
  }
}

/// Largest magnitude of an eigenvalue of generalized-alpha for x'' = -w^2 x, by its definition (Chung, Hulbert 1993), in (x, h v, h^2 a).
double spectral_radius_of(double rho, double w_h) {
  const step::AlphaCoefficients k = step::make_alpha_coefficients(rho);
  const double w2 = w_h * w_h;
  // (1 - am) a+ + am a = (1 - af) x''+ + af x'',  x'' = -w2 x;  x+ = x + v + (1/2 - beta) a + beta a+,  v+ = v + (1 - gamma) a + gamma a+
  Eigen::Matrix3d left = Eigen::Matrix3d::Identity(), right;
  left << 1.0, 0.0, -k.beta, 0.0, 1.0, -k.gamma, (1.0 - k.alpha_f) * w2, 0.0, 1.0 - k.alpha_m;
  right << 1.0, 1.0, 0.5 - k.beta, 0.0, 1.0, 1.0 - k.gamma, -k.alpha_f * w2, 0.0, -k.alpha_m;
  const Eigen::Matrix3d step = left.partialPivLu().solve(right);
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

/// A mass on a linear spring, pulled and let go: its decay over many steps is the largest eigenvalue of one.
void spectral_radius(Bench& bench) {
  const double w = 100.0, period = 2.0 * M_PI / w;
  const int steps = 400, window = 80;
  for (const double rho : {0.5, 0.8, 0.95})
    for (const double ratio : {0.1, 1.0, 10.0, 100.0}) {
      scene::Scene s;
      s.name = "mass on a spring";
      s.bodies = {make_body("mass", 2.0, {{0.1, 0.1, 0.1}}, {{1e-3, 0.0, 0.0}})};
      scene::Bushing spring;
      spring.name = "spring";
      spring.first.offset.x = Vec3::zero();
      spring.second.to = "mass";
      for (int i = 0; i < 6; ++i) spring.stiffness(i, i) = 2.0 * w * w;
      s.bushings = {spring};
      s.sensors = {make_point_sensor("mass", scene::SensorKind::position, "mass")};
      s.analysis.spectral_radius = rho;
      s.analysis.step_size = ratio * period;
      s.analysis.end_time = steps * s.analysis.step_size;
      s.analysis.tolerance = 1e-13;
      const MemoryRun run = bench.run(s);
      const std::vector<double> x = run.series("mass.x");
      const auto envelope = [&x](std::size_t from) {
        double most = 0.0;
        for (std::size_t k = from; k < from + window; ++k) most = std::max(most, std::abs(x.at(k)));
        return most;
      };
      const double designed = spectral_radius_of(rho, w * ratio * period);
      // Late enough for the other eigenvalues, early enough not to be round-off.
      const int apart =
          std::min(200, static_cast<int>(std::floor(std::log(1e-9) / std::log(std::min(designed, 0.999)))));
      const double measured = std::pow(envelope(static_cast<std::size_t>(20 + apart)) / envelope(20), 1.0 / apart);
      bench.error("rho = " + io::rounded_text(rho, 2) + ", h/T = " + io::rounded_text(ratio, 3),
                  std::abs(measured - designed), 2e-2);
    }
}

/// Beams, bodies and joints in a chain.
scene::Scene mixed_chain() {
  scene::Scene s;
  s.name = "mixed chain";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.sections = {make_section("bar", 8.4e7, 2.7e7, 2.7e7, 1.8e3, 2.8e3, 2.8e3)};
  set_mass(s.sections[0], 3.14, 2.1e-4, 1.05e-4, 1.05e-4);
  s.nodes = {make_node("a", Vec3::zero()), make_node("b", {{1, 0, 0}}), make_node("c", {{1.2, 0, 0}}),
             make_node("d", {{2.2, 0, 0}})};
  s.bodies = {make_body("link", 0.5, {{1e-4, 2e-3, 2e-3}}, {{1.1, 0.0, 0.0}})};
  s.beams = {make_beam("first", "bar", "a", "b", 3, 1), make_beam("second", "bar", "c", "d", 3, 2)};
  s.joints = {make_joint("hinge", scene::JointKind::revolute, "", Vec3::zero(), "a", Vec3::zero()),
              make_joint("weld", scene::JointKind::fixed, "b", Vec3::zero(), "link", {{-0.1, 0, 0}}),
              make_joint("ball", scene::JointKind::spherical, "link", {{0.1, 0, 0}}, "c", Vec3::zero())};
  s.sensors = {make_point_sensor("tip", scene::SensorKind::position, "d")};
  return s;
}

void condition_with_scaling(Bench& bench) {
  double longest = 0.0, most = 0.0, unscaled_most = 0.0;
  for (int k = 2; k <= 9; ++k) {
    scene::Scene s = mixed_chain();
    s.analysis.step_size = std::pow(10.0, -k);
    s.analysis.end_time = 10.0 * s.analysis.step_size;
    const TangentMatrix t = tangent_matrix(s);
    const double condition = condition_of(t.scaled), unscaled = condition_of(t.matrix);
    bench.backward_error(t.backward_error, static_cast<double>(t.matrix.rows()));
    bench.condition(condition);
    bench.tell("scaled, h = 1e-" + std::to_string(k), condition);
    bench.tell("not scaled, h = 1e-" + std::to_string(k), unscaled);
    if (longest > 0.0) most = std::max(most, condition / longest);
    longest = std::max(longest, condition);
    unscaled_most = std::max(unscaled_most, unscaled);
  }
  bench.figure("largest growth of the scaled condition as h falls", most, 2.0);
  bench.figure("largest scaled condition over the largest without scaling", longest / unscaled_most, 1e-6);
}

}  // namespace

void add_steps(std::vector<Definition>& table) {
  table.push_back({"step_floors", "step sizes",
                   "a pendulum in steps of 1e-2, 1e-4 and 1e-7 of its period: errors are C (h/T)^2 plus the floors "
                   "100 u |x| / h in rates and 100 u m |x| / h^2 in forces, which no scaling removes; tells the h at "
                   "which the floor passes the truncation error",
                   floors});
  table.push_back(
      {"large_steps", "step sizes",
       "the same in steps of 0.1 to 10 periods: the place stays on its circle to 1e-11 and the energy does "
       "not grow beyond m g L",
       large_steps, StressStatus::fails,
       "at a step of one period the bob turns by nearly half a turn in a step, which the run refuses by name"});
  table.push_back({"spectral_radius", "step sizes",
                   "a mass on a spring in steps of 0.1 to 100 periods decays by the spectral radius of "
                   "generalized-alpha, to 0.02",
                   spectral_radius, StressStatus::fails,
                   "above the period the start filters the vibration away before its decay can be measured"});
  table.push_back({"condition", "step sizes",
                   "the condition number of a chain's tangent, scaled, does not grow by more than 2 as h falls from "
                   "1e-2 to 1e-9 s, and is 1e6 times less than without scaling",
                   condition_with_scaling});
}

}  // namespace bough::study::stress
