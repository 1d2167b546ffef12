#include "case_process.hpp"

#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>

#include "bough/io/number_text.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/io/run_store.hpp"
#include "bough/records/no_recorder.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/simulate.hpp"
#include "bough/study/case_folders.hpp"
#include "bough/version.hpp"
#include "terminal.hpp"

namespace bough::app {

struct FolderAllowance::Shared {
  std::atomic<std::size_t> left;
};

FolderAllowance::FolderAllowance(std::size_t count) {
  void* memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory != MAP_FAILED) shared_ = new (memory) Shared{count};
}

FolderAllowance::~FolderAllowance() {
  if (shared_ != nullptr) ::munmap(shared_, sizeof(Shared));
}

bool FolderAllowance::take() {
  if (shared_ == nullptr) return false;
  std::size_t left = shared_->left;
  while (left > 0)
    if (shared_->left.compare_exchange_weak(left, left - 1)) return true;
  return false;
}

namespace {

/// Enough to know what is meant; `bough check` tells all.
std::string first_problems(const io::SceneFile& file) {
  constexpr std::size_t shown = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(shown, file.problems.size()); ++k) text += file.problems[k].text() + "\n";
  if (file.problems.size() > shown) text += "and " + std::to_string(file.problems.size() - shown) + " more problems";
  return text;
}

records::Summary simulate(const scene::Scene& scene, const CaseSettings& settings,
                          std::chrono::steady_clock::time_point start, records::Recorder& recorder) {
  run::SimulateOptions options{.threads = std::min(scene.solver.threads, settings.threads), .checks_estimate = true};
  options.stopped_by = [&]() -> std::string {
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - start;
    const bool is_late = settings.time_limit > 0.0 && age.count() >= 0.99 * settings.time_limit;
    return is_late ? "the time limit of " + io::rounded_text(settings.time_limit, 6) + " s" : "the user";
  };
  return run::simulate(scene, options, recorder, [](const records::Progress&) { return !interrupted(); });
}

/// What was not foreseen for a case by its estimate ends as a lack of memory in this case, not as one of the machine.
/// Memory that is no data, of files say, is watched from outside (study::BatchOptions::resident_limit).
void limit_memory(double bytes) {
  constexpr double program = 128e6;  // what the program itself and its reader take
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_cur, static_cast<rlim_t>(std::min(bytes + program, 1e18)));
  (void)::setrlimit(RLIMIT_DATA, &limit);
}

int status_of(const records::Summary& summary) {
  return summary.status == records::RunStatus::ok ? exit_done : exit_failed;
}

int run_into_folder(const study::BatchCase& which, const CaseSettings& settings, const scene::Scene& scene,
                    const io::RunOrigin& origin, std::chrono::steady_clock::time_point start,
                    study::CaseReport& report) {
  records::Summary summary;
  io::RunDirectory directory(which.directory, std::string(version), origin, false,
                             {scene.output.checkpoint, scene.output.checkpoint_time, settings.resume},
                             scene.output.formats);
  try {
    directory.open();
    summary = simulate(scene, settings, start, directory);
  } catch (const std::exception& error) {
    report.cause = cause_of(error);
    report.is_unwritten = dynamic_cast<const std::bad_alloc*>(&error) == nullptr;  // simulate throws nothing else
    summary.scene = scene.name;
    directory.end_as_failed(summary, cause_of(error));
    if (directory.has_ended()) report.directory = directory.directory();
    return exit_failed;
  }
  report.take(summary, scene);
  report.directory = directory.directory();
  return status_of(summary);
}

/// Results that would take more memory than runs of the usual size are written as they come, into a folder.
bool has_large_results(const scene::Scene& scene) {
  constexpr double bytes_a_number = 20.0, most_bytes = 64e6, numbers_a_sensor = 6.0, numbers_a_node = 6.0;
  const run::Estimate e = run::estimate_run(scene);
  const double rows = e.steps / std::max(1, scene.output.stride);
  const double frames = scene.output.motion ? e.steps / std::max(1, scene.output.motion_stride) : 0.0;
  return bytes_a_number * (rows * (3.0 + numbers_a_sensor * static_cast<double>(scene.sensors.size())) +
                           frames * numbers_a_node * (e.nodes + e.elements)) >
         most_bytes;
}

