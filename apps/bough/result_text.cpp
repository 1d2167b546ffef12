#include "result_text.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "error_text.hpp"

namespace bough::app {
namespace {

using io::rounded_text;

std::string count_text(long count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// Whether the run is an analysis of this kind.
bool is_of(const records::Summary& summary, const std::string& kind) {
  return std::any_of(summary.options.begin(), summary.options.end(), [&kind](const auto& option) {
    return option.first == "analysis/kind" && option.second == "\"" + kind + "\"";
  });
}

std::string balances_text(const records::Checks& checks) {
  std::string text = "  energy balance     " + rounded_text(checks.energy_balance, 3) + " J";
  if (checks.energy_scale > 0.0 && std::isfinite(checks.energy_balance)) {
    text += " (" + rounded_text(checks.energy_balance / checks.energy_scale, 2) + " of the largest energy)";
  }
  text += "\n";
  if (checks.numerical_dissipation != 0.0)
    text += "  integrator took    " + rounded_text(checks.numerical_dissipation, 3) + " J\n";
  return text + "  momentum balance   " + rounded_text(checks.momentum_balance, 3) + " kg m/s\n";
}

/// What the tree of sub-domains was, if the form of the solver has one.
std::string interfaces_text(const records::Summary& summary) {
  if (summary.levels.empty()) return {};
  int subdomains = 0, widest = 0;
  double condition = 0.0;
  for (const records::LevelFigures& level : summary.levels) {
    subdomains += level.subdomains;
    widest = std::max(widest, level.interface_unknowns);
    condition = std::max(condition, level.condition);
  }
  std::string text = "  interfaces         ";
  if (subdomains == 1) return text + "none: one sub-domain\n";
  text += std::to_string(subdomains - 1) + " on " + count_text(static_cast<long>(summary.levels.size()) - 1, "level") +
          ", of up to " + count_text(widest, "unknown");
  if (condition > 0.0) text += ", condition of their flexibilities up to " + rounded_text(condition, 2);
  for (const auto& [name, value] : summary.solver)
    if (name == "interfaces_indefinite" && value > 0.0)
      text += ", " + rounded_text(value, 6) + " with a stiffness that is not definite";
  return text + "\n";
}

std::string checks_text(const records::Summary& summary) {
  const records::Checks& checks = summary.checks;
  std::string text;
  if (checks.evaluated) {  // balances over time are those of a motion that is integrated
    if (is_of(summary, "dynamic")) text += balances_text(checks);
    text += "  constraints        " + rounded_text(checks.constraint_violation_position, 3) + " in position";
    if (!is_of(summary, "static"))
      text += ", " + rounded_text(checks.constraint_violation_velocity, 3) + " in velocity";
    text += "\n";
  }
  text += interfaces_text(summary);
  text += "  linear solutions   backward error up to " + rounded_text(checks.linear_backward_error_max, 2) + "\n";
  if (checks.round_off_floor_reached)
    text += "  Newton reached the floor of round-off before its tolerance in some steps\n";
  return text;
}

std::string expected_text(const std::vector<records::ExpectedResult>& expected) {
  std::vector<std::vector<std::string>> rows = {{"  expected", "value", "reference", "tolerance", "", "taken"}};
  for (const records::ExpectedResult& figure : expected)
    rows.push_back({"  " + figure.name, figure.reached && figure.has_value ? rounded_text(figure.value, 9) : "-",
                    rounded_text(figure.reference, 9), rounded_text(figure.tolerance, 3), figure.verdict(),
                    figure.taken});
  return table_text(rows);
}

/// The columns of a table for which a terminal has room.
std::string results_text(const records::Table& table) {
  constexpr std::size_t most_rows = 48, most_columns = 9;  // of a screen; the file has all
  std::vector<std::vector<std::string>> rows(1);
  for (const records::Table::Column& column : table.columns)
    if (column.is_brief && rows[0].size() < most_columns)
      rows[0].push_back((rows[0].empty() ? "  " : "") +
                        (column.unit.empty() ? column.name : column.name + " [" + column.unit + "]"));
  for (const auto& row : table.rows) {
    if (rows.size() > most_rows) break;
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (!table.columns[c].is_brief || cells.size() == most_columns) continue;
      const double* number = std::get_if<double>(&row[c]);
      cells.push_back((cells.empty() ? "  " : "") +
                      (number != nullptr ? rounded_text(*number, 7) : std::get<std::string>(row[c])));
    }
    rows.push_back(std::move(cells));
  }
  const std::size_t left = table.rows.size() + 1 - rows.size();
  return "  " + table.about + "\n" + table_text(rows) +
         (left > 0 ? "  ... " + std::to_string(left) + " more rows in " + table.name + ".csv\n" : "");
}

}  // namespace

std::string table_text(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t c = 0; c + 1 < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c)
      line += row[c] + std::string(std::max(widths[c], row[c].size()) - row[c].size() + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string doubts_text(const records::Summary& summary, const std::string& before) {
  std::string text;
  for (const records::Doubt& doubt : summary.doubts)
    text += before + "DOUBT (" + doubt.about + "): " + doubt.text + "\n";
  return text;
}

std::string result_text(const records::Summary& summary, const std::string& directory,
                        const std::vector<std::string>& files) {
  const char* words = summary.status == records::RunStatus::ok       ? "done"
                      : summary.status == records::RunStatus::failed ? "FAILED"
                                                                     : "stopped";
  std::string text = summary.scene + ": " + words;
  if (!summary.doubts.empty())
    text +=
        ", not to be trusted without a closer look: " + count_text(static_cast<long>(summary.doubts.size()), "doubt") +
        " below";
  text += "\n";
  if (!summary.cause.empty()) text += "  cause: " + summary.cause + "\n";
  text += "  " + count_text(summary.steps.accepted, "step") + " accepted, " + std::to_string(summary.steps.rejected) +
          " rejected, " + count_text(summary.steps.newton_iterations, "Newton iteration") + ", " +
          count_text(summary.steps.factorizations, "factorization") + " in " + rounded_text(summary.times.total, 3) +
          " s with " + count_text(summary.threads, "thread") + "\n";
  text += checks_text(summary);
  text += doubts_text(summary, "  ");
  if (!summary.not_judged.empty()) text += "  not judged: " + summary.not_judged + "\n";
  for (const std::string& note : summary.notes) text += "  note: " + note + "\n";
  if (!summary.expected.empty()) text += expected_text(summary.expected);
  if (!summary.measures.empty()) {
    std::vector<std::vector<std::string>> rows;
    for (const records::MeasureResult& m : summary.measures)
      rows.push_back({"  " + m.name, m.value ? rounded_text(*m.value, 9) : "none"});
    text += table_text(rows);
  }
  for (const records::Table& table : summary.tables) text += results_text(table);
  if (summary.errors) text += errors_text(*summary.errors);
  text += "  results in " + directory + ":";
  for (const std::string& file : files) text += " " + file;
  return text + "\n";
}

}  // namespace bough::app
