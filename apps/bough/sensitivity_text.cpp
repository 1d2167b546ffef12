#include <iostream>

#include "bough/io/number_text.hpp"
#include "case_run.hpp"
#include "result_text.hpp"

namespace bough::app {
namespace {

/// "0.31 (0.28 to 0.34)"
std::string index_text(const study::Index& index) {
  std::string text = io::rounded_text(index.value, 3);
  if (index.low && index.high)
    text += " (" + io::rounded_text(*index.low, 3) + " to " + io::rounded_text(*index.high, 3) + ")";
  return text;
}

}  // namespace

void print_sensitivities(const std::vector<study::MeasureSensitivity>& sensitivities) {
  for (const study::MeasureSensitivity& s : sensitivities) {
    std::cout << s.measure << ": " << s.of.method << " over " << s.of.rows << " cases";
    if (s.of.explained)
      std::cout << ", a linear function explains " << io::rounded_text(100.0 * *s.of.explained, 3)
                << " % of the variance, " << io::rounded_text(100.0 * *s.of.explained_ranks, 3)
                << " % of that of ranks";
    std::cout << "\n";
    std::vector<std::vector<std::string>> rows = {{"  "}};
    rows[0].insert(rows[0].end(), s.of.indices.begin(), s.of.indices.end());
    for (std::size_t k = 0; k < s.variables.size(); ++k) {
      rows.push_back({"  " + s.variables[k]});
      for (const std::vector<study::Index>& of : s.of.values) rows.back().push_back(index_text(of[k]));
    }
    std::cout << table_text(rows);
  }
}

}  // namespace bough::app
