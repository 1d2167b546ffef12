#pragma once
/// Names of history columns: "<sensor>.<component>" or "<sensor>".
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::io {

struct ColumnName {
  std::string sensor, component;  ///< component empty: a scalar sensor
};
ColumnName split_column(std::string_view column);

/// Columns of one sensor that share a unit and therefore a scale and a plot. Six components are two groups of three:
/// forces and moments, displacements and rotations. Further components are grouped by the word before their underscore.
struct ColumnGroup {
  std::string sensor;
  std::vector<std::size_t> columns;  ///< indices
  std::string word = {};             ///< that its components begin with
};
std::vector<ColumnGroup> group_columns(const std::vector<std::string>& columns);

/// The sensor, and the word that the components of the group share.
std::string title_of(const ColumnGroup& group);

/// `columns.json` describes the columns of history.csv,
///   {"columns":[{"name","unit","quantity","part"},...]}
/// first time, step_size and iterations, then those of the sensors. A load factor is a "time" without a unit. Where errors
/// were measured, the columns of errors.csv follow under "errors".
std::string columns_text(const records::HistoryHeader& header, const records::HistoryHeader* errors = nullptr);

/// Adds the descriptions in a `columns.json` to the header of a history. Leaves `about` empty if there is no such file
/// (runs of earlier versions). Throws std::runtime_error naming the file if it has other content.
void read_columns(const std::filesystem::path& path, records::HistoryHeader& header);

}  // namespace bough::io
