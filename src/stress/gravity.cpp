/// No gravity and huge gravity.
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/parts.hpp"

namespace bough::stress {

namespace {

scene::Scene hanging_pair(double g) {
  scene::Scene s;
  s.name = "pair";
  s.gravity = {{0.0, -g, 0.0}};
  s.bodies = {scene::make_body("upper", 2.0, {{0.1, 0.2, 0.2}}, {{0.5, 0.0, 0.0}}),
              scene::make_body("lower", 1.0, {{0.1, 0.1, 0.1}}, {{1.5, 0.0, 0.0}})};
  s.joints = {scene::make_joint("root", scene::JointKind::revolute, "", Vec3::zero(), "upper", {{-0.5, 0, 0}}),
              scene::make_joint("ball", scene::JointKind::spherical, "upper", {{0.5, 0, 0}}, "lower", {{-0.5, 0, 0}})};
  s.sensors = {scene::make_point_sensor("lower", scene::SensorKind::position, "lower"),
               scene::make_joint_sensor("root", "root")};
  s.analysis.end_time = 0.5;
  s.analysis.step_size = 2.5e-3;
  s.analysis.tolerance = 1e-11;
  return s;
}

void none(Bench& bench) {
  scene::Scene s = hanging_pair(0.0);
  s.sections = {scene::make_section("bar", 8.4e7, 2.7e7, 2.7e7, 1.8e3, 2.8e3, 2.8e3)};
  scene::set_mass(s.sections[0], 3.14, 2.1e-4, 1.05e-4, 1.05e-4);
  s.nodes = {scene::make_node("a", {{2, 0, 0}}), scene::make_node("b", {{3, 0, 0}})};
  s.beams = {scene::make_beam("beam", "bar", "a", "b", 4, 2)};
  s.joints.push_back(scene::make_joint("pin", scene::JointKind::spherical, "lower", {{0.5, 0, 0}}, "a", Vec3::zero()));
  s.sensors.push_back(scene::make_point_sensor("end", scene::SensorKind::position, "b"));
  const run::MemoryRun run = bench.run(s);
  double moved = 0.0, force = 0.0;
  for (const records::HistoryRow& row : run.rows)
    for (std::size_t c = 0; c < row.values.size(); ++c) {
      const bool is_force = run.header.columns[c].rfind("root", 0) == 0;
      const double v = is_force ? std::abs(row.values[c]) : std::abs(row.values[c] - run.rows.front().values[c]);
      (is_force ? force : moved) = std::max(is_force ? force : moved, v);
    }
  bench.figure("motion out of rest [m]", moved, 0.0);
  bench.figure("reactions out of nothing [N, N m]", force, 0.0);
}

/// Gravity times s^2 in time over s: the same path.
void huge(Bench& bench) {
  const run::MemoryRun base = bench.run(hanging_pair(9.81));
  for (const double s : {1e-4, 1e4}) {
    scene::Scene other = hanging_pair(9.81 * s * s);
    other.analysis.end_time /= s;
    other.analysis.step_size /= s;
    const run::MemoryRun run = bench.run(other, "gravity times " + io::rounded_text(s * s, 1));
    double place = 0.0, force = 0.0, size = 0.0;
    for (std::size_t r = 0; r < base.rows.size(); ++r)
      for (std::size_t c = 0; c < base.header.columns.size(); ++c) {
        const bool is_force = base.header.columns[c].rfind("root", 0) == 0;
        const double d = std::abs(run.rows.at(r).values[c] / (is_force ? s * s : 1.0) - base.rows[r].values[c]);
        if (is_force) size = std::max(size, std::abs(base.rows[r].values[c]));
        (is_force ? force : place) = std::max(is_force ? force : place, d);
      }
    bench.round_off_error("place, gravity times " + io::rounded_text(s * s, 1), place, 1e-9);
    bench.round_off_error("reactions, gravity times " + io::rounded_text(s * s, 1), force / size, 1e-8);
  }
}

}  // namespace

void add_gravity(std::vector<Definition>& table) {
  table.push_back(
      {"no_gravity", "gravity", "without gravity what is at rest stays there, exactly: bodies, joints, a beam", none});
  table.push_back({"huge_gravity", "gravity",
                   "gravity times 1e-8 and 1e8 in steps times 1e4 and 1e-4: the same path to 1e-9 m, reactions in "
                   "proportion to 1e-8",
                   huge});
}

}  // namespace bough::stress
