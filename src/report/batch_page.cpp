#include "bough/report/batch_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include "batch_cases.hpp"
#include "batch_script.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/report/document.hpp"
#include "bough/report/plot.hpp"
#include "svg_text.hpp"

namespace bough::report {
namespace {

using study::CaseResult;
using study::CaseStatus;
using study::CaseTable;

/// Whether a case went well but for the doubts of its run.
bool is_good_but_doubted(const CaseTable& results, std::uint32_t i) {
  return is_good(results.status(i)) && !results.at(i).report.doubts.empty();
}

Table status_table(const CaseTable& results, const std::vector<std::uint32_t>& ended) {
  std::map<std::pair<CaseStatus, bool>, std::size_t> counts;
  for (const std::uint32_t i : ended) ++counts[{results.status(i), is_good_but_doubted(results, i)}];
  Table table{{"status", "cases"}, {}};
  for (const auto& [kind, count] : counts)
    table.rows.push_back(
        {{std::string(study::text_of(kind.first)) + (kind.second ? ", not to be trusted as it is" : ""),
          is_good(kind.first) && !kind.second ? Tone::good : Tone::bad},
         number_cell(static_cast<double>(count), 9)});
  return table;
}

/// The text of a cause without its numbers; causes that differ only in numbers are counted together.
std::string kind_of(const std::string& cause) {
  std::string kind;
  for (std::size_t i = 0; i < cause.size() && kind.size() < 160; ++i) {
    const bool is_digit = cause[i] >= '0' && cause[i] <= '9';
    if (!is_digit)
      kind += cause[i];
    else if (kind.empty() || kind.back() != '#')
      kind += '#';
  }
  return kind;
}

/// Failures by cause, the most frequent first.
Table failure_table(const CaseTable& results, const std::vector<std::uint32_t>& ended) {
  constexpr std::size_t most_groups = 50, most_names = 5;
  struct Group {
    std::string status, example, names;
    std::size_t count = 0;
  };
  std::map<std::string, Group> groups;
  for (const std::uint32_t i : ended) {
    if (is_good(results.status(i))) continue;
    const CaseResult r = results.at(i);
    Group& g = groups[std::string(study::text_of(r.status)) + " " + kind_of(r.cause)];
    if (g.count == 0) {
      g.status = study::text_of(r.status);
      g.example = r.cause;
    }
    if (g.count < most_names) g.names += (g.count > 0 ? ", " : "") + r.which.name;
    if (g.count == most_names) g.names += ", ...";
    ++g.count;
  }
  std::vector<const Group*> order;
  for (const auto& [key, group] : groups) order.push_back(&group);
  std::stable_sort(order.begin(), order.end(), [](const Group* a, const Group* b) { return a->count > b->count; });
  Table table{{"status", "cause, of the first", "cases", "which"}, {}};
  for (const Group* g : order) {
    if (table.rows.size() == most_groups) break;
    table.rows.push_back(
        {{g->status, Tone::bad}, {g->example}, number_cell(static_cast<double>(g->count), 9), {g->names}});
  }
  return table;
}

double at_share(const Measured& m, double share) {
  return m.values[static_cast<std::size_t>(share * static_cast<double>(m.values.size() - 1) + 0.5)];
}

Table measure_table(const std::vector<Measured>& all, const CaseTable& results, std::size_t num_ended) {
  // The number of cases with a value is shown only if some have none, since the table is nearly as wide as the page.
  const bool is_whole =
      std::all_of(all.begin(), all.end(), [&](const Measured& m) { return m.values.size() == num_ended; });
  Table table{{"measure", "mean", "deviation", "least", "in case", "5 %", "median", "95 %", "largest", "in case"}, {}};
  if (!is_whole) table.head.insert(table.head.begin() + 1, "cases");
  for (const Measured& m : all) {
    if (m.values.empty()) continue;
    const double count = static_cast<double>(m.values.size());
    const double mean = std::accumulate(m.values.begin(), m.values.end(), 0.0) / count;
    double squares = 0.0;
    for (const double x : m.values) squares += (x - mean) * (x - mean);
    table.rows.push_back({{m.title()},
                          number_cell(mean, 5),
                          number_cell(m.values.size() > 1 ? std::sqrt(squares / (count - 1.0))
                                                          : std::numeric_limits<double>::quiet_NaN()),
                          number_cell(m.values.front(), 5),
                          {results.cases().at(m.cases.front()).name},
                          number_cell(at_share(m, 0.05), 5),
                          number_cell(at_share(m, 0.5), 5),
                          number_cell(at_share(m, 0.95), 5),
                          number_cell(m.values.back(), 5),
                          {results.cases().at(m.cases.back()).name}});
    if (!is_whole) table.rows.back().insert(table.rows.back().begin() + 1, number_cell(count, 9));
  }
  return table;
}

/// Of an indicator: in how many cases it is 1, with the interval of Wilson (J. Am. Stat. Assoc. 22, 1927) for the
/// probability. A count that happens to be 0 or 1 in all cases is none.
std::optional<std::string> share_text(const Measured& m) {
  const auto is = [&m](double x) { return std::count(m.values.begin(), m.values.end(), x); };
  const double n = static_cast<double>(m.values.size()), hits = static_cast<double>(is(1.0));
  if (m.values.empty() || !m.is_indicator) return std::nullopt;
  constexpr double z = 1.959963984540054;  // of 95 %
  const double p = hits / n, middle = (p + 0.5 * z * z / n) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + 0.25 * z * z / (n * n));
  const auto percent = [](double share) { return io::rounded_text(100.0 * std::clamp(share, 0.0, 1.0), 3); };
  return m.name + ": in " + io::rounded_text(hits, 9) + " of " + io::rounded_text(n, 9) + " cases, " + percent(p) +
         " %. Were the cases independent draws, the probability would lie between " + percent(middle - half) + " and " +
         percent(middle + half) + " % with a confidence of 95 %.";
}

constexpr double paper_width = 468.0, plot_left = 60.0, plot_right = 452.0;

std::string rectangle(double x, double y, double width, double height, std::string_view classes,
                      const std::string& note) {
  return "<rect class=\"" + std::string(classes) + "\" x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" width=\"" +
         pixel(width) + "\" height=\"" + pixel(height) + "\"><title>" + escaped(note) + "</title></rect>\n";
}

std::string text_at(double x, double y, std::string_view classes, std::string_view anchor, const std::string& text) {
  return "<text class=\"" + std::string(classes) + "\" x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" text-anchor=\"" +
         std::string(anchor) + "\">" + escaped(text) + "</text>\n";
}

std::string svg_of(double height, const std::string& inner) {
  return "<svg viewBox=\"0 0 " + pixel(paper_width) + " " + pixel(height) +
         "\" xmlns=\"http://www.w3.org/2000/svg\">\n" + "<rect class=\"paper\" width=\"" + pixel(paper_width) +
         "\" height=\"" + pixel(height) + "\"/>\n" + inner + "</svg>\n";
}

bool is_error(const Measured& m) { return m.name.ends_with(study::error_ending); }

/// Errors of the values of a measure, in their order; not a number where twins do not know it. Empty: none was measured.
std::vector<double> errors_of(const Measured& m, const std::vector<Measured>& all) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Measured& other) {
    return other.name == m.name + std::string(study::error_ending);
  });
  if (found == all.end()) return {};
  std::map<std::uint32_t, double> error_of;
  for (std::size_t k = 0; k < found->values.size(); ++k) error_of[found->cases[k]] = std::abs(found->values[k]);
  std::vector<double> errors;
  for (const std::uint32_t i : m.cases) {
    const auto error = error_of.find(i);
    errors.push_back(error != error_of.end() ? error->second : std::numeric_limits<double>::quiet_NaN());
  }
  return errors;
}

