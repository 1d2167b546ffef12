/// Errors that twins of a run measure: against closed forms, and what may not depend on them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bough/records/errors.hpp"
#include "bough/run/memory_run.hpp"
#include "bough/run/simulate.hpp"
#include "error_doubts.hpp"
#include "support/scenes.hpp"
#include "trust.hpp"
#include "twin_scenes.hpp"

namespace bough::run {
namespace {

using records::ErrorOf;
using records::ErrorState;

/// A mass on a spring of 10 rad/s.
constexpr const char* oscillator = R"({
  "bodies": [{"name": "mass", "mass": 1, "inertia": [0.1, 0.1, 0.1]}],
  "bushings": [{"name": "spring", "first": "ground", "second": "mass", "stiffness": [100, 100, 100, 100, 100, 100]}],
  "initial_velocities": [{"of": "mass", "velocity": [1, 0, 0]}],
  "sensors": [{"name": "at", "kind": "position", "at": "mass"}, {"name": "v", "kind": "velocity", "at": "mass"}],
  "measures": [{"name": "swing", "quantity": "at.x", "figure": "max"}],
  "analysis": {"kind": "dynamic", "end_time": 2, "step_size": 2e-3, "spectral_radius": 0.9,
               "errors": {"time": true, "mesh": true}}})";

/// A cantilever under its own weight, in elements of order 1.
constexpr const char* cantilever = R"({
  "gravity": [0, 0, -10],
  "sections": [{"name": "bar", "stiffness": {"EA": 8e7, "GA2": 3e7, "GA3": 3e7, "GJ": 2e3, "EI2": 3e3, "EI3": 3e3},
                "mass": {"mass_per_length": 3, "rotary": [2e-4, 1e-4, 1e-4]}}],
  "nodes": [{"name": "a", "position": [0, 0, 0]}, {"name": "b", "position": [1, 0, 0]}],
  "beams": [{"name": "beam", "section": "bar", "start": "a", "end": "b", "elements": 8}],
  "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "a"}],
  "loads": [{"name": "weight", "at": "beam.4", "force": [0, 0, -1]}],
  "sensors": [{"name": "tip", "kind": "position", "at": "b"}, {"name": "middle", "kind": "position", "at": "beam.4"}],
  "analysis": {"kind": "static", "load_steps": 2, "errors": {"time": true, "mesh": true}}})";

const ErrorOf& error_of(const MemoryRun& run, const std::string& column) {
  const auto& list = run.summary.errors->columns;
  return *std::find_if(list.begin(), list.end(), [&](const ErrorOf& e) { return e.name == column; });
}

TEST(Twins, an_error_in_time_is_that_of_the_closed_form) {
  const MemoryRun run = run_in_memory(support::scene_of(oscillator));
  ASSERT_TRUE(run.ok() && run.summary.errors) << run.text();
  double truth = 0.0;
  for (const records::HistoryRow& row : run.rows)
    truth = std::max(truth, std::abs(row.values[run.column("at.x")] - 0.1 * std::sin(10.0 * row.time)));
  const ErrorOf& x = error_of(run, "at.x");
  EXPECT_EQ(x.time.state, ErrorState::resolved) << x.time.cause;
  EXPECT_NEAR(x.time.order_of_largest, 2.0, 0.05);
  EXPECT_NEAR(x.time.largest, truth, 0.05 * truth);
  EXPECT_NEAR(x.extrapolated, 0.1 * std::sin(20.0), 0.02 * truth);
  EXPECT_EQ(error_of(run, "at.y").time.state, ErrorState::round_off);
  EXPECT_EQ(x.mesh.state, ErrorState::not_measured) << "there are no beams";
  EXPECT_EQ(run.summary.errors->remarks.size(), 1u);
}

