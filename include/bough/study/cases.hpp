#pragma once
/// The cases of a sweep, and the changes of the scene that define each.
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bough/io/sweep_spec.hpp"
#include "bough/study/case_table.hpp"
#include "bough/study/sensitivity.hpp"

namespace bough::study {

struct SweepCase {
  std::string name;                    ///< its number among all combinations, from 1, with leading zeros
  std::vector<io::SweepValue> inputs;  ///< by variable
};

/// The cases of a sweep, in a few bytes for each value.
class SweepCases {
 public:
  SweepCases() = default;
  explicit SweepCases(std::vector<std::string> variables) : variables_(std::move(variables)) {}
  [[nodiscard]] const std::vector<std::string>& variables() const { return variables_; }
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }
  /// Number of combinations that conditions excluded.
  [[nodiscard]] std::size_t left_out() const { return all_ - numbers_.size(); }
  [[nodiscard]] SweepCase at(std::size_t i) const { return {name(i), inputs(i)}; }
  [[nodiscard]] std::string name(std::size_t i) const;
  [[nodiscard]] std::vector<io::SweepValue> inputs(std::size_t i) const;
  /// The next combination: a case, or one that conditions exclude.
  void add(const std::vector<io::SweepValue>& inputs);
  void leave_out() { ++all_; }
  void set(std::size_t i, std::size_t variable, const io::SweepValue& value);

 private:
  /// A value whose text is that of its number with 12 digits, as drawn ones are, is the number alone (word 0); others
  /// are kept once.
  struct Cell {
    double number = 0.0;
    std::uint32_t word = 0;
  };
  Cell cell_of(const io::SweepValue& value);

  std::vector<std::string> variables_;
  std::size_t all_ = 0;                 ///< number of combinations
  std::vector<std::uint32_t> numbers_;  ///< of the cases among them
  std::vector<double> cells_;           ///< by case and variable
  std::vector<std::uint32_t> words_;    ///< of these; empty: all 0
  std::vector<io::SweepValue> values_;  ///< of word 1, 2, ...
  std::unordered_map<std::string, std::uint32_t> word_of_;
};

/// Makes all cases in order. A random value has 12 significant digits. It depends only on the seed, the index of its
/// variable and the row, not on the cases made before. Throws std::runtime_error above io::most_sweep_cases.
SweepCases make_cases(const io::SweepSpec& spec);

/// "/pointer=value" for every value that the case changes.
std::vector<std::string> overrides_of(const io::SweepSpec& spec, const SweepCase& which);

/// Sensitivities of each measure to the varied inputs, for sweeps with a single design that draws at random. Cases that
/// conditions excluded, or that failed, have no value.
std::vector<MeasureSensitivity> sensitivities_of(const io::SweepSpec& spec, const CaseTable& results);

/// Calls with each row of one design in turn, with one value per variable. number: index of the design in its sweep,
/// from 0.
void for_each_row(const io::SweepDesign& design, std::uint32_t number,
                  const std::function<void(const std::vector<io::SweepValue>&)>& call);

/// Points of a random design in the unit cube, by row and variable, before the quantiles of the distributions are
/// applied.
std::vector<std::vector<double>> unit_rows_of(const io::SweepDesign& design, std::uint32_t number);

}  // namespace bough::study
