/// bough sweep FILE: one scene in many cases.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <set>

#include "arguments.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/io/read_sweep.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/outlook.hpp"
#include "bough/study/cases.hpp"
#include "bough/study/collect.hpp"
#include "bough/study/journal.hpp"
#include "case_run.hpp"
#include "result_text.hpp"
#include "shard_run.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// The list refers to what it is made from.
study::CaseList batch_cases(const io::SweepSpec& spec, const study::SweepCases& made, const SweepArguments& arguments,
                            const std::filesystem::path& out) {
  study::CaseList cases(made.size(), [&spec, &made, &arguments, out](std::size_t i) {
    const study::SweepCase c = made.at(i);
    study::BatchCase one{c.name, spec.scene_file, out / c.name, study::overrides_of(spec, c), {}};
    one.overrides.insert(one.overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
    for (std::size_t k = 0; k < made.variables().size(); ++k)
      one.inputs.emplace_back(made.variables()[k], c.inputs[k].text);
    return one;
  });
  if (arguments.only.empty()) return cases;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < made.size(); ++i)
    if (std::find(arguments.only.begin(), arguments.only.end(), made.name(i)) != arguments.only.end())
      some.push_back(i);
  return study::chosen(cases, std::move(some));
}

bool has_case(const study::SweepCases& made, const std::string& name) {
  for (std::size_t i = 0; i < made.size(); ++i)
    if (made.name(i) == name) return true;
  return false;
}

/// How many cases, other than those named, have results in a folder. They would be lost, since the tables and the
/// journal of a folder are replaced as a whole.
std::size_t num_other_cases(const std::filesystem::path& folder, const std::vector<std::string>& only) {
  std::set<std::string> others;
  study::for_each_record(folder / study::journal_file,
                         [&](const std::string&, const study::CaseResult& result, std::string_view) {
                           const std::string& name = result.which.name;
                           if (std::find(only.begin(), only.end(), name) == only.end()) others.insert(name);
                         });
  return others.size();
}

/// What the cases will take: of some, evenly chosen, trial steps are taken. The others take the time that their size
/// lets expect, times the ratio of what was tried to what its size lets expect.
class Forecast {
 public:
  void look(std::size_t row, const scene::Scene& scene) {
    const run::Estimate e = run::estimate_run(scene);
    by_size_[row] = e.seconds();
    if (used_ > most_seconds) return;
    const auto begin = std::chrono::steady_clock::now();
    tried_[row] = run::forecast_seconds(scene);
    used_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    of_tried_ += tried_[row];
    of_size_ += e.seconds();
  }
  bool holds(std::size_t row) const { return by_size_.count(row) > 0; }
  double seconds(std::size_t row) const {
    if (const auto known = tried_.find(row); known != tried_.end()) return known->second;
    return by_size_.at(row) * (of_size_ > 0.0 ? of_tried_ / of_size_ : 1.0);
  }
  double all_seconds() const {
    double sum = 0.0;
    for (const auto& [row, size] : by_size_) sum += seconds(row);
    return sum;
  }
  std::size_t num_tried() const { return tried_.size(); }

 private:
  static constexpr double most_seconds = 2.0;  ///< for trial steps
  std::map<std::size_t, double> by_size_, tried_;
  double used_ = 0.0, of_tried_ = 0.0, of_size_ = 0.0;
};

/// The numbers below `count`, those first that divide it most evenly: 0, 1/2, 1/4, 3/4 of it and so on.
std::vector<std::size_t> spread(std::size_t count) {
  std::vector<std::size_t> order;
  std::vector<bool> is_in(count, false);
  for (std::size_t parts = 1; order.size() < count; parts *= 2)
    for (std::size_t k = 0; k < parts; ++k)
      if (const std::size_t i = k * count / parts; !is_in[i]) {
        is_in[i] = true;
        order.push_back(i);
      }
  return order;
}

/// Lists the cases and what they will take, and runs none. Of many it looks at a thousand.
int print_plan(const study::CaseList& cases, std::size_t left_out, int threads, const CaseSource& source) {
  constexpr std::size_t most_rows = 50, most_looks = 1000;
  const std::size_t every = std::max<std::size_t>(1, cases.size() / most_looks);
  std::vector<std::size_t> looked_at;
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (i < most_rows || i % every == 0) looked_at.push_back(i);
  Forecast forecast;
  std::map<std::size_t, std::string> refused;
  std::map<std::size_t, run::Estimate> sizes;
  double most_bytes = 0.0;
  for (const std::size_t k : spread(looked_at.size())) {
    const std::size_t i = looked_at[k];
    const io::SceneFile file = source.read(cases.at(i));
    if (!file.ok()) {
      refused[i] = file.problems.front().text();
      continue;
    }
    forecast.look(i, file.scene);
    sizes[i] = run::estimate_run(file.scene);
    most_bytes = std::max(most_bytes, sizes[i].memory_bytes);
  }
  std::vector<std::vector<std::string>> rows = {{"case"}};
  if (cases.size() > 0)
    for (const auto& [name, value] : cases.at(0).inputs) rows[0].push_back(name);
  for (const char* name : {"unknowns", "steps", "time", "memory"}) rows[0].emplace_back(name);
  for (std::size_t i = 0; i < std::min(most_rows, cases.size()); ++i) {
    const study::BatchCase c = cases.at(i);
    std::vector<std::string>& row = rows.emplace_back(1, c.name);
    for (const auto& [name, value] : c.inputs) row.push_back(value);
    if (forecast.holds(i))
      row.insert(row.end(), {io::rounded_text(sizes[i].unknowns, 6), io::rounded_text(sizes[i].steps, 6),
                             io::seconds_text(forecast.seconds(i)), io::bytes_text(sizes[i].memory_bytes)});
    else
      row.push_back("refused: " + refused[i]);
  }
  std::cout << table_text(rows);
  if (cases.size() > most_rows) std::cout << "and " << cases.size() - most_rows << " more\n";
  const double seconds = forecast.all_seconds() * static_cast<double>(cases.size()) /
                         static_cast<double>(std::max<std::size_t>(1, looked_at.size()));
  std::cout << cases.size() << " cases, " << left_out << " left out by conditions, " << refused.size() << " refused"
            << (looked_at.size() < cases.size() ? " of " + std::to_string(looked_at.size()) + " looked at" : "")
            << ": about " << io::seconds_text(seconds / threads) << " on " << threads
            << (threads == 1 ? " thread" : " threads") << " by trial steps of " << forecast.num_tried() << ", up to "
            << io::bytes_text(most_bytes) << " a case\n";
  return refused.empty() ? exit_done : exit_bad_input;
}

