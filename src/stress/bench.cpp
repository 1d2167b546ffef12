#include "bench.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/simulate.hpp"

namespace bough::stress {

namespace {
constexpr double unit_round_off = 0x1p-53;

double solver_figure(const records::Summary& summary, const std::string& name) {
  for (const auto& [key, value] : summary.solver)
    if (key == name) return value;
  return 0.0;
}
}  // namespace

run::MemoryRun Bench::try_run(const scene::Scene& scene) {
  scene::Scene in_space =
      scene;  // the planar decision would remove the redundant rows and soft directions that are tested
  in_space.without.insert(in_space.without.end(), {"line", "translation", "planar"});
  require_memory(in_space);
  run::MemoryRun run =
      run::run_in_memory(in_space, {}, [&](const records::Progress&) { return !is_stopped_ || !is_stopped_(); });
  if (run.summary.status == records::RunStatus::interrupted) throw std::runtime_error(run.summary.cause);
  const records::Summary& s = run.summary;
  ++result_.runs;
  result_.steps += s.steps.accepted;
  result_.rejected += s.steps.rejected;
  result_.iterations += s.steps.newton_iterations;
  result_.factorizations += s.steps.factorizations;
  result_.constraint_violation = std::max(result_.constraint_violation, s.checks.constraint_violation_position);
  condition(solver_figure(s, "condition_estimate"));
  // If the run ended early, a singular matrix may have been the reason, which is then reported instead.
  if (const double n = solver_figure(s, "unknowns"); n > 0.0 && run.ok())
    backward_error(s.checks.linear_backward_error_max, n);
  result_.rank_error = std::max(result_.rank_error, s.checks.linear_rank_error_max);
  return run;
}

void Bench::require_memory(const scene::Scene& scene) const {
  if (const std::string why = run::refusal(scene, memory_limit_); !why.empty()) throw std::runtime_error(why);
}

run::MemoryRun Bench::run(const scene::Scene& scene, const std::string& what) {
  run::MemoryRun done = try_run(scene);
  if (!done.ok()) throw std::runtime_error((what.empty() ? "" : what + ": ") + done.summary.cause);
  return done;
}

void Bench::error(const std::string& name, double value, double limit) {
  figure(name, value, limit);
  if (!(value <= result_.largest_error)) result_.largest_error = value;  // NaN is kept
}

void Bench::round_off_error(const std::string& name, double value, double limit) {
  error(name, value, limit);
  if (value > unit_round_off) result_.digits_lost = std::max(result_.digits_lost, std::log10(value / unit_round_off));
}

void Bench::figure(const std::string& name, double value, double limit) {
  result_.figures.push_back({name, value, limit});
}

void Bench::condition(double value) { result_.condition = std::max(result_.condition, value); }

void Bench::backward_error(double value, double unknowns) {
  result_.backward_error = std::max(result_.backward_error, value);
  // |b| <= |A| |x| + |r|, so |r| / (|A| |x|) is at most 2 eta / (1 - eta): the ratio is an upper bound.
  result_.lapack_ratio = std::max(result_.lapack_ratio, 2.0 * value / (1.0 - value) / (unknowns * unit_round_off));
}

void Bench::expect_refusal(const scene::Scene& scene, const std::vector<std::string>& words) {
  const run::MemoryRun run = try_run(scene);
  result_.refusal = run.summary.cause;
  if (run.ok()) throw std::runtime_error("it ran to its end and should have been refused");
  for (const std::string& word : words)
    if (run.summary.cause.find(word) == std::string::npos)
      throw std::runtime_error("the refusal does not name " + word + ": " + run.summary.cause);
}

std::size_t ReferenceTable::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) throw std::out_of_range("no column " + name);
  return static_cast<std::size_t>(found - columns.begin());
}

ReferenceTable reference_table(const std::string& file) {
  std::istringstream in(data_file("reference/" + file));
  const auto split = [](const std::string& line) {
    std::vector<std::string> parts;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) parts.push_back(cell);
    return parts;
  };
  ReferenceTable table;
  std::string line;
  std::getline(in, line);
  table.columns = split(line);
  table.columns.erase(table.columns.begin());
  while (std::getline(in, line)) {
    std::vector<double> values;
    for (const std::string& cell : split(line)) {
      double value = 0.0;
      if (!io::read_number(cell, value)) throw std::runtime_error(file + ": '" + cell + "' is not a number");
      values.push_back(value);
    }
    table.times.push_back(values.front());
    table.rows.emplace_back(values.begin() + 1, values.end());
  }
  return table;
}

scene::Scene gallery_scene(const std::string& stem) {
  io::SceneFile file = io::read_scene_text(data_file("scenarios/" + stem + ".json"), stem);
  if (!file.ok()) throw std::runtime_error(stem + ": " + file.problems.front().text());
  file.scene.expected.clear();
  return std::move(file.scene);
}

double value_at(const run::MemoryRun& run, const std::string& column, double time) {
  const std::size_t c = run.column(column);
  const auto next = std::lower_bound(run.rows.begin(), run.rows.end(), time,
                                     [](const records::HistoryRow& row, double t) { return row.time < t - 1e-9; });
  if (next == run.rows.end() || std::abs(next->time - time) > 1e-9)
    throw std::runtime_error("the run has no row at " + io::rounded_text(time, 9));
  return next->values[c];
}

}  // namespace bough::stress
