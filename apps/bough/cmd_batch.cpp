/// bough batch FOLDER: every scene of a folder, one thread a case.
#include <algorithm>
#include <chrono>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/study/batch.hpp"
#include "bough/study/estimate.hpp"
#include "bough/study/simulate.hpp"
#include "bough/version.hpp"
#include "memory_limit.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// Enough to know what is meant; `bough check` tells all.
std::string first_problems(const io::SceneFile& file) {
  constexpr std::size_t shown = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(shown, file.problems.size()); ++k) text += file.problems[k].text() + "\n";
  if (file.problems.size() > shown) text += "and " + std::to_string(file.problems.size() - shown) + " more problems";
  return text;
}

/// Runs in the case's own process.
int run_case(const study::BatchCase& which, const BatchArguments& arguments, double memory_limit,
             study::CaseReport& report) {
  catch_interrupts(Repeated::ignored);
  const auto start = std::chrono::steady_clock::now();
  const io::SceneFile file = io::read_scene(which.scene, arguments.overrides);
  if (!file.ok()) {
    report.cause = first_problems(file);
    return exit_bad_input;
  }
  report.cause = study::refusal(file.scene, memory_limit);
  if (!report.cause.empty()) return exit_bad_input;
  io::RunDirectory directory(which.directory, std::string(version), origin_of(which.scene, file, arguments.overrides));
  study::SimulateOptions options{.threads = 1};
  options.stopped_by = [&]() -> std::string {
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - start;
    const bool is_late = arguments.time_limit > 0.0 && age.count() >= 0.99 * arguments.time_limit;
    return is_late ? "the time limit of " + io::rounded_text(arguments.time_limit, 6) + " s" : "the user";
  };
  results::Summary summary;
  try {
    directory.open();
    summary = study::simulate(file.scene, options, directory, [](const results::Progress&) { return !interrupted(); });
  } catch (const std::exception& error) {
    report.cause = cause_of(error);
    summary.scene = file.scene.name;
    directory.end_as_failed(summary, cause_of(error));
    if (directory.has_ended()) report.directory = directory.directory();
    return exit_failed;
  }
  report.cause = summary.cause;
  report.directory = directory.directory();
  return summary.status == results::RunStatus::ok ? exit_done : exit_failed;
}

void print_case(const study::CaseResult& result, std::size_t done, std::size_t all, bool quiet) {
  const bool good = result.status == study::CaseStatus::ok;
  if (good && quiet) return;
  (good ? std::cout : std::cerr) << "[" << done << "/" << all << "] " << result.which.name << ": "
                                 << study::text_of(result.status) << (result.cause.empty() ? "" : ": ") << result.cause
                                 << std::endl;
}

}  // namespace

int batch(const BatchArguments& arguments) {
  study::BatchOptions options{arguments.folder, arguments.out,
                              arguments.threads > 0 ? arguments.threads : default_threads(), arguments.time_limit};
  std::size_t num_cases = 1;
  try {
    num_cases = std::max<std::size_t>(1, study::cases_in(options).size());
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_bad_input;
  }
  const io::OutputCollection collection(options.out, "batch", {arguments.folder});
  const double memory_limit = (arguments.memory_limit > 0.0 ? arguments.memory_limit : available_memory()) /
                              static_cast<double>(std::min(num_cases, static_cast<std::size_t>(options.threads)));
  catch_interrupts();
  const std::vector<study::CaseResult> results = study::run_batch(
      options,
      [&](const study::BatchCase& which, study::CaseReport& report) {
        return run_case(which, arguments, memory_limit, report);
      },
      [&](const study::CaseResult& result, std::size_t done, std::size_t all) {
        print_case(result, done, all, arguments.quiet);
      },
      interrupted);
  collection.write("batch.csv", study::batch_csv(results));

  const auto count = [&](const auto& condition) { return std::count_if(results.begin(), results.end(), condition); };
  const auto num_failed = count([](const study::CaseResult& r) {
    return r.status != study::CaseStatus::ok && r.status != study::CaseStatus::figures_fail;
  });
  const auto num_not_as_expected = count([](const study::CaseResult& r) { return r.expected_fails > 0; });
  if (!arguments.quiet) {
    std::cout << results.size() << " cases, " << num_failed << " not done, " << num_not_as_expected
              << " with an expected figure that fails: " << (options.out / "batch.csv").string() << "\n";
  }
  return num_failed > 0 || (arguments.check_expected && num_not_as_expected > 0) ? exit_failed : exit_done;
}

}  // namespace bough::app
