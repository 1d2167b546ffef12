// Looking up names costs in proportion to the size of a scene, in the reader, in the checks and in the plan: all names
// are as long as each other, so that a list that is searched for every item compares texts, which are counted.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bough/io/read_scene.hpp"
#include "bough/plan/plan.hpp"
#include "support/operations.hpp"

namespace bough::io {
namespace {

/// A list of a scene with n items, item(i) being the text of one.
struct List {
  const char* key;
  std::function<std::string(int)> item;
};

std::string scene_text(int n, const std::vector<List>& lists) {
  std::string text = R"({"schema_version": 1, "analysis": {"kind": "dynamic", "end_time": 1})";
  for (const List& list : lists) {
    text += std::string(", \"") + list.key + "\": [";
    for (int i = 0; i < n; ++i) text += (i == 0 ? "" : ",\n") + list.item(i);
    text += "]";
  }
  return text + "}";
}

/// A word of 30 letters, which differ at its end alone.
std::string name(const char* stem, int i) {
  const std::string number = std::to_string(i);
  return stem + std::string(30 - std::strlen(stem) - number.size(), '_') + number;
}
std::string quoted(const char* stem, int i) { return "\"" + name(stem, i) + "\""; }

/// {"name": ..., more}
std::string item(const char* stem, int i, const std::string& more) {
  return "{\"name\": " + quoted(stem, i) + (more.empty() ? "" : ", ") + more + "}";
}

const List bodies{"bodies", [](int i) {
                    return item("body", i,
                                R"("mass": 1, "inertia": [1, 1, 1], "position": [)" + std::to_string(i) + ", 0, 0]");
                  }};

/// A hinge for every body, with more.
List hinges(const std::function<std::string(int)>& more = [](int) { return std::string(); }) {
  return {"joints", [more](int i) {
            return item("hinge", i,
                        R"("kind": "revolute", "first": "ground", "second": )" + quoted("body", i) +
                            R"(, "axis": [0, 0, 1])" + more(i));
          }};
}

List signals(const std::vector<std::function<std::string(int)>>& kinds) {
  return {"signals", [kinds](int i) {
            std::string all;
            for (const auto& kind : kinds) all += (all.empty() ? "" : ",\n") + kind(i);
            return all;
          }};
}

std::string told_of(const SceneFile& file) {
  std::string all;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, file.problems.size()); ++k)
    all += file.problems[k].pointer + ": " + file.problems[k].rule + "\n";
  return all;
}

/// Reads, checks and plans scenes without faults.
void expect_linear(const std::vector<List>& lists, int size = 250) {
  const std::string small = scene_text(size, lists), large = scene_text(8 * size, lists);
  const auto text_of = [&](int n) -> const std::string& { return n == size ? small : large; };
  const SceneFile read = read_scene_text(small, "small");
  ASSERT_TRUE(read.ok()) << told_of(read);
  EXPECT_LT(test::growth_by_eight([&](int n) { (void)read_scene_text(text_of(n), "any"); }, size),
            test::linear_by_eight)
      << "reading and checking";
  const SceneFile all = read_scene_text(large, "large");
  EXPECT_LT(test::growth_by_eight([&](int n) { (void)plan::make_plan((n == size ? read : all).scene); }, size),
            test::linear_by_eight)
      << "the plan";
}

/// Reads scenes in which every item has a fault, which is told and has this hint for the first.
void expect_linear_faults(const std::vector<List>& lists, const std::string& hint) {
  constexpr int size = 250;
  const std::string small = scene_text(size, lists), large = scene_text(8 * size, lists);
  const SceneFile read = read_scene_text(small, "small");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.problems.front().hint.find(hint), std::string::npos) << told_of(read);
  EXPECT_LT(test::growth_by_eight([&](int n) { (void)read_scene_text(n == size ? small : large, "any"); }, size),
            test::linear_by_eight);
}

std::string law(const std::string& signal) { return R"({"signal": ")" + signal + "\"}"; }