/// "errors: median 2e-05, largest 1e-03; 3 of 500 are not known"
std::string errors_text(std::vector<double> errors) {
  const std::size_t all = errors.size();
  std::erase_if(errors, [](double e) { return std::isnan(e); });
  std::sort(errors.begin(), errors.end());
  std::string text = errors.empty() ? "no error is known"
                                    : "errors: median " + io::rounded_text(errors[errors.size() / 2], 2) +
                                          ", largest " + io::rounded_text(errors.back(), 2);
  if (!errors.empty() && errors.size() < all)
    text += "; " + std::to_string(all - errors.size()) + " of " + std::to_string(all) + " are not known";
  return text;
}

/// Histogram with equal intervals, about as many as the square root of the number of values. Where errors are known a
/// line in each column reaches from the number of values that lie in its interval whatever their errors are to that of
/// values that may lie there.
std::string histogram(const Measured& m, const std::vector<double>& errors) {
  constexpr double top = 34.0, bottom = 170.0;
  const double low = m.values.front(), high = m.values.back();
  const double root = std::sqrt(static_cast<double>(m.values.size()));
  const std::size_t bins = high > low ? static_cast<std::size_t>(std::clamp(root, 5.0, 40.0)) : 1;
  std::vector<std::size_t> counts(bins), least(bins), largest(bins);
  const auto bin_of = [&](double x) {
    const double share = high > low ? std::clamp((x - low) / (high - low), 0.0, 1.0) : 0.0;
    return std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)));
  };
  for (std::size_t k = 0; k < m.values.size(); ++k) {
    const double x = m.values[k], e = errors.empty() || std::isnan(errors[k]) ? 0.0 : errors[k];
    ++counts[bin_of(x)];
    const std::size_t first = bin_of(x - e), last = bin_of(x + e);
    for (std::size_t b = first; b <= last; ++b) ++largest[b];
    if (first == last) ++least[first];
  }
  const double most = static_cast<double>(*std::max_element(largest.begin(), largest.end()));
  const double width = (plot_right - plot_left) / static_cast<double>(bins);
  std::string inner = text_at(plot_left, 20.0, "ink head", "start", m.title());
  for (std::size_t k = 0; k < bins; ++k) {
    if (largest[k] == 0) continue;
    const double height = (bottom - top) * static_cast<double>(counts[k]) / most;
    const auto edge = [&](std::size_t i) {
      return io::rounded_text(low + (high - low) * static_cast<double>(i) / static_cast<double>(bins), 5);
    };
    inner += rectangle(plot_left + width * static_cast<double>(k) + 0.5, bottom - height, std::max(1.0, width - 1.0),
                       height, "s0 solid",
                       edge(k) + " to " + edge(k + 1) + ": " + std::to_string(counts[k]) + " cases" +
                           (least[k] < largest[k]
                                ? ", by their errors " + std::to_string(least[k]) + " to " + std::to_string(largest[k])
                                : ""));
    if (least[k] == largest[k]) continue;
    const auto to_y = [&](std::size_t n) { return bottom - (bottom - top) * static_cast<double>(n) / most; };
    const double middle = plot_left + width * (static_cast<double>(k) + 0.5);
    inner += line_element("mark", middle, to_y(least[k]), middle, to_y(largest[k]));
  }
  if (!errors.empty()) inner += text_at(plot_left, bottom + 32.0, "soft tiny", "start", errors_text(errors));
  inner += text_at(plot_left - 6.0, top + 4.0, "soft tiny", "end", io::rounded_text(most, 6));
  inner += text_at(plot_left, bottom + 16.0, "soft tiny", "start", io::rounded_text(low, 5));
  inner += text_at(plot_right, bottom + 16.0, "soft tiny", "end", io::rounded_text(high, 5));
  return svg_of(bottom + (errors.empty() ? 26.0 : 42.0), inner);
}

