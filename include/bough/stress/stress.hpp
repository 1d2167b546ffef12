#pragma once
/// The standing table of stiff and extreme cases: what is promised, what is measured.
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace bough::stress {

enum class StressStatus {
  holds,    ///< every figure is within what is promised
  fails,    ///< one is not, or a run broke off
  refused,  ///< the input cannot be computed and was refused by name: what such a case promises
};
const char* text_of(StressStatus status);

/// One number that was measured. It holds where value <= limit; a limit of infinity: told, nothing promised. NaN
/// never holds.
struct StressFigure {
  std::string name;
  double value = 0.0;
  double limit = 0.0;
  bool holds() const { return value <= limit; }
};

/// One case after its run.
struct StressCase {
  std::string name, family;
  std::string promise;  ///< in words
  StressStatus expected = StressStatus::holds;
  std::string reason;  ///< why it is listed as failing, where `expected` says so
  StressStatus status = StressStatus::fails;
  std::string measured;  ///< in words: the figures, or the cause
  std::string refusal;   ///< what the refusal said
  bool is_shortened = false;
  std::vector<StressFigure> figures;
  double seconds = 0.0;  ///< CPU seconds of the thread that ran it

  double largest_error = 0.0;  ///< of the figures that are errors relative to a reference [-]
  double digits_lost =
      0.0;  ///< log10(error / unit round-off) where round-off alone makes the error; else log10(condition)
  double condition = 0.0;             ///< largest estimate for a tangent in scaled variables [-]; 0: not estimated
  double backward_error = 0.0;        ///< largest normwise backward error of a linear solution [-]
  double lapack_ratio = 0.0;          ///< largest |r| / (|A| |x| n u) of a linear solution [-], see lapack_ratio_limit
  double rank_error = 0.0;            ///< largest, of what taking dependent rows for such has cost [-]
  double constraint_violation = 0.0;  ///< largest, [m] or [rad]
  long steps = 0, rejected = 0, iterations = 0, factorizations = 0, runs = 0;

  /// As the table expects. A case listed as failing may hold: then it should be listed no more.
  bool is_as_expected() const { return status == expected; }
};

/// The bound of LAPACK's own tests on residual over norm, size and unit round-off.
inline constexpr double lapack_ratio_limit = 30.0;

struct StressOptions {
  bool quick = false;     ///< every family, long runs shortened and marked
  int threads = 1;        ///< cases run side by side, each on one thread; figures do not depend on it
  std::string only = {};  ///< the one case of this name, or all of the family of this name; empty: all
  /// Of all cases side by side [bytes]. A case that comes to a scene whose run would take more than its share fails
  /// with the numbers, before anything is allocated for that run.
  double memory_limit = std::numeric_limits<double>::infinity();
};

/// What is wrong with the options; empty when nothing.
std::vector<std::string> problems_in(const StressOptions& options);

/// Names of all cases and families, in the order of the table.
std::vector<std::string> stress_names();

/// Runs the table. on_case is called as cases end, one at a time, from any thread; is_stopped is asked before each case
/// and after every step, from any thread; cases that it cuts short are left out. What a case throws is its failure,
/// never thrown on. The answer is in the order of the table.
std::vector<StressCase> run_stress(
    const StressOptions& options,
    const std::function<void(const StressCase&, std::size_t done, std::size_t all)>& on_case = {},
    const std::function<bool()>& is_stopped = {});

/// stress.json.
std::string stress_json(const std::vector<StressCase>& cases, const StressOptions& options, const std::string& version);

}  // namespace bough::stress
