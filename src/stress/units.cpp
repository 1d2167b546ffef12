/// The same scene in millimetres and tonnes.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/scene/parts.hpp"

namespace bough::stress {

namespace {

constexpr scene::JointKind hinge = scene::JointKind::revolute;

void set_steps(scene::Scene& s, double end, double h) {
  s.analysis.end_time = end;
  s.analysis.step_size = h;
  s.analysis.tolerance = 1e-11;
}

/// A bar on a hinge, a second one on a ball joint; steel, out of the plane.
scene::Scene two_bars() {
  scene::Scene s;
  s.name = "two bars";
  s.gravity = {{0.0, -9.81, 1.0}};
  s.bodies = {scene::make_body("upper", 7.0, {{0.01, 0.3, 0.3}}, {{0.35, 0.0, 0.0}}),
              scene::make_body("lower", 3.0, {{0.02, 0.1, 0.1}}, {{0.95, 0.0, 0.0}})};
  s.joints = {
      scene::make_joint("hinge", hinge, "", Vec3::zero(), "upper", {{-0.35, 0, 0}}),
      scene::make_joint("ball", scene::JointKind::spherical, "upper", {{0.35, 0, 0}}, "lower", {{-0.25, 0, 0}})};
  s.sensors = {scene::make_point_sensor("lower", scene::SensorKind::position, "lower"),
               scene::make_joint_sensor("hinge force", "hinge"), scene::make_joint_sensor("ball force", "ball")};
  set_steps(s, 0.5, 5e-3);
  return s;
}

/// A soft steel strip on a hinge with a body at its end.
scene::Scene beam_pendulum() {
  scene::Scene s;
  s.name = "beam pendulum";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.sections = {scene::make_section("strip", 4.2e6, 1.3e6, 1.3e6, 9.0, 35.0, 14.0)};
  scene::set_mass(s.sections[0], 0.157, 5e-7, 3e-7, 2e-7);
  s.nodes = {scene::make_node("root", Vec3::zero()), scene::make_node("tip", {{0.5, 0, 0}})};
  s.beams = {scene::make_beam("beam", "strip", "root", "tip", 6, 2)};
  s.bodies = {scene::make_body("bob", 0.2, {{1e-4, 2e-4, 3e-4}}, {{0.5, 0.0, 0.0}})};
  s.joints = {scene::make_joint("hinge", hinge, "", Vec3::zero(), "root", Vec3::zero()),
              scene::make_joint("weld", scene::JointKind::fixed, "tip", Vec3::zero(), "bob", Vec3::zero())};
  s.sensors = {scene::make_point_sensor("bob", scene::SensorKind::position, "bob"),
               scene::make_joint_sensor("hinge force", "hinge")};
  set_steps(s, 0.3, 5e-3);
  return s;
}

/// A top on a ball joint, spun.
scene::Scene top() {
  scene::Scene s;
  s.name = "top";
  s.gravity = {{0.0, 0.0, -9.81}};
  s.bodies = {scene::make_body("top", 15.0, {{0.25, 0.25, 0.47}}, {{0.3, 0.0, 1.0}})};
  s.joints = {scene::make_joint("ball", scene::JointKind::spherical, "", Vec3::zero(), "top", {{-0.3, 0.0, -1.0}})};
  scene::InitialVelocity spin;
  spin.of = "top";
  spin.angular_velocity = {{0.0, 0.0, 20.0}};
  spin.velocity = {{0.0, 6.0, 0.0}};
  s.initial_velocities = {spin};
  s.sensors = {scene::make_point_sensor("top", scene::SensorKind::position, "top"),
               scene::make_joint_sensor("ball force", "ball")};
  set_steps(s, 0.5, 5e-3);
  return s;
}

void millimetres(Bench& bench) {
  for (scene::Scene s : {two_bars(), beam_pendulum(), top()}) {
    const run::MemoryRun base = bench.run(s, s.name + " in SI units");
    scene::to_millimetres(s);
    const run::MemoryRun other = bench.run(s, s.name + " in millimetres");
    double worst[2] = {0.0, 0.0};  // motion, reactions
    for (std::size_t c = 0; c < base.header.columns.size(); ++c) {
      const std::string& column = base.header.columns[c];
      const std::string sensor = column.substr(0, column.rfind('.'));
      const bool is_reaction = sensor.find("force") != std::string::npos;
      const bool is_moment = is_reaction && column[column.rfind('.') + 1] == 'm';
      double size = 0.0, difference = 0.0;
      for (const std::string& other_column : base.header.columns)
        if (other_column.rfind(sensor + "." + (is_moment ? "m" : is_reaction ? "f" : ""), 0) == 0)
          size = std::max(size, base.largest(other_column));
      const double factor = scene::column_factor(s, column, 1e3, 1.0);
      for (std::size_t r = 0; r < base.rows.size(); ++r)
        difference = std::max(difference, std::abs(other.rows.at(r).values[c] / factor - base.rows[r].values[c]));
      if (size > 0.0) worst[is_reaction ? 1 : 0] = std::max(worst[is_reaction ? 1 : 0], difference / size);
    }
    bench.round_off_error("motion of " + s.name, worst[0], 1e-9);
    bench.round_off_error("reactions of " + s.name, worst[1], 1e-9);
  }
}

}  // namespace

void add_units(std::vector<Definition>& table) {
  table.push_back({"millimetres_and_tonnes", "units",
                   "bodies, a beam and a top in SI units and in mm, t, s: the same motion and the same reactions to "
                   "1e-9 of the largest",
                   millimetres});
}

}  // namespace bough::stress
