// Checkpoints of a directory of results: what a writer that was killed had recorded is gone on with, from the last
// checkpoint that can be used, and the files are then those of a writer that was never killed.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "bough/io/run_directory.hpp"
#include "bough/io/stored_states.hpp"
#include "bough/io/unfinished_run.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

const records::HistoryHeader header{{"tip.x", "tip.y"}};
const RunOrigin origin{"scene.json", "0123", {"/a=1"}, "commit", "program"};

records::StoredState state_at(double time, double x) {
  records::StoredState state;
  state.time = time;
  state.parts.push_back({.name = "tip", .position = {x, 0.0, 0.0}});
  return state;
}

void record(RunDirectory& run, int begin, int end) {
  for (int k = begin; k < end; ++k) {
    run.row({0.1 * k, 0.1, 3, {1.0 / (k + 1), -k / 3.0}});
    if (k % 3 == 0) run.motion(sample_frame(0.1 * k));
    if (k % 3 == 0) run.state(state_at(0.1 * k, 1.0 / (k + 1)));
    (void)run.is_checkpoint_due(0.1 * k, false);
  }
}

class Checkpoints : public ::testing::Test {
 protected:
  /// A writer that records 12 rows, with checkpoints after 5 and 8, and is killed: the last four were not flushed.
  void be_killed() const {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      RunDirectory run(place, "1", origin, false, {1e9}, {"gltf"});
      run.begin(header);
      run.parts({});
      record(run, 0, 5);
      run.checkpoint("after 5");
      record(run, 5, 8);
      run.checkpoint("after 8");
      record(run, 8, 12);
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
  }
  /// Goes on, and expects the state of a checkpoint.
  void expect_to_go_on_from(const std::string& state, int row, const std::string& told = "") const {
    RunDirectory run(place, "1", origin, false, {1e9, 0.0, true}, {"gltf"});
    run.open();
    EXPECT_EQ(run.resume(header), state);
    std::string all;
    for (const std::string& text : run.told()) all += text + "\n";
    EXPECT_NE(all.find(told), std::string::npos) << all;
    if (state.empty()) run.begin(header);
    run.parts({});
    record(run, row, 15);
    run.end(sample_summary());
    for (const auto& entry : fs::recursive_directory_iterator(whole)) {
      if (!entry.is_regular_file() || entry.path().filename() == "manifest.json") continue;
      const fs::path name = entry.path().lexically_relative(whole);
      EXPECT_EQ(text_of(place / name), text_of(entry.path())) << name;
    }
    EXPECT_FALSE(fs::exists(place / "checkpoint.1") || fs::exists(place / "checkpoint.2"));
  }
  void SetUp() override {
    RunDirectory run(whole, "1", origin, false, {}, {"gltf"});
    run.begin(header);
    run.parts({});
    record(run, 0, 15);
    run.end(sample_summary());
  }
  void change(const char* name, const std::function<void(std::string&)>& what) const {
    const fs::path file = staging / name;
    std::string text = text_of(file);
    what(text);
    std::ofstream(file, std::ios::binary) << text;
  }

  const ScratchDirectory scratch;
  const fs::path place = scratch / "out", whole = scratch / "whole", staging = scratch / ".out.bough-new";
};

TEST_F(Checkpoints, let_a_writer_go_on_as_if_it_had_not_been_killed) {
  be_killed();
  expect_to_go_on_from("after 8", 8, "going on from time 0.7");
}

TEST_F(Checkpoints, that_cannot_be_used_are_refused_by_name_and_the_other_one_is_used) {
  const struct {
    std::string why;
    std::function<void(std::string&)> what;
  } cases[] = {{"cut off", [](std::string& t) { t.resize(t.size() - 3); }},
               {"cut off", [](std::string& t) { t.clear(); }},
               {"damaged", [](std::string& t) { t.back() = '9'; }},
               {"another program", [](std::string& t) { t.replace(t.find("program"), 7, "another"); }},
               {"another version", [](std::string& t) { t.replace(t.find("checkpoint 2"), 12, "checkpoint 0"); }},
               {"not a checkpoint", [](std::string& t) { t = "a text\n" + t; }}};
  for (const auto& c : cases) {
    fs::remove_all(place);
    be_killed();
    change("checkpoint.2", c.what);
    expect_to_go_on_from("after 5", 5, "checkpoint.2 cannot be used: ");
  }
}

TEST_F(Checkpoints, of_another_scene_are_kept_beside_and_the_run_begins) {
  be_killed();
  for (const char* name : {"checkpoint.1", "checkpoint.2"})
    change(name, [](std::string& t) { t.replace(t.find("program,") + 8, 4, "zzzz"); });
  expect_to_go_on_from("", 0, "it is of another scene, or of other values of --set");
  EXPECT_EQ(read_history(scratch / "out.failed/history.csv").rows.size(), 8u);
}

TEST_F(Checkpoints, do_not_fit_files_that_were_changed_since) {
  be_killed();
  change("history.csv.partial", [](std::string& t) { t[40] = t[40] == '1' ? '2' : '1'; });
  RunDirectory run(place, "1", origin, false, {1e9, 0.0, true});
  run.open();
  EXPECT_THROW((void)run.resume(header), std::runtime_error);
}

