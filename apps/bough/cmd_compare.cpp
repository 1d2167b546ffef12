/// bough compare A B: the largest difference of every column.
#include <iostream>

#include "arguments.hpp"
#include "bough/io/compare.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/summary.hpp"
#include "result_text.hpp"

namespace bough::app {
namespace {

struct Side {
  io::History history;
  std::string status;  ///< empty for a bare history
};

Side read_side(const std::filesystem::path& path) {
  if (std::error_code unknown; !std::filesystem::is_directory(path, unknown)) return {io::read_history(path), ""};
  return io::read_unchanged(path, [&] {
    const io::SummaryFile summary = io::read_whole_summary(path, {"history.csv"});
    return Side{io::read_history(path / "history.csv"), summary.status};
  });
}

std::string verdict(const io::ColumnDifference& column) {
  if (column.has_non_finite) return "not finite";
  if (!column.is_judged) return "(not judged)";
  return column.holds ? "equal" : "differs";
}

}  // namespace

int compare(const CompareArguments& arguments) {
  Side a, b;
  try {
    a = read_side(arguments.a);
    b = read_side(arguments.b);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return exit_bad_input;
  }
  io::Comparison comparison = io::compare_histories(a.history, b.history, {arguments.relative, arguments.absolute});
  if (!a.status.empty() && !b.status.empty() && a.status != b.status) {
    comparison.problems.push_back("A is " + a.status + ", B is " + b.status);
    comparison.equal = false;
  }
  std::vector<std::vector<std::string>> rows = {{"column", "absolute", "over range", "at time", ""}};
  for (const io::ColumnDifference& column : comparison.columns)
    rows.push_back({column.name, io::rounded_text(column.absolute, 3), io::rounded_text(column.relative, 3),
                    io::rounded_text(column.time, 6), verdict(column)});
  std::cout << table_text(rows);
  for (const std::string& problem : comparison.problems) std::cout << problem << "\n";
  std::cout << (comparison.equal ? "equal" : "different") << " within " << io::rounded_text(arguments.relative, 3)
            << " of the range";
  if (arguments.absolute > 0.0) std::cout << " or " << io::rounded_text(arguments.absolute, 3);
  std::cout << "\n";
  return comparison.equal ? exit_done : exit_failed;
}

}  // namespace bough::app
