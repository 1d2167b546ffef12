#include "bough/report/study_page.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/report/document.hpp"
#include "bough/study/errors.hpp"
#include "bough/version.hpp"

namespace bough::report {
namespace {

using study::SweepResult;
using study::SweepRun;
using study::SweepSeries;
using study::Verdict;

std::string count_text(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string run_pointer(std::size_t k) { return "/runs/" + std::to_string(k); }
std::string error_pointer(std::size_t k, std::size_t q, const char* norm) {
  return run_pointer(k) + "/errors/" + std::to_string(q) + "/" + norm;
}

bool is_ok(const SweepRun& run) { return run.status == records::RunStatus::ok; }

Tone tone_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
    case Verdict::explained:
      return Tone::good;
    case Verdict::below:
    case Verdict::above:
      return Tone::bad;
    case Verdict::not_stated:
    case Verdict::not_measured:
      break;
  }
  return Tone::soft;
}

std::string axis_unit(const std::string& name) { return name == "step size" ? " [s]" : ""; }

std::string error_label(const io::StudyQuantity& q) {
  return q.kind == io::QuantityKind::vector ? "largest error, relative" : "largest error [rad]";
}

class StudyPage {
 public:
  explicit StudyPage(const SweepResult& result)
      : r_(result),
        page_(result.spec.title.empty() ? result.spec.name : result.spec.title, lead(result), "study.json") {}

  std::string html() {
    verdict();
    advice();
    work_and_precision();
    for (std::size_t g = 0; g < r_.spec.grids.size(); ++g) grid(g);
    failures();
    appendix();
    return page_.html();
  }

 private:
  static std::string lead(const SweepResult& r) {
    return "Scene " + r.spec.scene_name + ": " + count_text(r.num_runs(), "run", "runs") + ", " +
           std::to_string(r.num_failed()) +
           " failed. Errors are the largest over the sample times, relative to the largest value of the reference; of "
           "rotations, the angle between the two in rad. Run times are medians of " +
           std::to_string(r.repetitions) + " repetitions taken in turns.";
  }

  /// The grid's name if there are several, and the choices that are not on the abscissa.
  std::string series_name(const SweepSeries& s) const {
    const std::string& grid = r_.spec.grids[s.grid].name;
    return s.label == grid || r_.spec.grids.size() == 1 ? s.label : grid + ": " + s.label;
  }

  void verdict() {
    if (r_.was_stopped) page_.paragraph("The study was stopped before its end.", Tone::bad);
    for (const study::SweepReference& reference : r_.references)
      if (!reference.trouble.empty()) page_.paragraph("No errors: " + reference.trouble + ".", Tone::bad);
    const std::size_t held = r_.num_orders(Verdict::holds) + r_.num_orders(Verdict::explained),
                      failed = r_.num_orders(Verdict::below) + r_.num_orders(Verdict::above);
    if (held + failed == 0) return;
    page_.paragraph(count_text(held, "order", "orders") + " of convergence as theory states" +
                        (failed == 0 ? "." : ", " + std::to_string(failed) + " not: see the tables of orders."),
                    failed == 0 ? Tone::good : Tone::bad);
  }

  void advice() {
    page_.section("What to choose", "choose");
    if (std::any_of(r_.advice.begin(), r_.advice.end(),
                    [](const study::SweepAdvice& a) { return a.errors_of != "all"; }))
      page_.paragraph(
          "Errors of time are those of steps and integrator on the mesh of the grid, errors of space those of its "
          "meshes at equal steps: a run makes "
          "both, so choose for each.",
          Tone::soft);
    Table table{{"quantity", "errors of", "wanted error", "run time [s]", "error", "choice"}, {}};
    for (const study::SweepAdvice& a : r_.advice) {
      std::vector<Cell> row{{r_.spec.quantities[a.quantity].name}, {a.errors_of}, number_cell(a.wanted)};
      if (a.run) {
        const SweepRun& run = r_.runs[*a.run];
        row.push_back(number_cell(study::spread_of(run.wall).median, 3, run_pointer(*a.run) + "/seconds/median"));
        row.push_back(number_cell(run.errors[a.quantity].max, 3, error_pointer(*a.run, a.quantity, "max")));
        row.push_back({full_label(run)});
      } else {
        row.push_back({"-", Tone::soft, true});
        row.push_back({"-", Tone::soft, true});
        row.push_back({"none of these runs", Tone::soft});
      }
      table.rows.push_back(std::move(row));
    }
    page_.table(table);
  }

  std::string full_label(const SweepRun& run) const {
    return r_.spec.grids.size() == 1 ? run.label : r_.spec.grids[run.grid].name + ": " + run.label;
  }

