#pragma once
/// The interface with which the cases of the stress table are written: it runs scenes and records figures.
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "bough/run/memory_run.hpp"
#include "bough/stress/stress.hpp"

namespace bough::stress {

using scene::Vec3;

/// Receives the figures that a case measures.
class Bench {
 public:
  /// is_stopped is asked after every step of a run; memory_limit is that of one run [bytes].
  Bench(StressCase& result, bool is_quick, std::function<bool()> is_stopped = {},
        double memory_limit = std::numeric_limits<double>::infinity())
      : result_(result), is_quick_(is_quick), is_stopped_(std::move(is_stopped)), memory_limit_(memory_limit) {}

  bool is_quick() const { return is_quick_; }
  /// Returns `whole`, or `part` of it in a quick table, which is then marked as shortened.
  template <class T>
  T shorten(T whole, T part) {
    if (is_quick_) result_.is_shortened = true;
    return is_quick_ ? part : whole;
  }

  /// Runs a scene and accumulates its work, backward errors and violations. If the run ends early, the case has failed.
  run::MemoryRun run(const scene::Scene& scene, const std::string& what = {});
  /// As run(), for a run that may end early.
  run::MemoryRun try_run(const scene::Scene& scene);

  /// Ends the case as failed, with the amounts, if a run of the scene would need more memory than is available. All
  /// runs of the bench do this by themselves.
  void require_memory(const scene::Scene& scene) const;

  /// An error relative to a reference, promised to be at most `limit` [-].
  void error(const std::string& name, double value, double limit);
  /// An error caused by round-off alone; the digits lost are recorded as well.
  void round_off_error(const std::string& name, double value, double limit);
  /// Any other number that is promised to be at most `limit`.
  void figure(const std::string& name, double value, double limit);
  /// A number without a promise.
  void tell(const std::string& name, double value) { figure(name, value, std::numeric_limits<double>::infinity()); }
  /// A condition number of a matrix that was solved with, in scaled variables.
  void condition(double value);
  /// A normwise backward error of a solution with n unknowns.
  void backward_error(double value, double unknowns);
  /// Adds words to the report of the figures.
  void say(const std::string& text) { result_.measured += (result_.measured.empty() ? "" : "; ") + text; }
  /// Expects a run to be refused: its cause, or the problems of its scene, must contain all `words`.
  void expect_refusal(const scene::Scene& scene, const std::vector<std::string>& words);

 private:
  StressCase& result_;
  bool is_quick_;
  std::function<bool()> is_stopped_;
  double memory_limit_;
};

/// One row of the table.
struct Definition {
  const char* name;
  const char* family;
  const char* promise;
  void (*body)(Bench&);
  StressStatus expected = StressStatus::holds;
  const char* reason = "";  ///< of an expected failure
  bool is_long = false;     ///< started before the others, so that it does not run alone at the end
};

/// Rows of the table, by file; `table.cpp` collects them.
void add_slenderness(std::vector<Definition>& table);
void add_ratios(std::vector<Definition>& table);
void add_units(std::vector<Definition>& table);
void add_steps(std::vector<Definition>& table);
void add_penalty(std::vector<Definition>& table);
void add_constraints(std::vector<Definition>& table);
void add_buckling(std::vector<Definition>& table);
void add_sizes(std::vector<Definition>& table);
void add_stiff(std::vector<Definition>& table);
void add_spin(std::vector<Definition>& table);
void add_gravity(std::vector<Definition>& table);
void add_long(std::vector<Definition>& table);

/// Text of a file of data/ that is compiled in: "scenarios/andrews_squeezer.json". Throws std::out_of_range.
const std::string& data_file(const std::string& name);

/// A table of data/reference: time and columns by name.
struct ReferenceTable {
  std::vector<std::string> columns;
  std::vector<double> times;
  std::vector<std::vector<double>> rows;  ///< without the time
  std::size_t column(const std::string& name) const;
};
ReferenceTable reference_table(const std::string& file);

/// A scene of the gallery that is compiled in, without expected figures.
scene::Scene gallery_scene(const std::string& stem);

/// Value of a run's column at a time that is in the history, within 1e-9 of the step.
double value_at(const run::MemoryRun& run, const std::string& column, double time);

}  // namespace bough::stress
