#include "bough/report/page.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "bough/io/columns.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/unfinished_run.hpp"
#include "bough/report/document.hpp"
#include "bough/report/plot.hpp"
#include "error_bands.hpp"
#include "round_off.hpp"
#include "svg_text.hpp"
#include "table_charts.hpp"
#include "view_data.hpp"

namespace bough::report {

extern const std::string_view view_script;  // web/, embedded by CMakeLists.txt

namespace {

constexpr std::size_t most_plots = 24;

void add_heading(Document& page, const RunFiles& run) {
  if (!run.summary) return page.paragraph("The run did not end: there is no summary.", Tone::bad);
  const io::SummaryFile& s = *run.summary;
  const std::string words = s.status == "ok"       ? "The run is complete."
                            : s.status == "failed" ? "The run failed."
                                                   : "The run was interrupted.";
  if (!s.doubts.empty()) {
    std::string doubts =
        "Not to be trusted without a closer look. " + s.doubts[0].about + ": " + s.doubts[0].text + ".";
    if (s.doubts.size() > 1) doubts += " All " + std::to_string(s.doubts.size()) + " doubts stand below.";
    page.paragraph(doubts, Tone::bad);
  }
  page.paragraph(words + (s.cause.empty() ? "" : " " + s.cause), s.status == "ok" ? Tone::plain : Tone::bad);
  page.paragraph(s.scene + " · " + std::to_string(s.accepted) + " steps, " + std::to_string(s.rejected) +
                     " rejected, " + std::to_string(s.newton_iterations) + " Newton iterations · bough " + s.version,
                 Tone::soft);
}

/// The place of the moving picture, which the script fills and shows. Without scripts, and on paper, the drawing is
/// shown.
void add_motion(Document& page, const RunFiles& run, const PictureOptions& options) {
  if (run.motion.empty()) return page.paragraph(how_to_record_motion(), Tone::soft);
  page.markup(
      "<div id=\"viewer\" hidden></div>\n<p id=\"no-webgl\" class=\"lead\" hidden></p>\n<figure id=\"motion\">\n" +
      make_picture(is_of_modes(run) && run.motion.size() > 2 ? frames_of_mode(run, 1) : run.motion, options).svg +
      "</figure>\n");
}

/// Signals with their values in the last picture. The script shows those at the time of the picture.
void add_signals(Document& page, const RunFiles& run, const RunFiles* other) {
  const std::size_t count = num_signals_shown(run);
  if (count == 0) return;
  const auto& signals = run.motion.back().signals;
  const auto value_of = [](double value) {
    std::string text;
    io::append_rounded(text, value, 5);
    return "<output>" + text + "</output>";
  };
  const auto value_in_other = [&](const std::string& name) -> std::string {
    if (other->motion.empty()) return "<output>–</output>";
    const auto& list = other->motion.back().signals;
    const auto same = std::find_if(list.begin(), list.end(), [&](const auto& s) { return s.name == name; });
    return same == list.end() ? "<output>–</output>" : value_of(same->value);
  };
  page.section("Signals");
  std::string html = "<p id=\"signals-at\" class=\"lead\">At the end</p>\n<div id=\"signals\" class=\"signals\">\n";
  for (std::size_t k = 0; k < count; ++k) {
    const std::string unit = k < run.parts.signal_units.size() ? run.parts.signal_units[k] : std::string();
    html += "<p><span>" + escaped(signals[k].name) + (unit.empty() ? "" : " [" + escaped(unit) + "]") + "</span> " +
            value_of(signals[k].value) + (other != nullptr ? " " + value_in_other(signals[k].name) : "") + "</p>\n";
  }
  page.markup(html + "</div>\n");
  if (signals.size() > count)
    page.paragraph(std::to_string(signals.size() - count) + " more signals are in motion.bin.", Tone::soft);
}

void add_plots(Document& page, const RunFiles& run) {
  const std::vector<io::ColumnGroup> groups = io::group_columns(run.history.header.columns);
  if (groups.empty() || run.history.rows.empty()) return;
  page.section("Sensors");
  std::string html = "<div id=\"plots\" class=\"plots\">\n";
  const std::vector<double> round_off = round_off_of(run);
  const std::vector<std::vector<double>> bands = error_bands(run.history, run.errors);
  if (!bands.empty())
    page.paragraph("Thin lines are the measured errors above and below the values, in time and of the mesh together.",
                   Tone::soft);
  for (std::size_t k = 0; k < std::min(groups.size(), most_plots); ++k) {
    const std::size_t first = groups[k].columns.front();
    const std::string unit =
        first < run.history.header.about.size() ? run.history.header.about[first].unit : std::string();
    const std::string title = io::title_of(groups[k]) + (unit.empty() ? "" : " [" + unit + "]");
    html += "<figure>\n" +
            make_plot(run.history, title, groups[k].columns, time_label(run), round_off[first], bands).svg +
            "</figure>\n";
  }
  page.markup(html + "</div>\n");
  if (groups.size() > most_plots)
    page.paragraph("Without scripts " + std::to_string(groups.size() - most_plots) +
                       " plots are left out; history.csv holds all columns.",
                   Tone::soft);
}

/// The scene, with the values that were set for the run.
std::string what_ran(const RunFiles& run) {
  std::string text = run.name;
  if (run.summary)
    for (const std::string& set : run.summary->overrides) text += ", " + set;
  return text;
}

std::string words_of(std::string name) {
  for (char& c : name)
    if (c == '_') c = ' ';
  return name;
}

/// Expected figures: those that were missed, then the others, folded.
void add_expected(Document& page, const std::vector<records::ExpectedResult>& expected) {
  if (expected.empty()) return;
  page.section("Expected figures");
  Table open{{"figure", "value", "reference", "tolerance", "verdict", "taken"}, {}}, passed = open;
  for (const records::ExpectedResult& f : expected) {
    const bool is_good = f.reached && f.holds;
    (is_good ? passed : open)
        .rows.push_back({{f.name},
                         f.reached && f.has_value ? number_cell(f.value, 9) : Cell{"-", Tone::plain, true},
                         number_cell(f.reference, 9),
                         number_cell(f.tolerance, 3),
                         {f.verdict(), is_good     ? Tone::good
                                       : f.reached ? Tone::bad
                                                   : Tone::soft},
                         {f.taken}});
  }
  if (!open.rows.empty()) page.table(open);
  if (!passed.rows.empty())
    page.folded(std::to_string(passed.rows.size()) + (passed.rows.size() == 1 ? " figure holds" : " figures hold"),
                passed, open.rows.empty() && passed.rows.size() <= 12);
}

void add_tables(Document& page, const std::vector<records::Table>& tables) {
  for (const records::Table& table : tables) {
    std::string heading = table.name;
    heading.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(heading.front())));
    page.section(heading);
    page.paragraph(table.about);
    if (const std::vector<Chart> charts = charts_of(table); !charts.empty()) page.charts(charts);
    Table brief, whole;
    for (const records::Table::Column& column : table.columns) {
      whole.head.push_back(words_of(column.name) + (column.unit.empty() ? "" : " [" + column.unit + "]"));
      if (column.is_brief) brief.head.push_back(whole.head.back());
    }
    for (const auto& row : table.rows) {
      std::vector<Cell> cells, few;
      for (std::size_t c = 0; c < row.size(); ++c) {
        const double* number = std::get_if<double>(&row[c]);
        cells.push_back(number != nullptr ? number_cell(*number, 7) : Cell{std::get<std::string>(row[c])});
        if (table.columns[c].is_brief) few.push_back(cells.back());
      }
      whole.rows.push_back(std::move(cells));
      brief.rows.push_back(std::move(few));
    }
    constexpr std::size_t most_rows = 60;  // longer tables are folded
    if (brief.rows.size() <= most_rows) page.table(brief);
    page.folded("All columns", whole, false);
  }
}

