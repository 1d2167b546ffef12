#pragma once
/// The cases of a sweep, and the changes of the scene that define each.
#include <string>
#include <vector>

#include "bough/io/sweep_spec.hpp"
#include "bough/study/batch.hpp"

namespace bough::study {

struct SweepCase {
  std::string name;                    ///< its number among all combinations, from 1, with leading zeros
  std::vector<io::SweepValue> inputs;  ///< by variable
};

struct SweepCases {
  std::vector<std::string> variables;  ///< variables of all designs, in their order
  std::vector<SweepCase> cases;
  std::size_t left_out = 0;  ///< number of combinations that conditions excluded
};

/// Makes all cases in order. A random value has 12 significant digits. It depends only on the seed, the index of its
/// variable and the row, not on the cases made before. Throws std::runtime_error above io::most_sweep_cases.
SweepCases make_cases(const io::SweepSpec& spec);

/// "/pointer=value" for every value that the case changes.
std::vector<std::string> overrides_of(const io::SweepSpec& spec, const SweepCase& which);

/// Sensitivities of each measure to the varied inputs, for sweeps with a single design that draws at random. Cases that
/// conditions excluded, or that failed, have no value.
std::vector<MeasureSensitivity> sensitivities_of(const io::SweepSpec& spec, const std::vector<CaseResult>& results);

/// The rows of one design, with one value per variable. number: index of the design in its sweep, from 0.
std::vector<std::vector<io::SweepValue>> rows_of(const io::SweepDesign& design, std::uint32_t number);

/// Points of a random design in the unit cube, by row and variable, before the quantiles of the distributions are
/// applied.
std::vector<std::vector<double>> unit_rows_of(const io::SweepDesign& design, std::uint32_t number);

}  // namespace bough::study
