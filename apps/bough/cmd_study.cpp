/// bough study SPEC: errors and run times of a scene over grids of choices.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "arguments.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/io/read_study.hpp"
#include "bough/study/sweep.hpp"
#include "memory_limit.hpp"
#include "pages.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// The study, or all of a folder by name.
bool is_folder_of_studies(const std::filesystem::path& path) {
  std::error_code unknown;  // of a link that leads to itself: a study that cannot be read
  return std::filesystem::is_directory(path, unknown);
}

std::vector<std::filesystem::path> specs_in(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> specs;
  if (!is_folder_of_studies(path)) return {path};
  for (const auto& entry : std::filesystem::directory_iterator(path))
    if (entry.path().extension() == ".json") specs.push_back(entry.path());
  std::sort(specs.begin(), specs.end());
  return specs;
}

void print_counts(const study::SweepResult& r, const std::filesystem::path& page) {
  std::cout << r.spec.name << ": " << r.num_runs() << " runs, " << r.num_failed()
            << " failed; orders: " << r.num_orders(study::Verdict::holds) + r.num_orders(study::Verdict::explained)
            << " as in theory, " << r.num_orders(study::Verdict::below) + r.num_orders(study::Verdict::above)
            << " not\n";
  if (!page.empty()) std::cout << page.string() << "\n";
  std::cout << std::flush;
}

/// Whether anything was measured: an error at all, and one order where theory states any.
bool has_measured(const study::SweepResult& r) {
  const bool has_error = std::any_of(r.runs.begin(), r.runs.end(), [](const study::SweepRun& run) {
    return std::any_of(run.errors.begin(), run.errors.end(), [](const auto& e) { return std::isfinite(e.max); });
  });
  using study::Verdict;
  const std::size_t measured = r.num_orders(Verdict::holds) + r.num_orders(Verdict::explained) +
                               r.num_orders(Verdict::above) + r.num_orders(Verdict::below);
  return has_error && (measured > 0 || r.num_orders(Verdict::not_measured) == 0);
}

/// Everything that keeps a study from being a success, on standard error; true where there is nothing.
bool tell_faults(const study::SweepResult& r) {
  bool is_good = true;
  const auto tell = [&](const std::string& text) {
    std::cerr << "bough: " << r.spec.name << ": " << text << "\n";
    is_good = false;
  };
  for (const study::SweepReference& reference : r.references)
    if (!reference.trouble.empty()) tell(reference.trouble);
  for (const study::SweepSeries& series : r.series)
    for (std::size_t q = 0; q < series.fits.size(); ++q) {
      const study::OrderFit& f = series.fits[q];
      if (f.verdict != study::Verdict::below && f.verdict != study::Verdict::above) continue;
      tell(r.spec.grids[series.grid].name + ", " + series.label + ", " + r.spec.quantities[q].name + ": order " +
           io::rounded_text(f.order, 4) + ", theory " + io::rounded_text(f.expected, 4));
    }
  for (const study::SweepRun& run : r.runs)
    if (!run.is_repeatable) tell(run.label + ": repetitions end with different numbers");
  if (r.was_stopped)
    tell("it was stopped before its end");
  else if (!has_measured(r))
    tell(std::to_string(r.num_runs()) + " runs, " + std::to_string(r.num_failed()) +
         " of them failed, show no error or order that could be measured; study.csv says why each run failed");
  return is_good;
}

study::SweepOptions options_of(const StudyArguments& arguments) {
  study::SweepOptions options;
  options.threads = arguments.threads > 0 ? arguments.threads : default_threads();
  options.cache = arguments.cache.empty() ? arguments.out / "references" : arguments.cache;
  options.repetitions = arguments.repetitions;
  options.memory_limit = arguments.memory_limit > 0.0 ? arguments.memory_limit : available_memory();
  options.stop = interrupted;
  return options;
}

study::SweepResult run_one(const io::StudySpec& spec, const StudyArguments& arguments) {
  study::SweepOptions options = options_of(arguments);
  std::size_t tenth = 0;
  if (!arguments.quiet)
    options.progress = [&](const std::string& what, std::size_t done, std::size_t all) {
      if (done * 10 / all == tenth && done != all) return;
      tenth = done == all ? 0 : done * 10 / all;
      std::cerr << spec.name << ": " << what << " " << done << "/" << all << std::endl;
    };
  return study::run_sweep(spec, options);
}

io::Owner owner_of(const StudyArguments& arguments) {
  return {.verb = "study", .source = arguments.spec, .replaces = arguments.replace};
}

/// Runs one study into its folder and tells of it; whether it is a success.
bool run_into(const std::filesystem::path& directory, const io::StudySpec& spec, const StudyArguments& arguments,
              const std::vector<std::filesystem::path>& inputs, StudyPages& pages) {
  io::OutputFolder folder(directory, owner_of(arguments), {"study.csv", "study.json", "study.html"}, inputs);
  const study::SweepResult result = run_one(spec, arguments);
  folder.write("study.csv", study::sweep_csv(result));
  folder.write("study.json", study::sweep_json(result));
  const std::string page = pages.write(folder, "study.html", result);
  folder.publish(result.was_stopped ? io::FolderState::failed : io::FolderState::good);
  tell_if_beside(folder);
  if (!arguments.quiet) print_counts(result, page.empty() ? std::filesystem::path() : folder.folder() / page);
  return tell_faults(result);
}

}  // namespace

int study_scene(const StudyArguments& arguments) {
  const std::vector<std::filesystem::path> files = specs_in(arguments.spec);
  const bool is_folder = is_folder_of_studies(arguments.spec);
  if (files.empty()) {
    std::cerr << "bough: " << arguments.spec.string() << ": there is no study (*.json) in this folder\n";
    return exit_bad_input;
  }
  std::vector<io::StudySpec> specs;
  for (const std::filesystem::path& file : files) {
    io::StudyFile study = io::read_study(file);
    print_problems(file, study.problems, arguments.quiet ? std::vector<io::Problem>() : study.warnings);
    if (study.ok()) specs.push_back(std::move(study.spec));
  }
  if (specs.size() != files.size()) return exit_bad_input;
  bool is_refused = false;
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const std::string why = study::refusal(specs[k], options_of(arguments));
    if (!why.empty()) std::cerr << files[k].string() << ": " << why << "\n";
    is_refused = is_refused || !why.empty();
  }
  if (is_refused) return exit_bad_input;

  std::optional<io::OutputCollection> collection;
  if (is_folder) collection.emplace(arguments.out, owner_of(arguments), files);
  catch_interrupts();
  StudyPages pages;
  std::string index;
  bool all_good = true;
  for (const io::StudySpec& spec : specs) {
    if (interrupted()) break;
    all_good =
        run_into(is_folder ? arguments.out / spec.name : arguments.out, spec, arguments, files, pages) && all_good;
    if (collection) index = pages.write_index(*collection, "index.html");
  }
  if (!index.empty() && !arguments.quiet) std::cout << (arguments.out / index).string() << "\n";
  if (interrupted()) std::cerr << "bough: stopped before all studies were done\n";
  return all_good && !interrupted() ? exit_done : exit_failed;
}

}  // namespace bough::app
