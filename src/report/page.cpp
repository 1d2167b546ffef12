#include "bough/report/page.hpp"

#include <cmath>

#include "bough/io/columns.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/report/plot.hpp"
#include "page_script.hpp"
#include "page_style.hpp"
#include "svg_text.hpp"

namespace bough::report {
namespace {

constexpr std::size_t max_plots = 24, max_samples = 500;

void append_value(std::string& json, double value) {
  const bool finite = std::isfinite(value);
  if (!finite) json += '"';
  io::append_rounded(json, value, 6);
  if (!finite) json += '"';
}

template <class List, class Append>
void append_list(std::string& json, const List& list, const Append& append) {
  json += '[';
  bool first = true;
  for (const auto& item : list) {
    if (!first) json += ',';
    first = false;
    append(item);
  }
  json += ']';
}

/// Evenly chosen rows for reading values off, the first and the last among them.
std::vector<std::size_t> sample_rows(std::size_t num_rows) {
  std::vector<std::size_t> rows;
  const std::size_t count = std::min(num_rows, max_samples);
  for (std::size_t k = 0; k < count; ++k) rows.push_back(count < 2 ? 0 : k * (num_rows - 1) / (count - 1));
  return rows;
}

struct PlotEntry {
  Plot plot;
  std::vector<std::size_t> columns;
};

void append_plot_data(std::string& json, const PlotEntry& entry, const io::History& history,
                      const std::vector<std::size_t>& samples) {
  const PlotGeometry& g = entry.plot.geometry;
  json += "{\"l\":" + pixel(g.left) + ",\"r\":" + pixel(g.right) + ",\"a\":";
  append_value(json, g.first_time);
  json += ",\"b\":";
  append_value(json, g.last_time);
  json += ",\"n\":";
  append_list(json, entry.columns,
              [&](std::size_t c) { json += io::json_string(io::split_column(history.header.columns[c]).component); });
  json += ",\"t\":";
  append_list(json, samples, [&](std::size_t k) { append_value(json, history.rows[k].time); });
  json += ",\"v\":";
  append_list(json, entry.columns, [&](std::size_t c) {
    append_list(json, samples, [&](std::size_t k) { append_value(json, history.rows[k].values[c]); });
  });
  json += '}';
}

std::string run_data(const std::vector<Picture::Paths>& frames, const std::vector<PlotEntry>& plots,
                     const io::History& history) {
  std::string json = "{\"frames\":";
  append_list(json, frames, [&](const Picture::Paths& frame) {
    json += '[';
    append_value(json, frame.time);
    for (const std::string* path : {&frame.beams, &frame.bodies, &frame.springs, &frame.joints})
      json += ",\"" + *path + '"';
    json += ']';
  });
  json += ",\"plots\":";
  const std::vector<std::size_t> samples = sample_rows(history.rows.size());
  append_list(json, plots, [&](const PlotEntry& entry) { append_plot_data(json, entry, history, samples); });
  return inside_script(json + "}");
}

std::string heading(const RunFiles& run) {
  const std::string title = run.summary && !run.summary->title.empty() ? run.summary->title : run.name;
  std::string html = "<h1>" + escaped(title) + "</h1>\n";
  if (!run.summary) return html + "<p class=\"status\">The run did not end: there is no summary.</p>\n";
  const io::SummaryFile& s = *run.summary;
  const std::string words = s.status == "ok"       ? "The run is complete."
                            : s.status == "failed" ? "The run failed."
                                                   : "The run was interrupted.";
  html += "<p><span class=\"status\">" + words + "</span> " + escaped(s.cause) + "</p>\n";
  return html + "<p class=\"lead\">" + escaped(s.scene) + " · " + std::to_string(s.accepted) + " steps, " +
         std::to_string(s.rejected) + " rejected, " + std::to_string(s.newton_iterations) +
         " Newton iterations · bough " + escaped(s.version) + "</p>\n";
}

std::string motion_section(const Picture* picture) {
  if (picture == nullptr) return "<p class=\"lead\">" + escaped(how_to_record_motion()) + "</p>\n";
  return "<div id=\"motion\"><figure>\n" + picture->svg +
         "</figure></div>\n<div id=\"player\" hidden><button type=\"button\">Play</button>"
         "<input type=\"range\" min=\"0\" value=\"0\" aria-label=\"frame\"><output></output></div>\n";
}

std::string plots_section(const std::vector<PlotEntry>& plots, std::size_t num_groups) {
  if (plots.empty()) return {};
  std::string html = "<h2>Sensors</h2>\n<p class=\"lead\">SI units.</p>\n<div class=\"plots\">\n";
  for (std::size_t k = 0; k < plots.size(); ++k)
    html += "<figure id=\"plot" + std::to_string(k) + "\">\n" + plots[k].plot.svg +
            "<div class=\"reading\"></div></figure>\n";
  html += "</div>\n";
  if (num_groups > plots.size())
    html += "<p class=\"lead\">" + std::to_string(num_groups - plots.size()) +
            " more plots are left out; history.csv holds all columns.</p>\n";
  return html;
}

std::string words_of(std::string name) {
  for (char& c : name)
    if (c == '_') c = ' ';
  return name;
}

std::string tables(const io::SummaryFile& summary) {
  std::string html;
  if (!summary.expected.empty()) {
    html +=
        "<h2>Expected figures</h2>\n<div "
        "class=\"wide\"><table>\n<tr><th>figure</th><th>value</th><th>reference</th><th>tolerance</th><th></"
        "th><th>taken</th></tr>\n";
    for (const results::ExpectedResult& figure : summary.expected) {
      html += "<tr><td>" + escaped(figure.name) + "</td><td>" +
              (figure.reached && figure.has_value ? io::rounded_text(figure.value, 9) : "-") + "</td><td>" +
              io::rounded_text(figure.reference, 9) + "</td><td>" + io::rounded_text(figure.tolerance, 3) +
              "</td><td>" + figure.verdict() + "</td><td>" + escaped(figure.taken) + "</td></tr>\n";
    }
    html += "</table></div>\n";
  }
  if (!summary.doubts.empty()) {
    html += "<h2>Not to be trusted without a closer look</h2>\n<ul>\n";
    for (const results::Doubt& doubt : summary.doubts)
      html += "<li>" + escaped(doubt.about) + ": " + escaped(doubt.text) + "</li>\n";
    html += "</ul>\n";
  }
  if (!summary.not_judged.empty()) html += "<p class=\"lead\">Not judged: " + escaped(summary.not_judged) + ".</p>\n";
  if (!summary.checks.empty()) {
    html += "<h2>Checks</h2>\n<div class=\"wide\"><table>\n";
    for (const auto& [name, value] : summary.checks)
      html += "<tr><td>" + escaped(words_of(name)) + "</td><td>" + io::rounded_text(value, 4) + "</td></tr>\n";
    html += "</table></div>\n";
  }
  if (!summary.notes.empty()) {
    html += "<h2>Notes</h2>\n<ul>\n";
    for (const std::string& note : summary.notes) html += "<li>" + escaped(note) + "</li>\n";
    html += "</ul>\n";
  }
  return html;
}

}  // namespace

std::string_view how_to_record_motion() {
  return "No motion was recorded. Set \"output\": {\"motion\": true} in the scene, or run with --set "
         "/output/motion=true.";
}

bool is_static(const RunFiles& run) {
  if (run.summary)
    for (const auto& [pointer, text] : run.summary->options)
      if (text == "static" && pointer.starts_with("/analysis")) return true;
  return false;
}

RunFiles read_run(const std::filesystem::path& directory, std::size_t max_frames) {
  RunFiles run;
  run.name = std::filesystem::absolute(directory).lexically_normal().stem().string();
  run.summary = io::read_whole_summary(directory, {"history.csv", "motion.jsonl"});
  run.history = io::read_history(directory / "history.csv");
  if (!run.summary->scene.empty()) run.name = run.summary->scene;
  if (std::filesystem::exists(directory / "motion.jsonl"))
    run.motion = io::read_motion_lines(directory / "motion.jsonl", max_frames);
  return run;
}

std::string page_html(const RunFiles& run, const PictureOptions& options) {
  const std::string_view time_label = is_static(run) ? "load factor" : "time [s]";
  std::optional<Picture> picture;
  if (!run.motion.empty()) picture = make_picture(run.motion, options);
  std::vector<PlotEntry> plots;
  const std::vector<io::ColumnGroup> groups = io::group_columns(run.history.header.columns);
  for (std::size_t k = 0; k < groups.size() && plots.size() < max_plots; ++k)
    plots.push_back({make_plot(run.history, groups[k].sensor, groups[k].columns, time_label), groups[k].columns});

  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
         "script-src 'unsafe-inline'\">\n"
         "<title>" +
         escaped(run.name) + "</title>\n<style>" + std::string(page_style) + std::string(style_text()) +
         "</style>\n</head>\n<body>\n" + heading(run) + motion_section(picture ? &*picture : nullptr) +
         plots_section(plots, groups.size()) + (run.summary ? tables(*run.summary) : std::string()) +
         "<script type=\"application/json\" id=\"run\">" +
         run_data(picture ? picture->frames : std::vector<Picture::Paths>(), plots, run.history) +
         "</script>\n<script>" + std::string(page_script) + "</script>\n</body>\n</html>\n";
}

}  // namespace bough::report