/// Shortens a name so that it fits beside a plot.
std::string shortened(const std::string& name) {
  constexpr std::size_t most = 16;
  return io::shown(name, most);
}

/// Bars of the indices of one measure, one colour an index, with intervals of confidence.
std::string index_bars(const study::MeasureSensitivity& s) {
  constexpr double bar = 16.0, gap = 10.0, left = 120.0;
  double most = 0.0;
  for (const auto& of : s.of.values)
    for (const study::Index& i : of)
      most = std::max({most, std::abs(i.value), std::abs(i.high.value_or(0.0)), std::abs(i.low.value_or(0.0))});
  if (!(most > 0.0)) most = 1.0;
  const auto to_x = [&](double value) {
    return left + (plot_right - 40.0 - left) * std::min(1.0, std::abs(value) / most);
  };
  std::string inner = text_at(16.0, 20.0, "ink head", "start", s.measure);
  double legend = 200.0;
  for (std::size_t i = 0; i < s.of.indices.size(); ++i) {
    const std::string colour = "s" + std::to_string(i % 6) + " solid";
    inner += rectangle(legend, 11.0, 10.0, 10.0, colour, s.of.indices[i]);
    inner += text_at(legend + 14.0, 20.0, "soft tiny", "start", s.of.indices[i]);
    legend += 26.0 + 7.0 * static_cast<double>(s.of.indices[i].size());
  }
  double y = 34.0;
  for (std::size_t k = 0; k < s.variables.size(); ++k) {
    inner += text_at(left - 6.0, y + 0.5 * bar * static_cast<double>(s.of.indices.size()) + 4.0, "ink tiny", "end",
                     shortened(s.variables[k]));
    for (std::size_t i = 0; i < s.of.indices.size(); ++i, y += bar) {
      const study::Index& index = s.of.values[i][k];
      inner += rectangle(left, y + 1.0, to_x(index.value) - left, bar - 2.0, "s" + std::to_string(i % 6) + " solid",
                         s.variables[k] + ", " + s.of.indices[i] + ": " + io::rounded_text(index.value, 4));
      if (index.low && index.high)
        inner += line_element("mark", to_x(std::max(0.0, *index.low)), y + 0.5 * bar, to_x(*index.high), y + 0.5 * bar);
      const double end = std::max(to_x(index.value), index.high ? to_x(*index.high) : left);
      inner += text_at(end + 4.0, y + bar - 2.0, "soft tiny", "start", io::rounded_text(index.value, 2));
    }
    y += gap;
  }
  return svg_of(y + 8.0, inner);
}