void add_checks(Document& page, const io::SummaryFile& s) {
  if (!s.doubts.empty()) {
    page.section("Not to be trusted without a closer look");
    std::vector<std::string> list;
    for (const records::Doubt& doubt : s.doubts) list.push_back(doubt.about + ": " + doubt.text);
    page.list(list);
  }
  if (!s.not_judged.empty()) page.paragraph("Not judged: " + s.not_judged + ".", Tone::soft);
  if (!s.checks.empty()) {
    page.section("Checks");
    Table table{{"check", "value"}, {}};
    for (const auto& [name, value] : s.checks) table.rows.push_back({{words_of(name)}, number_cell(value, 4)});
    page.folded("Balances, violations and errors", table, false);
  }
  if (!s.notes.empty()) {
    page.section("Notes");
    page.list(s.notes);
  }
}

}  // namespace

std::string_view how_to_record_motion() {
  return "No motion was recorded. Set \"output\": {\"motion\": true} in the scene, or run with --set "
         "/output/motion=true.";
}

namespace {

bool is_of_kind(const RunFiles& run, std::string_view kind) {
  return run.summary && std::any_of(run.summary->options.begin(), run.summary->options.end(), [&](const auto& option) {
           return option.first == "/analysis/kind" && option.second == kind;
         });
}

}  // namespace

