/// What is not a finite number ends a run as failed, and says when and where.
#include "finite_gate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bough/io/read_scene.hpp"
#include "bough/run/memory_run.hpp"

namespace bough::run {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool says(const FiniteGate& gate, const std::string& word) { return gate.cause().find(word) != std::string::npos; }

TEST(FiniteGate, lets_finite_numbers_pass) {
  FiniteGate gate;
  gate.look_at({{"tip.x"}}, {1.0, 0.1, 2, {1e308}});
  gate.look_at("a number", -1e-320, 1.0);
  gate.look_at(records::Summary{});
  EXPECT_EQ(gate.cause(), "");
}

TEST(FiniteGate, names_the_first_time_and_quantity) {
  FiniteGate gate;
  gate.look_at({{"tip.x", "tip.y"}}, {0.25, 0.1, 2, {1.0, std::nan("")}});
  gate.look_at({{"tip.x", "tip.y"}}, {0.5, 0.1, 2, {infinity, 0.0}});
  EXPECT_TRUE(says(gate, "0.25") && says(gate, "tip.y is nan")) << gate.cause();
}

TEST(FiniteGate, looks_at_pictures_energies_checks_and_expected_figures) {
  records::MotionFrame frame;
  frame.bodies.push_back({"far away", {1e300, 0, 0}, {}, {0, infinity, 0}});
  FiniteGate of_frame;
  of_frame.look_at(frame);
  EXPECT_TRUE(says(of_frame, "body 'far away'")) << of_frame.cause();

  FiniteGate of_energy;
  results::Energies energies;
  energies.potential = -infinity;
  of_energy.look_at(energies, 0.5, [&] { return frame; });
  EXPECT_TRUE(says(of_energy, "potential energy") && says(of_energy, "body 'far away'")) << of_energy.cause();

  FiniteGate of_checks;
  records::Summary summary;
  summary.checks.energy_scale = infinity;
  of_checks.look_at(summary);
  EXPECT_TRUE(says(of_checks, "scale of the energy")) << of_checks.cause();

  FiniteGate of_figure;
  summary = {};
  summary.expected = {{"tip.x", std::nan(""), 1.0, 1.0, false, ""}};
  of_figure.look_at(summary);
  EXPECT_TRUE(says(of_figure, "expected figure tip.x")) << of_figure.cause();
  summary.expected[0].reached = false;
  FiniteGate unreached;
  unreached.look_at(summary);
  EXPECT_EQ(unreached.cause(), "");
}

/// A run of one ball; `part` replaces the list of bodies.
records::Summary run_of(const std::string& parts) {
  const io::SceneFile file =
      io::read_scene_text(R"({"schema_version": 1, "gravity": [0, 0, -9.81], )" + parts +
                              R"(, "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}})",
                          "gate");
  records::Summary refused;
  refused.cause = file.ok() ? "" : file.problems.front().text();
  return file.ok() ? run_in_memory(file.scene).summary : refused;
}

/// Whether it is refused by the reader, as may become possible, or fails here: it never passes.
TEST(FiniteGate, no_run_beyond_the_range_of_numbers_passes_as_good) {
  for (const char* parts : {
           R"("bodies": [{"name": "ball", "kind": "point_mass", "mass": 1, "position": [0, 0, 1e308]}],
              "sensors": [{"name": "ball", "kind": "position", "at": "ball"}])",
           R"("frames": [{"name": "f", "turns": [{"axis": [0, 0, 5e-324], "angle": 1}]}],
              "bodies": [{"name": "ball", "kind": "point_mass", "mass": 1, "frame": "f", "position": [1, 0, 0]}])",
           R"("frames": [{"name": "f", "turns": [{"axis": [0, 0, 1], "angle": 1e300}]}],
              "bodies": [{"name": "ball", "kind": "point_mass", "mass": 1, "frame": "f", "position": [1, 0, 0]}])"}) {
    const records::Summary summary = run_of(parts);
    EXPECT_NE(summary.status, records::RunStatus::ok) << parts;
    EXPECT_FALSE(summary.cause.empty()) << parts;
  }
}

TEST(FiniteGate, no_expected_figure_of_a_run_that_it_ends_holds) {
  const records::Summary summary = run_of(
      R"("bodies": [{"name": "ball", "kind": "point_mass", "mass": 1, "position": [0, 0, 1e308]}],
         "sensors": [{"name": "ball", "kind": "position", "at": "ball"}],
         "expected": [{"quantity": "ball.x", "value": 0, "tolerance": 1}])");
  EXPECT_NE(summary.status, records::RunStatus::ok);
  for (const records::ExpectedResult& figure : summary.expected) EXPECT_FALSE(figure.holds) << figure.name;
}

}  // namespace
}  // namespace bough::run
