#include "bough/io/atomic_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/io/summary.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

JsonValue parsed(const std::string& text) {
  std::vector<JsonFault> faults;
  auto value = parse_json(text, source_file, faults);
  if (!value || !faults.empty()) throw std::runtime_error("not JSON: " + text);
  return *value;
}

TEST(JsonText, any_bytes_become_a_valid_string) {
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second) {
      const std::string bytes{static_cast<char>(first), static_cast<char>(second)};
      ASSERT_NO_THROW((void)parsed(json_string(bytes))) << first << ' ' << second;
    }
  }
  const std::string good = "tab\t quote\" back\\ \xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8C\xB3 line\n";
  EXPECT_EQ(parsed(json_string(good)).text, good);
}

TEST(JsonText, non_finite_numbers_are_strings_and_never_null) {
  JsonText json;
  json.begin_array();
  json.value(std::numeric_limits<double>::quiet_NaN());
  json.value(-std::numeric_limits<double>::infinity());
  json.value(0.1);
  json.end_array();
  const JsonValue list = parsed(json.text());
  EXPECT_EQ(list.items[0].text, "nan");
  EXPECT_EQ(list.items[1].text, "-inf");
  EXPECT_EQ(list.items[2].number, 0.1);
}

TEST(JsonText, raw_text_that_is_not_json_becomes_a_string) {
  JsonText json;
  json.begin_array();
  json.raw("[1, 2]");
  json.raw("nan");
  json.raw("1}");
  json.end_array();
  const JsonValue list = parsed(json.text());
  EXPECT_EQ(list.items[0].items.size(), 2u);
  EXPECT_EQ(list.items[1].text, "nan");
  EXPECT_EQ(list.items[2].text, "1}");
}

TEST(Summary, holds_every_promised_field) {
  const JsonValue json = parsed(summary_text(sample_summary(), "9.9"));
  for (const char* key : {"status", "cause", "scene", "title", "version", "threads", "options", "steps", "time_s",
                          "memory_peak_bytes", "checks", "trust", "notes", "solver", "sensors", "expected"})
    EXPECT_NE(json.find(key), nullptr) << key;
  for (const char* key : {"accepted", "rejected", "newton_iterations", "factorizations"})
    EXPECT_NE(json.find("steps")->find(key), nullptr) << key;
  for (const char* key : {"prepare", "total", "cpu", "assemble", "factor", "solve", "update", "output"})
    EXPECT_NE(json.find("time_s")->find(key), nullptr) << key;
  for (const char* key :
       {"energy_balance", "numerical_dissipation", "energy_scale", "momentum_balance", "constraint_violation_position",
        "constraint_violation_velocity", "linear_backward_error_max", "round_off_floor_reached"})
    EXPECT_NE(json.find("checks")->find(key), nullptr) << key;
  EXPECT_EQ(json.find("status")->text, "ok");
  EXPECT_EQ(json.find("version")->text, "9.9");
  EXPECT_EQ(json.find("options")->find("/analysis/step_size")->number, 0.001);
  EXPECT_EQ(json.find("sensors")->find("tip")->find("y")->number, -0.1);
  EXPECT_EQ(json.find("sensors")->find("energy")->number, 3.5);
  EXPECT_TRUE(json.find("expected")->find("tip.x")->find("holds")->truth);
  EXPECT_FALSE(json.find("expected")->find("tip.y")->find("holds")->truth);
}

TEST(Summary, leaves_out_checks_that_were_not_made_and_values_that_were_not_reached) {
  const ScratchDirectory scratch;
  records::Summary summary = sample_summary();
  summary.checks.evaluated = false;
  summary.expected = {{"a.x", 1.0, 1.0, 1.0, false, "", false}, {"b.x", 1.0, 1.0, 1.0, true, ""}};
  const std::string text = summary_text(summary, "1");
  const JsonValue json = parsed(text);
  EXPECT_EQ(json.find("checks")->find("energy_balance"), nullptr);
  EXPECT_EQ(json.find("checks")->find("constraint_violation_position"), nullptr);
  EXPECT_NE(json.find("checks")->find("linear_backward_error_max"), nullptr);
  summary.checks.evaluated = true;
  summary.options = {{"analysis/kind", "\"inverse_dynamics\""}};
  const JsonValue still = parsed(summary_text(summary, "1"));  // nothing is integrated, and nothing balances over time
  EXPECT_EQ(still.find("checks")->find("energy_balance"), nullptr);
  EXPECT_EQ(still.find("checks")->find("momentum_balance"), nullptr);
  EXPECT_NE(still.find("checks")->find("constraint_violation_position"), nullptr);
  const JsonValue& figure = *json.find("expected")->find("a.x");
  EXPECT_FALSE(figure.find("reached")->truth);
  EXPECT_EQ(figure.find("value"), nullptr);
  EXPECT_EQ(figure.find("holds"), nullptr);
  EXPECT_TRUE(json.find("expected")->find("b.x")->find("reached")->truth);
  write_file(scratch / "summary.json", text);
  const SummaryFile back = read_summary(scratch / "summary.json");
  EXPECT_STREQ(back.expected[0].verdict(), "not reached");
  EXPECT_STREQ(back.expected[1].verdict(), "holds");
}

