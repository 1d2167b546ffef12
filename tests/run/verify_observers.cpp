/// What only observes changes no bit of a motion: signals that nothing reads, and sensors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/scenes.hpp"
#include "support/source_dir.hpp"

namespace bough::run {
namespace {

using Json = nlohmann::json;

std::vector<std::string> dynamic_scenes() {
  std::vector<std::string> stems;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data/scenarios"))
    if (entry.path().extension() == ".json") stems.push_back(entry.path().stem().string());
  std::sort(stems.begin(), stems.end());
  return stems;
}

Json read(const std::string& stem) {
  std::ifstream in(support::source_dir() / "data" / "scenarios" / (stem + ".json"));
  Json scene = Json::parse(std::string(std::istreambuf_iterator<char>(in), {}));
  scene.erase("schema_version");
  return scene;
}

/// A node or a body to look at: that of a sensor where a scene repeats its parts. All scenes have one.
std::string part_of(const Json& scene) {
  for (const char* list : {"bodies", "nodes"})
    if (scene.contains(list) && !scene[list].empty()) return scene[list].back()["name"];
  for (const Json& sensor : scene.value("sensors", Json::array()))
    if (sensor.contains("at")) return sensor["at"].is_string() ? sensor["at"] : sensor["at"]["to"];
  return "";
}

/// Signals of every kind that the scene has parts for, of which no element reads any.
void add_signals(Json& scene) {
  Json& signals = scene["signals"];
  if (signals.is_null()) signals = Json::array();
  const auto add = [&](const std::string& name, Json signal) {
    signal["name"] = "seen_" + name;
    signals.push_back(std::move(signal));
  };
  const std::string part = part_of(scene);
  add("position", {{"kind", "position"}, {"at", part}, {"axis", "y"}});
  add("velocity", {{"kind", "velocity"}, {"at", part}, {"axis", "x"}});
  for (const Json& joint : scene.value("joints", Json::array())) {
    const std::string kind = joint["kind"];
    if (kind != "revolute" && kind != "prismatic") continue;
    const char* coordinate = kind == "revolute" ? "joint_angle" : "joint_displacement";
    add("coordinate", {{"kind", coordinate}, {"joint", joint["name"]}});
    add("rate", {{"kind", "joint_rate"}, {"joint", joint["name"]}});
    add("effort", {{"kind", "joint_effort"}, {"joint", joint["name"]}});
    add("reaction", {{"kind", "joint_reaction"}, {"joint", joint["name"]}, {"component", "fx"}});
    break;
  }
  if (scene.contains("springs") && !scene["springs"].empty() && !scene["springs"][0].contains("force_law"))
    add("tension", {{"kind", "spring_tension"}, {"spring", scene["springs"][0]["name"]}});
  add("formula", {{"kind", "formula"}, {"expression", "2*seen_position - 0.1*seen_velocity"}});
  add("lag", {{"kind", "state"}, {"expression", "(seen_formula - seen_lag)/0.05"}});
  add("integral", {{"kind", "state"}, {"expression", "seen_position - 0.3*seen_lag"}, {"start", 0.5}});
  add("input", {{"kind", "input"}, {"start", 1.0}});
}

/// Sensors of motion and energies, and those of the signals.
void add_sensors(Json& scene) {
  const std::string part = part_of(scene);
  for (const char* kind : {"position", "rotation", "quaternion", "velocity", "acceleration"})
    scene["sensors"].push_back({{"name", std::string("seen ") + kind}, {"kind", kind}, {"at", part}});
  for (const char* kind : {"kinetic_energy", "strain_energy", "potential_energy", "total_energy"})
    scene["sensors"].push_back({{"name", std::string("seen ") + kind}, {"kind", kind}});
  for (const Json& signal : scene["signals"])
    if (const std::string name = signal["name"]; name.starts_with("seen_") && signal["kind"] != "input")
      scene["sensors"].push_back({{"name", "sensor of " + name}, {"kind", "signal"}, {"signal", name}});
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, moves_bit_by_bit_as_it_does_unobserved) {
  const Json given = read(GetParam());
  const std::string kind = given["analysis"].value("kind", "static");
  if (kind == "inverse_dynamics") return;  // whose signals are results of a motion that is given
  Json observed = given;
  add_signals(observed);
  add_sensors(observed);
  const auto run = [&](const Json& json) { return support::run(support::scene_of(json.dump())); };
  const support::Outcome alone = run(given), seen = run(observed);
  ASSERT_TRUE(alone.ok() && seen.ok()) << alone.summary.cause << seen.summary.cause;
  ASSERT_EQ(alone.history.rows.size(), seen.history.rows.size());
  for (std::size_t c = 0; c < alone.history.columns.size(); ++c) {
    const std::size_t other = seen.history.column(alone.history.columns[c]);
    for (std::size_t r = 0; r < alone.history.rows.size(); ++r)
      ASSERT_EQ(alone.history.rows[r][c], seen.history.rows[r][other]) << alone.history.columns[c] << ", row " << r;
  }
}

INSTANTIATE_TEST_SUITE_P(Gallery, EveryScene, testing::ValuesIn(dynamic_scenes()),
                         [](const auto& given) { return given.param; });

/// x' = a - x / T with a = 2: x = 2 T (1 - exp(-t / T)); y' = x, which oscillates with z in a loop of states.
TEST(ObservingStates, follow_their_closed_forms_to_second_order) {
  const auto error = [](double h) {
    const support::Outcome run = support::run(support::scene_of(
        R"({"bodies": [{"name": "b", "mass": 1, "inertia": [1, 1, 1]}],
          "initial_velocities": [{"of": "b", "velocity": [2, 0, 0]}],
          "signals": [{"name": "v", "kind": "velocity", "at": "b", "axis": "x"},
            {"name": "x", "kind": "state", "expression": "v - x/0.3"},
            {"name": "p", "kind": "state", "expression": "5*q", "start": 1}, {"name": "q", "kind": "state", "expression": "-5*p"}],
          "sensors": [{"name": "x", "kind": "signal", "signal": "x"}, {"name": "p", "kind": "signal", "signal": "p"}],
          "analysis": {"kind": "dynamic", "end_time": 1, "step_size": )" +
        support::text(h) + "}}"));
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    return std::vector<double>{std::abs(run.history.last("x") - 0.6 * (1.0 - std::exp(-1.0 / 0.3))),
                               std::abs(run.history.last("p") - std::cos(5.0))};
  };
  const std::vector<double> coarse = error(0.01), fine = error(0.005);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(support::order_of(coarse[k], fine[k]), 2.0, 0.2);
}

}  // namespace
}  // namespace bough::run
