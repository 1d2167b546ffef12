/// bough tune SCENE: the solver options that run a scene fastest on this machine.
#include <unistd.h>

#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/study/tune.hpp"
#include "memory_limit.hpp"
#include "result_text.hpp"
#include "standard_streams.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

std::string candidates_text(const study::TuneResult& result) {
  std::vector<std::vector<std::string>> rows{{"  options", "sub-domains", "levels", "step", "low", "high", ""}};
  for (std::size_t k = 0; k < result.candidates.size(); ++k) {
    const study::TuneCandidate& c = result.candidates[k];
    std::string word = !c.failure.empty() ? c.failure : k == result.best ? "best" : "";
    if (c.is_present) word = k == result.best ? "present, best" : "present" + (word.empty() ? "" : ", " + word);
    rows.push_back(
        {"  " + study::solver_block(c.solver), c.num_subdomains > 0 ? std::to_string(c.num_subdomains) : "-",
         c.num_levels > 0 ? std::to_string(c.num_levels) : "-", c.seconds.empty() ? "-" : io::seconds_text(c.median),
         c.seconds.empty() ? "-" : io::seconds_text(c.low), c.seconds.empty() ? "-" : io::seconds_text(c.high), word});
  }
  return table_text(rows);
}

}  // namespace

int tune(const TuneArguments& arguments) {
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, false);
  if (!file.ok()) return exit_bad_input;
  io::refuse_to_overwrite({arguments.scene}, {arguments.out});
  if (refuse_for_memory(arguments.scene, file.scene, arguments.memory_limit)) return exit_bad_input;
  catch_interrupts();
  study::TuneOptions options;
  options.threads = arguments.threads > 0 ? arguments.threads : default_threads();
  options.steps = arguments.steps;
  options.seconds = arguments.seconds;
  const bool on_terminal = isatty(STDERR_FILENO) != 0;
  const study::TuneResult result = study::tune(file.scene, options, [&](int done, int all) {
    if (on_terminal)
      write_to_terminal(true, std::string(line_start) + "run " + std::to_string(done) + " of at most " +
                                  std::to_string(all) + std::string(line_rest_erased));
    return !interrupted();
  });
  if (on_terminal) clear_line();
  const study::TuneCandidate& best = result.candidates[result.best];
  if (best.seconds.empty() || !best.failure.empty()) {
    std::cerr << "bough: " << file.scene.name << ": no options run this scene: " << best.failure << "\n";
    return exit_failed;
  }
  std::cerr << file.scene.name << ": time of a step, median of " << result.rounds << " interleaved rounds of "
            << options.steps << " steps with " << options.threads << (options.threads == 1 ? " thread\n" : " threads\n")
            << candidates_text(result);
  if (result.best == result.present) {
    std::cerr << "Nothing is faster than the present options by 2 % or more.\n";
  } else if (result.candidates[result.present].failure.empty()) {
    std::cerr << "It takes " << io::rounded_text(100.0 * result.gain, 2)
              << " % less time than the present options (median over the rounds).\n";
  } else {
    std::cerr << "The present options do not run: " << result.candidates[result.present].failure << "\n";
  }
  const std::string block = study::solver_block(best.solver);
  try {
    if (!arguments.out.empty()) io::write_file(arguments.out, block + "\n");
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_failed;
  }
  std::cerr << "Use it as \"solver\" of the scene, or --set /solver='...':\n";
  std::cout << block << "\n" << std::flush;
  return exit_done;
}

}  // namespace bough::app
