/// bough batch FOLDER: every scene of a folder, one thread a case.
#include <algorithm>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/study/batch.hpp"
#include "bough/study/simulate.hpp"
#include "bough/version.hpp"
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
int run_case(const study::BatchCase& which, const std::vector<std::string>& overrides, std::string& cause) {
  const io::SceneFile file = io::read_scene(which.scene, overrides);
  if (!file.ok()) {
    cause = first_problems(file);
    return exit_bad_input;
  }
  io::RunDirectory directory(which.directory, std::string(version));
  results::Summary summary;
  try {
    summary =
        study::simulate(file.scene, {.threads = 1}, directory, [](const results::Progress&) { return !interrupted(); });
  } catch (const std::exception& error) {
    cause = error.what();
    summary.scene = file.scene.name;
    directory.end_as_failed(summary, error.what());
    return exit_failed;
  }
  cause = summary.cause;
  return summary.status == results::RunStatus::ok ? exit_done : exit_failed;
}

}  // namespace

int batch(const BatchArguments& arguments) {
  study::BatchOptions options{arguments.folder, arguments.out,
                              arguments.threads > 0 ? arguments.threads : default_threads(), arguments.time_limit};
  try {
    (void)study::cases_in(options);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return exit_bad_input;
  }
  std::filesystem::create_directories(options.out);
  catch_interrupts();
  const auto report_case = [&](const study::CaseResult& result, std::size_t done, std::size_t all) {
    const bool good = result.status == study::CaseStatus::ok;
    if (good && arguments.quiet) return;
    (good ? std::cout : std::cerr) << "[" << done << "/" << all << "] " << result.which.name << ": "
                                   << study::text_of(result.status) << (result.cause.empty() ? "" : ": ")
                                   << result.cause << std::endl;
  };
  const std::vector<study::CaseResult> results = study::run_batch(
      options,
      [&](const study::BatchCase& which, std::string& cause) { return run_case(which, arguments.overrides, cause); },
      report_case, interrupted);
  io::write_file(options.out / "batch.csv", study::batch_csv(results));

  const auto count = [&](const auto& condition) { return std::count_if(results.begin(), results.end(), condition); };
  const auto num_failed = count([](const study::CaseResult& r) { return r.status != study::CaseStatus::ok; });
  const auto num_not_as_expected = count([](const study::CaseResult& r) { return r.expected_fails > 0; });
  if (!arguments.quiet) {
    std::cout << results.size() << " cases, " << num_failed << " not done, " << num_not_as_expected
              << " with an expected figure that fails: " << (options.out / "batch.csv").string() << "\n";
  }
  return num_failed > 0 || (arguments.check_expected && num_not_as_expected > 0) ? exit_failed : exit_done;
}

}  // namespace bough::app