TEST(Twins, rows_of_errors_hold_the_extrapolated_motion_at_the_times_of_the_history) {
  const MemoryRun run = run_in_memory(support::scene_of(oscillator, {"/output/stride=3"}));
  ASSERT_TRUE(run.ok() && run.summary.errors) << run.text();
  const records::MeasuredErrors& errors = *run.summary.errors;
  ASSERT_EQ(errors.rows.size(), run.rows.size());
  ASSERT_EQ(errors.header.columns.size(), 3 * run.header.columns.size());
  const std::size_t c = run.column("at.x");
  EXPECT_EQ(errors.header.columns[3 * c], "at.x.extrapolated");
  double worst = 0.0, plain = 0.0;
  for (std::size_t k = 0; k < run.rows.size(); ++k) {
    const double t = run.rows[k].time, exact = 0.1 * std::sin(10.0 * t);
    EXPECT_EQ(errors.rows[k].time, t);
    worst = std::max(worst, std::abs(errors.rows[k].values[3 * c] - exact));
    plain = std::max(plain, std::abs(run.rows[k].values[c] - exact));
    EXPECT_DOUBLE_EQ(errors.rows[k].values[3 * c], run.rows[k].values[c] + errors.rows[k].values[3 * c + 1]);
  }
  EXPECT_LT(worst, 0.02 * plain);
}

TEST(Twins, measures_and_expected_figures_have_errors) {
  const MemoryRun run = run_in_memory(support::scene_of(oscillator, {"/analysis/step_size=4e-3"}));
  ASSERT_TRUE(run.ok() && run.summary.errors) << run.text();
  const ErrorOf& swing = run.summary.errors->measures.at(0);
  EXPECT_EQ(swing.name, "swing");
  EXPECT_EQ(swing.value, *run.summary.measures[0].value);
  EXPECT_TRUE(swing.time.is_known()) << swing.time.cause;
  EXPECT_NEAR(swing.extrapolated, 0.1, 0.2 * std::abs(swing.value - 0.1) + 1e-9);
}

TEST(Twins, the_run_itself_is_bitwise_that_without_twins_for_any_number_of_threads) {
  for (const char* text : {oscillator, cantilever}) {
    const MemoryRun alone =
        run_in_memory(support::scene_of(text, {"/analysis/errors/time=false", "/analysis/errors/mesh=false"}));
    ASSERT_TRUE(alone.ok()) << alone.text();
    EXPECT_FALSE(alone.summary.errors);
    const MemoryRun one = run_in_memory(support::scene_of(text), 1);
    for (const int threads : {1, 2, 4}) {
      const MemoryRun run = run_in_memory(support::scene_of(text), threads);
      ASSERT_TRUE(run.ok() && run.summary.errors) << run.text();
      ASSERT_EQ(run.rows.size(), alone.rows.size());
      for (std::size_t k = 0; k < run.rows.size(); ++k) EXPECT_EQ(run.rows[k].values, alone.rows[k].values);
      for (std::size_t c = 0; c < run.header.columns.size(); ++c) {
        const ErrorOf &a = run.summary.errors->columns[c], &b = one.summary.errors->columns[c];
        EXPECT_EQ(a.time.largest, b.time.largest);
        EXPECT_EQ(a.mesh.largest, b.mesh.largest);
        EXPECT_EQ(a.time.state, b.time.state);
      }
    }
  }
}