/// The store of this process: opened by its first case, held to its end.
io::RunStore& store_in(const std::filesystem::path& folder) {
  static io::RunStore store(folder);
  return store;
}

/// Whether a run may take longer than its checkpoints are apart, for which it needs a folder.
bool takes_long(const scene::Scene& scene) {
  return scene.output.checkpoint > 0.0 && run::estimate_run(scene).seconds() > scene.output.checkpoint;
}

int run_into_store(const study::BatchCase& which, const CaseSettings& settings, const scene::Scene& scene,
                   const io::RunOrigin& origin, std::chrono::steady_clock::time_point start,
                   FolderAllowance& failed_folders, study::CaseReport& report, io::SharedText& rows) {
  records::Summary summary;
  io::RunInMemory run(std::string(version), origin, &rows);
  try {
    summary = simulate(scene, settings, start, run);
    report.take(summary, scene);
  } catch (const std::exception& error) {
    report.cause = cause_of(error);
    summary.scene = scene.name;
    run.end_as_failed(summary, cause_of(error));
    summary.status = records::RunStatus::failed;
  }
  const int status = status_of(summary);
  report.is_unwritten = true;  // until it is
  if (status == exit_failed && failed_folders.take())
    report.directory = io::unpack_run(run.files(), io::FolderState::failed, which.directory, which.owner());
  else
    report.stored = store_in(settings.out).add(run.files(), which.key);
  if (report.stored) (void)study::remove_case(which.directory);  // what is left there is of an attempt that was stopped
  report.is_unwritten = false;
  return status;
}

/// Runs in the case's own process.
int run_case_within(const study::BatchCase& which, const CaseSettings& settings, const CaseSource& source,
                    FolderAllowance& failed_folders, study::CaseReport& report, io::SharedText& rows) {
  catch_interrupts(Repeated::ignored);
  const auto start = std::chrono::steady_clock::now();
  const io::SceneFile file = source.read(which);
  if (!file.ok()) {
    report.cause = first_problems(file);
    return exit_bad_input;
  }
  report.cause = run::refusal(file.scene, settings.memory_limit);
  if (!report.cause.empty()) return exit_bad_input;
  io::RunOrigin origin = origin_of(which.scene, file, which.overrides);
  origin.key = which.key;
  switch (settings.kept_as(which)) {
    case Kept::nothing:
      break;
    case Kept::store:
      if (!has_large_results(file.scene) && !takes_long(file.scene))
        return run_into_store(which, settings, file.scene, origin, start, failed_folders, report, rows);
      [[fallthrough]];
    case Kept::folder:
      return run_into_folder(which, settings, file.scene, origin, start, report);
  }
  records::NoRecorder nothing;
  const records::Summary summary = simulate(file.scene, settings, start, nothing);
  report.take(summary, file.scene);
  return status_of(summary);
}

/// What a case that failed changes to be tried again: half the step, or twice the load steps; `which` names what it
/// did.
std::string smaller_steps(const study::BatchCase& which, const CaseSource& source) {
  const io::SceneFile file = source.read(which);
  if (!file.ok()) return {};
  const scene::Analysis& analysis = file.scene.analysis;
  std::string change = "/analysis/";
  if (analysis.kind == scene::AnalysisKind::statics)
    return change + "load_steps=" + std::to_string(2 * analysis.load_steps);
  change += "step_size=";
  io::append_number(change, 0.5 * analysis.step_size);
  return change;
}

}  // namespace

int run_case(const study::BatchCase& which, const CaseSettings& settings, const CaseSource& source,
             FolderAllowance& failed_folders, study::CaseReport& report, io::SharedText& rows) {
  limit_memory(settings.memory_limit);
  try {
    int code = run_case_within(which, settings, source, failed_folders, report, rows);
    study::BatchCase again = which;
    for (int k = 0; k < settings.retries && code == exit_failed && !interrupted(); ++k) {
      const std::string change = smaller_steps(again, source);
      const std::string why = report.cause;
      again.overrides.push_back(change);
      report = {};
      code = run_case_within(again, settings, source, failed_folders, report, rows);
      const std::string retried = "tried again with " + change;
      report.cause = code == exit_done ? retried + ", for it had failed: " + why : retried + ": " + report.cause;
    }
    return code;
  } catch (const std::exception& error) {
    report.cause = cause_of(error);
    return exit_failed;
  }
}

}  // namespace bough::app