/// Of files that the scene names.
std::filesystem::path folder_of(const io::SweepSpec& spec) {
  return std::filesystem::path(spec.scene_file).parent_path();
}

std::vector<double> work_of_cases(const io::SweepSpec& spec, const study::SweepCases& made,
                                  const std::vector<std::string>& overrides) {
  return study::predicted_work(
      made.size(), [&made](std::size_t i) { return made.inputs(i); },
      [&](const std::vector<io::SweepValue>& inputs) {
        std::vector<std::string> changes = study::overrides_of(spec, {"", inputs});
        changes.insert(changes.end(), overrides.begin(), overrides.end());
        return work_of(io::read_scene_text(spec.scene_text, spec.scene_name, changes, folder_of(spec)));
      });
}

}  // namespace

int sweep(const SweepArguments& arguments) {
  const io::SweepFile file = io::read_sweep(arguments.file);
  print_problems(arguments.file, file.problems, file.warnings);
  if (!file.ok()) return exit_bad_input;
  const bool runs_here = arguments.job_engine.empty();
  if (arguments.out.empty() && !arguments.dry_run) {
    std::cerr << "bough: --out DIR is needed, but with --dry-run\n";
    return exit_bad_input;
  }
  study::SweepCases made;
  try {
    made = study::make_cases(file.spec);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_bad_input;
  }
  WholeBatch whole{.verb = "sweep",
                   .source = arguments.file,
                   .inputs = {arguments.file, file.spec.scene_file},
                   .list = study::cases_csv(made)};
  std::optional<study::Shard> shard;
  if (!arguments.shard.empty() && !arguments.dry_run) shard = shard_asked_for(arguments.shard);
  if (shard || (!runs_here && !arguments.dry_run)) {
    whole.list = list_for_shards(whole, arguments);
    if (const std::string why = study::adopt_cases(whole.list, made); !why.empty()) refuse_other_list(arguments, why);
  }
  whole.cases = batch_cases(file.spec, made, arguments, shard ? folder_of(arguments, *shard) : arguments.out);
  for (const std::string& name : arguments.only)
    if (!has_case(made, name)) {
      std::cerr << "bough: the sweep has no case " << name << "\n";
      return exit_bad_input;
    }
  if (whole.cases.size() == 0) {
    std::cerr << "bough: the conditions of the sweep leave no case\n";
    return exit_bad_input;
  }
  CaseSource source{[&](const study::BatchCase& which) {
                      return io::read_scene_text(file.spec.scene_text, file.spec.scene_name, which.overrides,
                                                 folder_of(file.spec));
                    },
                    [&](const study::BatchCase&) { return file.spec.scene_text; }};
  if (arguments.dry_run)
    return print_plan(whole.cases, made.left_out(), arguments.threads > 0 ? arguments.threads : default_threads(),
                      source);
  if (!runs_here) return export_jobs(whole, arguments, source);

  CaseSettings settings{arguments, file.spec.title.empty() ? file.spec.name : file.spec.title,
                        kept_of(arguments, whole.cases.size())};
  if (shard) {
    whole.work = [&] { return work_of_cases(file.spec, made, arguments.overrides); };
    take_shard(*shard, source, whole, settings);
  } else {
    source.cases_table = std::move(whole.list);
  }
  if (const std::size_t others =
          arguments.only.empty() || arguments.replace ? 0 : num_other_cases(settings.out, arguments.only);
      others > 0) {
    std::cerr << "bough: --case would replace the results of " << others << " other cases in " << settings.out.string()
              << ": give another folder with --out\n";
    return exit_bad_input;
  }
  io::OutputCollection collection(settings.out, take_folder(settings, whole.verb, whole.source), whole.inputs,
                                  io::Writers::one);
  const study::CaseTable results = run_cases(whole.cases, settings, source, collection);
  std::vector<study::MeasureSensitivity> sensitivities;  // of a shard they would be those of some rows
  if (!shard) sensitivities = study::sensitivities_of(file.spec, results);
  if (!arguments.quiet) print_sensitivities(sensitivities);
  return finish_cases(results, sensitivities, settings, collection);
}

}  // namespace bough::app
