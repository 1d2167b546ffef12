/// bough run SCENE: one simulation from a scene to a directory of results.
#include <algorithm>
#include <iostream>
#include <optional>

#include "arguments.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/run/simulate.hpp"
#include "bough/version.hpp"
#include "memory_limit.hpp"
#include "result_text.hpp"
#include "terminal.hpp"

namespace bough::app {

namespace {

/// Runs the scene; what cannot be written to its end is kept as far as it goes. Nothing, after a message, where there
/// are no results.
std::optional<records::Summary> simulate_into(io::RunDirectory& directory, const io::SceneFile& file,
                                              const RunArguments& arguments) {
  catch_interrupts();
  ProgressBar bar(arguments.quiet);
  const auto on_step = [&](const records::Progress& progress) {
    bar.show(progress);
    directory.note_progress(progress);
    return !interrupted();
  };
  run::SimulateOptions options;
  options.threads = arguments.threads > 0 ? arguments.threads : default_threads();
  records::Summary summary;
  try {
    summary = run::simulate(file.scene, options, directory, on_step);
  } catch (const std::exception& error) {
    bar.clear();
    std::cerr << "bough: " << cause_of(error) << "\n";
    summary.scene = file.scene.name;
    summary.threads = options.threads;
    directory.end_as_failed(summary, cause_of(error));
    return std::nullopt;
  }
  bar.clear();
  return summary;
}

}  // namespace

int run(const RunArguments& arguments) {
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, arguments.quiet);
  if (!file.ok()) return exit_bad_input;
  if (refuse_for_memory(arguments.scene, file.scene, arguments.memory_limit)) return exit_bad_input;
  io::RunDirectory directory(arguments.out.empty() ? std::filesystem::path(file.scene.name + ".out") : arguments.out,
                             std::string(version), origin_of(arguments.scene, file, arguments.overrides),
                             arguments.replace,
                             {file.scene.output.checkpoint, file.scene.output.checkpoint_time, arguments.resume});
  directory.open();
  for (const std::string& text : directory.told())
    if (!arguments.quiet) std::cerr << "bough: " << file.scene.name << ": " << text << "\n";
  const std::optional<records::Summary> summary = simulate_into(directory, file, arguments);
  if (!summary) return exit_failed;
  if (!arguments.quiet)
    std::cout << result_text(*summary, directory.directory().string(), directory.files()) << std::flush;
  else
    std::cerr << doubts_text(*summary, "bough: " + file.scene.name + ": ");
  if (summary->status != records::RunStatus::ok)
    std::cerr << "bough: " << file.scene.name << ": " << summary->cause << "\n";
  if (const std::string why = directory.why_beside(); !why.empty())
    std::cerr << "bough: " << why << "; the results of this run stand in " << directory.directory().string() << "\n";
  if (directory.can_go_on()) {
    std::cerr << "bough: " << file.scene.name << ": --resume goes on from time "
              << io::rounded_text(directory.time(), 6) << "\n";
    return exit_stopped;
  }
  if (summary->status != records::RunStatus::ok || !directory.why_beside().empty()) return exit_failed;
  const bool all_hold = std::all_of(summary->expected.begin(), summary->expected.end(),
                                    [](const auto& figure) { return figure.holds || !figure.reached; });
  if (arguments.strict && !summary->doubts.empty()) return exit_failed;
  return arguments.check_expected && !all_hold ? exit_failed : exit_done;
}

}  // namespace bough::app
