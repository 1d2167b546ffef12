/// A run that starts from the state of another one goes on as that would have: to the accuracy of the integrator, since
/// its history of steps is not handed over.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "bough/io/read_scene.hpp"
#include "bough/records/stored_state.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "support/scenes.hpp"
#include "support/source_dir.hpp"

namespace bough::run {
namespace {

/// Keeps the states of a run and its rows.
struct Kept final : records::Recorder {
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow& r) override { rows.push_back(r); }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary& s) override { summary = s; }
  bool keeps_states() const override { return true; }
  void state(const records::StoredState& s) override { states.push_back(s); }

  std::vector<records::HistoryRow> rows;
  std::vector<records::StoredState> states;
  records::Summary summary;
};

using StatePtr = std::shared_ptr<const records::StoredState>;

Kept run_from(const scene::Scene& scene, const StatePtr& from = nullptr) {
  Kept kept;
  SimulateOptions options;
  options.from = from;
  (void)simulate(scene, options, kept);
  return kept;
}

/// The last state of a run that is to end well.
StatePtr state_of(const scene::Scene& scene) {
  const Kept kept = run_from(scene);
  EXPECT_EQ(kept.summary.status, records::RunStatus::ok) << kept.summary.cause;
  EXPECT_FALSE(kept.states.empty());
  return kept.states.empty() ? nullptr : std::make_shared<const records::StoredState>(kept.states.back());
}

/// Ends after so many steps.
scene::Scene cut_to(scene::Scene scene, double steps) {
  scene.analysis.end_time = steps * scene.analysis.step_size;
  return scene;
}

/// Largest difference of a column of two runs in rows of equal times after a time, and the range of the column.
struct Difference {
  double most = 0.0, range = 0.0;
};
Difference difference_of(const Kept& a, const Kept& b, std::size_t column, double from) {
  Difference d;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  auto other = b.rows.begin();
  for (const records::HistoryRow& row : a.rows) {
    low = std::min(low, row.values[column]);
    high = std::max(high, row.values[column]);
    const double same = 1e-9 * row.time;
    while (other != b.rows.end() && other->time < row.time - same) ++other;
    if (row.time >= from && other != b.rows.end() && other->time <= row.time + same)
      d.most = std::max(d.most, std::abs(row.values[column] - other->values[column]));
  }
  d.range = high - low;
  return d;
}

/// Whether a column depends on accelerations and multipliers, which a start finds anew.
bool shows_forces(const std::string& quantity) {
  return quantity == "joint_reaction" || quantity == "section_force" || quantity == "section_strain" ||
         quantity.find("acceleration") != std::string::npos;
}

/// Runs a scene whole, and its first half with another run that goes on from there. Both are off by 4/3 of what
/// halves of their steps change, since errors are of second order. Forces differ in the first steps: vibrations of stiff
/// parts that the integrator has damped are in balance anew.
void expect_halves_are_whole(scene::Scene scene, const std::string& name, double steps) {
  constexpr double both = 2.0 * 4.0 / 3.0, round_off = 1e-8, of_forces = 1e-2;
  SCOPED_TRACE(name);
  scene.output.stride = 1;
  scene.output.motion = false;
  scene.expected.clear();
  scene.measures.clear();
  const Kept whole = run_from(cut_to(scene, 2.0 * steps));
  ASSERT_EQ(whole.summary.status, records::RunStatus::ok) << whole.summary.cause;
  const StatePtr state = state_of(cut_to(scene, steps));
  ASSERT_NE(state, nullptr);
  scene::Scene second = cut_to(scene, 2.0 * steps);
  second.analysis.start = scene::StartKind::given;
  ASSERT_TRUE(problems_of_start(second, *state).empty()) << problems_of_start(second, *state).front();
  const Kept rest = run_from(second, state);
  ASSERT_EQ(rest.summary.status, records::RunStatus::ok) << rest.summary.cause;
  ASSERT_NEAR(rest.rows.front().time, state->time, 1e-12 * state->time);
  scene::Scene fine = cut_to(scene, 2.0 * steps);
  fine.analysis.step_size *= 0.5;
  const Kept finer = run_from(fine);
  ASSERT_EQ(finer.summary.status, records::RunStatus::ok) << finer.summary.cause;
  const double from = state->time + 0.5 * scene.analysis.step_size;
  double worst = 0.0;
  for (std::size_t c = 0; c < whole.summary.header.columns.size(); ++c) {
    const Difference off = difference_of(whole, rest, c, from), error = difference_of(whole, finer, c, from);
    const double allowed = shows_forces(whole.summary.header.about[c].quantity) ? of_forces : round_off;
    EXPECT_LE(off.most, both * error.most + allowed * off.range + 1e-12) << whole.summary.header.columns[c];
    if (error.most > round_off * off.range) worst = std::max(worst, off.most / error.most);
  }
  std::printf("[ MEASURED ] %-32s differs by at most %.2g of what half the step changes\n", name.c_str(), worst);
}

