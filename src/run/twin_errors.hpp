#pragma once
#include <vector>

#include "member_series.hpp"
#include "twin_scenes.hpp"

namespace bough::run {

/// A twin as it ran.
struct TwinRun {
  bool is_of_mesh = false;
  double factor = 1.0;
  MemberSeries series;
  records::Summary summary;
  double seconds = 0.0;
};

/// A run and its twins, at its end.
struct RunWithTwins {
  const scene::Scene& scene;
  const records::Summary& summary;
  MemberSeries series;                    ///< at the times at which twins are compared
  std::vector<records::HistoryRow> rows;  ///< of the history
  std::vector<TwinRun> twins;
  std::vector<std::string> remarks;
  double size = 0.0;  ///< of the structure [m]
};

/// What the twins tell. Precondition: the run is ok.
records::MeasuredErrors measure_errors(RunWithTwins run);

}  // namespace bough::run
