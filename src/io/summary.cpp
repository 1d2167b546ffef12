#include "bough/io/summary.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "bough/io/columns.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/lanes/instruction_set.hpp"
#include "measured_errors.hpp"
#include "result_tables.hpp"

namespace bough::io {
namespace {

long long wide(long count) { return static_cast<long long>(count); }

void write_steps(JsonText& json, const records::Summary& summary) {
  json.key("steps");
  json.begin_object();
  json.member("accepted", wide(summary.steps.accepted));
  json.member("rejected", wide(summary.steps.rejected));
  if (summary.steps.size_changes > 0) {
    json.member("rejected_for_error", wide(summary.steps.rejected_for_error));
    json.member("size_changes", wide(summary.steps.size_changes));
  }
  json.member("newton_iterations", wide(summary.steps.newton_iterations));
  json.member("factorizations", wide(summary.steps.factorizations));
  json.end_object();
  json.key("time_s");
  json.begin_object();
  json.member("prepare", summary.times.prepare);
  json.member("total", summary.times.total);
  json.member("cpu", summary.times.cpu);
  json.member("assemble", summary.times.assemble);
  json.member("factor", summary.times.factor);
  json.member("solve", summary.times.solve);
  json.member("update", summary.times.update);
  json.member("output", summary.times.output);
  json.end_object();
  json.member("memory_peak_bytes", static_cast<long long>(summary.memory_peak_bytes));
}

/// Only a motion that is integrated has balances of energy and momentum over time.
bool has_balances(const records::Summary& summary) {
  return std::find(summary.options.begin(), summary.options.end(),
                   std::pair<std::string, std::string>("analysis/kind", "\"dynamic\"")) != summary.options.end();
}

void write_checks(JsonText& json, const records::Summary& summary) {
  const records::Checks& checks = summary.checks;
  json.key("checks");
  json.begin_object();
  if (checks.evaluated) {
    if (has_balances(summary)) {
      json.member("energy_balance", checks.energy_balance);
      json.member("numerical_dissipation", checks.numerical_dissipation);
      json.member("energy_scale", checks.energy_scale);
      json.member("momentum_balance", checks.momentum_balance);
      if (checks.momentum_scale > 0.0) json.member("momentum_scale", checks.momentum_scale);
      if (checks.angular_momentum_scale > 0.0) {
        json.member("angular_momentum_balance", checks.angular_momentum_balance);
        json.member("angular_momentum_scale", checks.angular_momentum_scale);
      }
    }
    json.member("constraint_violation_position", checks.constraint_violation_position);
    json.member("constraint_violation_velocity", checks.constraint_violation_velocity);
  }
  if (checks.local_error_known) {
    json.member("local_error_max", checks.local_error_max);
    json.member("local_error_sum", checks.local_error_sum);
    json.member("local_error_max_velocity", checks.local_error_max_velocity);
  }
  json.member("linear_backward_error_max", checks.linear_backward_error_max);
  json.member("linear_rank_error_max", checks.linear_rank_error_max);
  json.member("round_off_floor_reached", checks.round_off_floor_reached);
  json.member("unbalanced_at_floor", checks.unbalanced_at_floor);
  json.end_object();
}

void write_limit_points(JsonText& json, const std::vector<records::LimitPoint>& points) {
  json.key("limit_points");
  json.begin_array();
  for (const records::LimitPoint& p : points) {
    json.begin_object();
    json.member("load_factor", p.load_factor);
    json.member("is_maximum", p.is_maximum);
    json.member("is_located", p.is_located);
    json.end_object();
  }
  json.end_array();
}

/// Estimated errors of sensors of motions at the end.
void write_errors(JsonText& json, const std::vector<records::SensorError>& errors) {
  if (errors.empty()) return;
  json.key("errors");
  json.begin_object();
  for (const records::SensorError& e : errors) {
    json.key(e.column);
    json.begin_object();
    json.member("error", e.of_steps + e.of_energy);
    json.member("range", e.range);
    json.end_object();
  }
  json.end_object();
}

void write_bifurcations(JsonText& json, const std::vector<records::Bifurcation>& points) {
  json.key("bifurcations");
  json.begin_array();
  for (const records::Bifurcation& p : points) {
    json.begin_object();
    json.member("load_factor", p.load_factor);
    json.member("mode", std::string_view(p.mode));
    json.member("is_lost", p.is_lost);
    json.end_object();
  }
  json.end_array();
}

void write_stability(JsonText& json, const records::Stability& s) {
  json.key("stability");
  json.begin_object();
  json.member("is_known", s.is_known);
  json.member("is_declared", s.is_declared);
  if (!s.not_conservative.empty()) json.member("not_conservative", std::string_view(s.not_conservative));
  json.member("unstable_directions", static_cast<long long>(s.unstable_directions));
  if (s.first_lost) {
    json.key("first_lost_between");
    json.begin_array();
    json.value(s.first_lost->before);
    json.value(s.first_lost->after);
    json.end_array();
  }
  if (!s.mode.empty()) json.member("mode", std::string_view(s.mode));
  if (!s.hidden.empty()) {
    json.member("hidden", std::string_view(s.hidden));
    json.member("hidden_mode", std::string_view(s.hidden_mode));
  }
  if (!s.largest_load.empty()) json.member("largest_load", std::string_view(s.largest_load));
  json.end_object();
}

/// Doubts about the run, and figures of the levels of the tree.
void write_trust(JsonText& json, const records::Summary& summary) {
  json.key("trust");
  json.begin_object();
  const std::string& not_judged = summary.not_judged;
  const std::string nothing = not_judged.empty()
                                  ? "nothing speaks against this run"
                                  : "nothing speaks against this run in what was judged; not judged: " + not_judged;
  json.member("verdict",
              std::string_view(summary.doubts.empty() ? nothing : "not to be trusted without a closer look"));
  if (!not_judged.empty()) json.member("not_judged", std::string_view(not_judged));
  json.key("doubts");
  json.begin_array();
  for (const records::Doubt& doubt : summary.doubts) {
    json.begin_object();
    json.member("about", std::string_view(doubt.about));
    json.member("text", std::string_view(doubt.text));
    json.end_object();
  }
  json.end_array();
  write_errors(json, summary.sensor_errors);
  json.key("levels");
  json.begin_array();
  for (const records::LevelFigures& level : summary.levels) {
    json.begin_object();
    json.member("level", static_cast<long long>(level.level));
    json.member("sub_domains", static_cast<long long>(level.subdomains));
    json.member("interface_unknowns", static_cast<long long>(level.interface_unknowns));
    if (level.condition > 0.0) json.member("interface_condition", level.condition);
    json.member("backward_error", level.backward_error);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

/// Final values: {sensor: number} or {sensor: {component: number}}.
void write_sensors(JsonText& json, const records::Summary& summary) {
  const std::vector<std::string>& columns = summary.header.columns;
  json.key("sensors");
  json.begin_object();
  std::vector<std::string> done;
  for (std::size_t c = 0; c < columns.size() && c < summary.final_values.size(); ++c) {
    const ColumnName name = split_column(columns[c]);
    if (name.component.empty()) {
      json.member(name.sensor, summary.final_values[c]);
      continue;
    }
    if (std::find(done.begin(), done.end(), name.sensor) != done.end()) continue;
    done.push_back(name.sensor);
    json.key(name.sensor);
    json.begin_object();
    for (std::size_t k = c; k < columns.size() && k < summary.final_values.size(); ++k) {
      const ColumnName other = split_column(columns[k]);
      if (other.sensor == name.sensor && !other.component.empty())
        json.member(other.component, summary.final_values[k]);
    }
    json.end_object();
  }
  json.end_object();
}

void write_expected(JsonText& json, const std::vector<records::ExpectedResult>& expected) {
  json.key("expected");
  json.begin_object();
  std::vector<std::string> names;
  for (const records::ExpectedResult& figure : expected) {
    const auto count = std::count(names.begin(), names.end(), figure.name);
    names.push_back(figure.name);
    json.key(count == 0 ? figure.name : figure.name + " #" + std::to_string(count + 1));
    json.begin_object();
    if (figure.reached && figure.has_value) json.member("value", figure.value);
    json.member("reference", figure.reference);
    json.member("tolerance", figure.tolerance);
    json.member("reached", figure.reached);
    if (figure.reached) json.member("holds", figure.holds);
    if (!figure.taken.empty()) json.member("taken", figure.taken);
    if (!figure.source.empty()) json.member("source", figure.source);
    json.end_object();
  }
  json.end_object();
}

void write_measures(JsonText& json, const std::vector<records::MeasureResult>& measures) {
  if (measures.empty()) return;
  json.key("measures");
  json.begin_object();
  for (const records::MeasureResult& m : measures) {
    json.key(m.name);
    if (m.value)
      json.value(*m.value);
    else
      json.value("none");
  }
  json.end_object();
}

void write_origin(JsonText& json, const RunOrigin& origin, const std::vector<FileRecord>& files) {
  json.key("origin");
  json.begin_object();
  json.member("scene_file", std::string_view(origin.scene_file.string()));
  json.member("scene_hash", std::string_view(origin.scene_hash));
  json.key("set");
  json.begin_array();
  for (const std::string& text : origin.overrides) json.value(std::string_view(text));
  json.end_array();
  json.member("commit", std::string_view(origin.commit));
  json.member("program_hash", std::string_view(origin.program_hash));
  if (origin.from) {
    json.key("from");
    json.begin_object();
    json.member("folder", std::string_view(origin.from->folder.string()));
    json.member("time", origin.from->time);
    json.member("hash", std::string_view(origin.from->hash));
    json.end_object();
  }
  json.end_object();
  json.key("files");
  json.begin_object();
  for (const FileRecord& file : files) json.member(file.name, std::string_view(file.hash));
  json.end_object();
}

std::string text_of(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  return value != nullptr && value->is(JsonKind::string) ? value->text.str() : std::string();
}

/// A number, also where it is written as "nan", "inf" or "-inf"; false where it is neither.
bool number_of(const JsonValue& value, double& number) {
  if (value.is(JsonKind::string)) return read_number(value.text.str(), number);
  number = value.number;
  return value.is(JsonKind::number);
}

long count_of(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  return value != nullptr && value->is(JsonKind::number) ? whole_number<long>(value->number) : 0;
}

void read_expected(const JsonValue& list, SummaryFile& summary) {
  if (!list.is(JsonKind::object)) return;
  for (std::size_t k = 0; k < list.items.size(); ++k) {
    const JsonValue& item = list.items[k];
    records::ExpectedResult figure;
    figure.name = list.items.key(k);
    const JsonValue* value = item.find("value");
    figure.has_value = value != nullptr && number_of(*value, figure.value);
    if (const JsonValue* v = item.find("reference"); v != nullptr) (void)number_of(*v, figure.reference);
    if (const JsonValue* v = item.find("tolerance"); v != nullptr) (void)number_of(*v, figure.tolerance);
    if (const JsonValue* v = item.find("reached"); v != nullptr) figure.reached = v->truth;
    if (const JsonValue* v = item.find("holds"); v != nullptr) figure.holds = v->truth;
    figure.source = text_of(item, "source");
    figure.taken = text_of(item, "taken");
    summary.expected.push_back(std::move(figure));
  }
}

void read_measures(const JsonValue& list, SummaryFile& summary) {
  for (std::size_t k = 0; k < list.items.size(); ++k) {
    const JsonValue& item = list.items[k];
    records::MeasureResult m{list.items.key(k), {}};
    if (item.is(JsonKind::number)) m.value = item.number;
    summary.measures.push_back(std::move(m));
  }
}

}  // namespace

std::string_view status_text(records::RunStatus status) {
  switch (status) {
    case records::RunStatus::ok:
      return "ok";
    case records::RunStatus::failed:
      return "failed";
    case records::RunStatus::interrupted:
      return "interrupted";
  }
  return "failed";
}

std::vector<std::filesystem::path> RunOrigin::inputs() const {
  std::vector<std::filesystem::path> files;
  if (!scene_file.empty()) files.push_back(scene_file);
  if (from) files.push_back(from->file);
  return files;
}

std::string summary_text(const records::Summary& summary, std::string_view version, const RunOrigin& origin,
                         const std::vector<FileRecord>& files) {
  JsonText json;
  json.begin_object();
  json.member("status", status_text(summary.status));
  json.member("cause", std::string_view(summary.cause));
  json.member("scene", std::string_view(summary.scene));
  json.member("title", std::string_view(summary.title));
  json.member("version", version);
  json.member("instruction_set", lanes::instruction_set().name);
  json.member("threads", static_cast<long long>(summary.threads));
  json.key("options");
  json.begin_object();
  for (const auto& [pointer, value] : summary.options) {
    json.key("/" + pointer);
    json.raw(value);
  }
  json.end_object();
  write_steps(json, summary);
  write_checks(json, summary);
  if (summary.follows_path) write_limit_points(json, summary.limit_points);
  if (summary.follows_path) write_bifurcations(json, summary.bifurcations);
  if (summary.stability) write_stability(json, *summary.stability);
  write_trust(json, summary);
  json.key("notes");
  json.begin_array();
  for (const std::string& note : summary.notes) json.value(std::string_view(note));
  json.end_array();
  json.key("solver");
  json.begin_object();
  for (const auto& [name, value] : summary.solver) json.member(name, value);
  json.end_object();
  write_sensors(json, summary);
  write_expected(json, summary.expected);
  write_measures(json, summary.measures);
  write_tables(json, summary.tables);
  if (summary.errors) write_measured_errors(json, *summary.errors);
  write_origin(json, origin, files);
  json.end_object();
  return json.text();
}

SummaryFile read_summary(const std::filesystem::path& path) {
  const std::string text = read_text(path, max_file_bytes);
  std::vector<JsonFault> faults;
  const std::optional<JsonValue> json = parse_json(text, source_file, faults);
  if (!json || !faults.empty() || !json->is(JsonKind::object))
    throw std::runtime_error(path.string() + ": not a JSON object");
  SummaryFile summary;
  summary.status = text_of(*json, "status");
  if (summary.status.empty()) throw std::runtime_error(path.string() + ": not the summary of a run: it has no status");
  summary.cause = text_of(*json, "cause");
  summary.scene = text_of(*json, "scene");
  summary.title = text_of(*json, "title");
  summary.version = text_of(*json, "version");
  if (const JsonValue* steps = json->find("steps"); steps != nullptr) {
    summary.accepted = count_of(*steps, "accepted");
    summary.rejected = count_of(*steps, "rejected");
    summary.newton_iterations = count_of(*steps, "newton_iterations");
  }
  if (const JsonValue* checks = json->find("checks"); checks != nullptr && checks->is(JsonKind::object)) {
    for (std::size_t k = 0; k < checks->items.size(); ++k) {
      double value = 0.0;
      if (number_of(checks->items[k], value)) summary.checks.emplace_back(checks->items.key(k), value);
    }
  }
  if (const JsonValue* trust = json->find("trust"); trust != nullptr)
    summary.not_judged = text_of(*trust, "not_judged");
  if (const JsonValue* trust = json->find("trust"); trust != nullptr)
    if (const JsonValue* doubts = trust->find("doubts"); doubts != nullptr)
      for (const JsonValue& doubt : doubts->items)
        summary.doubts.push_back({text_of(doubt, "about"), text_of(doubt, "text")});
  if (const JsonValue* options = json->find("options"); options != nullptr && options->is(JsonKind::object)) {
    for (std::size_t k = 0; k < options->items.size(); ++k)
      if (options->items[k].is(JsonKind::string))
        summary.options.emplace_back(options->items.key(k), options->items[k].text);
  }
  if (const JsonValue* notes = json->find("notes"); notes != nullptr)
    for (const JsonValue& note : notes->items) summary.notes.push_back(note.text.str());
  if (const JsonValue* measures = json->find("measures"); measures != nullptr) read_measures(*measures, summary);
  if (const JsonValue* tables = json->find("tables"); tables != nullptr) summary.tables = read_tables(*tables);
  if (const JsonValue* expected = json->find("expected"); expected != nullptr) read_expected(*expected, summary);
  if (const JsonValue* origin = json->find("origin"); origin != nullptr) {
    if (const JsonValue* set = origin->find("set"); set != nullptr)
      for (const JsonValue& item : set->items) summary.overrides.push_back(item.text.str());
    summary.scene_hash = text_of(*origin, "scene_hash");
    if (const JsonValue* from = origin->find("from"); from != nullptr) summary.start_hash = text_of(*from, "hash");
  }
  if (const JsonValue* files = json->find("files"); files != nullptr)
    for (std::size_t k = 0; k < files->items.size(); ++k)
      summary.files.push_back({files->items.key(k), 0, files->items[k].text});
  return summary;
}

namespace {

/// Whether a file has the size that the manifest lists, if there is one, and the hash that the summary lists.
bool is_as_listed(const std::filesystem::path& path, const std::optional<Manifest>& manifest,
                  const FileRecord& listed) {
  if (manifest) {
    const auto at = std::find_if(manifest->files.begin(), manifest->files.end(),
                                 [&](const FileRecord& file) { return file.name == listed.name; });
    if (at != manifest->files.end() && !at->hash.empty() && InputFile(path).size() != at->bytes) return false;
  }
  return digest_of_file(path) == listed.hash;
}

}  // namespace

std::string state_of_folder(const std::filesystem::path& directory) {
  std::string state;
  for (const std::filesystem::path& path : {directory, directory / manifest_name}) {
    struct stat there = {};
    if (::stat(path.c_str(), &there) != 0) continue;
    state += std::to_string(there.st_dev) + ":" + std::to_string(there.st_ino) + " ";
  }
  return state;
}

bool is_settled(const std::filesystem::path& directory, const std::string& state) {
  constexpr auto pause = std::chrono::milliseconds(20);
  if (state_of_folder(directory) != state) return false;
  std::error_code ignored;
  if (std::filesystem::exists(directory / manifest_name, ignored) ||
      !std::filesystem::exists(OutputFolder::staging_of(directory), ignored))
    return true;
  std::this_thread::sleep_for(pause);
  return false;
}

SummaryFile read_whole_summary(const std::filesystem::path& directory, const std::vector<std::string>& names) {
  const std::string run_again = "; run the scene again, into a new folder";
  const auto is_there = [&](const std::string& name) { return std::filesystem::exists(directory / name); };
  if (!std::filesystem::exists(directory)) throw std::runtime_error("there is no folder " + directory.string());
  if (!std::filesystem::is_directory(directory))
    throw std::runtime_error(directory.string() + " is a file, not a folder of results");
  const std::optional<Manifest> manifest = read_manifest(directory);
  if (!is_there("summary.json") && manifest && manifest->made_by != "run")
    throw std::runtime_error(
        directory.string() + " holds results of bough " + manifest->made_by + ", not of one run" +
        (is_there("batch.csv") ? ": name the folder of a case in it, or with bough view a --case" : ""));
  if (!is_there("summary.json"))
    throw std::runtime_error(directory.string() + " has no summary.json: the run did not end" + run_again);
  SummaryFile summary = read_summary(directory / "summary.json");
  if (manifest && manifest->state == FolderState::unfinished)
    throw std::runtime_error(directory.string() + ": its run could not write all results" + run_again);
  for (const std::string& name : names) {
    const auto listed = std::find_if(summary.files.begin(), summary.files.end(),
                                     [&](const FileRecord& file) { return file.name == name; });
    if (listed == summary.files.end() && !is_there(name)) continue;
    const std::string what = (directory / name).string();
    if (listed == summary.files.end())
      throw std::runtime_error(what + " does not belong to the summary beside it, which does not list it" + run_again);
    if (!is_there(name)) throw std::runtime_error(what + " is missing: the summary beside it lists it" + run_again);
    if (!is_as_listed(directory / name, manifest, *listed))
      throw std::runtime_error(what + " is not the file that was written with the summary beside it" + run_again);
  }
  return summary;
}

}  // namespace bough::io