TEST(StartFrom, goes_on_in_all_scenes_of_dynamics) {
  for (const char* folder : {"scenarios", "gallery"})
    for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / folder)) {
      if (entry.path().extension() != ".json") continue;
      const io::SceneFile file = io::read_scene(entry.path());
      ASSERT_TRUE(file.ok()) << entry.path();
      const scene::Scene& scene = file.scene;
      if (!scene::type_of(scene.analysis.kind).integrates || scene.analysis.step_control) continue;
      constexpr double large = 5000.0;  // unknowns
      const double most = 0.5 * scene.analysis.end_time / scene.analysis.step_size;
      expect_halves_are_whole(scene, entry.path().stem().string(),
                              std::floor(std::min(most, estimate_run(scene).unknowns > large ? 4.0 : 40.0)));
    }
}

TEST(StartFrom, goes_on_with_other_integrators_and_in_space) {
  const struct {
    const char *scene, *name;
    std::vector<std::string> set;
  } cases[] = {
      {"slider_crank", "backward differences", {"/analysis/integrator=bdf"}},
      {"double_pendulum", "variational", {"/analysis/integrator=variational"}},
      {"double_pendulum", "in space", {"/without=[\"planar\"]"}},
      {"flying_spaghetti", "in space", {"/without=[\"planar\", \"small\"]"}},
      {"andrews_squeezer", "nothing taken out", {"/without=[\"planar\", \"welded\", \"held\"]"}},
  };
  for (const auto& c : cases)
    expect_halves_are_whole(support::gallery(c.scene, c.set), std::string(c.scene) + ", " + c.name, 40.0);
}

TEST(StartFrom, goes_on_with_step_control_to_its_tolerance) {
  const std::vector<std::string> control{R"(/analysis/step_control={"tolerance": 1e-6})", "/expected=[]"};
  scene::Scene scene = support::gallery("slider_crank", control);
  const double end = scene.analysis.end_time;
  scene.output.stride = 1;
  const Kept whole = run_from(scene);
  scene.analysis.end_time = 0.5 * end;
  const StatePtr state = state_of(scene);
  scene.analysis.end_time = end;
  const Kept rest = run_from(scene, state);
  ASSERT_EQ(rest.summary.status, records::RunStatus::ok) << rest.summary.cause;
  for (std::size_t c = 0; c < whole.summary.header.columns.size(); ++c) {
    if (shows_forces(whole.summary.header.about[c].quantity)) continue;
    const Difference off = difference_of(whole, rest, c, end);
    EXPECT_LE(std::abs(whole.rows.back().values[c] - rest.rows.back().values[c]), 1e-3 * off.range)
        << whole.summary.header.columns[c];
  }
}

