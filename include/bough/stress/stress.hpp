#pragma once
/// The table of stiff and extreme cases: the promises made and the figures measured.
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace bough::stress {

enum class StressStatus {
  holds,    ///< every figure is within what is promised
  fails,    ///< a figure exceeds its limit, or a run ended early
  refused,  ///< the input cannot be computed and the refusal names the reason, as promised
};
const char* text_of(StressStatus status);

/// One measured number. It holds if value <= limit; with an infinite limit it is reported without a promise. NaN never
/// holds.
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
  std::string reason;  ///< why the case is expected to fail, if `expected` says so
  StressStatus status = StressStatus::fails;
  std::string measured;  ///< in words: the figures, or the cause
  std::string refusal;   ///< text of the refusal
  bool is_shortened = false;
  std::vector<StressFigure> figures;
  double seconds = 0.0;  ///< CPU seconds of the thread that ran it

  double largest_error = 0.0;  ///< largest of the figures that are errors relative to a reference [-]
  double digits_lost =
      0.0;  ///< log10(error / unit round-off) where round-off alone makes the error; else log10(condition)
  double condition = 0.0;             ///< largest estimate for a tangent in scaled variables [-]; 0: not estimated
  double backward_error = 0.0;        ///< largest normwise backward error of a linear solution [-]
  double lapack_ratio = 0.0;          ///< largest |r| / (|A| |x| n u) of a linear solution [-], see lapack_ratio_limit
  double rank_error = 0.0;            ///< largest error caused by treating constraint rows as dependent [-]
  double constraint_violation = 0.0;  ///< largest, [m] or [rad]
  long steps = 0, rejected = 0, iterations = 0, factorizations = 0, runs = 0;

  /// Whether the outcome is the one in the table. A case that is expected to fail but holds should be removed from the
  /// list of failures.
  bool is_as_expected() const { return status == expected; }
};

/// The bound used by LAPACK's own tests for the residual over norm, size and unit round-off.
inline constexpr double lapack_ratio_limit = 30.0;

struct StressOptions {
  bool quick = false;     ///< every family, with long runs shortened and marked
  int threads = 1;        ///< cases run side by side, each on one thread; figures do not depend on it
  std::string only = {};  ///< run only the case of this name, or the family of this name; empty: all
  /// Memory for all cases side by side [bytes]. A case with a scene whose run needs more than its share fails with the
  /// amounts, before memory is allocated for that run.
  double memory_limit = std::numeric_limits<double>::infinity();
};

/// What is wrong with the options; empty when nothing.
std::vector<std::string> problems_in(const StressOptions& options);

/// Names of all cases and families, in the order of the table.
std::vector<std::string> stress_names();

/// Runs the table. on_case is called as cases end, one at a time, from any thread. is_stopped is asked before each case
/// and after every step, from any thread; cases that it interrupts are omitted. An exception from a case is recorded as
/// its failure and not passed on. The results are in the order of the table.
std::vector<StressCase> run_stress(
    const StressOptions& options,
    const std::function<void(const StressCase&, std::size_t done, std::size_t all)>& on_case = {},
    const std::function<bool()>& is_stopped = {});

/// stress.json.
std::string stress_json(const std::vector<StressCase>& cases, const StressOptions& options, const std::string& version);

}  // namespace bough::stress
