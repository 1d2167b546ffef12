/// The table as a whole: its cases, and how they are run, judged and written.
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include "bench.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/nearest_name.hpp"

namespace bough::stress {

namespace {

std::vector<Definition> make_table() {
  std::vector<Definition> table;
  for (const auto add : {add_slenderness, add_ratios, add_units, add_steps, add_penalty, add_constraints, add_buckling,
                         add_sizes, add_stiff, add_spin, add_gravity, add_long})
    add(table);
  return table;
}

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// "tip 3.1e-10 (at most 1e-08)", worst first where they fail.
std::string figures_text(const std::vector<StressFigure>& figures) {
  std::string failing, holding;
  for (const StressFigure& f : figures) {
    std::string& text = f.holds() ? holding : failing;
    text += (text.empty() ? "" : "; ") + f.name + " " + io::rounded_text(f.value, 3);
    if (f.limit < std::numeric_limits<double>::infinity())
      text +=
          (f.holds() ? " (at most " : " instead of at most ") + io::rounded_text(f.limit, 3) + (f.holds() ? ")" : "");
  }
  return failing + (failing.empty() || holding.empty() ? "" : "; ") + holding;
}

StressCase run_case(const Definition& definition, bool is_quick, double memory_limit,
                    const std::function<bool()>& is_stopped) {
  StressCase result;
  result.name = definition.name;
  result.family = definition.family;
  result.promise = definition.promise;
  result.expected = definition.expected;
  result.reason = definition.reason;
  const double begin = thread_seconds();
  Bench bench(result, is_quick, is_stopped, memory_limit);
  std::string cause;
  try {
    definition.body(bench);
  } catch (const std::exception& e) {
    cause = e.what();
    if (cause.empty()) cause = "it broke off without a word";
  }
  result.seconds = thread_seconds() - begin;
  constexpr double all_digits = 15.95;  // of a double
  if (result.digits_lost == 0.0 && result.condition > 1.0)
    result.digits_lost = std::min(all_digits, std::log10(result.condition));
  bench.figure("LAPACK ratio", result.lapack_ratio, lapack_ratio_limit);
  const bool holds = cause.empty() && std::all_of(result.figures.begin(), result.figures.end(),
                                                  [](const StressFigure& f) { return f.holds(); });
  result.status = !holds                                         ? StressStatus::fails
                  : definition.expected == StressStatus::refused ? StressStatus::refused
                                                                 : StressStatus::holds;
  // A case that is expected to fail fails by its figures; one that should be refused but is not, fails.
  if (holds && definition.expected == StressStatus::refused && result.refusal.empty())
    result.status = StressStatus::holds;
  const std::string words = result.measured;
  result.measured = cause;
  for (const std::string& part : {result.refusal, words, figures_text(result.figures)})
    if (!part.empty()) bench.say(part);
  return result;
}

bool is_asked_for(const Definition& d, const std::string& only) {
  return only.empty() || only == d.name || only == d.family;
}

}  // namespace
const char* text_of(StressStatus status) {
  return status == StressStatus::holds ? "holds" : status == StressStatus::fails ? "fails" : "refused";
}

std::vector<std::string> stress_names() {
  std::vector<std::string> names, families;
  for (const Definition& d : make_table()) {
    names.emplace_back(d.name);
    if (families.empty() || families.back() != d.family) families.emplace_back(d.family);
  }
  names.insert(names.end(), families.begin(), families.end());
  return names;
}

std::vector<std::string> problems_in(const StressOptions& options) {
  std::vector<std::string> problems;
  if (options.threads < 1) problems.emplace_back("threads: at least 1");
  const std::vector<std::string> names = stress_names();
  if (!options.only.empty() && std::find(names.begin(), names.end(), options.only) == names.end()) {
    const std::string nearest = scene::nearest_name(options.only, names);
    problems.push_back("no case or family is named '" + options.only + "'" +
                       (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
  }
  return problems;
}

std::vector<StressCase> run_stress(
    const StressOptions& options,
    const std::function<void(const StressCase&, std::size_t done, std::size_t all)>& on_case,
    const std::function<bool()>& is_stopped) {
  std::vector<Definition> table = make_table();
  std::erase_if(table, [&](const Definition& d) { return !is_asked_for(d, options.only); });
  std::vector<StressCase> results(table.size());
  std::vector<char> is_done(table.size(), 0);
  const double memory_limit =
      options.memory_limit / std::max(1.0, std::min(static_cast<double>(table.size()), 1.0 * options.threads));
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex telling;
  std::vector<std::size_t> order;
  for (const bool is_long : {true, false})
    for (std::size_t k = 0; k < table.size(); ++k)
      if (table[k].is_long == is_long) order.push_back(k);
  const auto work = [&] {
    for (std::size_t place = next++; place < table.size(); place = next++) {
      if (is_stopped && is_stopped()) return;
      const std::size_t k = order[place];
      results[k] = run_case(table[k], options.quick, memory_limit, is_stopped);
      if (is_stopped && is_stopped()) return;  // it may have been interrupted
      const std::lock_guard<std::mutex> lock(telling);
      is_done[k] = 1;
      if (on_case) on_case(results[k], ++done, table.size());
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < options.threads; ++t) others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
  std::vector<StressCase> finished;
  for (std::size_t k = 0; k < results.size(); ++k)
    if (is_done[k] != 0) finished.push_back(std::move(results[k]));
  return finished;
}

std::string stress_json(const std::vector<StressCase>& cases, const StressOptions& options,
                        const std::string& version) {
  io::JsonText json;
  json.begin_object();
  json.member("version", std::string_view(version));
  json.member("quick", options.quick);
  json.member("threads", static_cast<long long>(options.threads));
  const auto count = [&](StressStatus status) {
    return static_cast<long long>(
        std::count_if(cases.begin(), cases.end(), [status](const StressCase& c) { return c.status == status; }));
  };
  json.member("holds", count(StressStatus::holds));
  json.member("fails", count(StressStatus::fails));
  json.member("refused", count(StressStatus::refused));
  double ratio = 0.0;
  for (const StressCase& c : cases) ratio = std::max(ratio, c.lapack_ratio);
  json.member("lapack_ratio_max", ratio);
  json.key("cases");
  json.begin_array();
  for (const StressCase& c : cases) {
    json.begin_object();
    json.member("name", std::string_view(c.name));
    json.member("family", std::string_view(c.family));
    json.member("status", text_of(c.status));
    json.member("expected", text_of(c.expected));
    if (!c.reason.empty()) json.member("reason", std::string_view(c.reason));
    json.member("promise", std::string_view(c.promise));
    json.member("measured", std::string_view(c.measured));
    if (!c.refusal.empty()) json.member("refusal", std::string_view(c.refusal));
    json.member("shortened", c.is_shortened);
    json.member("seconds", c.seconds);
    json.member("largest_error", c.largest_error);
    json.member("digits_lost", c.digits_lost);
    json.member("condition", c.condition);
    json.member("backward_error", c.backward_error);
    json.member("lapack_ratio", c.lapack_ratio);
    json.member("rank_error", c.rank_error);
    json.member("constraint_violation", c.constraint_violation);
    json.member("runs", static_cast<long long>(c.runs));
    json.member("steps", static_cast<long long>(c.steps));
    json.member("rejected", static_cast<long long>(c.rejected));
    json.member("iterations", static_cast<long long>(c.iterations));
    json.member("factorizations", static_cast<long long>(c.factorizations));
    json.key("figures");
    json.begin_array();
    for (const StressFigure& f : c.figures) {
      json.begin_object();
      json.member("name", std::string_view(f.name));
      json.member("value", f.value);
      if (f.limit < std::numeric_limits<double>::infinity()) json.member("limit", f.limit);
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.end_object();
  return json.text();
}

}  // namespace bough::stress
