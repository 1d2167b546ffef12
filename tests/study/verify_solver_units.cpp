/// The motion of rigid scenes under gravity depends neither on the unit of mass nor on that of length.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

void scale_masses(scene::Scene& s, double factor) {
  for (scene::Body& b : s.bodies) {
    b.mass *= factor;
    b.inertia = factor * b.inertia;
  }
  for (scene::Section& c : s.sections) {  // a beam's stiffness along, so that its frequencies stay
    c.mass = factor * c.mass;
    c.stiffness = factor * c.stiffness;
    c.damping = factor * c.damping;
  }
  for (scene::Joint& j : s.joints)
    for (scene::JointForce& f : j.forces) {
      ASSERT_EQ(f.effort.node(), nullptr);
      f.stiffness *= factor;
      f.damping *= factor;
    }
}

/// Millimetres and tonnes: forces stay newtons, moments become N mm.
void to_millimetres(scene::Scene& s) {
  const auto longer = [](Vec3<double>& v) { v = 1e3 * v; };
  longer(s.gravity);
  for (scene::Node& n : s.nodes) longer(n.placement.pose.x);
  for (scene::Body& b : s.bodies) {
    longer(b.placement.pose.x);
    longer(b.center_of_mass);
    b.mass *= 1e-3;
    b.inertia = 1e3 * b.inertia;
  }
  for (scene::Section& c : s.sections)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double lengths = (i < 3 ? 1.0 : 1e3) * (j < 3 ? 1.0 : 1e3);  // N, N mm, N mm^2
        c.stiffness(i, j) *= lengths;
        c.mass(i, j) *= 1e-6 * lengths;  // t/mm, t, t mm
      }
  for (scene::Joint& j : s.joints) {
    longer(j.first.offset.x);
    longer(j.second.offset.x);
    ASSERT_TRUE(j.forces.empty());
  }
  for (scene::InitialVelocity& v : s.initial_velocities) longer(v.velocity);
  for (scene::Sensor& q : s.sensors) longer(q.at.offset.x);
}

struct Case {
  const char* name;
  double end;
  double tolerance;  ///< of the largest value of the sensor
};

/// A column's factor: positions by `length`, forces by `force`, moments and energies by both; angles and directions by nothing.
double factor_of(const scene::Scene& s, const std::string& column, double length, double force) {
  for (const scene::Sensor& q : s.sensors) {
    if (column != q.name && column.rfind(q.name + ".", 0) != 0) continue;
    const std::string component = column == q.name ? "" : column.substr(q.name.size() + 1);
    switch (q.kind) {
      case scene::SensorKind::position:
      case scene::SensorKind::joint_displacement:
        return length;
      case scene::SensorKind::velocity:
      case scene::SensorKind::acceleration:
        return component[0] == 'w' || component[1] == 'l' ? 1.0 : length;
      case scene::SensorKind::joint_reaction:
        return component[0] == 'm' ? force * length : force;
      case scene::SensorKind::section_force:
        return component[0] == 'M' || component[0] == 'T' ? force * length : force;
      case scene::SensorKind::kinetic_energy:
      case scene::SensorKind::potential_energy:
      case scene::SensorKind::strain_energy:
      case scene::SensorKind::total_energy:
        return force * length;
      default:
        return 1.0;
    }
  }
  return 1.0;
}

/// Largest difference of any column, relative to the largest of the columns of its sensor.
void expect_same_motion(const Case& c, const std::function<void(scene::Scene&)>& change, double length, double force,
                        const char* what) {
  scene::Scene s = gallery(c.name);
  s.expected.clear();
  s.analysis.end_time = c.end;
  s.analysis.tolerance =
      1e-11;  // below, what Newton leaves would show: 1e-14 of a length is 1e-8 of a force at these steps
  const Outcome base = run(s);
  change(s);
  const Outcome other = run(s);
  ASSERT_TRUE(base.ok() && other.ok()) << c.name << ": " << base.text() << other.text();
  ASSERT_EQ(base.rows.size(), other.rows.size()) << c.name;
  double worst = 0.0;
  for (std::size_t q = 0; q < base.header.columns.size(); ++q) {
    const std::string& column = base.header.columns[q];
    const std::string sensor = column.substr(0, column.rfind('.'));
    double most = 0.0, difference = 0.0;
    for (std::size_t p = 0; p < base.header.columns.size(); ++p)
      if (base.header.columns[p].rfind(sensor, 0) == 0)
        for (const results::HistoryRow& row : base.rows) most = std::max(most, std::abs(row.values[p]));
    const double factor = factor_of(s, column, length, force);
    for (std::size_t r = 0; r < base.rows.size(); ++r)
      difference = std::max(difference, std::abs(other.rows[r].values[q] / factor - base.rows[r].values[q]));
    if (column == "energy") most = std::max(most, base.summary.checks.energy_scale);  // parts that nearly cancel
    if (most > 0.0) worst = std::max(worst, difference / most);
    EXPECT_LE(difference, c.tolerance * most) << c.name << ", " << what << ", " << column;
  }
  std::printf("  %s, %s: %.1e\n", c.name, what, worst);
}

/// 1e-9; 1e-8 where a reaction is measured: round-off of a position, 2e-16, over h^2 = 1e-6 is 1e-10 of a force in each step, and rings.
const Case cases[] = {{"pendulum", 0.5, 1e-8},     {"double_pendulum", 0.5, 1e-9}, {"heavy_top", 0.02, 1e-8},
                      {"free_body", 0.5, 1e-9},    {"bricard", 0.1, 1e-9},         {"four_bar_planar", 0.3, 1e-9},
                      {"slider_crank", 0.05, 1e-8}};

TEST(VerifySolverUnits, masses_may_all_be_scaled) {
  for (const Case& c : cases)
    for (const double factor : {1e-6, 1e6})
      expect_same_motion(
          c, [factor](scene::Scene& s) { scale_masses(s, factor); }, 1.0, factor, "masses");
}

TEST(VerifySolverUnits, millimetres_and_tonnes_give_the_same_motion) {
  for (const Case& c : cases) expect_same_motion(c, to_millimetres, 1e3, 1.0, "mm and t");
}

}  // namespace
}  // namespace bough::verify
