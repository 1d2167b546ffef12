#include <algorithm>
#include <cmath>

#include "bough/io/history.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"
#include "bough/study/sweep.hpp"
#include "bough/version.hpp"

namespace bough::study {
namespace {

const char* status_text(records::RunStatus status) {
  switch (status) {
    case records::RunStatus::ok:
      return "ok";
    case records::RunStatus::failed:
      return "failed";
    case records::RunStatus::interrupted:
      return "interrupted";
  }
  return "";
}

const char* kind_text(io::QuantityKind kind) { return kind == io::QuantityKind::vector ? "vector" : "rotation"; }

/// Names of all axes, in the order in which the grids name them.
std::vector<std::string> axis_names(const io::StudySpec& spec) {
  std::vector<std::string> names;
  for (const io::StudyGrid& grid : spec.grids)
    for (const io::StudyAxis& axis : grid.axes)
      if (std::find(names.begin(), names.end(), axis.name) == names.end()) names.push_back(axis.name);
  return names;
}

std::string choice_along(const io::StudyGrid& grid, const SweepRun& run, const std::string& name) {
  for (std::size_t a = 0; a < grid.axes.size(); ++a)
    if (grid.axes[a].name == name) return grid.axes[a].choices[run.choices[a]].label;
  return {};
}

/// Measured numbers; null where there is none (a run that failed, a machine that does not tell).
void measured(io::JsonText& json, std::string_view name, double value) {
  json.key(name);
  if (std::isnan(value))
    json.raw("null");
  else
    json.value(value);
}

void write_spread(io::JsonText& json, const char* name, const std::vector<double>& values) {
  const Spread s = spread_of(values);
  json.key(name);
  json.begin_object();
  measured(json, "median", s.median);
  measured(json, "low", s.low);
  measured(json, "high", s.high);
  json.end_object();
}

template <class List, class Write>
void write_list(io::JsonText& json, const char* name, const List& list, const Write& write) {
  json.key(name);
  json.begin_array();
  for (const auto& item : list) write(item);
  json.end_array();
}

long long wide(std::size_t n) { return static_cast<long long>(n); }

void write_environment(io::JsonText& json, const SweepResult& r) {
  json.key("environment");
  json.begin_object();
  json.member("program", "bough " + std::string(version));
  json.member("commit", std::string_view(commit));
  json.member("compiler", std::string_view(compiler));
  json.member("options", std::string_view(compiler_flags));
  json.member("instruction_set", std::string_view(r.machine.instruction_set));
  json.member("processor", std::string_view(r.machine.processor));
  json.member("cores", static_cast<long long>(r.machine.cores));
  json.member("system", std::string_view(r.machine.system));
  json.member("date", std::string_view(r.date));
  json.member("repetitions", static_cast<long long>(r.repetitions));
  json.member("runs_at_a_time_for_errors", static_cast<long long>(r.threads));
  json.end_object();
}

void write_quantities(io::JsonText& json, const SweepResult& r) {
  write_list(json, "quantities", r.spec.quantities, [&](const io::StudyQuantity& q) {
    json.begin_object();
    json.member("name", std::string_view(q.name));
    json.member("kind", kind_text(q.kind));
    json.member("unit", std::string_view(q.unit));
    json.end_object();
  });
}

void write_grids(io::JsonText& json, const SweepResult& r) {
  json.key("grids");
  json.begin_array();
  for (std::size_t g = 0; g < r.spec.grids.size(); ++g) {
    const io::StudyGrid& grid = r.spec.grids[g];
    const SweepReference& reference = r.references[g];
    json.begin_object();
    json.member("name", std::string_view(grid.name));
    json.member("abscissa", std::string_view(grid.axes[grid.abscissa].name));
    json.key("references");
    json.begin_array();
    for (std::size_t q = 0; q < r.spec.quantities.size(); ++q) {
      json.begin_object();
      json.member("kind", std::string_view(reference.kinds[q]));
      json.member("source", std::string_view(reference.sources[q]));
      json.member("errors_of", std::string_view(reference.errors_of[q]));
      measured(json, "uncertainty", reference.uncertainties[q]);
      json.member("scale", reference.scales[q]);
      json.end_object();
    }
    json.end_array();
    if (!reference.trouble.empty()) json.member("trouble", std::string_view(reference.trouble));
    json.end_object();
  }
  json.end_array();
}

void write_run(io::JsonText& json, const SweepResult& r, const SweepRun& run) {
  const io::StudyGrid& grid = r.spec.grids[run.grid];
  json.begin_object();
  json.member("grid", std::string_view(grid.name));
  json.key("choices");
  json.begin_object();
  for (std::size_t a = 0; a < grid.axes.size(); ++a)
    json.member(grid.axes[a].name, std::string_view(grid.axes[a].choices[run.choices[a]].label));
  json.end_object();
  json.member("abscissa", run.abscissa);
  json.member("status", status_text(run.status));
  if (!run.cause.empty()) json.member("cause", std::string_view(run.cause));
  write_list(json, "errors", run.errors, [&](const ErrorNorms& e) {
    json.begin_object();
    measured(json, "max", e.max);
    measured(json, "rms", e.rms);
    measured(json, "end", e.end);
    json.end_object();
  });
  json.member("samples", wide(run.num_samples));
  write_spread(json, "seconds", run.wall);
  write_spread(json, "cpu_seconds", run.cpu);
  json.member("steps", static_cast<long long>(run.steps.accepted));
  json.member("rejected", static_cast<long long>(run.steps.rejected));
  json.member("newton_iterations", static_cast<long long>(run.steps.newton_iterations));
  json.member("factorizations", static_cast<long long>(run.steps.factorizations));
  json.key("solver");
  json.begin_object();
  for (const auto& [name, value] : run.solver) measured(json, name, value);
  json.end_object();
  measured(json, "instructions", run.instructions.value_or(unmeasured));
  json.member("repeatable", run.is_repeatable);
  if (run.pair) {
    write_list(json, "pair", std::vector{run.pair->first, run.pair->second},
               [&](std::size_t k) { json.value(wide(k)); });
    write_list(json, "told_over_true", run.told_over_true, [&](double x) {
      if (std::isnan(x))
        json.raw("null");
      else
        json.value(x);
    });
  }
  json.end_object();
}

void write_series(io::JsonText& json, const SweepResult& r) {
  write_list(json, "series", r.series, [&](const SweepSeries& series) {
    json.begin_object();
    json.member("grid", std::string_view(r.spec.grids[series.grid].name));
    json.member("label", std::string_view(series.label));
    write_list(json, "runs", series.runs, [&](std::size_t k) { json.value(wide(k)); });
    write_list(json, "orders", series.fits, [&](const OrderFit& f) {
      json.begin_object();
      measured(json, "found", f.order);
      measured(json, "theory", f.expected);
      json.member("verdict", text_of(f.verdict));
      write_list(json, "runs", f.runs, [&](std::size_t k) { json.value(wide(k)); });
      if (!f.theory.empty()) json.member("source", std::string_view(f.theory));
      if (!f.explanation.empty()) json.member("explanation", std::string_view(f.explanation));
      json.end_object();
    });
    json.end_object();
  });
}

}  // namespace

double SweepRun::figure(const std::string& name) const {
  for (const auto& [known, value] : solver)
    if (known == name) return value;
  return unmeasured;
}

std::string sweep_json(const SweepResult& r) {
  io::JsonText json;
  json.begin_object();
  json.member("schema_version", 1LL);
  json.member("study", std::string_view(r.spec.name));
  json.member("title", std::string_view(r.spec.title));
  json.member("scene", std::string_view(r.spec.scene_name));
  json.member("stopped", r.was_stopped);
  write_environment(json, r);
  write_quantities(json, r);
  write_grids(json, r);
  write_list(json, "runs", r.runs, [&](const SweepRun& run) { write_run(json, r, run); });
  write_series(json, r);
  write_list(json, "advice", r.advice, [&](const SweepAdvice& a) {
    json.begin_object();
    json.member("quantity", std::string_view(r.spec.quantities[a.quantity].name));
    json.member("errors_of", std::string_view(a.errors_of));
    json.member("wanted", a.wanted);
    json.key("run");
    a.run ? json.value(wide(*a.run)) : json.raw("null");
    json.end_object();
  });
  json.end_object();
  return json.text();
}

std::string sweep_csv(const SweepResult& r) {
  const std::vector<std::string> names = axis_names(r.spec);
  std::string csv = "grid";
  for (const std::string& name : names) csv += "," + io::csv_field(name);
  csv +=
      ",status,cause,quantity,error_max,error_rms,error_end,reference_uncertainty,steps,rejected,newton_iterations,"
      "factorizations,flops_per_factorization,instructions,seconds_median,seconds_low,seconds_high,"
      "cpu_seconds_median,is_pair,told_over_true\n";
  const auto number = [&csv](double x) {
    csv += ',';
    if (!std::isnan(x)) io::append_number(csv, x);
  };
  for (const SweepRun& run : r.runs) {
    const io::StudyGrid& grid = r.spec.grids[run.grid];
    for (std::size_t q = 0; q < r.spec.quantities.size(); ++q) {
      csv += io::csv_field(grid.name);
      for (const std::string& name : names) csv += "," + io::csv_field(choice_along(grid, run, name));
      csv += std::string(",") + status_text(run.status) + "," + io::csv_field(run.cause) + "," +
             io::csv_field(r.spec.quantities[q].name);
      for (const double e : {run.errors[q].max, run.errors[q].rms, run.errors[q].end}) number(e);
      number(r.references[run.grid].uncertainties[q]);
      for (const long n :
           {run.steps.accepted, run.steps.rejected, run.steps.newton_iterations, run.steps.factorizations})
        csv += "," + std::to_string(n);
      const Spread wall = spread_of(run.wall);
      for (const double x : {run.figure("flops_per_factorization"), run.instructions.value_or(unmeasured), wall.median,
                             wall.low, wall.high, spread_of(run.cpu).median})
        number(x);
      csv += run.pair ? ",true" : ",false";
      number(run.pair ? run.told_over_true[q] : unmeasured);
      csv += '\n';
    }
  }
  return csv;
}

}  // namespace bough::study
