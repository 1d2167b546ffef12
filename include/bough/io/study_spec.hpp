#pragma once
/// A study: one scene over grids of choices, and the references with which its results are compared.
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "bough/laws/law.hpp"

namespace bough::io {

/// One value of an axis, and its changes of the scene.
struct StudyChoice {
  std::string label;                                         ///< as written in the file
  double number = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not a number
  std::vector<std::string> overrides;                        ///< "/pointer=value"
  int threads = 0;                                           ///< of the run; 0: not chosen by this axis
  std::string at;                                            ///< JSON pointer in the spec
};

struct StudyAxis {
  std::string name;
  std::vector<StudyChoice> choices;
  bool larger_is_finer = false;  ///< counts (elements, load steps): errors fall as the number grows
};

/// The theoretical order of convergence of one quantity over a grid's abscissa.
struct StudyOrder {
  std::size_t quantity = 0;
  double order = 0.0;
  std::string theory;       ///< where it comes from
  std::string explanation;  ///< why the measured order is above the theoretical one; empty: it should not be
};

/// A computed reference: its settings, and those of the run from which its error is estimated.
struct StudyReference {
  std::vector<std::string> overrides, check_overrides;
  /// Order p > 0: the check takes `ratio` times the step of a method of order p, and the difference is (ratio^p - 1)
  /// errors. 0: the difference is taken whole.
  double order = 0.0, ratio = 2.0;
  std::string about;
  std::string at;  ///< JSON pointer in the spec
};

/// All combinations of the choices of its axes.
struct StudyGrid {
  std::string name;
  std::vector<std::string> overrides;
  std::vector<StudyAxis> axes;
  std::size_t abscissa = 0;  ///< axis over which errors converge
  std::vector<StudyOrder> orders;
  bool has_reference = false;  ///< a reference of its own, instead of formulas and tables
  StudyReference reference;
};

enum class QuantityKind {
  vector,      ///< error: Euclidean norm of the difference over the largest norm of the reference
  rotation,    ///< error: |log(R_ref^T R)| [rad]; columns are a rotation vector
  quaternion,  ///< the same; columns are a quaternion, scalar first
};

/// One quantity whose error is measured.
struct StudyQuantity {
  std::string name, unit;
  QuantityKind kind = QuantityKind::vector;
  std::vector<std::size_t> columns;             ///< of the history
  std::vector<laws::Law> formula;               ///< closed form, one law a column; or
  std::vector<double> table_times;              ///< a table that was published or made elsewhere
  std::vector<std::vector<double>> table_rows;  ///< rotations: 3 numbers (rotation vector) or 4 (quaternion)
  std::string source;                           ///< of the formula or table
  double uncertainty = 0.0;                     ///< of the formula or table, in units of the error
  bool is_compared() const { return !formula.empty() || !table_times.empty(); }
};

/// A study. Every run reads the scene with the overrides of the study, of the grid and of the choices, in this order.
struct StudySpec {
  std::string name, title;
  std::string scene_name, scene_text;
  std::filesystem::path scene_folder;  ///< of files that the scene names
  std::vector<std::string> overrides;  ///< sensors, figures and output among them
  std::vector<StudyQuantity> quantities;
  double sample_interval = 0.0;  ///< [s] (statics: of the load factor); 0: errors at the end only
  bool is_dynamic = true;
  double end = 0.0;  ///< of all runs [s]; statics: 1
  int repetitions = 3;
  double time_limit = 0.0;           ///< of a run [s]
  std::vector<std::string> figures;  ///< of the solver, drawn over the abscissa of each grid
  std::vector<double> wanted;        ///< errors for which a choice is recommended
  bool has_reference = false;
  StudyReference reference;  ///< of grids that have none, for quantities without formula or table
  std::vector<StudyGrid> grids;
};

/// Times at which errors are measured: 0 and the multiples of the interval to the end, or the end alone.
std::vector<double> sample_times(const StudySpec& spec);

/// Overrides of the run that takes choice c[a] of axis a of a grid.
std::vector<std::string> overrides_of(const StudySpec& spec, const StudyGrid& grid, const std::vector<std::size_t>& c);
/// Overrides of a reference, given its own settings.
std::vector<std::string> overrides_of(const StudySpec& spec, const StudyGrid& grid,
                                      const std::vector<std::string>& settings);

/// The combinations of a grid, the last axis running fastest.
std::vector<std::vector<std::size_t>> combinations_of(const StudyGrid& grid);

}  // namespace bough::io
