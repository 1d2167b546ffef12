/// bough run SCENE: one simulation from a scene to a directory of results.
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "arguments.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/io/stored_states.hpp"
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
                                              const std::shared_ptr<const records::StoredState>& from,
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
  options.from = from;
  options.checks_estimate = true;
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

/// The state in which the run starts; none, after a message, where there is none or the scene cannot start from it.
std::optional<io::FoundState> find_start(const RunArguments& arguments, const scene::Scene& scene) {
  const std::string name = "bough: " + arguments.scene.string() + ": ";
  std::vector<std::string> skipped;
  std::optional<io::FoundState> found;
  std::string fault;
  try {
    found = io::read_unchanged(arguments.from, [&] {
      skipped.clear();
      return io::find_state(arguments.from, arguments.time, skipped);
    });
  } catch (const std::runtime_error& error) {
    fault = error.what();
  }
  for (const std::string& text : skipped) std::cerr << name << text << "\n";
  if (!found) {
    std::cerr << name << "cannot start from a state of another run: " << fault << "\n";
    return std::nullopt;
  }
  const std::vector<std::string> problems = run::problems_of_start(scene, found->state);
  for (const std::string& problem : problems)
    std::cerr << name << "cannot start from " << found->file.string() << ": " << problem << "\n";
  if (!problems.empty()) found.reset();
  return found;
}

/// What was told about checkpoints since the last call.
void print_told(const io::RunDirectory& directory, const std::string& scene, bool quiet, std::size_t& printed) {
  for (; printed < directory.told().size(); ++printed)
    if (!quiet) std::cerr << "bough: " << scene << ": " << directory.told()[printed] << "\n";
}

}  // namespace

int run(const RunArguments& arguments) {
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, arguments.quiet);
  if (!file.ok()) return exit_bad_input;
  if (refuse_for_memory(arguments.scene, file.scene, arguments.memory_limit)) return exit_bad_input;
  io::RunOrigin origin = origin_of(arguments.scene, file, arguments.overrides);
  std::shared_ptr<const records::StoredState> from;
  if (!arguments.from.empty()) {
    std::optional<io::FoundState> found = find_start(arguments, file.scene);
    if (!found) return exit_bad_input;
    origin.from = io::StartOrigin{arguments.from, found->file, found->state.time, found->hash};
    from = std::make_shared<const records::StoredState>(std::move(found->state));
  }
  io::RunDirectory directory(arguments.out.empty() ? std::filesystem::path(file.scene.name + ".out") : arguments.out,
                             std::string(version), std::move(origin), arguments.replace,
                             {file.scene.output.checkpoint, file.scene.output.checkpoint_time, arguments.resume},
                             file.scene.output.formats);
  if (arguments.resume && !arguments.replace && directory.has_all()) {
    if (!arguments.quiet)
      std::cout << file.scene.name << ": the run has ended, and its results stand in " << directory.directory().string()
                << "; nothing was done (--replace runs it anew)\n";
    return exit_done;
  }
  directory.open();
  std::size_t printed = 0;
  print_told(directory, file.scene.name, arguments.quiet, printed);
  const std::optional<records::Summary> summary = simulate_into(directory, file, from, arguments);
  print_told(directory, file.scene.name, arguments.quiet, printed);
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
