#pragma once
/// Sensitivities of measures to the varied inputs, by the method that the design of the sweep allows.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bough/io/sweep_spec.hpp"

namespace bough::study {

/// A number with its 95 % confidence interval, where one is known.
struct Index {
  double value = 0.0;
  std::optional<double> low, high;
};

/// Sensitivities of one measure: indices by variable.
struct Sensitivity {
  std::string method;                      ///< "morris", "regression" or "sobol_indices"
  std::vector<std::string> indices;        ///< their names
  std::vector<std::vector<Index>> values;  ///< by index, then by variable
  std::size_t rows = 0;                    ///< number of cases used
  /// For regressions: the share of the variance explained by a linear function, of values and of ranks. If it is low,
  /// the indices mean little.
  std::optional<double> explained, explained_ranks;
};

/// The sensitivity with names, for tables.
struct MeasureSensitivity {
  std::string measure;
  std::vector<std::string> variables;
  Sensitivity of;
};

/// Sensitivity for a random design: elementary effects for morris, Sobol's indices for saltelli, and standardised
/// regression for all others.
///  values: the measured values by the rows of the design; none: the case has no value
/// Returns none if the design allows no indices, if too few rows have values, or if the measure does not vary.
std::optional<Sensitivity> sensitivity_of(const io::SweepDesign& design, std::uint32_t number,
                                          std::span<const std::optional<double>> values);

/// Elementary effects along trajectories (Morris 1991, Factorial sampling plans for preliminary computational
/// experiments): differences over those of the unit cube; mean, mean of magnitudes (mu_star, Campolongo et al. 2007)
/// and standard deviation.
std::optional<Sensitivity> morris_effects(const std::vector<std::vector<double>>& unit_rows,
                                          std::span<const std::optional<double>> values);

/// Coefficients of a linear fit of standardised values, and of standardised ranks.
std::optional<Sensitivity> regression(const std::vector<std::vector<double>>& inputs,
                                      std::span<const std::optional<double>> values);

/// Sobol's indices from samples of `variables` + 2 cases a, b, a with one variable of b (Saltelli et al. 2010,
/// Variance based sensitivity analysis of model output):
///   S_i = mean(f(b) (f(ab_i) - f(a))) / V,   ST_i = mean((f(a) - f(ab_i))^2) / (2 V)   (Jansen 1999)
/// with f less its mean, V the variance of all f(a) and f(b), and percentile intervals of 1000 resamples.
std::optional<Sensitivity> sobol_indices(std::size_t variables, std::span<const std::optional<double>> values,
                                         std::uint64_t seed = 1);

}  // namespace bough::study
