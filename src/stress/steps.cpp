/// Step sizes from far below to far above the smallest period.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bench.hpp"
#include "bough/elements/catalogue.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/parts.hpp"
#include "bough/step/options.hpp"
#include "rigid_reference.hpp"
#include "tangent_matrix.hpp"

namespace bough::stress {

namespace {

constexpr double unit_round_off = 0x1p-53;
constexpr double gravity = 9.81;
constexpr double swing =
    2.3678419475762374;  ///< period of a pendulum of 1 m from the horizontal: 4 sqrt(L/g) K(1/2) [s]

constexpr double start_angle = -0.7;

/// Rate after a swing from rest at the horizontal.
double rate_at(double angle) { return -std::sqrt(-2.0 * gravity * std::sin(angle)); }

/// Released from rest at the horizontal. The run begins during the swing, where no component of position, rate and
/// force is zero; zeros would have no round-off.
scene::Scene pendulum(double h, int steps) {
  const Vec3 place{{std::cos(start_angle), std::sin(start_angle), 0.0}};
  const double rate = rate_at(start_angle);
  scene::Scene s;
  s.name = "pendulum";
  s.gravity = {{0.0, -gravity, 0.0}};
  scene::Body bob = scene::make_body("bob", 1.0, Vec3::zero(), place);
  bob.is_point_mass = true;
  s.bodies = {bob};
  s.joints = {scene::make_joint("hinge", scene::JointKind::revolute, "", Vec3::zero(), "bob", -1.0 * place)};
  scene::InitialVelocity moving;
  moving.of = "bob";
  moving.velocity = {{-rate * place[1], rate * place[0], 0.0}};
  moving.angular_velocity = {{0.0, 0.0, rate}};
  s.initial_velocities = {moving};
  s.sensors = {scene::make_point_sensor("bob", scene::SensorKind::position, "bob"),
               scene::make_joint_sensor("rate", "hinge", scene::SensorKind::joint_rate),
               scene::make_joint_sensor("hinge", "hinge")};
  s.analysis.step_size = h;
  s.analysis.end_time = h * steps;
  s.analysis.spectral_radius = 0.9;
  s.analysis.tolerance = 1e-12;
  return s;
}

struct Errors {
  double place = 0.0, rate = 0.0, force = 0.0;  ///< relative to 1 m, the largest rate, the largest force 3 m g
};

/// Errors at the end, and their maximum over the last rows, where the closed form is compared step by step.
Errors errors_of(Bench& bench, double h, int steps, int watched) {
  const run::MemoryRun run = bench.run(pendulum(h, steps), "h = " + io::rounded_text(h, 3));
  const double largest_rate = std::sqrt(2.0 * gravity);
  Errors worst;
  const std::size_t first = run.rows.size() - static_cast<std::size_t>(watched);
  PendulumState exact = physical_pendulum(gravity, start_angle, run.rows[first].time, rate_at(start_angle));
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

/// Largest effect of position errors of size e on rates and forces: at most rate e / h and force m e / h^2. Sums over
/// the responses of generalized-alpha to a single wrong position, where positions are prescribed by a constraint.
struct Amplification {
  double rate = 0.0, force = 0.0;
};

Amplification amplification(double rho) {
  const step::AlphaCoefficients k = step::make_alpha_coefficients(rho);
  Amplification sum;
  double x = 0.0, v = 0.0, a = 0.0, acceleration = 0.0;  // of x, h v, h^2 a, h^2 v'
  for (int n = 0; n < 1000; ++n) {
    const double next = n == 0 ? 1.0 : 0.0, a_next = (next - x - v - (0.5 - k.beta) * a) / k.beta;
    v += (1.0 - k.gamma) * a + k.gamma * a_next;
    acceleration = ((1.0 - k.alpha_m) * a_next + k.alpha_m * a - k.alpha_f * acceleration) / (1.0 - k.alpha_f);
    x = next;
    a = a_next;
    sum.rate += std::abs(v);
    sum.force += std::abs(acceleration);
  }
  return sum;
}

/// The truncation error is C (h/T)^2. The round-off of a position x leaves u |x| / h in velocities and u m |x| / h^2 in
/// forces. C is measured at steps where it dominates, the floors at steps so small that they dominate.
void floors(Bench& bench) {
  const double T = swing;
  const Errors resolved = errors_of(bench, 1e-2 * T, 50, 20);
  const double C_place = resolved.place / 1e-4, C_rate = resolved.rate / 1e-4, C_force = resolved.force / 1e-4;
  bench.error("place at h = 1e-2 T", resolved.place, 1e-2);
  // Steps of 1e-4 of the smallest period, over half of it.
  const Amplification most = amplification(pendulum(1.0, 1).analysis.spectral_radius);
  const int steps = bench.shorten(5000, 1000);
  const Errors small = errors_of(bench, 1e-4 * T, steps, 20);
  const double h = 1e-4 * T, largest_rate = std::sqrt(2.0 * gravity);
  bench.error("place at h = 1e-4 T", small.place, 4.0 * C_place * 1e-8 + 1e2 * unit_round_off);
  bench.error("rate at h = 1e-4 T", small.rate, 4.0 * C_rate * 1e-8 + most.rate * unit_round_off / h / largest_rate);
  bench.error("force at h = 1e-4 T", small.force,
              4.0 * C_force * 1e-8 + most.force * unit_round_off / (h * h) / (3.0 * gravity));
  // Very small steps: the floors, in units of u |x| / h and u m |x| / h^2.
  const double tiny = 1e-7 * T;
  const Errors floor = errors_of(bench, tiny, 200, 150);
  const double rate_floor = floor.rate * largest_rate * tiny / unit_round_off,
               force_floor = floor.force * 3.0 * gravity * tiny * tiny / unit_round_off;
  bench.figure("floor of rates at h = 1e-7 T over u |x| / h", rate_floor, most.rate);
  bench.figure("floor of forces at h = 1e-7 T over u m |x| / h^2", force_floor, most.force);
  bench.error("place at h = 1e-7 T", floor.place, 1e3 * unit_round_off);
  // The step h at which floor and truncation error are equal: C (h/T)^2 = f u / h, g u / h^2.
  bench.tell("h/T below which round-off rules rates",
             std::cbrt(rate_floor * unit_round_off / largest_rate / (C_rate * T)));
  bench.tell("h/T below which round-off rules forces",
             std::pow(force_floor * unit_round_off / (3.0 * gravity) / (C_force * T * T), 0.25));
}

/// The same pendulum on a stiff spring, which vibrates along its line. Steps are below and above the smallest period,
/// and far below that of the swing. The spring starts longer than in the swing, so that there is a vibration that could
/// grow.
void large_steps(Bench& bench) {
  const double w = 1e4, stretch = 1e-6, period = 2.0 * M_PI / w;  // m = 1 kg
  const int steps = bench.shorten(20000, 2000);
  for (const double ratio : {0.1, 1.0, 3.0, 10.0}) {
    scene::Scene s = pendulum(ratio * period, steps);
    s.bodies = {scene::make_body("bob", 1.0, {{0.1, 0.1, 0.1}}, s.bodies[0].placement.pose.x)};
    s.initial_velocities[0].angular_velocity = Vec3::zero();
    s.couplings = {
        scene::make_coupling(elements::kind_of<elements::Spring>, "spring", "", "bob", {w * w, 1.0 - stretch})};
    s.joints = {scene::make_joint("plane", scene::JointKind::planar, "", Vec3::zero(), "bob", Vec3::zero())};
    s.sensors = {scene::make_point_sensor("bob", scene::SensorKind::position, "bob"),
                 scene::make_point_sensor("bob rate", scene::SensorKind::velocity, "bob")};
    const run::MemoryRun run = bench.run(s, "h = " + io::rounded_text(ratio, 2) + " T");
    double off = 0.0, energy = 0.0;
    for (const records::HistoryRow& row : run.rows) {
      const auto value = [&](const char* name) { return row.values[run.column(name)]; };
      const double x = value("bob.x"), y = value("bob.y"), vx = value("bob rate.vx"), vy = value("bob rate.vy");
      off = std::max(off, std::abs(std::hypot(x, y) - 1.0));
      energy = std::max(energy, 0.5 * (vx * vx + vy * vy) + gravity * y);
    }
    // The spring's stretch and its force, at most 3 m g, as for a suddenly applied load: twice that.
    const std::string label = ", h/T = " + io::rounded_text(ratio, 2);
    bench.figure("distance from the circle" + label, off, 2.0 * (stretch + 3.0 * gravity / (w * w)));
    bench.figure("energy gained over m g L" + label, energy / gravity, 1e-2);
  }
}

/// A swing cannot be resolved by steps of its own period and more. Positions nevertheless remain on the circle, and the
/// run reports the problem.
void unresolved_swing(Bench& bench) {
  for (const double ratio : {1.0, 3.0, 10.0}) {
    const run::MemoryRun run = bench.try_run(pendulum(ratio * swing, bench.shorten(2000, 300)));
    double off = 0.0;
    for (const records::HistoryRow& row : run.rows)
      off = std::max(off, std::abs(std::hypot(row.values[run.column("bob.x")], row.values[run.column("bob.y")]) - 1.0));
    const std::string label = ", h/T = " + io::rounded_text(ratio, 2);
    bench.figure("distance from the circle" + label, off, 1e-11);
    bench.figure("the run says nothing" + label, run.summary.doubts.empty() ? 1.0 : 0.0, 0.0);
    for (const records::Doubt& doubt : run.summary.doubts) bench.say(doubt.text);
  }
}

/// Largest magnitude of an eigenvalue of generalized-alpha for x'' = -w^2 x, by its definition (Chung, Hulbert 1993),
/// in (x, h v, h^2 a).
double spectral_radius_of(double rho, double w_h) {
  const step::AlphaCoefficients k = step::make_alpha_coefficients(rho);
  const double w2 = w_h * w_h;
  // (1 - am) a+ + am a = (1 - af) x''+ + af x'',  x'' = -w2 x;  x+ = x + v + (1/2 - beta) a + beta a+,  v+ = v + (1 -
  // gamma) a + gamma a+
  Eigen::Matrix3d left = Eigen::Matrix3d::Identity(), right;
  left << 1.0, 0.0, -k.beta, 0.0, 1.0, -k.gamma, (1.0 - k.alpha_f) * w2, 0.0, 1.0 - k.alpha_m;
  right << 1.0, 1.0, 0.5 - k.beta, 0.0, 1.0, 1.0 - k.gamma, -k.alpha_f * w2, 0.0, -k.alpha_m;
  const Eigen::Matrix3d step = left.partialPivLu().solve(right);
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

/// Largest root of the recursion x_{k+3} = c_2 x_{k+2} + c_1 x_{k+1} + c_0 x_k that a history satisfies, by least
/// squares over rows of equal weight. (The decay over many steps is less informative: for long steps all three roots
/// coincide, and x_k behaves like k^2 rho^k.)
double measured_radius(const std::vector<double>& x, std::size_t first, std::size_t rows) {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(rows), 3);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index r = 0; r < A.rows(); ++r) {
    const std::size_t k = first + static_cast<std::size_t>(r);
    const double size = std::max({std::abs(x.at(k)), std::abs(x.at(k + 1)), std::abs(x.at(k + 2))});
    if (size == 0.0) throw std::runtime_error("the mass does not move");
    for (Eigen::Index j = 0; j < 3; ++j) A(r, j) = x[k + static_cast<std::size_t>(j)] / size;
    b(r) = x.at(k + 3) / size;
  }
  const Eigen::Vector3d c = A.colPivHouseholderQr().solve(b);
  Eigen::Matrix3d companion;
  companion << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, c(0), c(1), c(2);
  return companion.eigenvalues().cwiseAbs().maxCoeff();
}

/// A mass on a linear spring, displaced and released: the recursion of its positions has the largest eigenvalue of the
/// scheme as a root.
void spectral_radius(Bench& bench) {
  const double w = 100.0, period = 2.0 * M_PI / w;
  for (const double rho : {0.0, 0.5, 0.8, 0.95, 1.0})
    for (const double ratio : {0.1, 1.0, 10.0, 1e4}) {
      scene::Scene s;
      s.name = "mass on a spring";
      s.bodies = {scene::make_body("mass", 2.0, {{0.1, 0.1, 0.1}}, Vec3::zero())};
      s.couplings = {scene::make_coupling(elements::kind_of<elements::Bushing>, "spring", "", "mass")};
      for (std::size_t i = 0; i < 6; ++i) s.couplings[0].values[7 * i] = 2.0 * w * w;
      scene::InitialVelocity push;
      push.of = "mass";
      push.velocity = {{0.1, 0.0, 0.0}};
      s.initial_velocities = {push};
      s.sensors = {scene::make_point_sensor("mass", scene::SensorKind::position, "mass")};
      s.analysis.spectral_radius = rho;
      s.analysis.step_size = ratio * period;
      s.analysis.end_time = 16.0 * s.analysis.step_size;
      s.analysis.tolerance = 1e-13;
      const run::MemoryRun run = bench.run(s);
      const double measured = measured_radius(run.series("mass.x"), 1, 12);
      const std::string label = "rho = " + io::rounded_text(rho, 2) + ", h/T = " + io::rounded_text(ratio, 3);
      // A triple root is determined only to the cube root of round-off.
      bench.error(label, std::abs(measured - spectral_radius_of(rho, w * ratio * period)),
                  std::cbrt(2.0 * unit_round_off));
      if (ratio > 1e3) bench.error("from the limit, " + label, std::abs(measured - rho), 1e-2);
    }
}

/// Beams, bodies and joints in a chain.
scene::Scene mixed_chain() {
  scene::Scene s;
  s.name = "mixed chain";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.sections = {scene::make_section("bar", 8.4e7, 2.7e7, 2.7e7, 1.8e3, 2.8e3, 2.8e3)};
  scene::set_mass(s.sections[0], 3.14, 2.1e-4, 1.05e-4, 1.05e-4);
  s.nodes = {scene::make_node("a", Vec3::zero()), scene::make_node("b", {{1, 0, 0}}),
             scene::make_node("c", {{1.2, 0, 0}}), scene::make_node("d", {{2.2, 0, 0}})};
  s.bodies = {scene::make_body("link", 0.5, {{1e-4, 2e-3, 2e-3}}, {{1.1, 0.0, 0.0}})};
  s.beams = {scene::make_beam("first", "bar", "a", "b", 3, 1), scene::make_beam("second", "bar", "c", "d", 3, 2)};
  s.joints = {scene::make_joint("hinge", scene::JointKind::revolute, "", Vec3::zero(), "a", Vec3::zero()),
              scene::make_joint("weld", scene::JointKind::fixed, "b", Vec3::zero(), "link", {{-0.1, 0, 0}}),
              scene::make_joint("ball", scene::JointKind::spherical, "link", {{0.1, 0, 0}}, "c", Vec3::zero())};
  s.sensors = {scene::make_point_sensor("tip", scene::SensorKind::position, "d")};
  return s;
}

void condition_with_scaling(Bench& bench) {
  double longest = 0.0, most = 0.0, unscaled_most = 0.0;
  for (int k = 2; k <= 9; ++k) {
    scene::Scene s = mixed_chain();
    s.analysis.step_size = std::pow(10.0, -k);
    s.analysis.end_time = 10.0 * s.analysis.step_size;
    bench.require_memory(s);
    const TangentMatrix t = tangent_matrix(s);
    const double condition = condition_of(t.scaled), unscaled = condition_without_scaling(t);
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
  table.push_back(
      {"step_floors", "step sizes",
       "a pendulum in steps of 1e-2, 1e-4 and 1e-7 of its period: errors are C (h/T)^2 plus the floors "
       "76 u |x| / h in rates and 4332 u m |x| / h^2 in forces, what the scheme at spectral radius 0.9 can make of "
       "places rounded to u |x|, and no scaling removes; tells the h at which the floor passes the "
       "truncation error",
       floors});
  table.push_back(
      {"large_steps", "step sizes",
       "a pendulum on a stiff spring in steps of 0.1 to 10 of the spring's periods: places stay within twice "
       "the spring's stretch of the circle, and the energy grows by no more than 1e-2 m g L",
       large_steps});
  table.push_back({"unresolved_swing", "step sizes",
                   "a pendulum on a hinge in steps of 1 to 10 of its own periods: its place stays on the circle to "
                   "1e-11, and the run says that it should not be trusted, or breaks off",
                   unresolved_swing});
  table.push_back(
      {"spectral_radius", "step sizes",
       "a mass on a spring in steps of 0.1 to 1e4 periods: the largest root of the recursion that its places "
       "obey is the spectral radius of generalized-alpha to 6e-6, and the one asked for to 1e-2 in the limit",
       spectral_radius});
  table.push_back({"condition", "step sizes",
                   "the condition number of a chain's tangent, scaled, does not grow by more than 2 as h falls from "
                   "1e-2 to 1e-9 s, and is 1e6 times less than without scaling",
                   condition_with_scaling});
}

}  // namespace bough::stress