  std::string point_note(const SweepRun& run, std::size_t q) const {
    return full_label(run) + ": error " + io::rounded_text(run.errors[q].max, 3) + " in " +
           io::rounded_text(study::spread_of(run.wall).median, 3) + " s";
  }

  ChartSeries chart_series(std::size_t s, std::size_t q, bool over_time) const {
    const SweepSeries& series = r_.series[s];
    ChartSeries out{series_name(series), {}, {}, static_cast<int>(s)};
    for (const std::size_t k : series.runs) {
      const SweepRun& run = r_.runs[k];
      const double x = over_time ? study::spread_of(run.wall).median : run.abscissa;
      if (is_ok(run))
        out.points.push_back({x, run.errors[q].max, point_note(run, q), error_pointer(k, q, "max")});
      else
        out.failures.push_back({x, 0.0, full_label(run) + ": " + run.cause});
    }
    return out;
  }

  void work_and_precision() {
    page_.section("Work and precision", "work");
    std::vector<Chart> charts;
    for (std::size_t q = 0; q < r_.spec.quantities.size(); ++q) {
      const io::StudyQuantity& quantity = r_.spec.quantities[q];
      Chart chart{quantity.name, {"run time [s]", Scale::log}, {error_label(quantity), Scale::log}, {}};
      for (std::size_t s = 0; s < r_.series.size(); ++s) chart.series.push_back(chart_series(s, q, true));
      charts.push_back(std::move(chart));
    }
    page_.charts(charts);
  }

  void grid(std::size_t g) {
    const io::StudyGrid& grid = r_.spec.grids[g];
    const io::StudyAxis& axis = grid.axes[grid.abscissa];
    page_.section("Convergence: " + grid.name, "grid-" + std::to_string(g));
    references(g);
    std::vector<Chart> charts;
    for (std::size_t q = 0; q < r_.spec.quantities.size(); ++q) {
      const io::StudyQuantity& quantity = r_.spec.quantities[q];
      Chart chart{
          quantity.name, {axis.name + axis_unit(axis.name), Scale::log}, {error_label(quantity), Scale::log}, {}};
      for (std::size_t s = 0; s < r_.series.size(); ++s)
        if (r_.series[s].grid == g) {
          chart.series.push_back(chart_series(s, q, false));
          chart.series.back().name = r_.series[s].label;
          if (chart.slopes.empty()) add_slope(chart, r_.series[s], q, axis.larger_is_finer);
        }
      charts.push_back(std::move(chart));
    }
    for (const std::string& figure : r_.spec.figures) add_figure(figure, g, charts);
    page_.charts(charts);
    orders(g);
    pairs(g);
    runs(g);
  }

  /// A figure of the solver over the abscissa, if a run of the grid has it.
  void add_figure(const std::string& figure, std::size_t g, std::vector<Chart>& charts) const {
    const io::StudyAxis& axis = r_.spec.grids[g].axes[r_.spec.grids[g].abscissa];
    Chart chart{figure, {axis.name + axis_unit(axis.name), Scale::log}, {figure, Scale::log}, {}};
    for (std::size_t s = 0; s < r_.series.size(); ++s) {
      if (r_.series[s].grid != g) continue;
      ChartSeries series{r_.series[s].label, {}, {}, static_cast<int>(s)};
      for (const std::size_t k : r_.series[s].runs)
        if (const double value = r_.runs[k].figure(figure); is_ok(r_.runs[k]) && std::isfinite(value))
          series.points.push_back({r_.runs[k].abscissa, value,
                                   full_label(r_.runs[k]) + ": " + io::rounded_text(value, 3),
                                   run_pointer(k) + "/solver/" + figure});
      if (!series.points.empty()) chart.series.push_back(std::move(series));
    }
    if (!chart.series.empty()) charts.push_back(std::move(chart));
  }

  /// A line with the theoretical slope, a little below the finest error of the fit.
  void add_slope(Chart& chart, const SweepSeries& series, std::size_t q, bool larger_is_finer) const {
    const study::OrderFit& f = series.fits[q];
    if (std::isnan(f.expected) || f.runs.empty()) return;
    const SweepRun& finest = r_.runs[f.runs.back()];
    chart.slopes.push_back({finest.abscissa, 0.5 * finest.errors[q].max, larger_is_finer ? -f.expected : f.expected,
                            "order " + io::rounded_text(f.expected, 3), true});
  }

