#pragma once
/// Files of a linear model (records::LinearModel).
#include <string>
#include <utility>
#include <vector>

#include "bough/records/linear_model.hpp"

namespace bough::io {

/// linear_model.json: all of it. linear_model_A.mtx ...: matrices of the descriptor form in the format Matrix Market.
/// linear_model.npz: arrays of NumPy; A, B, C, D, T of the minimal form, and E_row, E_column, E_value, E_shape ... of
/// the descriptor form. Names of all files that there may be: linear_model_names.
std::vector<std::pair<std::string, std::string>> linear_model_files(const records::LinearModel& model);
inline const std::vector<std::string> linear_model_names{
    "linear_model.json",  "linear_model.npz",   "linear_model_E.mtx", "linear_model_A.mtx",
    "linear_model_B.mtx", "linear_model_C.mtx", "linear_model_D.mtx"};

}  // namespace bough::io
