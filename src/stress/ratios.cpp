/// Stiffness and mass ratios of up to 1e12 within one scene.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/parts.hpp"
#include "planar_rod.hpp"
#include "rigid_reference.hpp"

namespace bough::stress {

namespace {

constexpr double tip_force = 2.0;  // P L^2 / EI of the soft half

/// Two halves of a cantilever; their junction is a node of the interface mesh of two sub-domains. The half that hardly
/// bends is one element. With more elements there would be springs of 1e12 times 1e3 in a row, and the support by the
/// soft half would be below their round-off.
scene::Scene halves(double first, double second) {
  const auto elements = [](double own, double other) { return own > other ? 1 : 8; };
  scene::Scene s;
  s.name = "halves";
  for (const auto& [name, k] : {std::pair{"first", first}, std::pair{"second", second}})
    s.sections.push_back(scene::make_section(name, 1e3 * k, 4e2 * k, 4e2 * k, 0.8 * k, k, k));
  s.nodes = {scene::make_node("root", Vec3::zero()), scene::make_node("middle", {{0.5, 0, 0}}),
             scene::make_node("tip", {{1, 0, 0}})};
  s.beams = {scene::make_beam("beam 1", "first", "root", "middle", elements(first, second), 3),
             scene::make_beam("beam 2", "second", "middle", "tip", elements(second, first), 3)};
  s.joints = {scene::make_weld("clamp", "root")};
  s.sensors = {scene::make_point_sensor("tip", scene::SensorKind::position, "tip"),
               scene::make_joint_sensor("clamp", "clamp")};
  s.point_loads = {scene::make_load("tip", {{0.0, tip_force, 0.0}})};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = 4;
  s.analysis.tolerance = 1e-11;
  return s;
}

void stiffness(Bench& bench, int depth) {
  const auto piece = [](double k) { return RodPiece{0.5, 1e3 * k, 4e2 * k, k, 0.0, 0.0}; };
  for (int decade = 0; decade <= 12; decade += 3)
    for (const bool soft_first : {false, true}) {
      const double k = std::pow(10.0, decade), first = soft_first ? 1.0 : k, second = soft_first ? k : 1.0;
      scene::Scene s = halves(first, second);
      s.solver.depth = depth;
      const std::string label = std::string(soft_first ? "soft" : "stiff") + " root, 1e" + std::to_string(decade);
      const run::MemoryRun run = bench.run(s, label);
      const std::vector<RodSection> exact = cantilever_rod({piece(first), piece(second)}, 0.0, tip_force);
      bench.error("tip, " + label, std::hypot(run.final("tip.x") - exact.back().x, run.final("tip.y") - exact.back().y),
                  1e-8);
      bench.error("clamp, " + label,
                  std::max(std::abs(std::abs(run.final("clamp.mz")) - exact.front().moment),
                           std::abs(std::abs(run.final("clamp.fy")) - tip_force)) /
                      tip_force,
                  1e-8);
    }
}

void stiffness_in_scene(Bench& bench) { stiffness(bench, 0); }
void stiffness_across_interface(Bench& bench) { stiffness(bench, 1); }

/// Eight elements 1e12 times as stiff on a soft half: their support is less than the round-off of their own stiffness.
void beyond_round_off(Bench& bench) {
  scene::Scene s = halves(1.0, 1e12);
  s.beams[1].elements = 8;
  bench.expect_refusal(s, {"nothing holds", "beam 2", "softly"});
}

/// Bodies welded into one pendulum about z, alternately heavy and light. All masses in kg, bars of 0.1 m.
scene::Scene welded_pendulum(int bodies, double light) {
  scene::Scene s;
  s.name = "welded";
  s.gravity = {{0.0, -9.81, 0.0}};
  const double length = 0.1;
  for (int k = 0; k < bodies; ++k) {
    const double m = k % 2 == 0 ? 1.0 : light, J = m * length * length / 12.0;
    const std::string name = "bar " + std::to_string(k);
    s.bodies.push_back(scene::make_body(name, m, {{0.01 * J, J, J}}, {{length * (k + 0.5), 0.0, 0.0}}));
    if (k == 0)
      s.joints.push_back(
          scene::make_joint("hinge", scene::JointKind::revolute, "", Vec3::zero(), name, {{-0.5 * length, 0.0, 0.0}}));
    else
      s.joints.push_back(scene::make_joint("weld " + std::to_string(k), scene::JointKind::fixed,
                                           "bar " + std::to_string(k - 1), {{0.5 * length, 0.0, 0.0}}, name,
                                           {{-0.5 * length, 0.0, 0.0}}));
  }
  s.sensors = {scene::make_joint_sensor("angle", "hinge", scene::SensorKind::joint_angle),
               scene::make_joint_sensor("hinge", "hinge")};
  s.analysis.spectral_radius = 0.9;
  s.analysis.tolerance = 1e-10;
  return s;
}

/// Steps h and h / 2 separate the integrator's error, of second order, from that of the masses.
void mass_ratios(Bench& bench) {
  const int bodies = 12;
  const double end = 0.5, h = 2e-3;
  for (int decade = 0; decade <= 12; decade += 3) {
    const double light = std::pow(10.0, -decade);
    scene::Scene s = welded_pendulum(bodies, light);
    double mass = 0.0, first_moment = 0.0, inertia = 0.0;
    for (const scene::Body& b : s.bodies) {
      mass += b.mass;
      first_moment += b.mass * b.placement.pose.x[0];
      inertia += b.inertia(2, 2) + b.mass * b.placement.pose.x[0] * b.placement.pose.x[0];
    }
    const PendulumState exact = physical_pendulum(9.81 * first_moment / inertia, 0.0, end);
    const double centre = first_moment / mass, c = std::cos(exact.angle);
    const double turn = 9.81 * first_moment / inertia * c;  // magnitude of the angular acceleration
    const double along = mass * (exact.rate * exact.rate * centre + 9.81 * std::sin(-exact.angle)),
                 across = mass * (9.81 * c - turn * centre);
    double angle[2] = {}, force[2] = {};
    for (int k = 0; k < 2; ++k) {
      s.analysis.end_time = end;
      s.analysis.step_size = k == 0 ? h : 0.5 * h;
      const run::MemoryRun run = bench.run(s, "masses 1 to 1e-" + std::to_string(decade));
      angle[k] = run.final("angle");
      force[k] = std::hypot(run.final("hinge.fx"), run.final("hinge.fy"));
    }
    const std::string label = ", masses 1 to 1e-" + std::to_string(decade);
    bench.error("angle" + label, std::abs(angle[1] + (angle[1] - angle[0]) / 3.0 - exact.angle), 1e-7);
    bench.error("hinge force" + label,
                std::abs(force[1] + (force[1] - force[0]) / 3.0 - std::hypot(along, across)) / (9.81 * mass), 1e-6);
  }
}

/// The same motion, reactions in proportion, when all masses are scaled.
void scaled_masses(Bench& bench) {
  for (const int decade : {-12, -6, 6, 12}) {
    const double factor = std::pow(10.0, decade);
    scene::Scene s = welded_pendulum(4, 0.5);
    s.joints[2].kind = scene::JointKind::revolute;  // two bars on two bars
    s.sensors.push_back(scene::make_joint_sensor("second", "weld 2", scene::SensorKind::joint_angle));
    s.analysis.end_time = 0.5;
    s.analysis.step_size = 5e-3;
    s.analysis.tolerance = 1e-11;
    const run::MemoryRun base = bench.run(s);
    scene::scale_masses(s, factor);
    const run::MemoryRun other = bench.run(s, "masses times " + io::rounded_text(factor, 1));
    double motion = 0.0, reaction = 0.0;
    const double size = std::max(base.largest("hinge.fx"), base.largest("hinge.fy"));
    for (std::size_t r = 0; r < base.rows.size(); ++r)
      for (const char* name : {"angle", "second", "hinge.fx", "hinge.fy"}) {
        const std::size_t c = base.column(name);
        const bool is_force = name[0] == 'h';
        const double d = std::abs(other.rows.at(r).values[c] / (is_force ? factor : 1.0) - base.rows[r].values[c]);
        (is_force ? reaction : motion) = std::max(is_force ? reaction : motion, is_force ? d / size : d);
      }
    bench.round_off_error("motion, masses times 1e" + std::to_string(decade), motion, 1e-9);
    bench.round_off_error("reactions, masses times 1e" + std::to_string(decade), reaction, 1e-8);
  }
}

}  // namespace

void add_ratios(std::vector<Definition>& table) {
  table.push_back({"stiffness_in_scene", "ratios",
                   "a cantilever of two halves whose stiffnesses differ by 1 to 1e12, either first, one domain: tip to "
                   "1e-8 L, clamp reaction to 1e-8",
                   stiffness_in_scene});
  table.push_back({"stiffness_across_interface", "ratios",
                   "the same with the junction on the interface of two sub-domains: tip to 1e-8 L, clamp to 1e-8",
                   stiffness_across_interface});
  table.push_back(
      {"stiffness_beyond_round_off", "ratios",
       "a soft root under eight elements 1e12 as stiff: a condition of 1e18 leaves no digit; refused, and what "
       "cannot be told from free motion is named",
       beyond_round_off, StressStatus::refused});
  table.push_back({"mass_ratios", "ratios",
                   "a pendulum of 12 bodies welded to each other, masses alternately 1 and down to 1e-12: the closed "
                   "form of one body, extrapolated from two steps, to 1e-7 rad and 1e-6 of the weight",
                   mass_ratios});
  table.push_back(
      {"scaled_masses", "ratios",
       "all masses times 1e-12 to 1e12: the same motion to 1e-9, reactions in proportion to 1e-8 (round-off "
       "of positions over h^2)",
       scaled_masses});
}

}  // namespace bough::stress