/// A state is of parts by name, whatever the plan of either scene makes of them.
TEST(StartFrom, does_not_depend_on_decisions_of_the_plan) {
  const std::vector<std::string> none{R"(/without=["planar", "welded", "held", "small"])"};
  for (const char* name : {"andrews_squeezer", "slider_crank", "robot_arm", "right_angle_cantilever"}) {
    SCOPED_TRACE(name);
    const std::filesystem::path folder = support::source_dir() / "data";
    const std::filesystem::path file = std::filesystem::exists(folder / "scenarios" / (std::string(name) + ".json"))
                                           ? folder / "scenarios" / (std::string(name) + ".json")
                                           : folder / "gallery" / (std::string(name) + ".json");
    const auto scene_with = [&](const std::vector<std::string>& set, double steps) {
      scene::Scene scene = io::read_scene(file, set).scene;
      scene.expected.clear();
      scene.measures.clear();
      return cut_to(std::move(scene), steps);
    };
    const StatePtr plain = state_of(scene_with({}, 20.0)), whole = state_of(scene_with(none, 20.0));
    const Kept plain_of_whole = run_from(scene_with({}, 30.0), whole),
               whole_of_plain = run_from(scene_with(none, 30.0), plain);
    ASSERT_EQ(plain_of_whole.summary.status, records::RunStatus::ok) << plain_of_whole.summary.cause;
    ASSERT_EQ(whole_of_plain.summary.status, records::RunStatus::ok) << whole_of_plain.summary.cause;
    for (std::size_t c = 0; c < plain_of_whole.summary.header.columns.size(); ++c) {
      if (shows_forces(plain_of_whole.summary.header.about[c].quantity)) continue;
      const Difference off = difference_of(plain_of_whole, whole_of_plain, c, 0.0);
      EXPECT_LE(off.most, 1e-6 * (off.range + 1.0)) << plain_of_whole.summary.header.columns[c];
    }
  }
}

/// What statics has found is an equilibrium of dynamics: nothing moves.
TEST(StartFrom, rests_in_the_equilibrium_of_a_run_of_statics) {
  const char* bodies = R"("gravity": [0, 0, -9.81],
    "materials": [{"name": "steel", "young": 2e11, "poisson": 0.3, "density": 7800}],
    "sections": [{"name": "bar", "material": "steel", "shape": {"kind": "rectangle", "width": 0.02, "height": 0.01}}],
    "nodes": [{"name": "root", "position": [0, 0, 0]}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "beam", "section": "bar", "start": "root", "end": "tip", "elements": 6}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
    "loads": [{"name": "weight", "at": "tip", "force": [0, 3, -5]}],
    "sensors": [{"name": "tip", "kind": "position", "at": "tip"}],)";
  const scene::Scene still = support::scene_of("{" + std::string(bodies) + R"("analysis": {"kind": "static"}})");
  const scene::Scene moving = support::scene_of(
      "{" + std::string(bodies) + R"("analysis": {"kind": "dynamic", "end_time": 0.2, "step_size": 0.001}})");
  const Kept rest = run_from(moving, state_of(still));
  ASSERT_EQ(rest.summary.status, records::RunStatus::ok) << rest.summary.cause;
  EXPECT_EQ(rest.rows.front().time, 0.0);
  EXPECT_LT(rest.rows.front().values[2], -0.01);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(difference_of(rest, rest, c, 0.0).range, 1e-7);
}

constexpr const char* two_bodies = R"({"bodies": [
    {"name": "a", "mass": 1, "inertia": [1, 2, 3]},
    {"name": "b", "mass": 1, "inertia": [2, 2, 2], "position": [1, 0, 0]}],
  "sensors": [{"name": "a", "kind": "position", "at": "a"}],
  "initial_velocities": [{"of": "a", "velocity": [1, 0, 0.5], "angular_velocity": [0.3, 0.2, 1]}],
  "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}})";

TEST(StartFrom, says_which_parts_the_state_does_not_have) {
  const StatePtr state = state_of(support::scene_of(two_bodies));
  scene::Scene other = support::scene_of(two_bodies, {"/bodies/1/name=c", "/analysis/end_time=0.2"});
  const Kept kept = run_from(other, state);
  ASSERT_EQ(kept.summary.status, records::RunStatus::ok) << kept.summary.cause;
  std::string notes;
  for (const std::string& note : kept.summary.notes) notes += note + "\n";
  EXPECT_NE(notes.find("the state does not have 'c'"), std::string::npos) << notes;
  EXPECT_NE(notes.find("the scene does not have 'b' of the state"), std::string::npos) << notes;
  EXPECT_TRUE(kept.summary.changed_velocities.empty()) << "the velocity of a is that of the state";
}

