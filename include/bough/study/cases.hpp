#pragma once
/// The cases of a sweep: what each changes in its scene.
#include <string>
#include <vector>

#include "bough/io/sweep_spec.hpp"
#include "bough/study/batch.hpp"

namespace bough::study {

struct SweepCase {
  std::string name;                    ///< its number in all combinations, from 1, with leading zeros
  std::vector<io::SweepValue> inputs;  ///< by variable
};

struct SweepCases {
  std::vector<std::string> variables;  ///< of all designs, in their order
  std::vector<SweepCase> cases;
  std::size_t left_out = 0;  ///< by conditions
};

/// All cases in order. What is drawn has 12 significant digits, is a function of the seed, the place of its variable
/// and the row, and is the same whichever cases are made before. Throws std::runtime_error above
/// io::most_sweep_cases.
SweepCases make_cases(const io::SweepSpec& spec);

/// "/pointer=value" for all that a case changes.
std::vector<std::string> overrides_of(const io::SweepSpec& spec, const SweepCase& which);

/// How much what varies decides each measure: of a sweep with one design that draws, no other. Cases that conditions
/// left out, or that failed, have no value.
std::vector<MeasureSensitivity> sensitivities_of(const io::SweepSpec& spec, const std::vector<CaseResult>& results);

/// The rows of one design, each with a value a variable. number: of the design in its sweep, from 0.
std::vector<std::vector<io::SweepValue>> rows_of(const io::SweepDesign& design, std::uint32_t number);

/// In the unit cube, by row and variable: what designs that draw put through the quantiles of their distributions.
std::vector<std::vector<double>> unit_rows_of(const io::SweepDesign& design, std::uint32_t number);

}  // namespace bough::study
