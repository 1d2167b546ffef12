#pragma once
/// One run of a study: sampled for its errors, or timed.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/history.hpp"
#include "bough/io/study_spec.hpp"
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::study {

struct RunLimits {
  double time_limit = 0.0;  ///< wall time [s]; 0: none
  const std::function<bool()>* stop = nullptr;
};

/// A run with the values of its sensors at the sample times, taken as SimulateOptions::stops describes.
struct SampledRun {
  records::Summary summary;
  io::History samples;               ///< one row for each sample time that the run reached
  std::vector<double> sample_times;  ///< all of them
  bool was_stopped = false;          ///< by RunLimits::stop
  bool ok() const { return summary.status == records::RunStatus::ok; }

  /// Columns at every sample time, empty where there is no row.
  std::vector<std::vector<double>> of(const std::vector<std::size_t>& columns) const;
};

/// Precondition: the overrides lead to a valid scene.
scene::Scene study_scene(const io::StudySpec& spec, const std::vector<std::string>& overrides);

SampledRun run_sampled(scene::Scene scene, const std::vector<double>& sample_times, int threads,
                       const RunLimits& limits);

struct TimedRun {
  double wall = 0.0, cpu = 0.0;  ///< of the steps, without plan and tree [s]
  std::optional<double> instructions;
  records::Summary summary;
  bool was_stopped = false;
};

/// Without rows, checks and pictures; the steps are those of a sampled run.
TimedRun run_timed(scene::Scene scene, const std::vector<double>& sample_times, int threads, const RunLimits& limits,
                   bool count_instructions);

}  // namespace bough::study