TEST(Summary, tables_come_back_with_their_units_numbers_and_texts) {
  const ScratchDirectory scratch;
  records::Summary summary = sample_summary();
  summary.tables = {{"modes",
                     "What it shows.",
                     {{"mode", "", true}, {"frequency", "Hz", true}, {"what"}},
                     {{1.0, 0.1, std::string("'a, \"b\"' bends")}, {2.0, 1e300, std::string()}}}};
  write_file(scratch / "summary.json", summary_text(summary, "1"));
  const SummaryFile back = read_summary(scratch / "summary.json");
  ASSERT_EQ(back.tables.size(), 1U);
  const records::Table& table = back.tables.front();
  EXPECT_EQ(table.name, "modes");
  EXPECT_EQ(table.about, "What it shows.");
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[1].unit, "Hz");
  EXPECT_TRUE(table.columns[1].is_brief);
  EXPECT_FALSE(table.columns[2].is_brief);
  EXPECT_EQ(table.rows, summary.tables.front().rows);
}

TEST(Summary, a_path_without_limit_points_lists_none_and_other_runs_have_no_list) {
  records::Summary summary = sample_summary();
  EXPECT_EQ(parsed(summary_text(summary, "1")).find("limit_points"), nullptr);
  summary.follows_path = true;
  const JsonValue json = parsed(summary_text(summary, "1"));
  for (const char* list : {"limit_points", "bifurcations"}) {
    ASSERT_NE(json.find(list), nullptr) << list;
    EXPECT_TRUE(json.find(list)->is(JsonKind::array));
    EXPECT_TRUE(json.find(list)->items.empty());
  }
}

TEST(Summary, says_what_is_known_of_stability) {
  records::Summary summary = sample_summary();
  EXPECT_EQ(parsed(summary_text(summary, "1")).find("stability"), nullptr);
  records::Stability& s = summary.stability.emplace();
  s.is_known = true;
  s.unstable_directions = 2;
  s.first_lost = {0.25, 0.5};
  s.mode = "'tip' moves most, along (0, 1, 0)";
  const JsonValue json = parsed(summary_text(summary, "1"));
  EXPECT_EQ(json.find("stability")->find("unstable_directions")->number, 2.0);
  EXPECT_EQ(json.find("stability")->find("first_lost_between")->items[1].number, 0.5);
  EXPECT_EQ(json.find("stability")->find("mode")->text, s.mode);
}

TEST(Summary, components_apart_are_one_sensor_and_equal_names_stay_distinct) {
  records::Summary summary = sample_summary();
  summary.header.columns = {"a.x", "b.x", "a.y"};
  summary.final_values = {1.0, 2.0, 3.0};
  summary.expected = {{"a.x", 1.0, 1.0, 1.0, true, ""}, {"a.x", 2.0, 2.0, 1.0, true, ""}};
  const JsonValue json = parsed(summary_text(summary, "1"));  // duplicate keys would be a fault
  EXPECT_EQ(json.find("sensors")->find("a")->find("y")->number, 3.0);
  EXPECT_EQ(json.find("expected")->items.size(), 2u);
}

TEST(Summary, comes_back_with_what_reports_need) {
  const ScratchDirectory scratch;
  records::Summary summary = sample_summary();
  summary.status = records::RunStatus::failed;
  summary.cause = "the residual of \"crank\" grew\nat t = 1";
  summary.checks.energy_balance = std::numeric_limits<double>::infinity();
  summary.notes = {"two constraints say the same"};
  write_file(scratch / "summary.json", summary_text(summary, "1.0"));
  const SummaryFile back = read_summary(scratch / "summary.json");
  EXPECT_EQ(back.status, "failed");
  EXPECT_EQ(back.cause, summary.cause);
  EXPECT_EQ(back.accepted, 10);
  EXPECT_EQ(back.newton_iterations, 33);
  EXPECT_EQ(back.notes, summary.notes);
  ASSERT_FALSE(back.checks.empty());
  EXPECT_TRUE(std::isinf(back.checks[0].second));
  ASSERT_EQ(back.expected.size(), 2u);
  EXPECT_EQ(back.expected[1].reference, -0.2);
}

TEST(Summary, says_what_was_not_judged) {
  const ScratchDirectory scratch;
  records::Summary summary = sample_summary();
  summary.not_judged = "the error in time of 'pull' is not estimated";
  const std::string text = summary_text(summary, "1");
  const JsonValue written = parsed(text);
  EXPECT_NE(written.find("trust")->find("verdict")->text.str().find("not judged: the error in time of 'pull'"),
            std::string::npos);
  write_file(scratch / "summary.json", text);
  EXPECT_EQ(read_summary(scratch / "summary.json").not_judged, summary.not_judged);
}

