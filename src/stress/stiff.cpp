/// Stiff dynamics: spring-dampers, a squeezer, bushings in place of joints.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/elements/catalogue.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/parts.hpp"

namespace bough::stress {

namespace {

/// A slider on a spring and damper as in the governor of the IFToMM library: 8e5 N/m, 4e4 N s/m, rates of 20 and 1e5
/// per second.
void governor(Bench& bench) {
  const double m = 0.4, k = 8e5, c = 4e4, x0 = 0.1, end = 0.1;
  const double root = std::sqrt(c * c - 4.0 * m * k), fast = -(c + root) / (2.0 * m), slow = k / (m * fast);
  const auto exact = [&](double t) {  // from rest at x0
    return x0 * (slow * std::exp(fast * t) - fast * std::exp(slow * t)) / (slow - fast);
  };
  for (const double h : {1e-3, 1e-4}) {
    scene::Scene s;
    s.name = "governor";
    s.bodies = {scene::make_body("slider", m, {{1e-3, 1e-3, 1e-3}}, {{0.0, 0.0, x0}})};
    s.joints = {scene::make_joint("guide", scene::JointKind::prismatic, "", {{0, 0, x0}}, "slider", Vec3::zero())};
    scene::JointForce spring;
    spring.coordinate = "displacement";
    spring.stiffness = k;
    spring.rest = -x0;
    spring.damping = c;
    s.joints[0].forces = {spring};
    s.sensors = {scene::make_point_sensor("slider", scene::SensorKind::position, "slider")};
    s.analysis.end_time = end;
    s.analysis.step_size = h;
    s.analysis.tolerance = 1e-11;
    const run::MemoryRun run = bench.run(s);
    double worst = 0.0;
    for (const records::HistoryRow& row : run.rows)
      worst = std::max(worst, std::abs(row.values[run.column("slider.z")] - exact(row.time)) / x0);
    bench.error("place, h |rate| = " + io::rounded_text(h * -fast, 3), worst, 5e-2 * h / 1e-3);
    bench.error("place at the end, h |rate| = " + io::rounded_text(h * -fast, 3),
                std::abs(run.final("slider.z") - exact(end)) / x0, 2e-2 * h / 1e-3);
  }
}

void andrews(Bench& bench) {
  const ReferenceTable exact = reference_table("A03_andrews_iftomm.csv");
  const double end = bench.shorten(0.05, 0.01);
  run::MemoryRun runs[2];
  for (int k = 0; k < 2; ++k) {
    scene::Scene s = gallery_scene("andrews_squeezer");
    s.analysis.end_time = end;
    s.analysis.step_size = k == 0 ? 2e-5 : 1e-5;
    s.analysis.tolerance = 1e-11;
    runs[k] = bench.run(s);
  }
  double fine = 0.0, extrapolated = 0.0, size = 0.0;
  for (std::size_t r = 1; r < exact.times.size() && exact.times[r] <= end + 1e-12; ++r) {
    const double e = exact.rows[r][exact.column("beta")] + 0.062;  // bough measures angles from the initial position
    const double a = value_at(runs[0], "beta", exact.times[r]), b = value_at(runs[1], "beta", exact.times[r]);
    fine = std::max(fine, std::abs(b - e));
    extrapolated = std::max(extrapolated, std::abs(b + (b - a) / 3.0 - e));
    size = std::max(size, std::abs(e));
  }
  bench.error("angle of the crank, h = 1e-5 s", fine / size, 5e-4);
  bench.error("the same extrapolated", extrapolated / size, 1e-6);
}

/// Two bars; the second hangs on a hinge or on a bushing that is stiff in all but the hinge's turn.
scene::Scene two_bars(double stiffness) {
  scene::Scene s;
  s.name = "two bars";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.bodies = {scene::make_body("upper", 1.0, {{1e-2, 0.1, 0.1}}, {{0.5, 0.0, 0.0}}),
              scene::make_body("lower", 1.0, {{1e-2, 0.1, 0.1}}, {{1.5, 0.0, 0.0}})};
  const scene::JointKind hinge = scene::JointKind::revolute;
  s.joints = {scene::make_joint("root", hinge, "", Vec3::zero(), "upper", {{-0.5, 0, 0}})};
  if (stiffness > 0.0) {
    scene::Coupling b = scene::make_coupling(elements::kind_of<elements::Bushing>, "bushing", "upper", "lower");
    b.first.offset.x = {{0.5, 0, 0}};
    b.second.offset.x = {{-0.5, 0, 0}};
    for (std::size_t i = 0; i < 5; ++i) b.values[7 * i] = stiffness;
    s.couplings = {b};
  } else {
    s.joints.push_back(scene::make_joint("middle", hinge, "upper", {{0.5, 0, 0}}, "lower", {{-0.5, 0, 0}}));
  }
  s.sensors = {scene::make_point_sensor("lower", scene::SensorKind::position, "lower")};
  s.analysis.end_time = 1.0;
  s.analysis.step_size = 2e-3;
  s.analysis.tolerance = 1e-10;
  return s;
}

void bushings(Bench& bench) {
  const run::MemoryRun ideal = bench.run(two_bars(0.0), "ideal");
  for (int decade = 5; decade <= 12; ++decade) {
    const double k = std::pow(10.0, decade);
    const run::MemoryRun run = bench.run(two_bars(k), "bushing of 1e" + std::to_string(decade));
    double worst = 0.0;  // by time: steps that are cut and grow again add rows in between
    for (const records::HistoryRow& row : ideal.rows)
      worst = std::max(worst, std::hypot(value_at(run, "lower.x", row.time) - row.values[0],
                                         value_at(run, "lower.y", row.time) - row.values[1]));
    // The bushing deflects by (forces of some ten newtons) / k, and the motion carries the deflection on.
    bench.error("against the ideal joint, 1e" + std::to_string(decade) + " N/m", worst, 2e2 / k + 2e-5);
  }
}

}  // namespace

void add_stiff(std::vector<Definition>& table) {
  table.push_back({"governor", "stiff dynamics",
                   "a slider on a spring and damper with rates of 20 and 1e5 per second, in steps of 1e-3 and 1e-4 s: "
                   "the closed form to 0.05 and 0.005 of the pull, no ringing that grows",
                   governor});
  table.push_back({"andrews_squeezer", "stiff dynamics",
                   "seven bodies in 0.05 s: the crank's angle in steps of 1e-5 s to 5e-4, extrapolated to 1e-6 of its "
                   "range",
                   andrews});
  table.push_back(
      {"bushings", "stiff dynamics",
       "a bushing of 1e5 to 1e12 N/m in place of a hinge: within 200 N over its stiffness and 2e-5 m of the "
       "ideal joint",
       bushings});
}

}  // namespace bough::stress
