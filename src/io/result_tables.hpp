#pragma once
/// Tables of results (records::Table) as CSV and in the summary.
#include <string>
#include <vector>

#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/records/table.hpp"

namespace bough::io {

/// Name of the file of a table. Files of tables of all analyses: table_files.
std::string file_of(const records::Table& table);
inline const std::vector<std::string> table_files{"modes.csv",        "response.csv", "spectra.csv",  "rms.csv",
                                                  "linear_model.csv", "buckling.csv", "campbell.csv", "critical.csv"};

/// A line of names, "frequency [Hz]", and a line a row.
std::string table_csv(const records::Table& table);

/// "tables": {name: {"about": ..., "columns": [{"name", "unit", "brief"}], "rows": [{column: value}]}}
void write_tables(JsonText& json, const std::vector<records::Table>& tables);
std::vector<records::Table> read_tables(const JsonValue& tables);

}  // namespace bough::io
