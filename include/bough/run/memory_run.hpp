#pragma once
/// A run whose results are kept in memory, for programs that compare runs instead of writing them.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

struct SimulateOptions;
using ProgressCallback = std::function<bool(const records::Progress&)>;

/// The records of a run, without pictures of the motion.
struct MemoryRun {
  records::HistoryHeader header;
  std::vector<records::HistoryRow> rows;
  records::Summary summary;

  bool ok() const { return summary.status == records::RunStatus::ok; }
  /// Index of the column "<sensor>.<component>" or "<sensor>"; throws std::out_of_range if there is none.
  std::size_t column(std::string_view name) const;
  double final(std::string_view name) const { return summary.final_values.at(column(name)); }
  std::vector<double> series(std::string_view name) const;
  double largest(std::string_view name) const;  ///< largest magnitude over all rows
  /// Whether a note or the cause contains the text.
  bool says(std::string_view text) const;
  std::string text() const;  ///< cause and notes, for messages
};

/// The problems of a scene by problems_in, without warnings, in one line; empty if there are none.
std::string refusal_of(const scene::Scene& scene);

/// Runs a scene as simulate() does. A scene with problems is not run: its status is failed, and the cause starts with
/// "refused: ".
MemoryRun run_in_memory(const scene::Scene& scene, int threads = 1);
MemoryRun run_in_memory(const scene::Scene& scene, const SimulateOptions& options,
                        const ProgressCallback& progress = {});

}  // namespace bough::run
