#pragma once
/// Error against run time: one scene over grids of choices, compared with references, timed in turns.
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/study_spec.hpp"
#include "bough/records/run.hpp"

namespace bough::study {

inline constexpr double unmeasured = std::numeric_limits<double>::quiet_NaN();

/// Error of one quantity over the sample times: the largest, the root of the mean square, that at the end. Relative
/// to the largest norm of the reference [-]; rotations: [rad]. NaN: not measured.
struct ErrorNorms {
  double max = unmeasured, rms = unmeasured, end = unmeasured;
};

/// Median and range of repeated measurements [s].
struct Spread {
  double median = unmeasured, low = unmeasured, high = unmeasured;
};
Spread spread_of(std::vector<double> values);

/// One combination of choices.
struct SweepRun {
  std::size_t grid = 0;
  std::vector<std::size_t> choices;  ///< one of each axis of the grid
  std::string label;                 ///< "integrator variational, step size 1e-3"
  double abscissa = 0.0;
  records::RunStatus status = records::RunStatus::failed;
  std::string cause;               ///< why it failed
  std::vector<ErrorNorms> errors;  ///< by quantity
  std::size_t num_samples = 0;     ///< sample times that the run came to
  records::StepCounts steps;
  double flops_per_factorization = 0.0;
  std::optional<double>
      instructions;               ///< of one run, in user space; none: the machine does not tell, or several threads
  std::vector<double> wall, cpu;  ///< of the repetitions, in the order of the rounds [s]; without plan, tree and output
  std::vector<double> final_values;  ///< of all sensors
  bool is_repeatable = true;         ///< all repetitions ended with the same bits
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
/// The reference's own error may change an order found by this much.
inline constexpr double largest_doubt = 0.05;
/// Orders are fitted to this many errors in a row, the finest that the reference is accurate enough for.
inline constexpr std::size_t fitted_points = 3;

struct OrderFit {
  double order = unmeasured;      ///< slope of log error over log step, least squares
  std::vector<std::size_t> runs;  ///< that it is fitted to
  double expected = unmeasured;
  std::string theory, explanation;
  Verdict verdict = Verdict::not_stated;
};

/// Runs that differ along the abscissa alone, from coarse to fine.
struct SweepSeries {
  std::size_t grid = 0;
  std::string label;  ///< its choices along the other axes; the grid's name where there are none
  std::vector<std::size_t> runs;
  std::vector<OrderFit> fits;  ///< by quantity
};

/// What runs of one grid are compared with.
struct SweepReference {
  std::vector<std::string> kinds;    ///< by quantity: "formula", "table", "computed"
  std::vector<std::string> sources;  ///< by quantity, in words
  /// By quantity, what an error holds: "all" of a run (formula, table), or only what the computed reference does
  /// otherwise: "time" (steps, integrator), "space" (meshes), "time and space", "solver".
  std::vector<std::string> errors_of;
  std::vector<double> uncertainties;  ///< by quantity, in units of its error
  std::vector<double> scales;         ///< by quantity: largest norm, in its unit
  std::string trouble;                ///< why there is none
  bool is_cached = false;             ///< was there from before
};

/// The quickest choice that keeps an error, among runs whose errors hold the same.
struct SweepAdvice {
  std::size_t quantity = 0;
  std::string errors_of;  ///< as SweepReference has it
  double wanted = 0.0;
  std::optional<std::size_t> run;  ///< none: no run keeps it
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

  std::size_t num_failed() const;                 ///< runs
  std::size_t num_orders(Verdict verdict) const;  ///< fits with this verdict
};

struct SweepOptions {
  int threads = 1;                   ///< runs at a time while errors are measured; timed runs go one at a time
  std::filesystem::path cache = {};  ///< folder of computed references; empty: none are kept
  int repetitions = 0;               ///< timed runs of every choice; 0: as the study says
  double memory_limit = std::numeric_limits<double>::infinity();  ///< of all runs side by side [bytes], see refusal()
  std::function<bool()> stop = {};
  std::function<void(const std::string& what, std::size_t done, std::size_t all)> progress = {};
};

/// Empty where no run of the study, references that are not in the cache included, would take more than its share of
/// `memory_limit`: all of it, over the runs that go side by side. Otherwise the largest such run by its choices and
/// grid, how many more there are, the numbers and what to do, in words. Allocates nothing but scenes, one at a time.
/// Precondition: the study was read without problems.
std::string refusal(const io::StudySpec& spec, const SweepOptions& options);

/// Precondition: the study was read without problems. A run that fails is kept with its cause; a reference that
/// cannot be computed leaves the errors of its grid unmeasured. Throws std::runtime_error where the cache cannot be
/// written.
SweepResult run_sweep(const io::StudySpec& spec, const SweepOptions& options);

/// One row a run and quantity.
std::string sweep_csv(const SweepResult& result);
std::string sweep_json(const SweepResult& result);

}  // namespace bough::study
