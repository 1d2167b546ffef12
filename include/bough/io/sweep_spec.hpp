#pragma once
/// A sweep: variables of a scene, designs that give them values, and measures. Plain data, checked.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bough/laws/formula.hpp"

namespace bough::io {

/// A random number, or one of several.
struct SweepDistribution {
  enum class Kind : std::uint8_t { uniform, normal, lognormal, discrete };
  Kind kind = Kind::uniform;
  double low = 0.0, high = 1.0;        ///< uniform
  double mean = 0.0, deviation = 1.0;  ///< normal; lognormal: of the logarithm
  std::vector<double> values;          ///< discrete
  std::vector<double> weights;         ///< of these; empty: all the same
};

/// A value of the scene as JSON text, and its number where it is one.
struct SweepValue {
  std::string text;
  std::optional<double> number;
};

/// A varied input.
struct SweepVariable {
  std::string name;
  std::vector<std::string> pointers;  ///< into the scene, as of overrides: all take the same value
  std::vector<SweepValue> values;     ///< grid, one at a time: the values it takes; list, csv: by row
  std::optional<SweepValue> nominal;  ///< one at a time: while others vary
  SweepDistribution distribution;     ///< designs that draw
};

enum class SweepDesignKind : std::uint8_t {
  list,
  csv,
  grid,
  one_at_a_time,
  random,
  latin_hypercube,
  sobol,
  morris,
  saltelli
};

/// Values for some variables. Of several designs all combinations are made, the last one fastest.
struct SweepDesign {
  SweepDesignKind kind = SweepDesignKind::grid;
  std::vector<SweepVariable> variables;
  std::uint32_t samples = 0;  ///< of designs that draw; morris: trajectories
  std::uint64_t seed = 1;
  int levels = 4;  ///< morris
};

/// Keeps the cases whose value lies in [low, high]; only variables that are numbers can have conditions.
struct SweepCondition {
  std::string text;
  laws::Formula formula;
  std::vector<std::string> names;
  std::optional<double> low, high;
};

struct SweepSpec {
  std::string name, title;
  std::string scene_text, scene_name, scene_file;
  std::vector<std::string> overrides;  ///< of all cases: "/pointer=value"
  std::vector<SweepDesign> designs;
  std::vector<SweepCondition> where;
};

inline constexpr std::size_t most_sweep_cases = 1'000'000;

}  // namespace bough::io