  void references(std::size_t g) {
    const study::SweepReference& reference = r_.references[g];
    Table table{{"quantity", "compared with", "its own error", "largest value", "unit"}, {}};
    for (std::size_t q = 0; q < r_.spec.quantities.size(); ++q) {
      const std::string at = "/grids/" + std::to_string(g) + "/references/" + std::to_string(q);
      const std::string& source = reference.sources[q];
      table.rows.push_back({{r_.spec.quantities[q].name},
                            {reference.kinds[q] + (source.empty() ? "" : ": " + source)},
                            number_cell(reference.uncertainties[q], 2, at + "/uncertainty"),
                            number_cell(reference.scales[q], 4, at + "/scale"),
                            {r_.spec.quantities[q].unit}});
    }
    page_.table(table);
  }

  void orders(std::size_t g) {
    Table table{{"runs", "quantity", "order found", "theory", "verdict", "from"}, {}};
    std::vector<std::string> theories;
    for (std::size_t s = 0; s < r_.series.size(); ++s) {
      if (r_.series[s].grid != g) continue;
      for (std::size_t q = 0; q < r_.spec.quantities.size(); ++q) {
        const study::OrderFit& f = r_.series[s].fits[q];
        const std::string at = "/series/" + std::to_string(s) + "/orders/" + std::to_string(q);
        const std::string why = f.verdict == Verdict::explained ? ": " + f.explanation : "";
        table.rows.push_back({{r_.series[s].label},
                              {r_.spec.quantities[q].name},
                              number_cell(f.order, 3, std::isnan(f.order) ? "" : at + "/found"),
                              number_cell(f.expected, 3, std::isnan(f.expected) ? "" : at + "/theory"),
                              {text_of(f.verdict) + why, tone_of(f.verdict)},
                              {count_text(f.runs.size(), "run", "runs"), Tone::soft}});
        if (!f.theory.empty() && std::find(theories.begin(), theories.end(), f.theory) == theories.end())
          theories.push_back(f.theory);
      }
    }
    page_.subsection("Orders");
    page_.table(table);
    for (const std::string& theory : theories) page_.paragraph("Theory: " + theory + ".", Tone::soft);
  }

  /// What runs of h and 2 h tell of the error of the first, and what their extrapolation leaves.
  void pairs(std::size_t g) {
    Table table{{"runs", "quantity", "error", "told over true", "error extrapolated", "time [s]", "time of both [s]"},
                {}};
    for (std::size_t k = 0; k < r_.runs.size(); ++k) {
      const SweepRun& run = r_.runs[k];
      if (run.grid != g || !run.pair) continue;
      const SweepRun& fine = r_.runs[run.pair->first];
      for (std::size_t q = 0; q < run.errors.size(); ++q) {
        if (std::isnan(run.told_over_true[q])) continue;
        table.rows.push_back(
            {{fine.label},
             {r_.spec.quantities[q].name},
             measured(fine.errors[q].max, 3, error_pointer(run.pair->first, q, "max")),
             measured(run.told_over_true[q], 3, run_pointer(k) + "/told_over_true/" + std::to_string(q)),
             measured(run.errors[q].max, 3, error_pointer(k, q, "max")),
             measured(study::spread_of(fine.wall).median, 3, run_pointer(run.pair->first) + "/seconds/median"),
             measured(study::spread_of(run.wall).median, 3, run_pointer(k) + "/seconds/median")});
      }
    }
    if (table.rows.empty()) return;
    page_.subsection("Pairs of runs with steps h and 2 h");
    page_.paragraph(
        "Told over true: the error of the run with h as the difference of both tells it, over the error "
        "against the reference.");
    page_.table(table);
  }

  void runs(std::size_t g) {
    page_.subsection("Runs");
    Table table{{"choices"}, {}};
    for (const io::StudyQuantity& q : r_.spec.quantities) table.head.push_back("error of " + q.name);
    for (const std::string& figure : r_.spec.figures) table.head.push_back(figure);
    for (const char* name : {"time [s]", "from", "to", "steps", "rejected", "Newton", "factorizations"})
      table.head.emplace_back(name);
    for (std::size_t k = 0; k < r_.runs.size(); ++k) {
      const SweepRun& run = r_.runs[k];
      if (run.grid != g) continue;
      const std::string at = run_pointer(k);
      std::vector<Cell> row{{run.label + (is_ok(run) ? "" : " (failed)"), is_ok(run) ? Tone::plain : Tone::bad}};
      for (std::size_t q = 0; q < run.errors.size(); ++q)
        row.push_back(measured(run.errors[q].max, 3, error_pointer(k, q, "max")));
      for (const std::string& figure : r_.spec.figures)
        row.push_back(measured(run.figure(figure), 3, at + "/solver/" + figure));
      const study::Spread wall = study::spread_of(run.wall);
      row.push_back(measured(wall.median, 3, at + "/seconds/median"));
      row.push_back(measured(wall.low, 3, at + "/seconds/low"));
      row.push_back(measured(wall.high, 3, at + "/seconds/high"));
      row.push_back(count(run.steps.accepted, at + "/steps"));
      row.push_back(count(run.steps.rejected, at + "/rejected"));
      row.push_back(count(run.steps.newton_iterations, at + "/newton_iterations"));
      row.push_back(count(run.steps.factorizations, at + "/factorizations"));
      table.rows.push_back(std::move(row));
    }
    page_.table(table);
  }

