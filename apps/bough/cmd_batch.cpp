/// bough batch FOLDER: every scene of a folder, one thread a case.
#include <fstream>
#include <iostream>
#include <iterator>

#include "arguments.hpp"
#include "case_run.hpp"
#include "terminal.hpp"

namespace bough::app {

int batch(const BatchArguments& arguments) {
  std::vector<study::BatchCase> cases;
  try {
    cases = study::cases_in(arguments.folder, arguments.out);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_bad_input;
  }
  for (study::BatchCase& c : cases) c.overrides = arguments.overrides;
  const io::OutputCollection collection(arguments.out, "batch", {arguments.folder});
  const CaseSettings settings{arguments.out,        arguments.folder.string(), arguments.threads,
                              arguments.time_limit, arguments.memory_limit,    true,
                              arguments.quiet,      arguments.check_expected,  arguments.stop_after,
                              arguments.retries,    arguments.resume};
  const CaseSource source{[](const study::BatchCase& which) { return io::read_scene(which.scene, which.overrides); },
                          [](const study::BatchCase& which) {
                            std::ifstream in(which.scene,
                                             std::ios::binary);  // of one that cannot be read its case tells
                            return std::string(std::istreambuf_iterator<char>(in), {});
                          }};
  return finish_cases(run_cases(cases, settings, source, collection), {}, settings, collection);
}

}  // namespace bough::app