TEST(StartFrom, passes_figures_of_times_before_it) {
  const StatePtr state = state_of(support::scene_of(two_bodies));
  const Kept kept = run_from(support::scene_of(two_bodies, {"/analysis/end_time=0.2", R"(/expected=[
      {"quantity": "a.x", "time": 0.05, "value": 0.05, "tolerance": 1e-9, "source": "uniform motion"},
      {"quantity": "a.x", "time": 0.15, "value": 0.15, "tolerance": 1e-9, "source": "uniform motion"}])"}),
                             state);
  ASSERT_EQ(kept.summary.expected.size(), 2u) << kept.summary.cause;
  EXPECT_FALSE(kept.summary.expected[0].reached);
  EXPECT_TRUE(kept.summary.expected[1].reached && kept.summary.expected[1].holds) << kept.summary.expected[1].value;
}

/// Runs a scene from a state and expects it to fail for a reason.
void expect_refusal(const scene::Scene& scene, const StatePtr& state, const std::vector<std::string>& words) {
  const Kept kept = run_from(scene, state);
  EXPECT_EQ(kept.summary.status, records::RunStatus::failed);
  for (const std::string& word : words)
    EXPECT_NE(kept.summary.cause.find(word), std::string::npos) << kept.summary.cause;
}

TEST(StartFrom, refuses_what_cannot_be_where_the_state_has_it) {
  const StatePtr state = state_of(support::scene_of(two_bodies));
  const std::string later = "/analysis/end_time=0.2", at_rest = "/initial_velocities=[]";
  const std::string tied = R"(/joints=[{"name": "j", "kind": "fixed", "first": "a", "second": "b"}])",
                    held = R"(/joints=[{"name": "j", "kind": "fixed", "first": "ground", "second": "a"}])";
  const auto scene_with = [&](std::vector<std::string> set) {
    set.push_back(later);
    return support::scene_of(two_bodies, set);
  };
  expect_refusal(scene_with({at_rest}), state, {"'a' cannot", "--without line"});
  expect_refusal(scene_with({at_rest, tied}), state, {"'b' cannot", "fixed to '", "\"welded\""});
  expect_refusal(scene_with({tied}), state, {"'j' is open"});
  expect_refusal(scene_with({at_rest, held}), state, {"'a' cannot be where", "the scene holds it"});
  expect_refusal(scene_with({held}), state, {"'j' is open"});
}

TEST(StartFrom, refuses_scenes_that_do_not_fit_by_name) {
  const auto expect_problem = [](const scene::Scene& scene, const records::StoredState& state, const char* word) {
    const std::vector<std::string> problems = problems_of_start(scene, state);
    ASSERT_EQ(problems.size(), 1u) << word;
    EXPECT_NE(problems[0].find(word), std::string::npos) << problems[0];
  };
  scene::Scene scene = cut_to(support::gallery("flying_spaghetti"), 4.0);
  const records::StoredState state = *state_of(scene);
  scene = cut_to(scene, 8.0);
  EXPECT_TRUE(problems_of_start(scene, state).empty());
  scene::Scene other = scene;
  other.beams[0].elements += 1;
  expect_problem(other, state, ("beam '" + scene.beams[0].name + "' has").c_str());
  other = cut_to(scene, 4.0);
  expect_problem(other, state, "/analysis/end_time");
  other = scene;
  other.analysis.start = scene::StartKind::equilibrium;
  expect_problem(other, state, "/analysis/start");
  other = scene;
  other.analysis.kind = scene::AnalysisKind::statics;
  expect_problem(other, state, "/analysis/kind");
  records::StoredState seen_otherwise = state;
  seen_otherwise.frame = "carousel";
  expect_problem(scene, seen_otherwise, "frame 'carousel'");
  records::StoredState of_others;
  of_others.time = state.time;
  of_others.parts.push_back({.name = "stranger"});
  expect_problem(scene, of_others, "no node, body or beam");
}

}  // namespace
}  // namespace bough::run