bool is_static(const RunFiles& run) { return is_of_kind(run, "static"); }

bool is_of_modes(const RunFiles& run) { return is_of_kind(run, "modes") || is_of_kind(run, "buckling"); }

std::vector<std::string> mode_labels(const RunFiles& run) {
  std::vector<std::string> labels;
  if (!is_of_modes(run)) return labels;
  for (const records::Table& table : run.summary->tables) {
    const auto cell = [&](const auto& row, std::string_view name) -> const records::Table::Cell& {
      const auto at =
          std::find_if(table.columns.begin(), table.columns.end(), [&](const auto& c) { return c.name == name; });
      return row[static_cast<std::size_t>(at - table.columns.begin())];
    };
    for (const auto& row : table.rows) {
      if (table.name == "buckling")
        labels.push_back(std::to_string(labels.size() + 1) + ": load factor " +
                         io::rounded_text(std::get<double>(cell(row, "load_factor")), 6) + ", " +
                         std::get<std::string>(cell(row, "what")));
      if (table.name != "modes") continue;
      const double frequency = std::get<double>(cell(row, "frequency"));
      labels.push_back(
          std::to_string(labels.size() + 1) + ": " +
          (frequency > 0.0 ? io::rounded_text(frequency, 5) + " Hz" : std::get<std::string>(cell(row, "kind"))) + ", " +
          std::get<std::string>(cell(row, "what")));
    }
  }
  return labels;
}

std::vector<records::MotionFrame> frames_of_mode(const RunFiles& run, int mode) {
  std::vector<records::MotionFrame> frames;
  for (const double phase : {0.75, 0.0, 0.25}) {
    const double time = mode - 1 + phase;
    const auto nearest = std::min_element(run.motion.begin(), run.motion.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.time - time) < std::abs(b.time - time);
    });
    if (nearest == run.motion.end() || std::abs(nearest->time - time) > 0.1) return {};
    frames.push_back(*nearest);
    frames.back().time = phase;
  }
  return frames;
}

bool has_velocities(const RunFiles& run) { return !run.is_by_step && !is_static(run); }

bool turns_back(const RunFiles& run) {
  const std::vector<records::HistoryRow>& rows = run.history.rows;
  return is_static(run) &&
         std::adjacent_find(rows.begin(), rows.end(), [](const records::HistoryRow& a, const records::HistoryRow& b) {
           return !(a.time < b.time);
         }) != rows.end();
}

