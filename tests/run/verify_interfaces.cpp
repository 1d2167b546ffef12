// Forces at the interfaces of sub-domains: they balance each other and the loads, and are what sensors of sections and
// of joints show at the same place.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

const std::vector<std::string> forces{"fx", "fy", "fz", "mx", "my", "mz"};

/// A cantilever under a dead load at its tip, divided once: both sub-domains share the node in the middle.
scene::Scene cantilever(const std::vector<std::string>& overrides) {
  return scene_of(R"-({
  "sections": [{"name": "bar", "stiffness": {"EA": 1e5, "GA2": 4e4, "GA3": 4e4, "GJ": 100, "EI2": 120, "EI3": 150},
                "mass": {"mass_per_length": 2, "rotary": [0.02, 0.01, 0.01]}}],
  "nodes": [{"name": "root", "position": [0, 0, 0]}, {"name": "tip", "position": [2, 0, 0]}],
  "beams": [{"name": "bar", "section": "bar", "start": "root", "end": "tip", "elements": 8}],
  "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
  "loads": [{"name": "load", "at": "tip", "force": [3, -20, 8]}],
  "solver": {"depth": 1},
  "sensors": [{"name": "a", "kind": "interface_force", "subdomain": "0"},
              {"name": "b", "kind": "interface_force", "subdomain": "1"},
              {"name": "clamp", "kind": "joint_reaction", "joint": "clamp"},
              {"name": "middle", "kind": "position", "at": "bar.4"},
              {"name": "tip", "kind": "position", "at": "tip"},
              {"name": "section", "kind": "section_force", "beam": "bar", "station": 0.5},
              {"name": "axes", "kind": "rotation", "at": "bar.4"}]})-",
                  overrides);
}

TEST(Interfaces, in_statics_their_forces_balance_each_other_and_the_load) {
  const Outcome r = run_ok(cantilever({R"-(/analysis={"kind": "static", "load_steps": 4, "tolerance": 1e-11})-"}));
  const support::Table& h = r.history;
  for (const std::string& c : forces) EXPECT_NEAR(h.last("a." + c) + h.last("b." + c), 0.0, 1e-8) << c;
  // One of the two sub-domains holds the tip: it is held against the load.
  const double load[] = {3.0, -20.0, 8.0};
  const std::string outer = std::abs(h.last("a.fy") - 20.0) < 1.0 ? "a" : "b";
  const double arm[] = {h.last("tip.x") - h.last("middle.x"), h.last("tip.y") - h.last("middle.y"),
                        h.last("tip.z") - h.last("middle.z")};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    EXPECT_NEAR(h.last(outer + "." + forces[static_cast<std::size_t>(i)]), -load[i], 1e-8);
    EXPECT_NEAR(h.last(outer + "." + forces[static_cast<std::size_t>(3 + i)]), -(arm[j] * load[k] - arm[k] * load[j]),
                1e-7);
  }
}

/// In a plane and in space, in time: the resultants of the section there, turned into the ground's axes.
TEST(Interfaces, in_time_their_forces_are_those_of_the_section) {
  for (const char* load : {"[3, -20, 8]", "[3, -20, 0]"}) {
    const Outcome r = run_ok(cantilever({std::string("/loads/0/force=") + load,
                                         R"-(/analysis={"kind": "dynamic", "end_time": 0.2, "step_size": 2e-3})-"}));
    const support::Table& h = r.history;
    const double span = h.largest("section.Q2");
    for (std::size_t k = 0; k < h.rows.size(); ++k) {
      for (const std::string& c : forces)
        EXPECT_NEAR(h.of("a." + c)[k] + h.of("b." + c)[k], 0.0, 1e-6 * span) << c << ", row " << k;
      double of_interface = 0.0, of_section = 0.0;
      for (const char* c : {"fx", "fy", "fz"}) of_interface += std::pow(h.of(std::string("a.") + c)[k], 2);
      for (const char* c : {"N", "Q2", "Q3"}) of_section += std::pow(h.of(std::string("section.") + c)[k], 2);
      EXPECT_NEAR(std::sqrt(of_interface), std::sqrt(of_section), 1e-6 * span) << "row " << k;
    }
  }
}

/// A chain of rigid links on hinges, whose sub-domains meet at a body: what one of them exerts is what its joint does.
TEST(Interfaces, of_links_carry_what_their_joints_carry) {
  std::string bodies, joints, sensors;
  for (int i = 0; i < 8; ++i) {
    const std::string n = std::to_string(i), before = i == 0 ? "ground" : "b" + std::to_string(i - 1);
    bodies += std::string(i == 0 ? "" : ",") + R"-({"name": "b)-" + n +
              R"-(", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [)-" + n + ".5, 0, 0]}";
    joints += std::string(i == 0 ? "" : ",") + R"-({"name": "j)-" + n + R"-(", "kind": "revolute", "first": ")-" +
              before + R"-(", "second": "b)-" + n + R"-(", "position": [)-" + n + ", 0, 0], \"axis\": [0, 0, 1]}";
    sensors += std::string(i == 0 ? "" : ",") + R"-({"name": "r)-" + n +
               R"-(", "kind": "joint_reaction", "joint": "j)-" + n + R"-("})-";
  }
  const scene::Scene s =
      scene_of(R"-({"gravity": [0, -9.81, 0], "bodies": [)-" + bodies + R"-(], "joints": [)-" + joints +
               R"-(], "sensors": [)-" + sensors + R"-(, {"name": "a", "kind": "interface_force", "subdomain": "0"},
                      {"name": "b", "kind": "interface_force", "subdomain": "1"}],
      "solver": {"depth": 1}, "analysis": {"kind": "dynamic", "end_time": 0.8, "step_size": 2e-3, "tolerance": 1e-11}})-");
  const Outcome r = run_ok(s);
  for (const std::string& c : forces) EXPECT_NEAR(r.history.last("a." + c) + r.history.last("b." + c), 0.0, 1e-7) << c;
  // The force at the interface is that of one of the joints of the body where the sub-domains meet.
  double nearest = 1e300;
  for (int i = 1; i < 8; ++i)
    for (const double sign : {1.0, -1.0}) {
      double distance = 0.0;
      for (const char* c : {".fx", ".fy", ".fz"})
        distance += std::abs(r.history.last("a" + std::string(c)) - sign * r.history.last("r" + std::to_string(i) + c));
      nearest = std::min(nearest, distance);
    }
  EXPECT_LT(nearest, 1e-7);
  EXPECT_GT(std::abs(r.history.last("a.fy")), 1.0);
}

