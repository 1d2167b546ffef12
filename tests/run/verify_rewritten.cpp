// Scenes rewritten with signals: what laws, springs and gravity do there, signals do. Laws of time keep every bit;
// forces by formulas and weights differ by round-off and the tolerance of Newton's method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bough/io/number_text.hpp"
#include "bough/scene/couplings.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::gallery;
using support::Outcome;
using support::run_ok;

/// Gives a law to a signal of time, and returns its name.
std::string as_signal(scene::Scene& s, laws::Law& law) {
  scene::Signal signal;
  signal.name = "law_" + std::to_string(s.signals.size());
  signal.kind = scene::SignalKind::time;
  signal.law = law;
  law = {};
  s.signals.push_back(signal);
  return signal.name;
}

/// Laws of drives and loads as signals.
scene::Scene with_laws_as_signals(scene::Scene s) {
  const auto give = [&s](laws::Law& law, std::string& name) { name = as_signal(s, law); };
  for (scene::Joint& joint : s.joints)
    for (scene::JointDrive& drive : joint.drives)
      if (!drive.is_rate) give(drive.law, drive.signal);
  for (scene::PointLoad& load : s.point_loads) give(load.law, load.signal);
  for (scene::LineLoad& load : s.line_loads) give(load.law, load.signal);
  return s;
}

std::string in_brackets(double x) {
  std::string text = "(";
  io::append_number(text, x);
  return text + ")";
}

/// Springs and dampers between points as struts with an effort that is a formula of their length and its rate.
scene::Scene with_springs_as_signals(scene::Scene s) {
  for (const scene::Coupling& spring : s.couplings) {
    const auto tension = scene::line_force_of(spring);
    if (!tension) continue;
    scene::Joint strut;
    strut.name = spring.name;
    strut.kind = scene::JointKind::strut;
    strut.first = spring.first;
    strut.second = spring.second;
    const std::string number = std::to_string(s.signals.size());
    scene::Signal length, rate, force;
    length.name = "length_" + number;
    length.kind = scene::SignalKind::joint_displacement;
    rate.name = "rate_" + number;
    rate.kind = scene::SignalKind::joint_rate;
    length.joint = rate.joint = strut.name;
    force.name = "force_" + number;
    force.kind = scene::SignalKind::formula;
    force.inputs = {length.name, rate.name};
    force.formula =
        laws::Formula("-" + in_brackets(tension->stiffness) + "*(" + length.name + " - " +
                          in_brackets(tension->rest_length) + ") - " + in_brackets(tension->damping) + "*" + rate.name,
                      force.inputs);
    scene::JointForce effort;
    effort.coordinate = "displacement";
    effort.signal = force.name;
    strut.forces.push_back(effort);
    s.joints.push_back(strut);
    for (const scene::Signal* signal : {&length, &rate, &force}) s.signals.push_back(*signal);
  }
  s.couplings.clear();
  return s;
}

/// Largest difference of the two histories, each column over its largest value or that of its sensor. Energies are left
/// out, since what signals drive stores none.
double difference(const Outcome& a, const Outcome& b, const std::string& without = "energy") {
  EXPECT_EQ(a.history.times, b.history.times);
  EXPECT_EQ(a.history.columns, b.history.columns);
  double most = 0.0;
  for (const std::string& column : a.history.columns) {
    if (column.find("energy") != std::string::npos || column.find(without) != std::string::npos) continue;
    double size = 0.0;
    for (const std::string& other : a.history.columns)
      if (other.substr(0, other.rfind('.')) == column.substr(0, column.rfind('.')))
        size = std::max(size, a.history.largest(other));
    for (std::size_t i = 0; i < a.history.times.size(); ++i)
      if (size > 0.0) most = std::max(most, std::abs(a.history.of(column)[i] - b.history.of(column)[i]) / size);
  }
  return most;
}

scene::Scene shortened(const std::string& name, double end, std::vector<std::string> overrides = {}) {
  overrides.emplace_back("/expected=[]");
  overrides.push_back("/analysis/end_time=" + support::text(end));
  return gallery(name, overrides);
}

TEST(Rewritten, laws_of_time_as_signals_keep_every_bit) {
  for (const auto& [name, end] : {std::pair{"spin_up", 0.5}, std::pair{"flying_spaghetti", 1.0},
                                  std::pair{"right_angle_cantilever", 1.0}, std::pair{"tower_crane_jib", 0.05}}) {
    SCOPED_TRACE(name);
    const scene::Scene s = shortened(name, end), signals = with_laws_as_signals(s);
    ASSERT_FALSE(signals.signals.empty());
    const Outcome a = run_ok(s), b = run_ok(signals);
    EXPECT_EQ(a.history.rows, b.history.rows) << difference(a, b);
  }
}

TEST(Rewritten, springs_as_signals_differ_by_round_off) {
  for (const auto& [name, end] : {std::pair{"struck_row", 0.2}, std::pair{"spring_carousel", 0.5}}) {
    SCOPED_TRACE(name);
    const scene::Scene s = shortened(name, end, {"/analysis/tolerance=1e-12", "/output/checks=false"});
    const Outcome a = run_ok(s), b = run_ok(with_springs_as_signals(s));
    EXPECT_LT(difference(a, b), 1e-9);
  }
}

TEST(Rewritten, gravity_of_a_signal_differs_by_round_off) {
  for (const auto& [name, end] : {std::pair{"double_pendulum", 0.5}, std::pair{"heavy_top", 0.2}}) {
    SCOPED_TRACE(name);
    const std::vector<std::string> list = {"/analysis/tolerance=1e-12", "/output/checks=false"};
    std::vector<std::string> rewritten = list;
    const scene::Scene s = shortened(name, end, list);
    std::string vector;
    for (int k = 0; k < 3; ++k) vector += (k == 0 ? "" : ", ") + support::text(s.gravity[k]);
    rewritten.push_back(R"(/gravity={"vector": [)" + vector + R"(], "law": {"signal": "one"}})");
    rewritten.emplace_back(R"(/signals=[{"name": "one", "kind": "time", "law": 1}])");
    const Outcome a = run_ok(s), b = run_ok(shortened(name, end, rewritten));
    EXPECT_LT(difference(a, b, "force"), 1e-9);
    EXPECT_LT(difference(a, b), 1e-6);  // reactions answer the rounding of places with h^-2
  }
}

}  // namespace
}  // namespace bough::run
