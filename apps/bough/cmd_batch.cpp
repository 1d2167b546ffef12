/// bough batch FOLDER: every scene of a folder, one thread a case.
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>

#include "arguments.hpp"
#include "bough/io/history.hpp"
#include "bough/run/estimate.hpp"
#include "case_run.hpp"
#include "collect_run.hpp"
#include "shard_run.hpp"
#include "terminal.hpp"

namespace bough::app {

int batch(const BatchArguments& arguments) {
  if (!arguments.shards.empty()) return collect(arguments);
  WholeBatch whole{.verb = "batch", .source = arguments.folder, .inputs = {arguments.folder}};
  std::optional<study::Shard> shard;
  if (!arguments.shard.empty()) shard = shard_asked_for(arguments.shard);
  std::vector<study::BatchCase> cases;
  try {
    cases = study::cases_in(arguments.folder, shard ? folder_of(arguments, *shard) : arguments.out);
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_bad_input;
  }
  whole.list = "case\n";
  for (study::BatchCase& c : cases) {
    c.overrides = arguments.overrides;
    whole.list += io::csv_field(c.name) + '\n';
  }
  whole.cases = study::CaseList(std::move(cases));
  CaseSettings settings{arguments, arguments.folder.string(), kept_of(arguments, whole.cases.size())};
  const CaseSource source{[](const study::BatchCase& which) { return io::read_scene(which.scene, which.overrides); },
                          [](const study::BatchCase& which) {
                            std::ifstream in(which.scene,
                                             std::ios::binary);  // of one that cannot be read its case tells
                            return std::string(std::istreambuf_iterator<char>(in), {});
                          }};
  whole.work = [&] {
    std::vector<double> work;
    for (std::size_t i = 0; i < whole.cases.size(); ++i) work.push_back(work_of(source.read(whole.cases.at(i))));
    return work;
  };
  if (shard || !arguments.job_engine.empty())
    if (list_for_shards(whole, arguments) != whole.list)
      refuse_other_list(arguments, "the scenes of " + arguments.folder.string() + " have other names");
  if (!arguments.job_engine.empty()) return export_jobs(whole, arguments, source);
  if (shard) take_shard(*shard, source, whole, settings);
  const io::OutputCollection collection(settings.out, "batch", whole.inputs);
  return finish_cases(run_cases(whole.cases, settings, source, collection), {}, settings, collection);
}

}  // namespace bough::app
