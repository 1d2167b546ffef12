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
std::string percent(double share) { return io::rounded_text(100.0 * share, share < 1.0 ? 2 : 3) + " %"; }

const ErrorOf* column_named(const records::MeasuredErrors& errors, const std::string& name) {
  const auto at =
      std::find_if(errors.columns.begin(), errors.columns.end(), [&](const ErrorOf& e) { return e.name == name; });
  return at != errors.columns.end() ? &*at : nullptr;
}

/// What a kind of error is called, and what makes it less.
struct Words {
  const char *of, *remedy;
};
constexpr Words in_time{"in time", "take smaller steps"}, of_mesh{"of the mesh", "take more elements"};

bool is_told(const ErrorPart& part, double bound) {
  return part.is_known() || agrees(part, bound) || (part.state == ErrorState::not_resolved && part.largest > bound);
}

/// Whether twins tell of all that the estimate doubts: they know its error, agree on it, or doubt it themselves.
bool is_replaced(const records::MeasuredErrors& errors, const records::Summary& summary, const TrustLimits& limits) {
  const auto is_told_of = [&](const std::string& column) {
    const ErrorOf* const e = column_named(errors, column);
    return e != nullptr && is_told(e->time, limits.sensor_error * e->range);
  };
  if (summary.sensor_errors.empty())
    return !errors.columns.empty() && std::all_of(errors.columns.begin(), errors.columns.end(),
                                                  [](const ErrorOf& e) { return e.time.is_known(); });
  return std::all_of(summary.sensor_errors.begin(), summary.sensor_errors.end(), [&](const records::SensorError& e) {
    return e.relative() <= limits.sensor_error || is_told_of(e.column);
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
  const std::string share =
      ", " + percent(p.largest / worst->range) + " of the " + two_digits(worst->range) + " over which it ranges";
  const std::string others =
      count > 1 ? " (and " + std::to_string(count - 1) + " more columns by more than " + percent(bound) + ")" : "";
  if (is_known)
    doubts.push_back({"error", "'" + worst->name + "' has an error " + words.of + " of up to " + two_digits(p.largest) +
                                   share + others + ", measured by twins; " + (p.cause.empty() ? "" : p.cause + "; ") +
                                   words.remedy});
  else
    doubts.push_back({"error", "the error " + std::string(words.of) + " of '" + worst->name +
                                   "' is not resolved: it differs from its twin by up to " + two_digits(p.largest) +
                                   share + others + (p.cause.empty() ? "" : "; " + p.cause) + "; " + words.remedy});
}

constexpr double most_ratio = 4.0, least_ratio = 2.0;  ///< of differences, which errors of second and first order have

/// By how much the largest differences between members shrink, no more than second order gives.
double shrinking(const ErrorPart& part) {
  return part.largest > 0.0 ? std::min(part.spread / part.largest, most_ratio) : 0.0;
}

/// What twins tell of the error of a column that they know or on which they agree.
double error_told(const ErrorPart& part) {
  if (part.is_known() || !part.has_finer) return part.largest;
  const double ratio = std::max(shrinking(part), least_ratio);
  return part.largest * ratio / (ratio - 1.0);
}

/// Columns that the estimate doubts. Without sensors of motion the estimate is one of all columns.
std::vector<const ErrorOf*> doubted_columns(const records::MeasuredErrors& errors, const records::Summary& summary,
                                            const TrustLimits& limits) {
  std::vector<const ErrorOf*> doubted;
  for (const ErrorOf& e : errors.columns) {
    const auto estimate = std::find_if(summary.sensor_errors.begin(), summary.sensor_errors.end(),
                                       [&](const records::SensorError& s) { return s.column == e.name; });
    if (estimate == summary.sensor_errors.end() ? summary.sensor_errors.empty()
                                                : estimate->relative() > limits.sensor_error)
      doubted.push_back(&e);
  }
  return doubted;
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

bool agrees(const ErrorPart& part, double bound) {
  constexpr double small = 0.25, safety = 2.0;
  if (part.state != ErrorState::not_resolved || part.largest > bound) return false;
  if (part.largest <= small * bound && part.spread <= bound) return true;
  const double ratio = shrinking(part);
  return ratio >= least_ratio && part.largest * ((part.has_finer ? 1.0 : 0.0) + safety / (ratio - 1.0)) <= bound;
}

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

bool is_estimate_doubted(const records::Summary& summary) {
  return std::any_of(summary.doubts.begin(), summary.doubts.end(),
                     [](const records::Doubt& d) { return d.about == estimate_beside_twins; });
}

bool check_estimate(const records::MeasuredErrors& errors, const std::string& runs, records::Summary& summary) {
  const TrustLimits limits;
  const std::vector<const ErrorOf*> doubted = doubted_columns(errors, summary, limits);
  bool are_known = !doubted.empty(), are_right = are_known;
  for (const ErrorOf* e : doubted) {
    const double bound = limits.sensor_error * e->range;
    are_known = are_known && e->time.is_known();
    are_right = are_right && ((e->time.is_known() && e->time.largest <= bound) || agrees(e->time, bound));
  }
  if (!are_right && !are_known) return false;
  double most = 0.0;  // over the range
  for (const ErrorOf* e : doubted)
    if (e->range > 0.0) most = std::max(most, error_told(e->time) / e->range);
  std::erase_if(summary.doubts, [](const records::Doubt& d) { return d.about == estimate_beside_twins; });
  for (records::SensorError& s : summary.sensor_errors)
    if (const ErrorOf* const e = column_named(errors, s.column); e != nullptr && e->time.largest > 0.0) {
      s.of_steps = error_told(e->time);
      s.of_energy = 0.0;
    }
  if (are_right)
    summary.notes.push_back("the estimated error in time was large; runs in " + runs + " put it at " + percent(most) +
                            " of a range or less");
  else
    doubt_worst(errors, &ErrorOf::time, in_time, true, limits.sensor_error, summary.doubts);
  return true;
}

double difference_from_twins(const records::MeasuredErrors& errors, const records::Summary& summary) {
  double most = 0.0;
  for (const ErrorOf* e : doubted_columns(errors, summary, TrustLimits{}))
    if (e->range > 0.0) most = std::max(most, e->time.largest / e->range);
  return most;
}

void keep_estimates_doubt(records::Summary& summary, const std::string& more) {
  for (records::Doubt& d : summary.doubts) {
    if (d.about != estimate_beside_twins) continue;
    d.about = "error";
    if (!more.empty()) d.text += "; " + more;
  }
}

}  // namespace bough::run