TEST(Lookups, of_joints_signals_and_efforts) {
  expect_linear(
      {bodies,
       hinges([](int i) { return R"(, "forces": [{"stiffness": 1, "effort": )" + law(name("torque", i)) + "}]"; }),
       signals({[](int i) { return item("angle", i, R"("kind": "joint_angle", "joint": )" + quoted("hinge", i)); },
                [](int i) { return item("rate", i, R"("kind": "joint_rate", "joint": )" + quoted("hinge", i)); },
                [](int i) {
                  return item(
                      "torque", i,
                      R"("kind": "formula", "expression": "-5*)" + name("angle", i) + " - " + name("rate", i) + "\"");
                },
                [](int i) { return item("effort", i, R"("kind": "joint_effort", "joint": )" + quoted("hinge", i)); },
                [](int i) {
                  return item("shear", i,
                              R"("kind": "joint_reaction", "component": "fx", "joint": )" + quoted("hinge", i));
                },
                [](int i) {
                  return item("moment", i,
                              R"("kind": "joint_reaction", "component": "mx", "joint": )" + quoted("hinge", i));
                },
                [](int i) {
                  return item("wave", i, R"("kind": "state", "nominal": 2, "expression": ")" + name("angle", i) + "\"");
                }}),
       {"sensors", [](int i) { return item("sensor", i, R"("kind": "signal", "signal": )" + quoted("torque", i)); }}});
}

TEST(Lookups, of_keys_that_are_not_known) {
  const auto text_of = [](int n) {  // with keys as long as one that the scene may have
    std::string text = R"({"schema_version": 1, "analysis": {"kind": "dynamic", "end_time": 1})";
    for (int i = 0; i < n; ++i) text += ", \"unknown key " + std::to_string(100'000 + i) + "\": 1";
    return text + "}";
  };
  static_assert(sizeof("unknown key 100000") == sizeof("initial_velocities"));
  constexpr int size = 48;  // fewer than are told
  const std::string small = text_of(size), large = text_of(8 * size);
  EXPECT_LT(test::growth_by_eight([&](int n) { (void)read_scene_text(n == size ? small : large, "any"); }, size),
            test::linear_by_eight);
}

TEST(Lookups, of_servos) {
  expect_linear({bodies,
                 hinges(),
                 {"actuators",
                  [](int i) {
                    return item(
                        "servo", i,
                        R"("kind": "servo", "position_gain": 5, "rate_gain": 1, "limit": 9, "lag": 1, "joint": )" +
                            quoted("hinge", i) + R"(, "target": )" + law(name("path", i)));
                  }},
                 signals({[](int i) { return item("path", i, R"("kind": "time", "law": {"expression": "t"})"); }})});
}

TEST(Lookups, of_springs_and_bushings) {
  const auto ends = [](int i) { return R"("first": "ground", "second": )" + quoted("body", i + 1); };
  const List more_bodies{"bodies",
                         [](int i) { return (i == 0 ? bodies.item(0) + "," : std::string()) + bodies.item(i + 1); }};
  expect_linear(
      {more_bodies,
       {"springs",
        [&](int i) {
          return item("spring", i, ends(i) + R"(, "stiffness": 5)") + "," +
                 item("coil", i, ends(i) + R"(, "stiffness": 5, "stiffness_factor": )" + law(name("factor", i))) + "," +
                 item("buffer", i,
                      ends(i) + R"(, "force_law": {"expression": "stretch^3*)" + name("factor", i) + "\"}");
        }},
       {"bushings",
        [&](int i) {
          return item("pad", i,
                      ends(i) + R"(, "stiffness": [1, 1, 1, 1, 1, 1], "stiffness_factor": )" + law(name("factor", i)));
        }},
       signals(
           {[](int i) { return item("factor", i, R"("kind": "time", "law": {"expression": "1 + t"})"); },
            [](int i) { return item("pull", i, R"("kind": "spring_tension", "spring": )" + quoted("spring", i)); },
            [](int i) { return item("tight", i, R"("kind": "spring_tension", "spring": )" + quoted("coil", i)); }})});
}

