#include "error_doubts.hpp"

#include <algorithm>

#include "bough/io/number_text.hpp"
#include "not_judged.hpp"
#include "trust.hpp"

namespace bough::run {

using records::ErrorOf;
using records::ErrorPart;
using records::ErrorState;

namespace {

std::string two_digits(double value) { return io::rounded_text(value, 2); }

/// What a kind of error is called, and what makes it less.
struct Words {
  const char *of, *remedy;
};
constexpr Words in_time{"in time", "take smaller steps"}, of_mesh{"of the mesh", "take more elements"};

/// Whether twins tell of all that the estimate doubts: they know its error, or doubt it themselves.
bool is_replaced(const records::MeasuredErrors& errors, const records::Summary& summary, const TrustLimits& limits) {
  const auto is_told = [&](const std::string& column) {
    const auto at =
        std::find_if(errors.columns.begin(), errors.columns.end(), [&](const ErrorOf& e) { return e.name == column; });
    return at != errors.columns.end() && (at->time.is_known() || (at->time.state == ErrorState::not_resolved &&
                                                                  at->time.largest > limits.sensor_error * at->range));
  };
  if (summary.sensor_errors.empty())
    return !errors.columns.empty() && std::all_of(errors.columns.begin(), errors.columns.end(),
                                                  [](const ErrorOf& e) { return e.time.is_known(); });
  return std::all_of(summary.sensor_errors.begin(), summary.sensor_errors.end(), [&](const records::SensorError& e) {
    return e.relative() <= limits.sensor_error || is_told(e.column);
  });
}

/// The largest of the errors in one state that exceed the bound, and how many do.
void doubt_worst(const records::MeasuredErrors& errors, ErrorPart ErrorOf::*part, const Words& words, bool is_known,
                 double bound, std::vector<records::Doubt>& doubts) {
  const ErrorOf* worst = nullptr;
  std::size_t count = 0;
  for (const ErrorOf& e : errors.columns) {
    const ErrorPart& p = e.*part;
    const bool is_of_state =
        is_known ? p.is_known() && p.state != ErrorState::round_off : p.state == ErrorState::not_resolved;
    if (!is_of_state || p.largest <= bound * e.range || !(e.range > 0.0)) continue;
    ++count;
    if (worst == nullptr || p.largest / e.range > (worst->*part).largest / worst->range) worst = &e;
  }
  if (worst == nullptr) return;
  const ErrorPart& p = worst->*part;
  const std::string share = ", " + two_digits(100.0 * p.largest / worst->range) + " % of the " +
                            two_digits(worst->range) + " over which it ranges";
  const std::string others = count > 1 ? " (and " + std::to_string(count - 1) + " more columns by more than " +
                                             two_digits(100.0 * bound) + " %)"
                                       : "";
  if (is_known)
    doubts.push_back({"error", "'" + worst->name + "' has an error " + words.of + " of up to " + two_digits(p.largest) +
                                   share + others + ", measured by twins; " + words.remedy});
  else
    doubts.push_back({"error", "the error " + std::string(words.of) + " of '" + worst->name +
                                   "' is not resolved: it differs from its twin by up to " + two_digits(p.largest) +
                                   share + others + (p.cause.empty() ? "" : "; " + p.cause) + "; " + words.remedy});
}

/// Names of the columns of which twins know nothing, with the reason.
std::string left_out(const records::MeasuredErrors& errors, ErrorPart ErrorOf::*part, const Words& words) {
  std::string names, cause;
  std::size_t count = 0;
  constexpr std::size_t most_named = 4;
  for (const ErrorOf& e : errors.columns) {
    if ((e.*part).state != ErrorState::not_measured) continue;
    if (count++ < most_named) names += (names.empty() ? "'" : ", '") + e.name + "'";
    cause = (e.*part).cause;
  }
  if (count == 0) return "";
  if (count > most_named) names += " and " + std::to_string(count - most_named) + " more";
  return "the error " + std::string(words.of) + " of " + names + " was not measured" +
         (cause.empty() ? "" : ", since " + cause);
}

}  // namespace

void judge_errors(const records::MeasuredErrors& errors, const scene::ErrorsWanted& wanted, records::Summary& summary) {
  const TrustLimits limits;
  if (wanted.time && is_replaced(errors, summary, limits))
    std::erase_if(summary.doubts, [](const records::Doubt& d) { return d.about == estimate_beside_twins; });
  for (const bool is_known : {true, false}) {
    if (wanted.time) doubt_worst(errors, &ErrorOf::time, in_time, is_known, limits.sensor_error, summary.doubts);
    if (wanted.mesh) doubt_worst(errors, &ErrorOf::mesh, of_mesh, is_known, limits.sensor_error, summary.doubts);
  }
  summary.not_judged = one_line({summary.not_judged, wanted.time ? left_out(errors, &ErrorOf::time, in_time) : "",
                                 wanted.mesh ? left_out(errors, &ErrorOf::mesh, of_mesh) : ""});
}

}  // namespace bough::run