void add_sensitivities(Document& page, const std::vector<study::MeasureSensitivity>& sensitivities) {
  if (sensitivities.empty()) return;
  page.section("What decides them");
  const std::string& method = sensitivities.front().of.method;
  page.paragraph(
      method == "morris"
          ? "Elementary effects: change of the measure over that of the quantile. mu: mean, mu_star: mean "
            "of magnitudes, sigma: deviation, which interactions and curvature make."
      : method == "sobol_indices"
          ? "Sobol's indices: the share of the variance that a variable has alone (first), and with all its "
            "interactions (total). Lines are intervals of confidence of 95 %."
          : "Coefficients of a linear fit of standardised values (src) and of ranks (srrc); bars show magnitudes.",
      Tone::soft);
  std::vector<std::string> drawings;
  for (const study::MeasureSensitivity& s : sensitivities) drawings.push_back(index_bars(s));
  page.figures(drawings);
  for (const study::MeasureSensitivity& s : sensitivities)
    if (s.of.explained)
      page.paragraph(s.measure + ": a linear function explains " + io::rounded_text(100.0 * *s.of.explained, 3) +
                         " % of the variance, and " + io::rounded_text(100.0 * *s.of.explained_ranks, 3) +
                         " % of that of ranks.",
                     Tone::soft);
}

}  // namespace

std::string batch_page(const CaseTable& results, const std::string& title,
                       const std::vector<study::MeasureSensitivity>& sensitivities, bool goes_on) {
  const std::vector<std::uint32_t> ended = ended_cases(results, goes_on);
  const auto good = static_cast<std::size_t>(
      std::count_if(ended.begin(), ended.end(), [&](std::uint32_t i) { return is_good(results.status(i)); }));
  const auto doubted =
      std::count_if(ended.begin(), ended.end(), [&](std::uint32_t i) { return is_good_but_doubted(results, i); });
  std::string lead = std::to_string(ended.size()) + " cases, " + std::to_string(good) + " ok";
  if (doubted > 0) lead += ", " + std::to_string(doubted) + " of them not to be trusted without a closer look";
  lead += ".";
  if (goes_on)
    lead += " The batch goes on: " + std::to_string(results.size() - ended.size()) + " of " +
            std::to_string(results.size()) + " are left.";
  Document page(title, lead);
  page.section("What came of them");
  page.table(status_table(results, ended));
  if (good < ended.size()) {
    page.subsection("Causes");
    page.table(failure_table(results, ended));
  }
  const std::vector<Measured> measured = measured_in(results);
  if (!measured.empty()) {
    page.section("What was measured");
    for (const Measured& m : measured)
      if (const std::optional<std::string> share = share_text(m)) page.paragraph(*share);
    page.table(measure_table(measured, results, ended.size()));
    constexpr std::size_t most_histograms = 24;
    std::vector<std::string> drawings;
    for (const Measured& m : measured)
      if (!m.values.empty() && !is_error(m) && drawings.size() < most_histograms)
        drawings.push_back(histogram(m, errors_of(m, measured)));
    page.figures(drawings);
  }
  add_sensitivities(page, sensitivities);
  page.section("Cases");
  const Cases cases = cases_of(results, ended, measured);
  page.paragraph(
      cases.shown.size() < ended.size()
          ? "The extreme cases of every measure, failures and a sample, " + std::to_string(cases.shown.size()) +
                " in all; batch.csv holds every case."
          : "A click on a heading sorts, one on a row or point selects; selected cases have links to their views.",
      Tone::soft);
  page.markup("<div id=\"scatter\"></div>\n<div id=\"cases\">\n");
  page.table(case_table(cases, measured));
  page.markup("</div>\n");
  page.program("batch", cases_json(cases, measured), batch_script);
  return page.html();
}

}  // namespace bough::report
