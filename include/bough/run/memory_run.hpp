#pragma once
/// A run kept in memory, for whoever compares runs instead of writing them.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

struct SimulateOptions;
using ProgressCallback = std::function<bool(const records::Progress&)>;

/// A run as its recorder saw it; pictures of the motion are not kept.
struct MemoryRun {
  records::HistoryHeader header;
  std::vector<records::HistoryRow> rows;
  records::Summary summary;

  bool ok() const { return summary.status == records::RunStatus::ok; }
  /// Column of a name "<sensor>.<component>" or "<sensor>"; throws std::out_of_range where there is none.
  std::size_t column(std::string_view name) const;
  double final(std::string_view name) const { return summary.final_values.at(column(name)); }
  std::vector<double> series(std::string_view name) const;
  double largest(std::string_view name) const;  ///< magnitude over all rows
  /// Whether some note or the cause holds the text.
  bool says(std::string_view text) const;
  std::string text() const;  ///< cause and notes, for messages
};

/// What problems_in has against a scene, warnings left out, in one line; empty when nothing.
std::string refusal_of(const scene::Scene& scene);

/// Runs a scene, as simulate() does. One with problems does not run: it is failed, and the cause starts with
/// "refused: ".
MemoryRun run_in_memory(const scene::Scene& scene, int threads = 1);
MemoryRun run_in_memory(const scene::Scene& scene, const SimulateOptions& options,
                        const ProgressCallback& progress = {});

}  // namespace bough::run