TEST(Summary, says_whether_to_trust_the_run_and_why_not) {
  const ScratchDirectory scratch;
  records::Summary summary = sample_summary();
  const JsonValue good = parsed(summary_text(summary, "1"));
  EXPECT_EQ(good.find("trust")->find("verdict")->text, "nothing speaks against this run");
  EXPECT_TRUE(good.find("trust")->find("doubts")->items.empty());
  summary.doubts = {{"energy", "it grows \"out of nothing\""}};
  summary.levels = {{0, 1, 0, 0.0, 1e-16}, {1, 2, 6, 3.5, 2e-16}};
  const std::string text = summary_text(summary, "1");
  const JsonValue doubted = parsed(text);
  EXPECT_NE(doubted.find("trust")->find("verdict")->text, good.find("trust")->find("verdict")->text);
  const JsonValue& levels = *doubted.find("trust")->find("levels");
  ASSERT_EQ(levels.items.size(), 2u);
  EXPECT_EQ(levels.items[0].find("interface_condition"), nullptr);
  EXPECT_EQ(levels.items[1].find("interface_condition")->number, 3.5);
  EXPECT_EQ(levels.items[1].find("backward_error")->number, 2e-16);
  write_file(scratch / "summary.json", text);
  const SummaryFile back = read_summary(scratch / "summary.json");
  ASSERT_EQ(back.doubts.size(), 1u);
  EXPECT_EQ(back.doubts[0].about, "energy");
  EXPECT_EQ(back.doubts[0].text, summary.doubts[0].text);
}

TEST(Summary, a_file_that_is_no_summary_is_refused) {
  const ScratchDirectory scratch;
  for (const char* text : {"", "{", "[]", "{}", "{\"status\": 3}"}) {
    write_file(scratch / "s.json", text);
    EXPECT_THROW((void)read_summary(scratch / "s.json"), std::runtime_error) << text;
  }
  EXPECT_THROW((void)read_summary(scratch / "none.json"), std::runtime_error);
}

TEST(Summary, says_what_the_run_was_made_from) {
  const RunOrigin origin{"scene.json", "abc", {"/analysis/step_size=1e-4", "/a=\"b\""}, "0123", "456"};
  const JsonValue json = parsed(summary_text(sample_summary(), "1", origin, {{"history.csv", 5, "789"}}));
  const JsonValue& told = *json.find("origin");
  EXPECT_EQ(told.find("scene_hash")->text, "abc");
  EXPECT_EQ(told.find("set")->items.at(1).text, "/a=\"b\"");
  EXPECT_EQ(told.find("program_hash")->text, "456");
  EXPECT_EQ(json.find("files")->find("history.csv")->text, "789");
}

TEST(Summary, is_read_only_with_the_files_that_were_written_with_it) {
  const ScratchDirectory scratch;
  const auto write = [&](const char* name, double value, bool with_motion) {
    RunDirectory run(scratch / name, "1");
    run.begin({{"a"}});
    run.row({0.0, 0.0, 0, {value}});
    if (with_motion) run.motion(sample_frame(value));
    run.end(sample_summary());
  };
  write("one", 1.0, true);
  write("other", 2.0, true);
  write("still", 1.0, false);
  const std::vector<std::string> names = {"history.csv", "motion.bin"};
  const auto is_whole = [&](const char* name) {
    try {
      (void)read_whole_summary(scratch / name, names);
      return true;
    } catch (const std::runtime_error&) {
      return false;
    }
  };
  EXPECT_TRUE(is_whole("one") && is_whole("still"));
  std::filesystem::copy_file(scratch / "one/motion.bin", scratch / "still/motion.bin");
  EXPECT_FALSE(is_whole("still")) << "frames of another run";
  std::filesystem::remove(scratch / "one/motion.bin");
  EXPECT_FALSE(is_whole("one")) << "a file is missing";
  std::filesystem::rename(scratch / "still/history.csv", scratch / "other/history.csv");
  EXPECT_FALSE(is_whole("other")) << "a history of another run";
  EXPECT_FALSE(is_whole("still")) << "no history";
  EXPECT_FALSE(is_whole("none"));
}

/// A run ends between two files that a reader opens: what it read first does not belong to what it reads then.
TEST(Summary, is_read_again_where_new_results_take_the_place_of_those_read) {
  const ScratchDirectory scratch;
  const auto write = [&](double value) {
    RunDirectory run(scratch / "out", "1");
    run.begin({{"a"}});
    run.row({0.0, 0.0, 0, {value}});
    run.end(sample_summary());
  };
  write(1.0);
  int reads = 0;
  const History history = read_unchanged(scratch / "out", [&] {
    (void)read_whole_summary(scratch / "out", {"history.csv"});
    if (++reads == 1) write(2.0);
    if (reads == 1) throw std::runtime_error("what was read of both does not fit together");
    if (reads == 2) write(3.0);
    return read_history(scratch / "out/history.csv");
  });
  EXPECT_EQ(reads, 3);
  EXPECT_EQ(history.rows.at(0).values.at(0), 3.0);
  reads = 0;
  EXPECT_THROW(read_unchanged(scratch / "out", [&]() -> int { throw std::runtime_error(std::to_string(++reads)); }),
               std::runtime_error);
  EXPECT_EQ(reads, 1) << "of a folder that stays as it is";
}

}  // namespace
}  // namespace bough::io