RunFiles by_step(RunFiles run) {
  records::HistoryHeader& header = run.history.header;
  std::vector<records::HistoryRow>& rows = run.history.rows;
  header.columns.insert(header.columns.begin(), "load factor");
  if (!header.about.empty()) header.about.insert(header.about.begin(), records::HistoryHeader::About{});
  std::size_t row = 0;
  for (records::MotionFrame& frame : run.motion) {  // every picture is that of a row, both are in order
    while (row + 1 < rows.size() && std::abs(rows[row].time - frame.time) > 1e-12) ++row;
    frame.time = static_cast<double>(row++);
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].values.insert(rows[k].values.begin(), rows[k].time);
    rows[k].time = static_cast<double>(k);
  }
  run.errors = {};  // load factors of twins are not known by step
  run.is_by_step = true;
  return run;
}

std::string_view time_label(const RunFiles& run) {
  if (is_of_modes(run)) return "mode";
  return run.is_by_step ? "step" : is_static(run) ? "load factor" : "time [s]";
}

namespace {

/// What is there of a run that has not ended.
RunFiles read_run_so_far(const io::UnfinishedRun& unfinished, const std::string& name, std::size_t max_frames) {
  RunFiles run;
  run.name = name;
  run.history = io::read_rows_so_far(unfinished);
  if (const auto columns = io::file_so_far(unfinished, "columns.json"); !columns.empty())
    io::read_columns(columns, run.history.header);
  if (const auto motion = io::file_so_far(unfinished, "motion.bin"); !motion.empty()) try {
      io::Motion read = io::read_motion_file(motion, max_frames);
      run.motion = std::move(read.frames);
      run.parts = std::move(read.parts);
    } catch (const std::runtime_error&) {  // nothing of it is on the disk yet
    }
  return run;
}

RunFiles read_run_once(const std::filesystem::path& directory, std::size_t max_frames) {
  RunFiles run;
  run.name = std::filesystem::absolute(directory).lexically_normal().stem().string();
  if (const auto unfinished = io::find_unfinished_run(directory))
    return read_run_so_far(*unfinished, run.name, max_frames);
  run.summary = io::read_whole_summary(directory, {"history.csv", "columns.json", "errors.csv", "motion.bin"});
  run.history = io::read_history(directory / "history.csv");
  io::read_columns(directory / "columns.json", run.history.header);
  if (std::filesystem::exists(directory / "errors.csv")) run.errors = io::read_history(directory / "errors.csv");
  if (!run.summary->scene.empty()) run.name = run.summary->scene;
  if (std::filesystem::exists(directory / "motion.bin")) {
    io::Motion motion = io::read_motion_file(directory / "motion.bin", max_frames);
    run.motion = std::move(motion.frames);
    run.parts = std::move(motion.parts);
  }
  return run;
}

}  // namespace

RunFiles read_run(const std::filesystem::path& directory, std::size_t max_frames) {
  return io::read_unchanged(directory, [&] { return read_run_once(directory, max_frames); });
}

std::string page_html(const RunFiles& run, const PictureOptions& options, const RunFiles* other) {
  if (!run.is_by_step && (turns_back(run) || (other != nullptr && turns_back(*other)))) {
    const RunFiles second = other != nullptr ? by_step(*other) : RunFiles{};
    PictureOptions by_steps = options;
    by_steps.is_by_step = true;
    return page_html(by_step(run), by_steps, other != nullptr ? &second : nullptr);
  }
  const std::string title = run.summary && !run.summary->title.empty() ? run.summary->title : run.name;
  Document page(title);
  add_heading(page, run);
  if (other != nullptr) {
    page.paragraph("A: " + what_ran(run) + ". B, dashed and in orange: " + what_ran(*other) + ".", Tone::soft);
    if (!run.motion.empty() && other->motion.empty())
      page.paragraph("The picture shows A alone: B did not store its motion.", Tone::soft);
  }
  add_motion(page, run, options);
  add_signals(page, run, other);
  add_plots(page, run);
  if (run.summary) {
    add_tables(page, run.summary->tables);
    add_expected(page, run.summary->expected);
    add_checks(page, *run.summary);
  }
  page.program("run", "[" + view_data(run) + (other != nullptr ? "," + view_data(*other) : "") + "]", view_script);
  return page.html();
}

}  // namespace bough::report