TEST(Lookups, of_loads_motions_sensors_and_measures) {
  expect_linear({bodies,
                 hinges(),
                 {"nodes", [](int i) { return item("node", i, R"("position": [0, 0, )" + std::to_string(i) + "]"); }},
                 {"motions",
                  [](int i) {
                    return item("drive", i,
                                R"("at": )" + quoted("node", i) + R"(, "x": 0, "y": 0, "z": )" + law(name("way", i)) +
                                    R"(, "rotation": "hold")");
                  }},
                 {"loads",
                  [](int i) {
                    return item(
                        "load", i,
                        R"("force": [1, 0, 0], "at": )" + quoted("body", i) + R"(, "law": )" + law(name("way", i)));
                  }},
                 {"initial_velocities",
                  [](int i) { return R"({"angular_velocity": [0, 0, 1], "of": )" + quoted("body", i) + "}"; }},
                 signals({[](int i) { return item("way", i, R"("kind": "state", "expression": "1")"); },
                          [](int i) {
                            return item("place", i,
                                        R"("kind": "position", "axis": "x", "at": )" + quoted("body", i) +
                                            R"(, "frame": )" + quoted("node", i));
                          }}),
                 {"sensors",
                  [](int i) {
                    return item("place", i, R"("kind": "position", "at": )" + quoted("body", i)) + "," +
                           item("angle", i, R"("kind": "joint_angle", "joint": )" + quoted("hinge", i)) + "," +
                           item("value", i, R"("kind": "signal", "signal": )" + quoted("way", i));
                  }},
                 {"measures",
                  [](int i) {
                    return item("most", i, R"("figure": "max", "quantity": ")" + name("place", i) + ".x\"") + "," +
                           item("sum", i,
                                R"("figure": "max", "expression": "a + b", "of": {"a": ")" + name("place", i) +
                                    R"(.x", "b": ")" + name("value", i) + "\"}");
                  }},
                 {"expected",
                  [](int i) { return R"({"value": 0, "tolerance": 9, "quantity": ")" + name("place", i) + ".y\"}"; }}});
}

TEST(Lookups, of_beams_sections_and_their_loads) {
  expect_linear(
      {{"sections",
        [](int i) {
          return item("section", i, R"("stiffness": {"EA": 1, "GA2": 1, "GA3": 1, "GJ": 1, "EI2": 1, "EI3": 1},
            "mass": {"mass_per_length": 1, "rotary": [1, 1, 1]})");
        }},
       {"nodes",
        [](int i) {
          const auto node = [i](const char* stem, int x) {
            return item(stem, i, R"("position": [)" + std::to_string(x) + ", " + std::to_string(i) + ", 0]");
          };
          return node("left", 0) + "," + node("right", 1);
        }},
       {"beams",
        [](int i) {
          return item("beam", i,
                      R"("section": )" + quoted("section", i) + R"(, "start": )" + quoted("left", i) + R"(, "end": )" +
                          quoted("right", i));
        }},
       {"loads", [](int i) { return item("load", i, R"("force": [1, 0, 0], "beam": )" + quoted("beam", i)); }},
       {"initial_velocities", [](int i) { return R"({"velocity": [0, 0, 1], "of": )" + quoted("beam", i) + "}"; }},
       {"sensors",
        [](int i) {
          return item("force", i, R"("kind": "section_force", "station": 0.5, "beam": )" + quoted("beam", i));
        }}},
      100);
}

// Every one is compared with all names until searches have cost enough.
TEST(Lookups, of_names_that_are_misspelt) {
  const auto twisted = [](const char* stem, int i) { return name(stem, i) + "x"; };
  expect_linear_faults(
      {bodies,
       hinges(),
       {"actuators",
        [&](int i) {
          return item("servo", i, R"("kind": "servo", "limit": 9, "lag": 1, "joint": ")" + twisted("hinge", i) + "\"");
        }}},
      "did you mean \"" + name("hinge", 0));
  expect_linear_faults({bodies,
                        {"springs",
                         [&](int i) {
                           return item("coil", i,
                                       R"("first": "ground", "second": )" + quoted("body", std::max(i, 1)) +
                                           R"(, "stiffness": 5, "rest_law": )" + law(twisted("length", i)));
                         }},
                        signals({[](int i) { return item("length", i, R"("kind": "time", "law": 1)"); }})},
                       "did you mean \"" + name("length", 0));
  expect_linear_faults(
      {bodies,
       hinges(),
       signals({[&](int i) {
         return item("tension", i, R"("kind": "spring_tension", "spring": ")" + twisted("coil", i) + "\"");
       }}),
       {"springs",
        [](int i) {
          return item("coil", i, R"("stiffness": 5, "first": "ground", "second": )" + quoted("body", std::max(i, 1)));
        }}},
      "did you mean \"" + name("coil", 0));
  expect_linear_faults(
      {{"materials", [](int i) { return item("steel", i, R"("young": 2e11, "poisson": 0.3, "density": 7850)"); }},
       {"bodies",
        [&](int i) {
          return item("body", i,
                      R"("shape": {"kind": "sphere", "radius": 1}, "material": ")" + twisted("steel", i) + "\"");
        }}},
      "did you mean \"" + name("steel", 0));
}

}  // namespace
}  // namespace bough::io
