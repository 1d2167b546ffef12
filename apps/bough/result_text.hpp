#pragma once
/// The printed result of a run.
#include <string>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::app {

/// Status, steps, checks in words, expected figures, where the files lie.
std::string result_text(const records::Summary& summary, const std::string& directory,
                        const std::vector<std::string>& files);

/// The doubts about a run, one to a line, each after `before`.
std::string doubts_text(const records::Summary& summary, const std::string& before);

/// Columns padded to equal widths, two spaces apart. Rows may be of different lengths; the last cell of a row may run
/// on.
std::string table_text(const std::vector<std::vector<std::string>>& rows);

}  // namespace bough::app