TEST(Twins, the_error_of_a_mesh_is_that_against_a_mesh_four_times_as_fine) {
  const MemoryRun run = run_in_memory(support::scene_of(cantilever));
  ASSERT_TRUE(run.ok() && run.summary.errors) << run.text();
  const MemoryRun fine = run_in_memory(support::scene_of(
      cantilever, {"/beams/beam/elements=64", "/loads/weight/at=beam.32", "/sensors/middle/at=beam.32",
                   "/analysis/errors/time=false", "/analysis/errors/mesh=false"}));
  ASSERT_TRUE(fine.ok()) << fine.text();
  for (const char* column : {"tip.z", "middle.z"}) {
    const ErrorOf& e = error_of(run, column);
    const double truth = std::abs(run.final(column) - fine.final(column));
    EXPECT_EQ(e.mesh.state, ErrorState::resolved) << column << " " << e.mesh.cause;
    EXPECT_NEAR(std::abs(e.mesh.at_end), truth, 0.1 * truth) << column;
    EXPECT_NEAR(e.extrapolated, fine.final(column), 0.1 * truth) << column;
    EXPECT_EQ(e.time.state, ErrorState::round_off) << "equilibria do not depend on load steps";
  }
  EXPECT_EQ(run.summary.not_judged.find("mesh"), std::string::npos) << run.summary.not_judged;
}

/// A cantilever of two beams that bends far, of order 1: one element at the clamp, sixteen beyond.
std::string coarse_at_the_clamp(bool is_first) {
  const std::string clamp = is_first ? "a" : "z", end = is_first ? "z" : "a";
  return R"({"sections": [{"name": "s", "stiffness": {"EA": 1e6, "GA2": 1e6, "GA3": 1e6, "GJ": 10, "EI2": 10,
                           "EI3": 10}}],
    "nodes": [{"name": "a"}, {"name": "m", "position": [1, 0, 0]}, {"name": "z", "position": [2, 0, 0]}],
    "beams": [{"name": "first", "section": "s", "start": "a", "end": "m", "order": 1, "elements": )" +
         std::string(is_first ? "1" : "16") + R"(},
              {"name": "second", "section": "s", "start": "m", "end": "z", "order": 1, "elements": )" +
         std::string(is_first ? "16" : "1") + R"(}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": ")" +
         clamp + R"("}],
    "loads": [{"at": ")" +
         end + R"(", "force": [0, 0, 20]}],
    "sensors": [{"name": "tip", "kind": "position", "at": ")" +
         end + R"("}],
    "analysis": {"kind": "static", "load_steps": 10, "errors": {"mesh": true}}})";
}

TEST(Twins, a_mesh_that_is_doubted_names_the_beam_that_has_too_few_elements) {
  for (const bool is_first : {true, false}) {
    const MemoryRun run = run_in_memory(support::scene_of(coarse_at_the_clamp(is_first)));
    ASSERT_TRUE(run.ok() && run.summary.errors) << run.text();
    std::string doubts;
    for (const records::Doubt& d : run.summary.doubts) doubts += d.text + "\n";
    EXPECT_NE(doubts.find(is_first ? "'first' makes " : "'second' makes "), std::string::npos) << doubts;
    EXPECT_EQ(doubts.find(is_first ? "'second'" : "'first'"), std::string::npos) << doubts;
  }
}

