/// What the plan leaves out changes no result: every scene of the gallery with each decision taken and barred.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bough/plan/plan.hpp"
#include "bough/scene/components.hpp"
#include "support/scenes.hpp"
#include "support/source_dir.hpp"

namespace bough::study {
namespace {

using support::Outcome;

std::vector<std::string> gallery_stems() {
  std::vector<std::string> stems;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data/scenarios"))
    if (entry.path().extension() == ".json") stems.push_back(entry.path().stem().string());
  std::sort(stems.begin(), stems.end());
  return stems;
}

/// The scene with places and velocities off by about one part in 1e15, each by its own; within a plane or a line, if they were.
scene::Scene twin_of(scene::Scene s, int k) {
  const auto shake = [&k](scene::Vec3& v) {
    const double factor = 1.0 + (++k % 3 - 1) * 1e-15;
    for (int i = 0; i < 3; ++i) v[i] *= factor;
  };
  for (scene::Node& n : s.nodes) shake(n.placement.pose.x);
  for (scene::Body& b : s.bodies) shake(b.placement.pose.x);
  for (scene::InitialVelocity& v : s.initial_velocities) {
    shake(v.velocity);
    shake(v.angular_velocity);
  }
  shake(s.gravity);
  return s;
}

/// Largest difference of a column over the rows that both have.
double difference(const support::Table& a, const support::Table& b, std::size_t column) {
  double most = a.rows.size() == b.rows.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < std::min(a.rows.size(), b.rows.size()); ++r)
    most = std::max(most, std::abs(a.rows[r][column] - b.rows[r][column]));
  return most;
}

/// Largest entry of the columns of one sensor: its vector's components share round-off.
double size_of_sensor(const support::Table& t, const std::string& column) {
  const std::string sensor = column.substr(0, column.rfind('.'));
  double most = 0.0;
  for (std::size_t c = 0; c < t.columns.size(); ++c)
    if (t.columns[c].substr(0, t.columns[c].rfind('.')) == sensor)
      for (const auto& row : t.rows) most = std::max(most, std::abs(row[c]));
  return most;
}

/// What round-off alone leaves: eps |x| / h in velocities, eps |x| / h^2 in accelerations, eps m |x| / h^2 in forces and eps of the terms of
/// energies, whatever their sum is.
double floor_of(const scene::Scene& s, const plan::Plan& plan, const Outcome& run, const std::string& column) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const double h = s.analysis.kind == scene::AnalysisKind::dynamics ? s.analysis.step_size : 1.0;
  double mass = 0.0;
  for (const scene::Body& b : s.bodies) mass += b.mass;
  for (const plan::BeamPlan& b : plan.beams)
    for (const scene::Beam& given : s.beams)
      for (const scene::Section& section : s.sections)
        if (given.name == b.name && given.section == section.name) mass += section.mass(0, 0) * b.length;
  for (const scene::Sensor& sensor : s.sensors) {
    if (column.substr(0, column.rfind('.')) != sensor.name && column != sensor.name) continue;
    switch (sensor.kind) {
      case scene::SensorKind::velocity:
      case scene::SensorKind::joint_rate:
        return eps * plan.length_scale / h;
      case scene::SensorKind::acceleration:
        return eps * plan.length_scale / (h * h);
      case scene::SensorKind::joint_reaction:
      case scene::SensorKind::section_force:
        return eps * mass * plan.length_scale / (h * h) * std::max(1.0, plan.length_scale);
      case scene::SensorKind::total_energy:
        return 1e-10 * run.summary.checks.energy_scale;
      default:
        return 0.0;
    }
  }
  return 0.0;
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, has_the_same_results_with_and_without_each_decision) {
  const scene::Scene given = support::gallery(GetParam());
  const plan::Plan plan = plan::make_plan(given);
  const Outcome given_run = support::run(given);
  ASSERT_TRUE(given_run.ok()) << given_run.summary.cause;
  // Iterations with old factors end elsewhere within the tolerance: these are compared at one near round-off.
  scene::Scene tight = given;
  tight.analysis.tolerance = 1e-12;
  const Outcome tight_run = support::run(tight);
  std::vector<Outcome> given_twins, tight_twins;
  for (int k = 0; k < 3; ++k) {  // one alone may happen to come near
    given_twins.push_back(support::run(twin_of(given, k)));
    tight_twins.push_back(support::run(twin_of(tight, k)));
  }
  for (const plan::Decision& d : plan.decisions) {
    if (!d.taken || !d.can_be_barred) continue;
    const bool is_tight = d.name == "reuse";
    const Outcome& all = is_tight ? tight_run : given_run;
    scene::Scene s = is_tight ? tight : given;
    s.without = {d.name};
    const Outcome without = support::run(s);
    ASSERT_TRUE(without.ok()) << d.name << ": " << without.summary.cause;
    for (std::size_t c = 0; c < all.history.columns.size(); ++c) {
      const std::string& column = all.history.columns[c];
      double allowed = std::max(1e-10 * size_of_sensor(all.history, column), floor_of(given, plan, all, column));
      for (const Outcome& twin : is_tight ? tight_twins : given_twins)
        allowed = std::max(allowed, 10.0 * difference(all.history, twin.history, c));
      const double found = difference(all.history, without.history, c);
      EXPECT_LE(found, allowed) << d.name << ", " << column << ": " << found / size_of_sensor(all.history, column);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gallery, EveryScene, testing::ValuesIn(gallery_stems()),
                         [](const auto& given) { return given.param; });

}  // namespace
}  // namespace bough::study
