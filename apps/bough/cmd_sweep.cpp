/// bough sweep FILE: one scene in many cases.
#include <algorithm>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/history.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/io/read_sweep.hpp"
#include "bough/study/cases.hpp"
#include "bough/study/estimate.hpp"
#include "case_run.hpp"
#include "result_text.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

constexpr std::size_t most_folders = 200;  // of cases, unless more are asked for

std::vector<study::BatchCase> batch_cases(const io::SweepSpec& spec, const study::SweepCases& made,
                                          const SweepArguments& arguments) {
  std::vector<study::BatchCase> cases;
  for (const study::SweepCase& c : made.cases) {
    if (!arguments.only.empty() &&
        std::find(arguments.only.begin(), arguments.only.end(), c.name) == arguments.only.end())
      continue;
    study::BatchCase one{c.name, spec.scene_file, arguments.out / c.name, study::overrides_of(spec, c), {}};
    one.overrides.insert(one.overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
    for (std::size_t k = 0; k < made.variables.size(); ++k)
      one.inputs.emplace_back(made.variables[k], c.inputs[k].text);
    cases.push_back(std::move(one));
  }
  return cases;
}

/// All cases with what they change, for whoever runs them again.
std::string cases_csv(const study::SweepCases& made) {
  std::string text = "case";
  for (const std::string& name : made.variables) text += ',' + io::csv_field(name);
  text += '\n';
  for (const study::SweepCase& c : made.cases) {
    text += c.name;
    for (const io::SweepValue& v : c.inputs) text += ',' + io::csv_field(v.text);
    text += '\n';
  }
  return text;
}

/// Lists the cases and what they will take, and runs none. Of many it looks at a thousand.
int print_plan(const std::vector<study::BatchCase>& cases, std::size_t left_out, int threads,
               const CaseSource& source) {
  constexpr std::size_t most_rows = 50, most_looks = 1000;
  const std::size_t every = std::max<std::size_t>(1, cases.size() / most_looks);
  std::vector<std::vector<std::string>> rows = {{"case"}};
  for (std::size_t k = 0; !cases.empty() && k < cases.front().inputs.size(); ++k)
    rows[0].push_back(cases.front().inputs[k].first);
  for (const char* name : {"unknowns", "steps", "time", "memory"}) rows[0].emplace_back(name);
  double seconds = 0.0, most_bytes = 0.0;
  std::size_t bad = 0, looked_at = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (i >= most_rows && i % every != 0) continue;
    ++looked_at;
    std::vector<std::string> row = {cases[i].name};
    for (const auto& [name, value] : cases[i].inputs) row.push_back(value);
    const io::SceneFile file = source.read(cases[i]);
    if (file.ok()) {
      const study::Estimate e = study::estimate_run(file.scene);
      seconds += e.seconds();
      most_bytes = std::max(most_bytes, e.memory_bytes);
      row.insert(row.end(), {io::rounded_text(e.unknowns, 6), io::rounded_text(e.steps, 6),
                             io::seconds_text(e.seconds()), io::bytes_text(e.memory_bytes)});
    } else {
      ++bad;
      row.push_back("refused: " + file.problems.front().text());
    }
    if (i < most_rows) rows.push_back(std::move(row));
  }
  std::cout << table_text(rows);
  if (cases.size() > most_rows) std::cout << "and " << cases.size() - most_rows << " more\n";
  seconds *= static_cast<double>(cases.size()) / static_cast<double>(std::max<std::size_t>(1, looked_at));
  std::cout << cases.size() << " cases, " << left_out << " left out by conditions, " << bad << " refused"
            << (looked_at < cases.size() ? " of " + std::to_string(looked_at) + " looked at" : "") << ": about "
            << io::seconds_text(seconds / threads) << " on " << threads << (threads == 1 ? " thread" : " threads")
            << ", up to " << io::bytes_text(most_bytes) << " a case\n";
  return bad > 0 ? exit_bad_input : exit_done;
}

/// "0.31 (0.28 to 0.34)"
std::string index_text(const study::Index& index) {
  std::string text = io::rounded_text(index.value, 3);
  if (index.low && index.high)
    text += " (" + io::rounded_text(*index.low, 3) + " to " + io::rounded_text(*index.high, 3) + ")";
  return text;
}

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

}  // namespace

int sweep(const SweepArguments& arguments) {
  const io::SweepFile file = io::read_sweep(arguments.file);
  print_problems(arguments.file, file.problems, file.warnings);
  if (!file.ok()) return exit_bad_input;
  study::SweepCases made;
  try {
    made = study::make_cases(file.spec);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_bad_input;
  }
  const std::vector<study::BatchCase> cases = batch_cases(file.spec, made, arguments);
  for (const std::string& name : arguments.only)
    if (std::none_of(cases.begin(), cases.end(), [&](const study::BatchCase& c) { return c.name == name; })) {
      std::cerr << "bough: the sweep has no case " << name << "\n";
      return exit_bad_input;
    }
  if (cases.empty()) {
    std::cerr << "bough: the conditions of the sweep leave no case\n";
    return exit_bad_input;
  }
  CaseSource source{[&](const study::BatchCase& which) {
                      return io::read_scene_text(file.spec.scene_text, file.spec.scene_name, which.overrides);
                    },
                    [&](const study::BatchCase&) { return file.spec.scene_text; }};
  if (arguments.dry_run)
    return print_plan(cases, made.left_out, arguments.threads > 0 ? arguments.threads : default_threads(), source);
  if (arguments.out.empty()) {
    std::cerr << "bough: --out DIR is needed, but with --dry-run\n";
    return exit_bad_input;
  }
  source.cases_table = cases_csv(made);
  const io::OutputCollection collection(arguments.out, "sweep", {arguments.file, file.spec.scene_file});
  const bool keeps = arguments.keep == "all" || (arguments.keep == "few" && cases.size() <= most_folders);
  const std::string title = file.spec.title.empty() ? file.spec.name : file.spec.title;
  const CaseSettings settings{
      arguments.out,   title,           arguments.threads,        arguments.time_limit, arguments.memory_limit,
      keeps,           arguments.quiet, arguments.check_expected, arguments.stop_after, arguments.retries,
      arguments.resume};
  const std::vector<study::CaseResult> results = run_cases(cases, settings, source, collection);
  const std::vector<study::MeasureSensitivity> sensitivities = study::sensitivities_of(file.spec, results);
  if (!arguments.quiet) print_sensitivities(sensitivities);
  return finish_cases(results, sensitivities, settings, collection);
}

}  // namespace bough::app
