/// bough study SPEC: errors and run times of a scene over grids of choices.
#include <algorithm>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/read_study.hpp"
#include "bough/study/sweep.hpp"
#include "pages.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// The study, or all of a folder by name.
std::vector<std::filesystem::path> specs_in(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> specs;
  if (!std::filesystem::is_directory(path)) return {path};
  for (const auto& entry : std::filesystem::directory_iterator(path))
    if (entry.path().extension() == ".json") specs.push_back(entry.path());
  std::sort(specs.begin(), specs.end());
  return specs;
}

void print_result(const study::SweepResult& r, const std::filesystem::path& page) {
  std::cout << r.spec.name << ": " << r.runs.size() << " runs, " << r.num_failed()
            << " failed; orders: " << r.num_orders(study::Verdict::holds) + r.num_orders(study::Verdict::explained)
            << " as in theory, " << r.num_orders(study::Verdict::below) + r.num_orders(study::Verdict::above)
            << " not\n";
  for (const study::SweepReference& reference : r.references)
    if (!reference.trouble.empty()) std::cerr << "bough: " << r.spec.name << ": " << reference.trouble << "\n";
  for (const study::SweepSeries& series : r.series)
    for (std::size_t q = 0; q < series.fits.size(); ++q) {
      const study::OrderFit& f = series.fits[q];
      if (f.verdict != study::Verdict::below && f.verdict != study::Verdict::above) continue;
      std::cerr << "bough: " << r.spec.name << ": " << r.spec.grids[series.grid].name << ", " << series.label << ", "
                << r.spec.quantities[q].name << ": order " << f.order << ", theory " << f.expected << "\n";
    }
  if (!page.empty()) std::cout << page.string() << "\n";
  std::cout << std::flush;
}

bool is_good(const study::SweepResult& r) {
  const bool has_references = std::all_of(r.references.begin(), r.references.end(),
                                          [](const study::SweepReference& x) { return x.trouble.empty(); });
  const bool is_repeatable =
      std::all_of(r.runs.begin(), r.runs.end(), [](const study::SweepRun& run) { return run.is_repeatable; });
  return has_references && is_repeatable && !r.was_stopped &&
         r.num_orders(study::Verdict::below) + r.num_orders(study::Verdict::above) == 0;
}

study::SweepResult run_one(const io::StudySpec& spec, const StudyArguments& arguments,
                           const std::filesystem::path& directory) {
  study::SweepOptions options;
  options.threads = arguments.threads > 0 ? arguments.threads : default_threads();
  options.cache = arguments.cache.empty() ? arguments.out / "references" : arguments.cache;
  options.repetitions = arguments.repetitions;
  options.stop = interrupted;
  std::size_t tenth = 0;
  if (!arguments.quiet)
    options.progress = [&](const std::string& what, std::size_t done, std::size_t all) {
      if (done * 10 / all == tenth && done != all) return;
      tenth = done == all ? 0 : done * 10 / all;
      std::cerr << spec.name << ": " << what << " " << done << "/" << all << std::endl;
    };
  study::SweepResult result = study::run_sweep(spec, options);
  std::filesystem::create_directories(directory);
  io::write_file(directory / "study.csv", study::sweep_csv(result));
  io::write_file(directory / "study.json", study::sweep_json(result));
  return result;
}

}  // namespace

int study_scene(const StudyArguments& arguments) {
  const std::vector<std::filesystem::path> files = specs_in(arguments.spec);
  const bool is_folder = std::filesystem::is_directory(arguments.spec);
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

  catch_interrupts();
  StudyPages pages;
  std::filesystem::path index;
  bool all_good = true;
  try {
    for (const io::StudySpec& spec : specs) {
      if (interrupted()) break;
      const std::filesystem::path directory = is_folder ? arguments.out / spec.name : arguments.out;
      const study::SweepResult result = run_one(spec, arguments, directory);
      const std::filesystem::path page = pages.write(directory / "study.html", result);
      if (!arguments.quiet) print_result(result, page);
      all_good = all_good && is_good(result);
      if (is_folder) index = pages.write_index(arguments.out / "index.html");
    }
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return exit_failed;
  }
  if (!index.empty() && !arguments.quiet) std::cout << index.string() << "\n";
  return all_good && !interrupted() ? exit_done : exit_failed;
}

}  // namespace bough::app
