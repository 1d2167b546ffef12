#include "references.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/atomic_file.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/read_study.hpp"
#include "bough/lanes/instruction_set.hpp"
#include "bough/version.hpp"

namespace bough::study {
namespace {

const io::StudyReference* computed_reference(const io::StudySpec& spec, const io::StudyGrid& grid) {
  return grid.has_reference ? &grid.reference : spec.has_reference ? &spec.reference : nullptr;
}

bool is_computed(const io::StudyGrid& grid, const io::StudyQuantity& quantity) {
  return grid.has_reference || !quantity.is_compared();
}

/// Follows the text that a kept reference is made from.
std::string hash_line(const std::string& hash) { return "figures " + hash + "\n"; }

/// Formula or table at the sample times.
Samples given_values(const io::StudyQuantity& q, const std::vector<double>& times) {
  Samples values(times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!q.formula.empty()) {
      for (const laws::Law& law : q.formula) values[k].push_back(law.at(times[k], laws::Side::left).value);
      continue;
    }
    const auto found = std::find(q.table_times.begin(), q.table_times.end(), times[k]);
    if (found != q.table_times.end()) values[k] = q.table_rows[static_cast<std::size_t>(found - q.table_times.begin())];
  }
  return values;
}

}  // namespace

std::string made_from(const io::StudySpec& spec, const std::vector<std::string>& overrides) {
  std::string text = "bough " + std::string(version) + " " + std::string(commit) + ", " + std::string(compiler) + " " +
                     std::string(compiler_flags) + " for " + std::string(lanes::instruction_set().name) +
                     "\nsample interval ";
  io::append_number(text, spec.sample_interval);
  text += "\n" + io::canonical_scene(spec.scene_text, overrides) + "\n";
  // Files that the scene names belong to what a reference is made from.
  const std::string hash = io::read_scene_text(spec.scene_text, spec.scene_name, overrides, spec.scene_folder).hash;
  return hash == io::digest_of(spec.scene_text) ? text : text + "with files: " + hash + "\n";
}

std::optional<io::History> ReferenceCache::find(const std::string& from) const {
  if (folder_.empty()) return std::nullopt;
  const std::string name = io::digest_of(from);
  const std::filesystem::path text = folder_ / (name + ".txt"), figures = folder_ / (name + ".csv");
  try {
    // Otherwise it is another reference with the same hash, or its figures are not those that were written.
    if (io::read_text(text, io::max_file_bytes) != from + hash_line(io::digest_of_file(figures))) return std::nullopt;
    return io::read_history(figures);
  } catch (const std::runtime_error&) {
    return std::nullopt;  // not there, or damaged: it is computed
  }
}

void ReferenceCache::keep(const std::string& from, const io::History& history) const {
  if (folder_.empty()) return;
  std::filesystem::create_directories(folder_);
  const std::string name = io::digest_of(from);
  for (const char* ending : {".csv", ".txt"}) io::list_file(folder_, {"references"}, name + ending);
  try {
    io::HistoryWriter writer(folder_ / (name + ".csv"), history.header);
    for (const records::HistoryRow& row : history.rows) writer.row(row);
    writer.commit();
    io::write_file(folder_ / (name + ".txt"), from + hash_line(writer.record().hash));
  } catch (const io::BeingWritten&) {  // by another study with the same cache, which computed the same reference
  }
}

ReferenceRuns plan_references(const io::StudySpec& spec) {
  ReferenceRuns plan;
  for (const io::StudyGrid& grid : spec.grids) {
    plan.which.emplace_back();
    const io::StudyReference* reference = computed_reference(spec, grid);
    const bool is_needed = std::any_of(spec.quantities.begin(), spec.quantities.end(),
                                       [&](const io::StudyQuantity& q) { return is_computed(grid, q); });
    if (reference == nullptr || !is_needed) continue;
    for (const std::vector<std::string>* settings : {&reference->overrides, &reference->check_overrides}) {
      ReferenceRun run;
      run.overrides = io::overrides_of(spec, grid, *settings);
      run.from = made_from(spec, run.overrides);
      const auto same = std::find_if(plan.runs.begin(), plan.runs.end(),
                                     [&](const ReferenceRun& other) { return other.from == run.from; });
      plan.which.back().push_back(static_cast<std::size_t>(same - plan.runs.begin()));
      if (same == plan.runs.end()) plan.runs.push_back(std::move(run));
    }
  }
  return plan;
}

namespace {
/// How runs differ from a reference with these `overrides` ("/pointer=value"): SweepReference::errors_of.
std::string errors_seen_by(const std::vector<std::string>& overrides) {
  const auto sets = [&](std::string_view part) {
    return std::any_of(overrides.begin(), overrides.end(),
                       [part](const std::string& o) { return o.starts_with(part); });
  };
  const bool time = sets("/analysis/"), space = sets("/beams/");
  return time && space ? "time and space" : time ? "time" : space ? "space" : "solver";
}
}  // namespace

GridReference make_reference(const io::StudySpec& spec, const ReferenceRuns& references, std::size_t grid_index) {
  const io::StudyGrid& grid = spec.grids[grid_index];
  const std::vector<double> times = io::sample_times(spec);
  GridReference r;
  const ReferenceRun* main = nullptr;
  const ReferenceRun* check = nullptr;
  double errors_in_difference = 1.0;
  std::string about, errors_of;
  if (const std::vector<std::size_t>& two = references.which[grid_index]; !two.empty()) {
    main = &references.runs[two[0]];
    check = &references.runs[two[1]];
    const io::StudyReference& asked = *computed_reference(spec, grid);
    about = asked.about;
    errors_of = errors_seen_by(asked.overrides);
    if (asked.order > 0.0) errors_in_difference = std::pow(asked.ratio, asked.order) - 1.0;
    r.told.is_cached = main->is_cached && check->is_cached;
    for (const ReferenceRun* run : {main, check})
      if (!run->run.ok() && r.told.trouble.empty())
        r.told.trouble = std::string(run == main ? "the reference" : "the check of the reference") +
                         " could not be computed: " + run->run.summary.cause;
  }
  for (const io::StudyQuantity& q : spec.quantities) {
    const bool computed = is_computed(grid, q);
    Samples values;
    double uncertainty = q.uncertainty;
    if (!computed)
      values = given_values(q, times);
    else if (r.told.trouble.empty())
      values = main->run.of(q.columns);
    const double scale = error_scale(q.kind, values);
    if (computed && r.told.trouble.empty())
      uncertainty = eval_errors(q.kind, check->run.of(q.columns), values, scale).max / errors_in_difference;
    r.told.kinds.emplace_back(computed ? "computed" : q.formula.empty() ? "table" : "formula");
    r.told.sources.push_back(computed ? about : q.source);
    r.told.errors_of.push_back(computed ? errors_of : "all");
    r.told.uncertainties.push_back(computed && !r.told.trouble.empty() ? unmeasured : uncertainty);
    r.told.scales.push_back(scale);
    r.values.push_back(std::move(values));
  }
  return r;
}

}  // namespace bough::study
