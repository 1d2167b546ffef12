#include "shard_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "bough/io/digest.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/run/estimate.hpp"
#include "bough/study/job_files.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

namespace fs = std::filesystem;

/// Of what all shards have to agree in, besides the list of cases: scenes, what is set in them, the policy.
std::string content_of(const WholeBatch& batch, const CaseArguments& arguments, const CaseSource& source) {
  io::Digest digest;
  digest.add(policy_of(arguments));
  std::string before;
  for (std::size_t i = 0; i < batch.cases.size(); ++i) {
    const study::BatchCase c = batch.cases.at(i);
    std::string text = source.text(c);
    if (text != before) digest.add(text);
    before = std::move(text);
    for (const std::string& o : c.overrides) digest.add(o + '\n');
  }
  return digest.text();
}

}  // namespace

study::Shard shard_asked_for(const std::string& text) {
  try {
    study::Shard shard = study::read_shard(text, [](const char* name) { return std::getenv(name); });
    std::cout << "shard " << shard.number << " of " << shard.count << ", from " << shard.origin << std::endl;
    return shard;
  } catch (const std::runtime_error& error) {
    throw io::OutputRefused(error.what());
  }
}

fs::path folder_of(const CaseArguments& arguments, const study::Shard& shard) {
  return arguments.out / study::folder_name(shard);
}

double work_of(const io::SceneFile& file) {
  if (!file.ok()) return 0.0;
  const run::Estimate e = run::estimate_run(file.scene);
  const double work = e.unknowns * e.steps;
  return std::isfinite(work) ? work : 0.0;
}

void refuse_other_list(const CaseArguments& arguments, const std::string& why) {
  throw io::OutputRefused((arguments.out / study::cases_file).string() + " lists the cases of another batch: " + why +
                          "; give --out a new name");
}

std::string list_for_shards(const WholeBatch& batch, const CaseArguments& arguments) {
  const fs::path file = arguments.out / study::cases_file;
  std::error_code ignored;
  if (!fs::exists(file, ignored))  // later shards take no offence at what engines write beside
    io::OutputCollection(arguments.out, {batch.verb, batch.source}, batch.inputs)
        .write_once(study::cases_file, batch.list);
  return io::read_text(file);
}

void take_shard(const study::Shard& shard, const CaseSource& source, WholeBatch& batch, CaseSettings& settings) {
  settings.shard_record = study::ShardRecord{batch.verb,
                                             settings.title,
                                             fs::absolute(batch.source).lexically_normal().string(),
                                             io::digest_of(batch.list),
                                             content_of(batch, settings, source),
                                             shard,
                                             study::this_machine()};
  settings.out = folder_of(settings, shard);
  const std::vector<std::size_t> shards = study::shards_of(batch.work(), shard.count);
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < batch.cases.size(); ++i)
    if (shards[i] + 1 == shard.number) own.push_back(i);
  batch.cases = study::chosen(batch.cases, std::move(own));
}