/// The first and the last section of a beam have names as its inner nodes have, also where they lie beside the node.
TEST(Interfaces, ends_of_beams_have_places) {
  scene::Scene s = cantilever({R"-(/analysis={"kind": "static"})-",
                               R"-(/sensors=[{"name": "first", "kind": "position", "at": "bar.0"},
                                             {"name": "root", "kind": "position", "at": "root"},
                                             {"name": "last", "kind": "position", "at": "bar.8"},
                                             {"name": "tip", "kind": "position", "at": "tip"}])-"});
  s.beams.front().end_offset = scene::Vec3{{0.5, 0.0, 0.0}};
  const support::Table h = run_ok(s).history;
  for (const char* c : {".x", ".y", ".z"})
    EXPECT_DOUBLE_EQ(h.last(std::string("first") + c), h.last(std::string("root") + c));
  const double apart[] = {h.last("last.x") - h.last("tip.x"), h.last("last.y") - h.last("tip.y"),
                          h.last("last.z") - h.last("tip.z")};
  EXPECT_NEAR(std::hypot(apart[0], apart[1], apart[2]), 0.5, 1e-12);
}

/// A bar pulled at both ends shows the pull at every node of every interface, on both sides of a cut with opposite
/// signs, in the ground's axes and in those of the node; the resultant on a part in the middle is zero.
TEST(Interfaces, show_the_pull_of_a_bar_at_each_node) {
  for (const char* form : {"local", "augmented"}) {
    std::string sensors;
    for (const std::string path : {"0", "1", "0.0", "0.1", "1.0", "1.1"})
      for (int node = 0; node <= 8; ++node) {
        const std::string name =
            (path.size() > 1 ? path.substr(0, 1) + "_" + path.substr(2) : path) + "@" + std::to_string(node);
        sensors += std::string(sensors.empty() ? "" : ",") + R"-({"name": ")-" + name +
                   R"-(", "kind": "interface_force", "subdomain": ")-" + path + R"-(", "at": "bar.)-" +
                   std::to_string(node) + R"-(", "axes": "body"})-";
      }
    scene::Scene s =
        cantilever({R"-(/analysis={"kind": "static", "load_steps": 1})-", "/loads/0/force=[1000, 0, 0]",
                    "/sensors=[" + sensors + "]", R"-(/solver={"depth": 2, "form": ")-" + std::string(form) + "\"}"});
    // Only nodes of the interface are taken: the others are refused one after the other.
    for (std::size_t left = s.sensors.size();; --left) {
      ASSERT_GT(left, 0u);
      const Outcome tried = support::run(s);
      if (tried.ok()) break;
      const auto is_refused = [&](const scene::Sensor& sensor) {
        return tried.summary.cause.starts_with("sensor '" + sensor.name + "': 'bar." +
                                               sensor.name.substr(sensor.name.find('@') + 1) +
                                               "' is not at the interface of sub-domain ");
      };
      ASSERT_EQ(std::erase_if(s.sensors, is_refused), 1u) << tried.summary.cause;
    }
    ASSERT_GE(s.sensors.size(), 6u);
    const Outcome r = run_ok(s);
    int twice = 0;
    for (const scene::Sensor& a : s.sensors) {
      EXPECT_NEAR(std::abs(r.history.last(a.name + ".fx")), 1000.0, 1e-6) << a.name;
      for (const char* c : {".fy", ".fz", ".mx", ".my", ".mz"}) EXPECT_NEAR(r.history.last(a.name + c), 0.0, 1e-6);
      for (const scene::Sensor& b : s.sensors) {  // of the same part at another node, of the same level at the same
        const auto path = [](const scene::Sensor& of) { return of.name.substr(0, of.name.find('@')); };
        const bool is_other_side = path(a) != path(b) && path(a).size() == path(b).size() && a.at.to == b.at.to;
        const bool is_other_end = path(a) == path(b) && a.at.to != b.at.to;
        if (!is_other_side && !is_other_end) continue;
        ++twice;
        EXPECT_NEAR(r.history.last(a.name + ".fx") + r.history.last(b.name + ".fx"), 0.0, 1e-6) << a.name << b.name;
      }
    }
    EXPECT_GE(twice, 4);
  }
}

TEST(Interfaces, that_the_tree_does_not_have_are_refused_by_name) {
  const Outcome r =
      support::run(cantilever({R"-(/analysis={"kind": "static"})-", R"-(/sensors/0/subdomain="1.0.2")-"}));
  EXPECT_FALSE(r.ok());
  EXPECT_EQ(r.summary.cause,
            "sensor 'a': the tree of the solver has no sub-domain 1.0.2, since sub-domain 1 has no children: name "
            "another, or set /solver/depth or /solver/leaf_size");
}

}  // namespace
}  // namespace bough::run
