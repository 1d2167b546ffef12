#pragma once
/// Scenes for tests: from the gallery or from a text, run in memory, and tables to compare with.
#include <functional>
#include <string>
#include <vector>

#include "bough/run/simulate.hpp"

namespace bough::support {

/// A scene of data/scenarios by its stem, with overrides "/pointer=value". Throws std::runtime_error with all its
/// problems.
scene::Scene gallery(const std::string& stem, const std::vector<std::string>& overrides = {});

/// A scene from JSON text; "schema_version" is added. Throws as above.
scene::Scene scene_of(const std::string& json, const std::vector<std::string>& overrides = {});

/// Sensors to add to a scene.
scene::Sensor point_sensor(const std::string& name, scene::SensorKind kind, const scene::Attachment& at,
                           scene::LoadAxes axes = scene::LoadAxes::space);
scene::Sensor joint_sensor(const std::string& name, scene::SensorKind kind, const std::string& joint);

/// A number with all its digits, for texts.
std::string text(double value);

/// Rows over time. Columns are found by name; an unknown name throws.
struct Table {
  std::vector<std::string> columns;
  std::vector<double> times;
  std::vector<double> step_sizes;  ///< size of the step that ended at each row; of runs only
  std::vector<std::vector<double>> rows;

  std::size_t column(const std::string& name) const;
  std::vector<double> of(const std::string& name) const;
  double last(const std::string& name) const { return rows.back()[column(name)]; }
  double first(const std::string& name) const { return rows.front()[column(name)]; }
  /// Row at a time that is in the table (within 1e-9 s); throws if there is none.
  std::size_t row_at(double time) const;
  double at(const std::string& name, double time) const { return rows[row_at(time)][column(name)]; }
  double largest(const std::string& name) const;  ///< largest magnitude
};

/// A table of data/reference; its first column is the time.
Table reference(const std::string& file);

struct Outcome {
  records::Summary summary;
  Table history;
  bool ok() const { return summary.status == records::RunStatus::ok; }
};

/// The whole scene in another place: positions, ground, gravity, dead loads and velocities rotated and translated by
/// `to`. Only for scenes without fixed frames and prescribed motions.
scene::Scene moved(scene::Scene scene, const scene::Frame& to);

/// Expects LAPACK's ratio of linear solutions, |r| / (|A| |x| n u), to be at most 30.
void expect_sound_solutions(double backward_error, double unknowns);

/// Runs a scene in memory on one thread, and expects small residuals of the linear solutions (expect_sound_solutions).
/// Does not throw if the run fails: see ok() and summary.cause.
Outcome run(const scene::Scene& scene, const run::ProgressCallback& progress = {});
/// The same, and expects that the run ends well.
Outcome run_ok(const scene::Scene& scene);

/// Order p from errors at step sizes h and h / ratio: e = C h^p.
double order_of(double coarse_error, double fine_error, double ratio = 2.0);

/// Value at h -> 0 from values at h and h / 2 whose error is C h^2.
inline double extrapolate(double coarse, double fine) { return fine + (fine - coarse) / 3.0; }

/// Largest |a - b| of one column each over the rows of `reference` whose times `a` has as well.
double largest_difference(const Table& a, const std::string& column_a, const Table& reference,
                          const std::string& column_b);

}  // namespace bough::support
