#include "error_text.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bough/io/known_text.hpp"
#include "bough/io/number_text.hpp"
#include "result_text.hpp"

namespace bough::app {

using io::rounded_text;
using records::ErrorOf;
using records::ErrorPart;
using records::ErrorState;

namespace {

constexpr std::size_t most_rows = 24;

/// "at most 2.1e-05 at 1.25", "not resolved"
std::string part_text(const ErrorPart& part) {
  switch (part.state) {
    case ErrorState::not_measured:
      return "-";
    case ErrorState::round_off:
      return "round-off, " + rounded_text(part.largest, 1);
    case ErrorState::not_resolved:
      return "not resolved, differs by " + rounded_text(part.largest, 2);
    case ErrorState::resolved:
    case ErrorState::unexamined:
      break;
  }
  std::string text = "up to " + rounded_text(part.largest, 2) + " at " + rounded_text(part.when, 4);
  if (part.state == ErrorState::unexamined) return text + ", order not examined";
  return text + ", order " + rounded_text(part.order_of_largest, 2);
}

/// The sum of what is known of the error at the end. Of a part that is not resolved the difference of its members counts,
/// where it is no larger than what is known of the other part; else the sum is not a number.
double error_at_end(const ErrorOf& e) {
  double sum = 0.0, open = 0.0;
  for (const ErrorPart* part : {&e.time, &e.mesh}) {
    if (part->state == ErrorState::not_resolved)
      open += part->largest;
    else
      sum += part->state == ErrorState::round_off ? part->largest : std::abs(part->at_end);
  }
  return open <= sum ? sum + open : std::nan("");
}

bool is_told(const ErrorOf& e) {
  return e.time.state != ErrorState::not_measured || e.mesh.state != ErrorState::not_measured;
}

void add_rows(const std::vector<ErrorOf>& list, std::vector<std::vector<std::string>>& rows, std::size_t& left_out) {
  for (const ErrorOf& e : list) {
    if (!is_told(e)) continue;
    if (rows.size() > most_rows) {
      ++left_out;
      continue;
    }
    rows.push_back({"  " + e.name, io::known_text(e.value, error_at_end(e)) + (e.unit.empty() ? "" : " " + e.unit),
                    part_text(e.time), part_text(e.mesh)});
  }
}

}  // namespace

std::string errors_text(const records::MeasuredErrors& errors) {
  std::string text;
  for (const records::TwinMember& m : errors.members)
    text += "  twin with " + rounded_text(m.factor, 3) + (m.is_of_mesh ? " times the elements" : " times the step") +
            (m.status == records::RunStatus::ok ? ": " + rounded_text(m.seconds, 2) + " s\n"
                                                : " failed: " + m.cause + "\n");
  std::vector<std::vector<std::string>> rows{{"  errors", "at the end", "in time", "of the mesh"}};
  std::size_t left_out = 0;
  for (const auto* list : {&errors.columns, &errors.expected, &errors.measures}) add_rows(*list, rows, left_out);
  if (rows.size() > 1) text += table_text(rows);
  if (left_out > 0) text += "  and " + std::to_string(left_out) + " more in summary.json\n";
  for (const std::string& remark : errors.remarks) text += "  errors: " + remark + "\n";
  return text;
}

}  // namespace bough::app
