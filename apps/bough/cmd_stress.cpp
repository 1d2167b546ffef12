/// bough stress: the standing table of stiff and extreme cases.
#include <algorithm>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/stress/stress.hpp"
#include "bough/version.hpp"
#include "memory_limit.hpp"
#include "pages.hpp"
#include "terminal.hpp"

namespace bough::app {

int stress(const StressArguments& arguments) {
  const stress::StressOptions options{arguments.quick, arguments.threads > 0 ? arguments.threads : default_threads(),
                                      arguments.only,
                                      arguments.memory_limit > 0.0 ? arguments.memory_limit : available_memory()};
  const std::vector<std::string> problems = problems_in(options);
  for (const std::string& problem : problems) std::cerr << "bough: " << problem << "\n";
  if (!problems.empty()) return exit_bad_input;
  io::OutputFolder folder(arguments.out, {.verb = "stress", .replaces = arguments.replace},
                          {"stress.json", "stress.html"});
  catch_interrupts();
  const auto tell = [&](const stress::StressCase& c, std::size_t done, std::size_t all) {
    if (arguments.quiet && c.is_as_expected()) return;
    std::ostream& out = c.is_as_expected() ? std::cout : std::cerr;
    out << "[" << done << "/" << all << "] " << c.name << ": " << text_of(c.status);
    if (!c.is_as_expected())
      out << ", listed as " << text_of(c.expected) << ": " << c.measured;
    else if (c.status == stress::StressStatus::fails)
      out << ", as listed: " << c.reason;
    out << " (" << io::rounded_text(c.seconds, 2) << " s)" << std::endl;
  };
  const std::vector<stress::StressCase> cases = stress::run_stress(options, tell, interrupted);
  std::string page;
  try {
    folder.write("stress.json", stress::stress_json(cases, options, std::string(version)));
    page = write_stress_page(folder, "stress.html", cases, options);
    folder.publish(interrupted() ? io::FolderState::failed : io::FolderState::good);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_failed;
  }
  tell_if_beside(folder);
  const auto count = [&](stress::StressStatus status) {
    return std::count_if(cases.begin(), cases.end(), [status](const auto& c) { return c.status == status; });
  };
  double ratio = 0.0;
  for (const stress::StressCase& c : cases) ratio = std::max(ratio, c.lapack_ratio);
  if (!arguments.quiet)
    std::cout << count(stress::StressStatus::holds) << " hold, " << count(stress::StressStatus::fails) << " fail, "
              << count(stress::StressStatus::refused) << " refused by name; LAPACK ratio at most "
              << io::rounded_text(ratio, 2) << ": "
              << (folder.folder() / (page.empty() ? "stress.json" : page)).string() << "\n";
  const bool is_whole = !interrupted();
  const bool is_bad = std::any_of(cases.begin(), cases.end(), [](const stress::StressCase& c) {
    return !c.is_as_expected() && c.expected != stress::StressStatus::fails;
  });
  return is_whole && !is_bad ? exit_done : exit_failed;
}

}  // namespace bough::app