namespace {

/// Seconds of all cases and memory of the largest, from at most a thousand of them.
run::Estimate predicted(const study::CaseList& cases, const CaseSource& source, double& seconds) {
  constexpr std::size_t most_looks = 1000;
  run::Estimate largest;
  std::size_t looked_at = 0;
  const std::size_t every = (cases.size() + most_looks - 1) / most_looks;
  seconds = 0.0;
  for (std::size_t i = 0; i < cases.size(); i += every) {
    ++looked_at;
    const io::SceneFile file = source.read(cases.at(i));
    if (!file.ok()) continue;
    const run::Estimate e = run::estimate_run(file.scene);
    seconds += e.seconds();
    if (e.memory_bytes > largest.memory_bytes) largest = e;
  }
  seconds *= static_cast<double>(cases.size()) / static_cast<double>(std::max<std::size_t>(1, looked_at));
  return largest;
}

/// The folder that holds all of them, as far as their names agree.
fs::path common_folder(const std::vector<fs::path>& paths) {
  fs::path common = paths.front().parent_path();
  for (const fs::path& path : paths) {
    fs::path shared;
    for (auto a = common.begin(), b = path.begin(); a != common.end() && b != path.end() && *a == *b; ++a, ++b)
      shared /= *a;
    common = shared;
  }
  return common;
}

std::vector<std::string> words_of(const WholeBatch& batch, const CaseArguments& a, const fs::path& out) {
  std::vector<std::string> words = {batch.verb,  fs::absolute(batch.source).lexically_normal().string(),
                                    "--out",     out.string(),
                                    "--threads", std::to_string(std::max(1, a.threads))};
  const auto add = [&words](const char* option, double value) {
    if (value <= 0.0) return;
    words.emplace_back(option);
    words.emplace_back();
    io::append_number(words.back(), value);
  };
  add("--time-limit", a.time_limit);
  add("--memory-limit", a.memory_limit);
  add("--stop-after", a.stop_after);
  add("--retries", a.retries);
  for (const std::string& o : a.overrides) words.insert(words.end(), {"--set", o});
  if (a.check_expected) words.emplace_back("--check-expected");
  if (a.strict) words.emplace_back("--strict");
  words.insert(words.end(), {"--keep", a.keep});
  for (const std::string& name : a.keep_cases) words.insert(words.end(), {"--keep-case", name});
  words.insert(words.end(), {"--resume", "--quiet"});
  return words;
}

study::JobEngine engine_named(const std::string& name) {
  return name == "slurm"       ? study::JobEngine::slurm
         : name == "parallel"  ? study::JobEngine::parallel
         : name == "snakemake" ? study::JobEngine::snakemake
                               : study::JobEngine::kubernetes;
}

}  // namespace

int export_jobs(const WholeBatch& batch, const CaseArguments& arguments, const CaseSource& source) {
  constexpr double cases_a_task = 300.0, seconds_a_task = 3600.0;
  constexpr double program_bytes = 256e6, spare = 1.5;  // of what a task asks for, since estimates are rough
  double seconds = 0.0;
  const run::Estimate largest = predicted(batch.cases, source, seconds);
  const auto cases = static_cast<double>(batch.cases.size());
  const double count = arguments.tasks > 0 ? arguments.tasks
                                           : std::ceil(std::max({1.0, cases / cases_a_task, seconds / seconds_a_task}));
  const fs::path out = fs::absolute(arguments.out).lexically_normal();
  std::vector<fs::path> paths = {out};
  for (const fs::path& input : batch.inputs) paths.push_back(fs::absolute(input).lexically_normal());
  study::JobSpec spec;
  spec.program = fs::read_symlink("/proc/self/exe").string();
  spec.words = words_of(batch, arguments, out);
  spec.out = out.string();
  spec.folder = arguments.out.string();
  spec.common_folder = common_folder(paths).string();
  spec.count = static_cast<std::size_t>(std::min(count, std::max(1.0, cases)));
  spec.threads = std::max(1, arguments.threads);
  spec.memory_bytes = program_bytes + spare * spec.threads * largest.memory_bytes;
  study::JobFile file;
  try {
    file = study::job_file(engine_named(arguments.job_engine), spec);
  } catch (const std::runtime_error& error) {
    throw io::OutputRefused(error.what());
  }
  io::OutputCollection collection(arguments.out, {batch.verb, batch.source}, batch.inputs);
  collection.write(file.name, file.text);
  std::cout << (arguments.out / file.name).string() << ": " << batch.cases.size() << " cases in " << spec.count
            << " tasks, of about " << io::seconds_text(seconds / static_cast<double>(spec.count) / spec.threads)
            << " each\nrun it by      " << file.how_to_run << "\n";
  if (arguments.job_engine != "snakemake")
    std::cout << "and after that bough batch --collect " << study::shell_quoted(arguments.out.string()) << " --out "
              << study::shell_quoted(arguments.out.string()) << "\n";
  return exit_done;
}

}  // namespace bough::app
