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

/// Columns of one sensor that share a unit and so one scale and one plot. Six components are two groups of three:
/// forces and moments, displacements and rotations; of more, those with one word before their underscore are a group.
struct ColumnGroup {
  std::string sensor;
  std::vector<std::size_t> columns;  ///< indices
  std::string word = {};             ///< that its components begin with
};
std::vector<ColumnGroup> group_columns(const std::vector<std::string>& columns);

/// The sensor, and the word that the components of the group share.
std::string title_of(const ColumnGroup& group);

/// `columns.json`: what the columns of history.csv hold,
///   {"columns":[{"name","unit","quantity","part"},...]}
/// first time, step_size and iterations, then those of the sensors. A load factor is a "time" without a unit.
std::string columns_text(const records::HistoryHeader& header);

/// Adds to the header of a history what a `columns.json` says of its columns; leaves `about` empty where there is no
/// such file (runs of versions before it). Throws std::runtime_error naming the file where it holds something else.
void read_columns(const std::filesystem::path& path, records::HistoryHeader& header);

}  // namespace bough::io