TEST_F(Checkpoints, whose_files_were_changed_since_are_left_out_for_the_other_one) {
  const auto change_end = [](std::string& t) { t[t.size() - 2] = t[t.size() - 2] == '1' ? '2' : '1'; };
  for (const char* name : {"history.csv.partial", "motion.bin.partial", "states.bin.partial"}) {
    SCOPED_TRACE(name);
    fs::remove_all(place);
    be_killed();
    change(name, change_end);
    expect_to_go_on_from("after 5", 5, "checkpoint.2 cannot be used: ");
  }
  if (!fs::exists(whole / "motion/frame_000002.vtu")) return;  // a build without VTK
  for (const bool is_missing : {false, true}) {
    fs::remove_all(place);
    be_killed();
    if (is_missing)
      fs::remove(staging / "motion/frame_000002.vtu");
    else
      change("motion/frame_000002.vtu", change_end);
    expect_to_go_on_from("after 5", 5, "frame_000002.vtu");
  }
}

TEST_F(Checkpoints, of_a_run_that_has_ended_are_gone_and_it_is_known_to_have_ended) {
  const CheckpointRule resumes{1e9, 0.0, true};
  EXPECT_TRUE(RunDirectory(whole, "1", origin, false, resumes).has_all());
  EXPECT_FALSE(RunDirectory(place, "1", origin, false, resumes).has_all()) << "there is nothing";
  RunOrigin other = origin;
  other.overrides = {"/a=2"};
  EXPECT_FALSE(RunDirectory(whole, "1", other, false, resumes).has_all()) << "another value of --set";
  other = origin;
  other.from = StartOrigin{"out", "out/states.bin", 1.0, "4567"};
  EXPECT_FALSE(RunDirectory(whole, "1", other, false, resumes).has_all()) << "another start";
  std::ofstream(whole / "history.csv", std::ios::app) << "1";
  EXPECT_FALSE(RunDirectory(whole, "1", origin, false, resumes).has_all()) << "a file is not as it was";
}

TEST_F(Checkpoints, are_found_by_time_as_states_are) {
  records::Archive archive;
  records::StoredState state = state_at(0.4, 0.2);
  archive(state);
  RunDirectory run(place, "1", origin, false, {1e9}, {"gltf"});
  run.begin(header);
  run.parts({});
  record(run, 0, 5);
  run.checkpoint(archive.bytes() + "the rest");
  record(run, 5, 6);
  std::vector<std::string> skipped;
  EXPECT_EQ(find_state(place, 0.4, skipped).file.filename(), "checkpoint.1");
  EXPECT_EQ(find_state(place, 0.3, skipped).state.parts.at(0).position[0], 0.25);
  EXPECT_EQ(find_state(place, std::nullopt, skipped).state.time, 0.4) << "the last one";
  EXPECT_TRUE(skipped.empty());
  try {
    (void)find_state(place, 0.35, skipped);
    FAIL() << "there is none";
  } catch (const NoSuchState& told) {
    EXPECT_NE(std::string(told.what()).find("there are 0, 0.3"), std::string::npos) << told.what();
  }
  run.end(sample_summary());
  std::string text = text_of(place / "states.bin");
  text.back() = static_cast<char>(text.back() ^ 1);
  std::ofstream(place / "states.bin", std::ios::binary) << text;
  EXPECT_EQ(find_state(place, std::nullopt, skipped).state.time, 0.0) << "the last one that is whole";
  ASSERT_EQ(skipped.size(), 1u);
  EXPECT_NE(skipped[0].find("is damaged"), std::string::npos) << skipped[0];
}

TEST_F(Checkpoints, stay_with_a_run_that_was_stopped_and_go_with_it_where_it_goes_on) {
  {
    RunDirectory run(place, "1", origin, false, {1e9}, {"gltf"});
    run.begin(header);
    run.parts({});
    record(run, 0, 7);
    EXPECT_TRUE(run.is_checkpoint_due(0.6, true));
    run.checkpoint("after 7");
    records::Summary summary = sample_summary();
    summary.status = records::RunStatus::interrupted;
    run.end(summary);
    EXPECT_TRUE(run.can_go_on());
  }
  EXPECT_TRUE(fs::exists(place / "checkpoint.1"));
  expect_to_go_on_from("after 7", 7);
}

TEST_F(Checkpoints, of_a_run_beside_good_results_are_found_there) {
  fs::copy(whole, place, fs::copy_options::recursive);
  {
    RunDirectory run(place, "1", origin, false, {1e9}, {"gltf"});
    run.begin(header);
    run.parts({});
    record(run, 0, 7);
    run.checkpoint("after 7");
    records::Summary summary = sample_summary();
    summary.status = records::RunStatus::interrupted;
    run.end(summary);
    EXPECT_EQ(run.directory().filename(), "out.failed");
  }
  expect_to_go_on_from("after 7", 7);
  EXPECT_FALSE(fs::exists(scratch / "out.failed"));
}

TEST_F(Checkpoints, are_no_use_to_a_run_that_begins_and_what_was_killed_is_kept) {
  be_killed();
  const std::optional<UnfinishedRun> killed = find_unfinished_run(place);
  ASSERT_TRUE(killed);
  EXPECT_FALSE(killed->goes_on);
  EXPECT_DOUBLE_EQ(killed->checkpoint.value_or(0.0), 0.7);
  RunDirectory run(place, "1", origin);
  run.open();
  ASSERT_EQ(run.told().size(), 1u);
  EXPECT_NE(run.told()[0].find("out.failed"), std::string::npos) << run.told()[0];
  run.begin(header);
  record(run, 0, 2);
  const std::optional<UnfinishedRun> going = find_unfinished_run(place);
  ASSERT_TRUE(going);
  EXPECT_TRUE(going->goes_on);
  run.end(sample_summary());
  EXPECT_FALSE(find_unfinished_run(place));
  EXPECT_EQ(read_history(scratch / "out.failed/history.csv").rows.size(), 8u);
}

}  // namespace
}  // namespace bough::io
