#pragma once
/// Studies of error against run time: one scene over grids of choices, compared with references and timed in turns.
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bough/io/study_spec.hpp"
#include "bough/records/run.hpp"

namespace bough::study {

inline constexpr double unmeasured = std::numeric_limits<double>::quiet_NaN();

/// Norms of the error of one quantity over the sample times: the largest, the root mean square, and the error at the
/// end. Relative to the largest norm of the reference [-]; rotations in [rad]. NaN: not measured.
struct ErrorNorms {
  double max = unmeasured, rms = unmeasured, end = unmeasured;
};

/// Median and range of repeated measurements [s].
struct Spread {
  double median = unmeasured, low = unmeasured, high = unmeasured;
};
Spread spread_of(std::vector<double> values);

/// One combination of choices, or a pair: a run extrapolated with that of twice its step.
struct SweepRun {
  std::size_t grid = 0;
  std::vector<std::size_t> choices;  ///< one of each axis of the grid
  std::string label;                 ///< "integrator variational, step size 1e-3"
  double abscissa = 0.0;
  records::RunStatus status = records::RunStatus::failed;
  std::string cause;               ///< why it failed
  std::vector<ErrorNorms> errors;  ///< by quantity
  std::size_t num_samples = 0;     ///< number of sample times that the run reached
  records::StepCounts steps;
  std::vector<std::pair<std::string, double>> solver;  ///< figures of the solver, as in its summary
  double figure(const std::string& name) const;        ///< one of them; NaN: there is none of this name
  std::optional<double>
      instructions;  ///< of one run, in user space; none: the machine does not count them, or the run has several
                     ///< threads
  std::vector<double> wall, cpu;  ///< of the repetitions, in the order of the rounds [s]; without plan, tree and output
  std::vector<double> final_values;  ///< of all sensors
  bool is_repeatable = true;         ///< all repetitions ended with the same bits
  /// A pair: the runs of its step and of twice its step. Times, instructions and steps are then sums of both.
  std::optional<std::pair<std::size_t, std::size_t>> pair;
  /// A pair: by quantity, the error of its first run as both tell it, over the true one; NaN: not measured.
  std::vector<double> told_over_true;
};

enum class Verdict {
  not_stated,    ///< theory says nothing
  not_measured,  ///< fewer than two errors, or the reference is not accurate enough
  holds,         ///< within 0.1
  explained,     ///< above, and the study says why
  above,         ///< above, and it does not
  below,
};
const char* text_of(Verdict verdict);

/// The largest difference of an order found from that of theory.
inline constexpr double order_tolerance = 0.1;
/// Largest change of a measured order that the error of the reference may cause.
inline constexpr double largest_doubt = 0.05;
/// Number of consecutive errors to which an order is fitted: the finest ones for which the reference is accurate
/// enough.
inline constexpr std::size_t fitted_points = 3;

struct OrderFit {
  double order = unmeasured;      ///< slope of log error over log step, least squares
  std::vector<std::size_t> runs;  ///< runs in the fit
  double expected = unmeasured;
  std::string theory, explanation;
  Verdict verdict = Verdict::not_stated;
};

/// Runs that differ along the abscissa only, from coarse to fine.
struct SweepSeries {
  std::size_t grid = 0;
  std::string label;  ///< its choices along the other axes; the grid's name where there are none
  std::vector<std::size_t> runs;
  std::vector<OrderFit> fits;  ///< by quantity
};

/// The reference with which the runs of one grid are compared.
struct SweepReference {
  std::vector<std::string> kinds;    ///< by quantity: "formula", "table", "computed"
  std::vector<std::string> sources;  ///< by quantity, in words
  /// By quantity, the parts of the error that the comparison shows: "all" (formula, table), or only those in which the
  /// computed reference differs: "time" (steps, integrator), "space" (meshes), "time and space", "solver".
  std::vector<std::string> errors_of;
  std::vector<double> uncertainties;  ///< by quantity, in units of its error
  std::vector<double> scales;         ///< by quantity: largest norm, in its unit
  std::string trouble;                ///< why there is no reference
  bool is_cached = false;             ///< it was read from the cache
};

/// The fastest choice that meets an error bound, among runs whose errors have the same parts.
struct SweepAdvice {
  std::size_t quantity = 0;
  std::string errors_of;  ///< as in SweepReference::errors_of
  double wanted = 0.0;
  std::optional<std::size_t> run;  ///< none: no run meets the bound
};

struct SweepMachine {
  std::string processor, system;
  std::string instruction_set;  ///< of the library that ran
  int cores = 0;
};

struct SweepResult {
  io::StudySpec spec;
  int threads = 1, repetitions = 0;
  SweepMachine machine;
  std::string date;                        ///< UTC
  std::vector<SweepReference> references;  ///< by grid
  std::vector<SweepRun> runs;
  std::vector<SweepSeries> series;
  std::vector<SweepAdvice> advice;
  bool was_stopped = false;

  std::size_t num_runs() const;                   ///< without pairs
  std::size_t num_failed() const;                 ///< runs
  std::size_t num_orders(Verdict verdict) const;  ///< fits with this verdict
};

struct SweepOptions {
  int threads = 1;                   ///< runs at a time while errors are measured; timed runs are run one by one
  std::filesystem::path cache = {};  ///< folder of computed references; empty: none are kept
  int repetitions = 0;               ///< timed runs of every choice; 0: as the study specifies
  double memory_limit = std::numeric_limits<double>::infinity();  ///< of all runs side by side [bytes], see refusal()
  std::function<bool()> stop = {};
  std::function<void(const std::string& what, std::size_t done, std::size_t all)> progress = {};
};

/// Empty if no run of the study, including references that are not in the cache, needs more than its share of
/// `memory_limit`: the limit divided by the number of runs side by side. Otherwise describes the largest such run by
/// its choices and grid, how many more there are, the amounts and what to do. Allocates only scenes, one at a time.
/// Precondition: the study was read without problems.
std::string refusal(const io::StudySpec& spec, const SweepOptions& options);

/// Runs a study. Precondition: it was read without problems. A run that fails is kept with its cause. If a reference
/// cannot be computed, the errors of its grid are not measured. Throws std::runtime_error where the cache cannot be
/// written.
SweepResult run_sweep(const io::StudySpec& spec, const SweepOptions& options);

/// One row for each run and quantity.
std::string sweep_csv(const SweepResult& result);
std::string sweep_json(const SweepResult& result);

}  // namespace bough::study
