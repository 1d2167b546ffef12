/// bough run SCENE: one simulation from a scene to a directory of results.
#include <algorithm>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/study/simulate.hpp"
#include "bough/version.hpp"
#include "result_text.hpp"
#include "terminal.hpp"

namespace bough::app {

int run(const RunArguments& arguments) {
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, arguments.quiet);
  if (!file.ok()) return exit_bad_input;

  io::RunDirectory directory(arguments.out.empty() ? std::filesystem::path(file.scene.name + ".out") : arguments.out,
                             std::string(version));
  catch_interrupts();
  ProgressBar bar(arguments.quiet);
  const auto on_step = [&bar](const results::Progress& progress) {
    bar.show(progress);
    return !interrupted();
  };
  study::SimulateOptions options;
  options.threads = arguments.threads > 0 ? arguments.threads : default_threads();
  results::Summary summary;
  try {
    summary = study::simulate(file.scene, options, directory, on_step);
  } catch (const std::exception& error) {  // the results could not be written to their end: keep what is there
    bar.clear();
    std::cerr << "bough: " << error.what() << "\n";
    summary.scene = file.scene.name;
    summary.threads = options.threads;
    directory.end_as_failed(summary, error.what());
    return exit_failed;
  }
  bar.clear();
  if (!arguments.quiet)
    std::cout << result_text(summary, directory.directory().string(), directory.files()) << std::flush;
  if (summary.status != results::RunStatus::ok) {
    std::cerr << "bough: " << file.scene.name << ": " << summary.cause << "\n";
    return exit_failed;
  }
  const bool all_hold = std::all_of(summary.expected.begin(), summary.expected.end(),
                                    [](const auto& figure) { return figure.holds || !figure.reached; });
  return arguments.check_expected && !all_hold ? exit_failed : exit_done;
}

}  // namespace bough::app
