#include "bough/io/read_study.hpp"

#include <algorithm>
#include <cmath>

#include "bough/plan/history_header.hpp"
#include "bough/plan/plan.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "document_report.hpp"
#include "study_converter.hpp"
#include "study_rules.hpp"

namespace bough::io {
namespace {

constexpr std::size_t most_runs = 5000;  // of a study

void append(const std::vector<std::string>& from, std::vector<std::string>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void StudyConverter::convert(const JsonValue& root) {
  spec.title = text_or(root, "title");
  spec.repetitions = whole_number<int>(number_or(root, "repetitions", 3));
  spec.time_limit = number_or(root, "time_limit", 120.0);
  spec.sample_interval = number_or(root, "sample_interval", 0.0);
  if (const Value* wanted = sound(root, "wanted"))
    for (const Value& w : wanted->items) spec.wanted.push_back(w.number);
  if (const Value* figures = sound(root, "figures"))
    for (const Value& f : figures->items) spec.figures.push_back(f.text);
  const std::optional<std::filesystem::path> scene_file = read_scene_file(root, spec.scene_text, spec.scene_name);
  if (!scene_file) return;
  spec.scene_folder = scene_file->parent_path();
  read_base(root);
  const Value* quantities = root.find("quantities");
  if (!base_ || quantities == nullptr || !quantities->is(JsonKind::array)) return;
  for (std::size_t i = 0; i < quantities->items.size(); ++i)
    if (quantities->items[i].sound) read_quantity(quantities->items[i], "/quantities/" + std::to_string(i));
  if (!quantities->sound) return;
  if (const Value* reference = root.find("reference")) {
    if (!reference->sound) return;
    spec.has_reference = true;
    spec.reference = read_reference(*reference, "/reference");
  }
  const Value* grids = root.find("grids");
  if (grids == nullptr || !grids->is(JsonKind::array)) return;
  std::size_t num_runs = 0;
  for (std::size_t i = 0; i < grids->items.size(); ++i) {
    if (!grids->items[i].sound) continue;
    read_grid(grids->items[i], "/grids/" + std::to_string(i));
    std::size_t runs = 1;
    for (const StudyAxis& axis : spec.grids.back().axes) runs = std::min(most_runs + 1, runs * axis.choices.size());
    num_runs += runs;
  }
  if (num_runs > most_runs)
    fault("/grids", "a study has at most " + std::to_string(most_runs) + " runs", "take fewer values");
  if (!faults.empty() || !grids->sound) return;
  for (std::size_t i = 0; i < spec.grids.size(); ++i) check_runs(spec.grids[i], "/grids/" + std::to_string(i));
}

/// The scene with the overrides common to all runs. Its sensors may be replaced; its expected figures are not used.
void StudyConverter::read_base(const Value& root) {
  spec.overrides = {"/expected=[]"};
  if (const Value* sensors = root.find("sensors")) {
    if (!sensors->sound) return;
    spec.overrides.push_back("/sensors=" + slice(*sensors));
    origins_.push_back({"/sensors", "/sensors"});
  }
  if (const Value* set = root.find("set")) {
    if (!set->sound) return;
    const std::vector<std::string> settings = read_settings(*set, "/set");
    add_origins(settings, "/set", origins_);
    append(settings, spec.overrides);
  }
  if (!faults.empty()) return;
  base_ = scene_->read(spec.overrides, origins_, "/scene", faults);
  if (!base_) return;
  spec.is_dynamic = scene::type_of(base_->analysis.kind).is_in_time;
  spec.end = spec.is_dynamic ? base_->analysis.end_time : 1.0;
  columns_ = plan::make_header(plan::make_plan(*base_)).columns;
  if (const double n = spec.sample_interval > 0.0 ? spec.end / spec.sample_interval : 1.0;
      n < 0.5 || n > 1e6 || std::abs(n - std::round(n)) > 1e-9 * n) {
    fault("/sample_interval", "the end of the run is a multiple of it, of at most a million");
    base_.reset();
  }
}

std::vector<std::string> StudyConverter::read_settings(const Value& list, const std::string& at) {
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < list.items.size(); ++i)
    append(read_setting(list.items[i].find("pointer")->text, slice(*list.items[i].find("value")),
                        at + "/" + std::to_string(i) + "/pointer"),
           overrides);
  return overrides;
}

StudyFile read_study_text(std::string_view text, std::string name, const std::filesystem::path& folder) {
  StudyFile file;
  StudyConverter converter(text, folder);
  read_document(text, study_rules(), converter, file);
  file.spec = std::move(converter.spec);
  file.spec.name = std::move(name);
  return file;
}

StudyFile read_study(const std::filesystem::path& file) {
  return read_document_file<StudyFile>(
      file, [&](const std::string& text) { return read_study_text(text, name_of_file(file), file.parent_path()); });
}

std::vector<double> sample_times(const StudySpec& spec) {
  if (!(spec.sample_interval > 0.0)) return {spec.end};
  const long n = std::lround(spec.end / spec.sample_interval);
  std::vector<double> times;
  for (long k = 0; k <= n; ++k)
    times.push_back(k == n ? spec.end : spec.end * static_cast<double>(k) / static_cast<double>(n));
  return times;
}

std::vector<std::string> overrides_of(const StudySpec& spec, const StudyGrid& grid, const std::vector<std::size_t>& c) {
  std::vector<std::string> overrides = spec.overrides;
  append(grid.overrides, overrides);
  for (std::size_t a = 0; a < grid.axes.size(); ++a) append(grid.axes[a].choices[c[a]].overrides, overrides);
  return overrides;
}

std::vector<std::string> overrides_of(const StudySpec& spec, const StudyGrid& grid,
                                      const std::vector<std::string>& settings) {
  std::vector<std::string> overrides = spec.overrides;
  append(grid.overrides, overrides);
  append(settings, overrides);
  return overrides;
}

std::vector<std::vector<std::size_t>> combinations_of(const StudyGrid& grid) {
  std::vector<std::vector<std::size_t>> all = {{}};
  for (const StudyAxis& axis : grid.axes) {
    std::vector<std::vector<std::size_t>> longer;
    for (const std::vector<std::size_t>& c : all)
      for (std::size_t k = 0; k < axis.choices.size(); ++k) {
        longer.push_back(c);
        longer.back().push_back(k);
      }
    all = std::move(longer);
  }
  return all;
}

}  // namespace bough::io
