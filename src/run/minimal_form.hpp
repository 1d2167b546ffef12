#pragma once
/// Linearised equations in minimal coordinates.
#include <cstdint>
#include <string>
#include <vector>

#include "bough/records/linear_model.hpp"

namespace bough::run {

enum class UnknownKind : std::uint8_t { motion, multiplier, signal, state };

/// M z'' + C z' + K z = b u between all unknowns z, of which multipliers have neither M nor C, and outputs
///   y = C_z z + C_v q' + C_a q''    with the motions q among z.
/// The right-hand side of an input is a one in the row of its signal.
struct LinearEquations {
  std::vector<UnknownKind> kinds;
  std::vector<records::LinearVariable> names, rates, accelerations;  ///< by unknown
  std::vector<double> weights;                                       ///< Linearisation::weights
  records::SparseEntries M, C, K, of_values, of_rates, of_accelerations;
  std::vector<std::size_t> inputs;  ///< unknowns
};

/// Eliminates signals, then motions by constraint rows, whose independent ones stay as states under their names, then
/// accelerations. Returns why there is no such form; empty: there is.
std::string make_minimal(const LinearEquations& equations, records::LinearModel::Minimal& minimal);

}  // namespace bough::run
