#include "bough/run/memory_run.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bough/run/simulate.hpp"
#include "bough/scene/problems.hpp"

namespace bough::run {

namespace {

struct Memory final : records::Recorder {
  MemoryRun& out;
  explicit Memory(MemoryRun& o) : out(o) {}
  void begin(const records::HistoryHeader& header) override { out.header = header; }
  void row(const records::HistoryRow& row) override { out.rows.push_back(row); }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary& summary) override { out.summary = summary; }
};

}  // namespace

std::size_t MemoryRun::column(std::string_view name) const {
  const auto found = std::find(header.columns.begin(), header.columns.end(), name);
  if (found == header.columns.end()) throw std::out_of_range("no column " + std::string(name));
  return static_cast<std::size_t>(found - header.columns.begin());
}

std::vector<double> MemoryRun::series(std::string_view name) const {
  const std::size_t c = column(name);
  std::vector<double> values;
  for (const records::HistoryRow& row : rows) values.push_back(row.values[c]);
  return values;
}

double MemoryRun::largest(std::string_view name) const {
  double most = 0.0;
  for (const double v : series(name)) most = std::max(most, std::abs(v));
  return most;
}

bool MemoryRun::says(std::string_view text) const {
  const auto holds = [text](const std::string& s) { return s.find(text) != std::string::npos; };
  return holds(summary.cause) || std::any_of(summary.notes.begin(), summary.notes.end(), holds);
}

std::string MemoryRun::text() const {
  std::string all = "cause: " + summary.cause;
  for (const std::string& n : summary.notes) all += "\nnote: " + n;
  return all;
}

std::string refusal_of(const scene::Scene& scene) {
  std::string refused;
  for (const scene::SceneProblem& p : scene::problems_in(scene))
    if (!p.is_warning)
      refused += " " + p.section + " " + std::to_string(p.index) + " " + p.key + " '" + p.value + "': " + p.rule;
  return refused;
}

MemoryRun run_in_memory(const scene::Scene& scene, const SimulateOptions& options, const ProgressCallback& progress) {
  MemoryRun out;
  const std::string refused = refusal_of(scene);
  if (!refused.empty()) {
    out.summary.cause = "refused:" + refused;
    return out;
  }
  Memory memory(out);
  simulate(scene, options, memory, progress);
  return out;
}

MemoryRun run_in_memory(const scene::Scene& scene, int threads) {
  return run_in_memory(scene, SimulateOptions{.threads = threads, .checks_estimate = true});
}

}  // namespace bough::run
