#include "collect_run.hpp"

#include <algorithm>
#include <iostream>

#include "bough/io/read_sweep.hpp"
#include "case_run.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// Of the sweep that the cases came from, where it is still there with the same cases; else says why there are none.
std::vector<study::MeasureSensitivity> sensitivities_of(const study::Collected& all,
                                                        const std::filesystem::path& source) {
  const io::SweepFile file = io::read_sweep(source);
  std::string why;
  if (!file.ok()) {
    why = file.problems.front().text();
  } else {
    try {
      study::SweepCases made = study::make_cases(file.spec);
      why = study::adopt_cases(all.list, made);
    } catch (const std::exception& error) {
      why = error.what();
    }
  }
  if (why.empty()) return study::sensitivities_of(file.spec, all.results);
  std::cerr << "bough: no sensitivities, for " << source.string()
            << " is not the sweep of these shards (name the file after `batch` where it was moved): " << why << "\n";
  return {};
}

void tell_missing(const study::Collected& all) {
  constexpr std::size_t shown = 10;
  std::cerr << all.missing.size() << " of " << all.results.size() << " cases are missing:";
  for (std::size_t k = 0; k < std::min(shown, all.missing.size()); ++k) std::cerr << ' ' << all.missing[k];
  if (all.missing.size() > shown) std::cerr << " and " << all.missing.size() - shown << " more";
  std::cerr << "\n";
}

}  // namespace

int collect(const BatchArguments& arguments) {
  study::Collected all;
  try {
    all = study::collect_shards(arguments.shards);
  } catch (const std::runtime_error& error) {
    throw io::OutputRefused(error.what());
  }
  if (!arguments.quiet)
    std::cout << all.num_shards << " shards with " << all.results.size() - all.missing.size() << " of "
              << all.results.size() << " cases\n";
  if (!all.missing.empty()) tell_missing(all);
  if (!all.machines.empty())
    std::cerr << "bough: the rows come from machines with different arithmetic, so their last digits are not those of "
                 "one: the column \"machine\" of batch.csv says which is from where\n";
  std::vector<study::MeasureSensitivity> sensitivities;
  if (all.record.verb == "sweep" && all.results.size() > 0)
    sensitivities =
        sensitivities_of(all, arguments.folder.empty() ? std::filesystem::path(all.record.source) : arguments.folder);
  if (!arguments.quiet) print_sensitivities(sensitivities);
  const CaseSettings settings{arguments, all.record.title};
  io::OutputCollection collection(arguments.out, {all.record.verb, all.record.source}, {}, io::Writers::one);
  collection.write_once(study::cases_file, all.list);
  return finish_cases(all.results, sensitivities, settings, collection, &all);
}

}  // namespace bough::app