  static Cell measured(double value, int digits, const std::string& at) {
    return std::isnan(value) ? Cell{"-", Tone::soft, true} : number_cell(value, digits, at);
  }
  static Cell count(long value, const std::string& at) { return {std::to_string(value), Tone::plain, true, at}; }

  void failures() {
    Table table{{"run", "cause"}, {}};
    for (const SweepRun& run : r_.runs) {
      if (!is_ok(run)) table.rows.push_back({{full_label(run)}, {run.cause, Tone::bad}});
      if (!run.is_repeatable) table.rows.push_back({{full_label(run)}, {"repetitions differ", Tone::bad}});
    }
    if (table.rows.empty()) return;
    page_.section("Failures", "failures");
    page_.table(table);
  }

  void appendix() {
    page_.section("How it was measured", "appendix");
    const study::SweepMachine& machine = r_.machine;
    page_.table(
        {{"what", ""},
         {{{"program"}, {"bough " + std::string(version) + ", commit " + std::string(commit)}},
          {{"compiler"}, {std::string(compiler) + ", " + std::string(compiler_flags)}},
          {{"processor"},
           {machine.processor + ", " + count_text(static_cast<std::size_t>(machine.cores), "core", "cores")}},
          {{"instruction set"}, {machine.instruction_set}},
          {{"system"}, {machine.system}},
          {{"date"}, {r_.date}},
          {{"repetitions"},
           {std::to_string(r_.repetitions) + ", in rounds over all runs, forwards and backwards in turn"}},
          {{"errors"},
           {r_.spec.sample_interval > 0.0
                ? "at every " + io::rounded_text(r_.spec.sample_interval, 6) +
                      (r_.spec.is_dynamic ? " s, at the ends of steps, without interpolation" : " of the load factor")
                : "at the end"}},
          {{"run time"}, {"of the steps: without reading the scene, its plan and tree, and output"}},
          {{"orders"},
           {"slope of log error over log step, least squares over " + std::to_string(study::fitted_points) +
            " errors in a row, the finest that the reference's own error leaves certain to " +
            io::rounded_text(study::largest_doubt, 2) + "; an order holds within " +
            io::rounded_text(study::order_tolerance, 2)}}}});
    page_.paragraph(
        "study.json and study.csv beside this page hold all figures, root mean squares and values at the end among "
        "them.",
        Tone::soft);
  }

  const SweepResult& r_;
  Document page_;
};

}  // namespace

std::string study_html(const SweepResult& result) { return StudyPage(result).html(); }

StudyEntry entry_of(const SweepResult& r) {
  StudyEntry entry{r.spec.name,
                   r.spec.title,
                   r.num_runs(),
                   r.num_failed(),
                   r.num_orders(Verdict::holds) + r.num_orders(Verdict::explained),
                   r.num_orders(Verdict::below) + r.num_orders(Verdict::above),
                   {}};
  for (const study::SweepReference& reference : r.references)
    if (entry.trouble.empty()) entry.trouble = reference.trouble;
  if (r.was_stopped) entry.trouble = "stopped before its end";
  return entry;
}

std::string study_index_html(const std::vector<StudyEntry>& entries) {
  Document page("Studies", "Error against run time, one page a scene. bough " + std::string(version) + ", commit " +
                               std::string(commit) + ".");
  Table table{{"study", "runs", "failed", "orders as in theory", "not", ""}, {}};
  for (const StudyEntry& e : entries) {
    const auto count = [](std::size_t n, Tone tone = Tone::plain) { return Cell{std::to_string(n), tone, true}; };
    table.rows.push_back({{e.title.empty() ? e.name : e.title, Tone::plain, false, "", e.name + "/study.html"},
                          count(e.num_runs),
                          count(e.num_failed, e.num_failed == 0 ? Tone::plain : Tone::bad),
                          count(e.num_orders_held),
                          count(e.num_orders_failed, e.num_orders_failed == 0 ? Tone::plain : Tone::bad),
                          {e.trouble, Tone::bad}});
  }
  page.table(table);
  return page.html();
}

}  // namespace bough::report
