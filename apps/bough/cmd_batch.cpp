/// bough batch FOLDER: every scene of a folder, one thread a case.
#include <cmath>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/history.hpp"
#include "bough/io/input_file.hpp"
#include "bough/run/estimate.hpp"
#include "case_run.hpp"
#include "collect_run.hpp"
#include "shard_run.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// The scene of a case. One whose folder would take the place of a file of the batch is bad input.
io::SceneFile read_case(const study::BatchCase& which) {
  if (!study::is_name_of_batch(which.name)) return io::read_scene(which.scene, which.overrides);
  io::SceneFile refused;
  io::Problem& problem = refused.problems.emplace_back();
  problem.value = which.scene.string();
  problem.rule = "a batch keeps names like " + which.name + " for its own files";
  problem.hint = "give the scene another name";
  return refused;
}

/// The text that identifies a case. Of a file that cannot be read the reason: its case fails, and says why.
std::string text_of_case(const study::BatchCase& which) {
  try {
    return io::read_text(which.scene, io::max_file_bytes);
  } catch (const io::Unreadable& fault) {
    return fault.what();
  }
}

}  // namespace

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
  const CaseSource source{read_case, text_of_case};
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
  io::OutputCollection collection(settings.out, take_folder(settings, whole.verb, whole.source), whole.inputs,
                                  io::Writers::one);
  return finish_cases(run_cases(whole.cases, settings, source, collection), {}, settings, collection);
}

}  // namespace bough::app