TEST(Twins, numbers_of_elements_are_halved_where_they_and_named_inner_nodes_can_be) {
  const auto factors = [](const std::vector<std::string>& overrides) {
    std::vector<double> list;
    for (const Twin& t : make_twins(support::scene_of(cantilever, overrides)).members)
      if (t.is_of_mesh) list.push_back(t.factor);
    return list;
  };
  EXPECT_EQ(factors({}), (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(factors({"/beams/beam/elements=6"}), (std::vector<double>{0.5, 2.0}));
  EXPECT_EQ(factors({"/beams/beam/elements=5"}), (std::vector<double>{2.0, 4.0}));
  EXPECT_EQ(factors({"/sensors/middle/at=beam.3"}), (std::vector<double>{2.0, 4.0}));
  const Twins twins = make_twins(support::scene_of(cantilever, {"/sensors/middle/at=beam.2"}));
  const Twin& half =
      *std::find_if(twins.members.begin(), twins.members.end(), [](const Twin& t) { return t.is_of_mesh; });
  EXPECT_EQ(half.scene.sensors[1].at.to, "beam.1");
  EXPECT_EQ(half.scene.point_loads[0].at.to, "beam.2");
}

/// 2 steps a period are right to no digit, and the estimate or the twins must say so.
TEST(Twins, what_steps_do_not_resolve_is_not_resolved_and_doubted) {
  const MemoryRun run = run_in_memory(support::scene_of(oscillator, {"/analysis/step_size=0.2"}));
  ASSERT_TRUE(run.ok() && run.summary.errors) << run.text();
  EXPECT_EQ(error_of(run, "at.x").time.state, ErrorState::not_resolved);
  EXPECT_TRUE(std::any_of(run.summary.doubts.begin(), run.summary.doubts.end(),
                          [](const records::Doubt& d) { return d.about == "error"; }));
}

/// A summary with a doubt of the estimate about one column, and what twins tell of that column.
records::Summary judged(ErrorState state, double largest, double spread = 0.1) {
  records::Summary summary;
  summary.doubts = {{estimate_beside_twins, "x is off"}, {"error", "a pulse is missed"}};
  records::SensorError estimated;
  estimated.column = "x";
  estimated.of_steps = 0.5;
  estimated.range = 1.0;
  summary.sensor_errors = {estimated};
  records::MeasuredErrors errors;
  records::ErrorOf& x = errors.columns.emplace_back();
  x.name = "x";
  x.range = 1.0;
  x.time.state = state;
  x.time.largest = largest;
  x.time.spread = spread;
  judge_errors(errors, {true, false}, summary);
  return summary;
}

TEST(Twins, doubts_about_errors_in_time_rest_on_them) {
  const auto count = [](const records::Summary& s, const std::string& about) {
    return std::count_if(s.doubts.begin(), s.doubts.end(), [&](const auto& d) { return d.about == about; });
  };
  const records::Summary good = judged(ErrorState::resolved, 0.01), wrong = judged(ErrorState::resolved, 0.1),
                         lost = judged(ErrorState::not_resolved, 0.1),
                         open = judged(ErrorState::not_resolved, 0.03, 0.03),
                         none = judged(ErrorState::not_measured, 0.0);
  EXPECT_EQ(count(good, estimate_beside_twins), 0);
  EXPECT_EQ(count(good, "error"), 1) << "doubts of another origin stay";
  EXPECT_EQ(count(wrong, "error"), 2);
  EXPECT_EQ(count(wrong, estimate_beside_twins), 0);
  EXPECT_EQ(count(lost, "error"), 2);
  EXPECT_EQ(count(judged(ErrorState::not_resolved, 0.005, 0.03), estimate_beside_twins), 0) << "members agree";
  EXPECT_EQ(count(judged(ErrorState::not_resolved, 0.03, 0.12), estimate_beside_twins), 0)
      << "and shrink as they should";
  EXPECT_EQ(count(open, estimate_beside_twins), 1) << "what twins do not know is left to the estimate";
  EXPECT_EQ(count(open, "error"), 1);
  EXPECT_EQ(count(none, estimate_beside_twins), 1);
  EXPECT_NE(none.not_judged.find("the error in time of 'x' was not measured"), std::string::npos) << none.not_judged;
}

TEST(Twins, a_run_that_fails_or_is_stopped_has_no_errors_and_ends_its_twins) {
  long steps = 0;
  const MemoryRun run = run_in_memory(support::scene_of(oscillator), SimulateOptions{.threads = 2},
                                      [&steps](const records::Progress&) { return ++steps < 20; });
  EXPECT_EQ(run.summary.status, records::RunStatus::interrupted);
  EXPECT_FALSE(run.summary.errors);
  EXPECT_TRUE(run.says("no errors were measured")) << run.text();
}

TEST(Twins, steps_of_controlled_size_are_refused_with_a_reason) {
  EXPECT_THROW((void)support::scene_of(oscillator, {"/analysis/step_control={}"}), std::runtime_error);
}

}  // namespace
}  // namespace bough::run
