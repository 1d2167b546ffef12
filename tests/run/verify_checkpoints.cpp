/// A run that goes on from a checkpoint is the run that was never cut, to the last bit: its rows, its pictures and its
/// summary apart from times. Taking checkpoints changes no bit either.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "bough/io/history.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/summary.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/simulation.hpp"
#include "support/scenes.hpp"
#include "support/source_dir.hpp"

namespace bough::run {
namespace {

/// Keeps a run in memory, with checkpoints after some of its steps.
struct Kept final : records::Recorder {
  struct Checkpoint {
    long step = 0;
    std::string state;
    std::vector<records::HistoryRow> rows;
    std::string motion;
    io::MotionBytes writer = io::MotionBytes();
  };

  explicit Kept(std::vector<long> steps_to_keep) : wanted(std::move(steps_to_keep)) {}
  explicit Kept(const Checkpoint& from)
      : rows(from.rows), motion_bytes(from.motion), writer(from.writer), kept(from.state) {}

  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow& r) override { rows.push_back(r); }
  void parts(const records::MotionParts& p) override {
    if (kept.empty()) writer = io::MotionBytes(p);
  }
  void motion(const records::MotionFrame& frame) override { writer.append(motion_bytes, frame); }
  void end(const records::Summary& s) override { summary = s; }
  bool keeps_checkpoints() const override { return !wanted.empty() || !kept.empty(); }
  bool is_checkpoint_due(double, bool) override {
    return std::find(wanted.begin(), wanted.end(), ++steps) != wanted.end();
  }
  void checkpoint(std::string_view state) override {
    checkpoints.push_back({steps, std::string(state), rows, motion_bytes, writer});
  }
  std::string resume(const records::HistoryHeader&) override { return kept; }

  std::vector<long> wanted;
  std::vector<records::HistoryRow> rows;
  std::string motion_bytes;
  io::MotionBytes writer;
  std::string kept;
  records::Summary summary;
  std::vector<Checkpoint> checkpoints;
  long steps = 0;
};

/// Rows, pictures and the summary as text, all that depends on a clock, on memory or on threads taken out of it.
std::string text_of(Kept& run) {
  std::string text;
  for (const records::HistoryRow& row : run.rows) io::append_history_row(text, row);
  text += run.motion_bytes;
  records::Summary& s = run.summary;
  s.times = {};
  s.memory_peak_bytes = 0;
  s.threads = 1;
  std::erase_if(s.solver, [](const auto& figure) { return figure.first.ends_with("_bytes"); });
  return text + io::summary_text(s, "");
}

/// Where two texts differ first, with what stands there.
std::string difference(const std::string& a, const std::string& b) {
  const auto at = static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
  const std::size_t from = a.rfind('\n', at == 0 ? 0 : at - 1) + 1;
  return "at byte " + std::to_string(at) + " of " + std::to_string(a.size()) + " and " + std::to_string(b.size()) +
         ": '" + a.substr(from, at - from + 80) + "' and '" + b.substr(from, at - from + 80) + "'";
}

void run_through(const scene::Scene& scene, Kept& recorder, int threads) {
  SimulateOptions options;
  options.threads = threads;
  (void)simulate(scene, options, recorder);
}

/// Runs a scene whole, with checkpoints, and on from each of these.
void expect_no_cut_shows(const scene::Scene& scene, const std::string& name, int cuts) {
  SCOPED_TRACE(name);
  Kept whole(std::vector<long>{});
  run_through(scene, whole, 1);
  const long steps = whole.summary.steps.accepted;
  const std::string expected = text_of(whole);
  if (steps < 2) return;
  std::mt19937 random(static_cast<std::mt19937::result_type>(std::hash<std::string>{}(name)));
  std::vector<long> after;
  for (int k = 0; k < cuts; ++k) after.push_back(std::uniform_int_distribution<long>(1, steps - 1)(random));
  Kept kept(std::move(after));
  run_through(scene, kept, 1);
  const std::string with_checkpoints = text_of(kept);
  ASSERT_EQ(with_checkpoints == expected, true)
      << "of a run with checkpoints, " << difference(expected, with_checkpoints);
  ASSERT_FALSE(kept.checkpoints.empty());
  int threads = 1;
  for (const Kept::Checkpoint& checkpoint : kept.checkpoints) {
    Kept rest(checkpoint);
    run_through(scene, rest, threads);
    const std::string resumed = text_of(rest);
    EXPECT_EQ(resumed == expected, true) << "after step " << checkpoint.step << " of " << steps << " on " << threads
                                         << " threads, " << difference(expected, resumed);
    threads = threads % 3 + 1;
  }
}

/// Long scenes are cut short: a checkpoint has to hold for the steps after it, not for an hour.
scene::Scene shortened(scene::Scene s) {
  constexpr double large = 5000.0;  // unknowns
  const double most_steps = estimate_run(s).unknowns > large ? 8.0 : 120.0;
  s.output.motion = true;
  if (s.analysis.kind != scene::AnalysisKind::statics)
    s.analysis.end_time = std::min(s.analysis.end_time, most_steps * s.analysis.step_size);
  return s;
}

TEST(Checkpoints, change_nothing_in_all_scenes_of_the_gallery) {
  for (const char* folder : {"data/scenarios", "data/gallery"})
    for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / folder)) {
      if (entry.path().extension() != ".json") continue;
      const io::SceneFile file = io::read_scene(entry.path(), {});
      ASSERT_TRUE(file.ok()) << entry.path();
      expect_no_cut_shows(shortened(file.scene), entry.path().stem().string(), 3);
    }
}

TEST(Checkpoints, change_nothing_under_all_integrators_and_options) {
  const struct {
    const char *scene, *name;
    std::vector<std::string> set;
  } cases[] = {
      {"slider_crank", "order 2", {"/analysis/integrator=bdf", "/analysis/bdf_order=2"}},
      {"slider_crank", "order 3", {"/analysis/integrator=bdf", "/analysis/bdf_order=3"}},
      {"double_pendulum", "order chosen", {"/analysis/integrator=bdf"}},
      {"double_pendulum", "variational", {"/analysis/integrator=variational"}},
      {"right_angle_cantilever", "variational", {"/analysis/integrator=variational"}},
      {"four_bar_planar", "variational", {"/analysis/integrator=variational"}},
      {"slider_crank", "controlled", {"/analysis/step_control={\"tolerance\": 1e-4}"}},
      {"flying_spaghetti", "controlled", {"/analysis/step_control={\"tolerance\": 1e-3}"}},
      {"slider_crank", "one solution", {"/analysis/newton=single"}},
      {"four_bar_misaligned", "in space", {}},
      {"four_bar_misaligned", "augmented", {"/solver/form=augmented"}},
      {"slider_crank", "without checks", {"/output/checks=false"}},
      {"slider_crank", "strides", {"/output/stride=7", "/output/motion_stride=3"}},
      {"deep_arch", "path", {}},
      {"bend_45", "load steps", {}},
  };
  for (const auto& c : cases)
    expect_no_cut_shows(shortened(support::gallery(c.scene, c.set)), std::string(c.scene) + ", " + c.name, 6);
}

}  // namespace
}  // namespace bough::run
